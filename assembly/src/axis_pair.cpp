#include "axis_pair.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "dowel/assembly/thread.h"
#include "dowel/catalog/metric_thread.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

struct PlacedAxis {
  const Instance* instance = nullptr;
  const Feature* feature = nullptr;
  Eigen::Vector3d origin_W;
  Eigen::Vector3d direction_W;
  Eigen::Vector3d run_W = Eigen::Vector3d::Zero();  ///< slotted holes
};

bool is_slotted_hole(const Feature& feature) {
  return feature.kind == FeatureKind::Slot && feature.slot &&
         feature.slot->type == SlotShape::Type::Through;
}

/// How far the axis is from that of the hole; in a slotted hole, from the line between its two
/// ends.
double offset_mm(const PlacedAxis& hole, const Eigen::Vector3d& across) {
  if (hole.feature->kind == FeatureKind::Hole) return across.norm();
  const double half_mm =
      0.5 * std::max(0.0, hole.feature->slot->length_mm - hole.feature->diameter_mm);
  const double along_mm = hole.run_W.dot(across);
  return (across - std::clamp(along_mm, -half_mm, half_mm) * hole.run_W).norm();
}

double narrowest_mm(const Feature& hole, const DepthRange& range) {
  double narrowest = hole.kind == FeatureKind::Slot ? hole.diameter_mm : 0.0;
  for (const HoleSegment& segment : hole.segments) {
    const double overlap_mm =
        std::min(segment.to_mm, range.to_mm) - std::max(segment.from_mm, range.from_mm);
    if (segment.type != HoleSegment::Type::Cylinder || overlap_mm <= kCoincident_mm) continue;
    if (narrowest == 0.0 || segment.diameter_mm < narrowest) narrowest = segment.diameter_mm;
  }
  return narrowest;
}

/// Nothing where the two do not meet.
std::optional<AxisPair> pair_of(const PlacedAxis& shaft, const PlacedAxis& hole) {
  const double along = hole.direction_W.dot(shaft.direction_W);
  if (1.0 - std::abs(along) > 0.5 * kCoaxial_rad * kCoaxial_rad) return std::nullopt;
  const Eigen::Vector3d to_shaft = shaft.origin_W - hole.origin_W;
  const double depth_mm = hole.direction_W.dot(to_shaft);
  AxisPair pair;
  pair.offset_mm = offset_mm(hole, to_shaft - depth_mm * hole.direction_W);
  if (pair.offset_mm > 0.5 * hole.feature->diameter_mm) return std::nullopt;
  const double other_end_mm = depth_mm + along * shaft.feature->depth_mm;
  const DepthRange range{std::max(0.0, std::min(depth_mm, other_end_mm)),
                         std::min(hole.feature->depth_mm, std::max(depth_mm, other_end_mm))};
  pair.overlap_mm = range.length_mm();
  if (pair.overlap_mm <= kDefaultTolerance_mm) return std::nullopt;
  pair.shaft_instance = shaft.instance->name;
  pair.hole_instance = hole.instance->name;
  pair.shaft = shaft.feature;
  pair.hole = hole.feature;
  pair.past_opening_mm = -std::min(depth_mm, other_end_mm);
  pair.bore_mm = narrowest_mm(*hole.feature, range);
  pair.is_coaxial = pair.offset_mm <= kCoaxial_mm;
  if (!pair.is_coaxial || hole.feature->kind != FeatureKind::Hole) return pair;
  pair.engagement_mm =
      engagement_mm(*shaft.feature, shaft.instance->X_WI, *hole.feature, hole.instance->X_WI);
  pair.is_thread = pair.engagement_mm > 0.0;
  if (const auto core = core_hole(*hole.feature, shaft.feature->diameter_mm)) {
    pair.tip_to_end_mm = core->to_mm - std::max(depth_mm, other_end_mm);
  }
  return pair;
}

}  // namespace

std::vector<AxisPair> axis_pairs(const ProjectState& state, const ElementOf& element_of) {
  struct Axes {
    std::vector<PlacedAxis> shafts;
    std::vector<PlacedAxis> holes;
  };
  std::map<const Instance*, Axes> axes;
  for (const auto& [name, instance] : state.instances) {
    Axes& of = axes[&instance];
    for (const Feature& feature : element_of(instance).features) {
      const bool is_hole = feature.kind == FeatureKind::Hole || is_slotted_hole(feature);
      if (!is_hole && feature.kind != FeatureKind::Shaft) continue;
      PlacedAxis axis{&instance, &feature, instance.X_WI * feature.origin,
                      instance.X_WI.rotation() * feature.direction};
      if (is_slotted_hole(feature)) axis.run_W = instance.X_WI.rotation() * feature.slot->run;
      (is_hole ? of.holes : of.shafts).push_back(axis);
    }
  }
  std::vector<AxisPair> pairs;
  const auto add = [&](const Axes& of_shafts, const Axes& of_holes) {
    for (const PlacedAxis& shaft : of_shafts.shafts) {
      for (const PlacedAxis& hole : of_holes.holes) {
        if (auto pair = pair_of(shaft, hole)) pairs.push_back(std::move(*pair));
      }
    }
  };
  // A shaft that is in a hole is in the box around it.
  for (const auto& [a, b] : near_pairs(state, element_of, 0.0, nullptr)) {
    add(axes.at(a), axes.at(b));
    add(axes.at(b), axes.at(a));
  }
  std::ranges::stable_sort(pairs, {}, [](const AxisPair& pair) {
    return std::tie(pair.shaft_instance, pair.hole_instance, pair.shaft->name, pair.hole->name);
  });
  return pairs;
}

}  // namespace dowel
