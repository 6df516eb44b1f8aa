#include "shafts.h"

#include <cmath>

namespace dowel {
namespace {

/// Whether a shaft with two free or two shouldered ends points up its axis: down in the part (-z,
/// then -y, then -x), as a pin that is put into a hole.
bool points_up(const Eigen::Vector3d& direction) {
  for (const Eigen::Index i : {2, 1, 0}) {
    if (std::abs(direction[i]) > kUnitVectorSlack) return direction[i] < 0.0;
  }
  return true;
}

}  // namespace

std::vector<Feature> find_shafts(const std::vector<AxisBands>& axes) {
  std::vector<Feature> result;
  for (const AxisBands& about : axes) {
    for (const Band& band : about.bands) {
      if (band.is_inner || !band.is_cylinder || band.length_mm() <= kSameFeature_mm) continue;
      const bool low_shoulder = band.ends[0].lean > 0.0;
      const bool high_shoulder = band.ends[1].lean > 0.0;
      const bool is_up =
          low_shoulder != high_shoulder ? low_shoulder : points_up(about.axis.direction);
      Feature shaft;
      shaft.kind = FeatureKind::Shaft;
      shaft.origin = about.axis.at(band.ends[is_up ? 0 : 1].rim_mm);
      shaft.direction = is_up ? about.axis.direction : Eigen::Vector3d(-about.axis.direction);
      shaft.diameter_mm = 2.0 * band.radius_mm[0];
      shaft.depth_mm = band.length_mm();
      shaft.faces = band.faces;
      result.push_back(std::move(shaft));
    }
  }
  return result;
}

}  // namespace dowel
