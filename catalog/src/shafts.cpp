#include "shafts.h"

#include <algorithm>
#include <cmath>

#include "dowel/catalog/metric_thread.h"

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

/// Diameter to which a chamfer narrows `bands[i]` at one of its ends, its own where there is none.
/// A chamfer is a cone of about 45 degrees; the long cone that leads a pin in is none.
double chamfered_diameter_mm(const std::vector<Band>& bands, std::size_t i, std::size_t end) {
  constexpr double kLeastSlope = 0.5;  // radius over length
  double result_mm = 2.0 * bands[i].radius_mm[end];
  for (const Band& cone : bands) {
    if (cone.is_cylinder || cone.is_inner) continue;
    const std::size_t near = 1 - end;
    if (std::abs(cone.ends[near].rim_mm - bands[i].ends[end].rim_mm) > kSameFeature_mm) continue;
    const double drop_mm = cone.radius_mm[near] - cone.radius_mm[end];
    if (drop_mm < kLeastSlope * cone.length_mm()) continue;
    result_mm = std::min(result_mm, 2.0 * cone.radius_mm[end]);
  }
  return result_mm;
}

/// The thread that a shaft likely is, by a chamfer at either end. Discs and rings are none.
const MetricThread* likely_thread(const std::vector<Band>& bands, std::size_t i) {
  constexpr double kShortest = 0.75;  // in diameters
  if (bands[i].length_mm() < kShortest * 2.0 * bands[i].radius_mm[0]) return nullptr;
  for (const std::size_t end : {0U, 1U}) {
    if (const MetricThread* const thread = likely_thread_of_shaft(
            2.0 * bands[i].radius_mm[0], chamfered_diameter_mm(bands, i, end))) {
      return thread;
    }
  }
  return nullptr;
}

}  // namespace

std::vector<Feature> find_shafts(const std::vector<AxisBands>& axes) {
  std::vector<Feature> result;
  for (const AxisBands& about : axes) {
    for (std::size_t i = 0; i < about.bands.size(); ++i) {
      const Band& band = about.bands[i];
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
      if (const MetricThread* const thread = likely_thread(about.bands, i)) {
        shaft.thread = thread->name;
        shaft.thread_is_guess = true;
      }
      result.push_back(std::move(shaft));
    }
  }
  return result;
}

}  // namespace dowel
