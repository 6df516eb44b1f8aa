#include "holes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "dowel/kernel/check.h"

namespace dowel::library {
namespace {

constexpr double kDrillPoint_rad = 118.0 / 180.0 * std::numbers::pi;

DesignedFeature hole(const HolePlace& place, double diameter_mm, double depth_mm, bool through) {
  DesignedFeature feature;
  feature.geometry.name = place.name;
  feature.geometry.kind = FeatureKind::Hole;
  feature.geometry.origin = place.origin;
  feature.geometry.direction = place.direction;
  feature.geometry.diameter_mm = diameter_mm;
  feature.geometry.depth_mm = depth_mm;
  feature.geometry.through = through;
  return feature;
}

void add_cylinder(DesignedFeature& feature, double diameter_mm, double from_mm, double to_mm) {
  DOWEL_EXPECTS(to_mm > from_mm);
  feature.geometry.segments.push_back(
      {HoleSegment::Type::Cylinder, diameter_mm, diameter_mm, from_mm, to_mm});
}

}  // namespace

DesignedFeature plain_hole(const HolePlace& place, double diameter_mm, double depth_mm,
                           bool through) {
  DesignedFeature feature = hole(place, diameter_mm, depth_mm, through);
  add_cylinder(feature, diameter_mm, 0.0, depth_mm);
  if (!through) feature.geometry.blind_end = "flat";
  return feature;
}

DesignedFeature node_hole(const HolePlace& place, double depth_mm, bool through) {
  const double core_mm = fastener_size(kSystemThread).thread.minor_diameter_mm;
  DesignedFeature feature = hole(place, core_mm, depth_mm, through);
  add_cylinder(feature, kBore_mm, 0.0, kBoreDepth_mm);
  add_cylinder(feature, core_mm, kBoreDepth_mm, depth_mm);
  if (!through) {
    const double point_mm = core_mm / 2.0 / std::tan(kDrillPoint_rad / 2.0);
    feature.geometry.segments.push_back(
        {HoleSegment::Type::Cone, core_mm, 0.0, depth_mm, depth_mm + point_mm});
    feature.geometry.depth_mm = depth_mm + point_mm;
    feature.geometry.blind_end = "cone";
  }
  return threaded(fitted(std::move(feature), "H7"), std::string(kSystemThread));
}

DesignedFeature screw_hole(const HolePlace& place, double height_mm, double counterbore_depth_mm,
                           bool located) {
  const ThreadSize& thread = fastener_size(kSystemThread).thread;
  const double guide_mm = located ? thread.diameter_mm : 0.0;  // as long as wide
  DesignedFeature feature =
      hole(place, located ? kBore_mm : thread.clearance_hole_mm, height_mm, true);
  add_cylinder(feature, thread.counterbore_mm, 0.0, counterbore_depth_mm);
  const double guide_from_mm = height_mm - guide_mm;
  if (guide_from_mm > counterbore_depth_mm) {
    add_cylinder(feature, thread.clearance_hole_mm, counterbore_depth_mm, guide_from_mm);
  }
  if (located) {
    add_cylinder(feature, kBore_mm, std::max(guide_from_mm, counterbore_depth_mm), height_mm);
    feature.fit = "H7";
  }
  return feature;
}

}  // namespace dowel::library
