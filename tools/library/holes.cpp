#include "holes.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "dowel/kernel/check.h"

namespace dowel::library {
namespace {

constexpr double kDrillPoint_rad = 118.0 / 180.0 * std::numbers::pi;

Feature hole(const HolePlace& place, double diameter_mm, double depth_mm, bool through) {
  Feature feature;
  feature.use = place.use;
  feature.kind = FeatureKind::Hole;
  feature.origin = place.origin;
  feature.direction = place.direction;
  feature.diameter_mm = diameter_mm;
  feature.depth_mm = depth_mm;
  feature.through = through;
  return feature;
}

void add_cylinder(Feature& feature, double diameter_mm, double from_mm, double to_mm) {
  DOWEL_EXPECTS(to_mm > from_mm);
  feature.segments.push_back(
      {HoleSegment::Type::Cylinder, diameter_mm, diameter_mm, from_mm, to_mm});
}

/// Ends a blind hole `depth_mm` deep with the point of a drill.
void add_drill_point(Feature& feature, double diameter_mm, double depth_mm) {
  const double point_mm = diameter_mm / 2.0 / std::tan(kDrillPoint_rad / 2.0);
  feature.segments.push_back(
      {HoleSegment::Type::Cone, diameter_mm, 0.0, depth_mm, depth_mm + point_mm});
  feature.depth_mm = depth_mm + point_mm;
  feature.blind_end = "cone";
}

}  // namespace

Feature plain_hole(const HolePlace& place, double diameter_mm, double depth_mm, bool through) {
  Feature feature = hole(place, diameter_mm, depth_mm, through);
  add_cylinder(feature, diameter_mm, 0.0, depth_mm);
  if (!through) feature.blind_end = "flat";
  return feature;
}

Feature tapped_hole(const HolePlace& place, const ThreadSize& thread, double depth_mm,
                    bool through) {
  Feature feature = hole(place, thread.minor_diameter_mm, depth_mm, through);
  add_cylinder(feature, thread.minor_diameter_mm, 0.0, depth_mm);
  if (!through) add_drill_point(feature, thread.minor_diameter_mm, depth_mm);
  return threaded(std::move(feature), thread.name);
}

Feature node_hole(const System& system, const HolePlace& place, double depth_mm, bool through) {
  DOWEL_EXPECTS(system.node.has_value());
  const double core_mm = fastener_of(system).thread.minor_diameter_mm;
  Feature feature = hole(place, core_mm, depth_mm, through);
  add_cylinder(feature, system.node->bore_mm, 0.0, system.node->bore_depth_mm);
  add_cylinder(feature, core_mm, system.node->bore_depth_mm, depth_mm);
  if (!through) add_drill_point(feature, core_mm, depth_mm);
  return threaded(fitted(std::move(feature), "H7"), system.thread);
}

Feature top_hole(const System& system, const HolePlace& place) {
  if (system.node) return node_hole(system, place, system.node->thread_depth_mm, false);
  const ThreadSize& thread = fastener_of(system).thread;
  return tapped_hole(place, thread, 2.5 * thread.diameter_mm, false);
}

Feature screw_hole(const System& system, const HolePlace& place, double height_mm,
                   double counterbore_depth_mm, bool located) {
  const ThreadSize& thread = fastener_of(system).thread;
  const double guide_mm = located ? thread.diameter_mm : 0.0;
  Feature feature = hole(place, located ? system.node.value().bore_mm : thread.clearance_hole_mm,
                         height_mm, true);
  add_cylinder(feature, thread.counterbore_mm, 0.0, counterbore_depth_mm);
  const double guide_from_mm = height_mm - guide_mm;
  if (guide_from_mm > counterbore_depth_mm) {
    add_cylinder(feature, thread.clearance_hole_mm, counterbore_depth_mm, guide_from_mm);
  }
  if (located) {
    add_cylinder(feature, system.node->bore_mm, std::max(guide_from_mm, counterbore_depth_mm),
                 height_mm);
    feature.fit = "H7";
  }
  return feature;
}

Feature straight_slot(std::string use, SlotShape::Type type, const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& direction, double width_mm, double depth_mm,
                      double length_mm) {
  const auto end = type == SlotShape::Type::Through ? SlotShape::End::Round : SlotShape::End::Open;
  Feature feature;
  feature.use = std::move(use);
  feature.kind = FeatureKind::Slot;
  feature.origin = origin;
  feature.direction = direction;
  feature.diameter_mm = width_mm;
  feature.depth_mm = depth_mm;
  feature.through = type == SlotShape::Type::Through;
  feature.slot = SlotShape{};
  feature.slot->type = type;
  feature.slot->length_mm = length_mm;
  feature.slot->ends = {end, end};
  return feature;
}

Feature tee_slot(std::string use, const TeeSlotSize& size, const Eigen::Vector3d& origin,
                 const Eigen::Vector3d& run, double length_mm) {
  Feature feature = straight_slot(std::move(use), SlotShape::Type::Tee, origin, kDown,
                                  size.throat_mm, size.depth_mm, length_mm);
  feature.slot->run = run;
  feature.slot->throat_depth_mm = size.depth_mm - size.undercut_height_mm;
  feature.slot->undercut_width_mm = size.undercut_mm;
  feature.slot->undercut_height_mm = size.undercut_height_mm;
  feature.slot->nominal_mm = static_cast<std::uint32_t>(size.throat_mm);
  return fitted(std::move(feature), "H8");
}

Feature key_slot(const System& system, const Eigen::Vector3d& run, double length_mm) {
  DOWEL_EXPECTS(system.key_depth_mm > 0.0);
  Feature feature = straight_slot("key", SlotShape::Type::Plain, {0.0, 0.0, 0.0}, kUp,
                                  system.key_width_mm, system.key_depth_mm, length_mm);
  feature.slot->run = run;
  return fitted(std::move(feature), "H7");
}

}  // namespace dowel::library
