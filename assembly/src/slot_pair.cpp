#include "slot_pair.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include <Eigen/Geometry>

#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

bool is_slot_with_floor(const Feature& feature) {
  return feature.kind == FeatureKind::Slot && feature.slot &&
         feature.slot->type != SlotShape::Type::Through;
}

/// From, to.
struct Range {
  double from = std::numeric_limits<double>::infinity();
  double to = -std::numeric_limits<double>::infinity();

  void extend(double value) {
    from = std::min(from, value);
    to = std::max(to, value);
  }
  double common_with(double other_from, double other_to) const {
    return std::min(to, other_to) - std::max(from, other_from);
  }
};

/// A slot in the frame of the part that may stand in it.
struct SlotFrame {
  Eigen::Vector3d origin;
  Eigen::Vector3d into;
  Eigen::Vector3d run;
  Eigen::Vector3d across;
};

SlotFrame seen_from(const Pose& X_PS, const Feature& slot) {
  const Eigen::Vector3d into = X_PS.rotation() * slot.direction;
  const Eigen::Vector3d run = X_PS.rotation() * slot.slot->run;
  return {X_PS * slot.origin, into, run, into.cross(run)};
}

/// A planar face of the part by what the slot sees of it.
struct Flat {
  Eigen::Vector3d normal;
  Range across;
  Range depth;
  Range along;
};

std::vector<Flat> flats_of(const FacetedSolid& solid, const SlotFrame& slot) {
  std::vector<Flat> flats(solid.faces.size());
  for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
    Flat& flat = flats[solid.face_of[t]];
    for (const std::uint32_t vertex : solid.triangles[t]) {
      const Eigen::Vector3d from_mouth = solid.vertices[vertex] - slot.origin;
      flat.across.extend(slot.across.dot(from_mouth));
      flat.depth.extend(slot.into.dot(from_mouth));
      flat.along.extend(slot.run.dot(from_mouth));
    }
  }
  std::vector<Flat> planar;
  for (std::size_t face = 0; face < flats.size(); ++face) {
    const auto* const plane = std::get_if<PlaneSurface>(&solid.faces[face].surface);
    if (plane == nullptr) continue;
    planar.push_back(flats[face]);
    planar.back().normal = plane->normal;
  }
  return planar;
}

bool is_along(const Eigen::Vector3d& normal, const Eigen::Vector3d& direction) {
  return normal.dot(direction) >= 1.0 - 0.5 * kCoaxial_rad * kCoaxial_rad;
}

/// The two sides of a part that face the walls between two depths.
struct Sides {
  Range across;
  Range depth;
  bool has_low = false;
  bool has_high = false;

  bool are_there() const { return has_low && has_high && across.to > across.from; }
};

Sides sides_between(const std::vector<Flat>& flats, const SlotFrame& slot, double from_mm,
                    double to_mm, double width_mm, double length_mm) {
  Sides sides;
  for (const Flat& flat : flats) {
    const bool is_high = is_along(flat.normal, slot.across);
    if (!is_high && !is_along(flat.normal, -slot.across)) continue;
    const double at_mm = 0.5 * (flat.across.from + flat.across.to);
    if (std::abs(at_mm) > 0.5 * width_mm + kDefaultTolerance_mm ||
        flat.depth.common_with(from_mm, to_mm) <= kDefaultTolerance_mm ||
        flat.along.common_with(-0.5 * length_mm, 0.5 * length_mm) <= kDefaultTolerance_mm) {
      continue;
    }
    sides.across.extend(at_mm);
    sides.depth.extend(flat.depth.from);
    sides.depth.extend(flat.depth.to);
    (is_high ? sides.has_high : sides.has_low) = true;
  }
  return sides;
}

/// Of the faces that look out of the slot from under its throat, the highest.
std::optional<double> shoulder_below(const std::vector<Flat>& flats, const SlotFrame& slot,
                                     const SlotShape& shape) {
  std::optional<double> least_mm;
  for (const Flat& flat : flats) {
    const double below_mm = flat.depth.from - shape.throat_depth_mm;
    if (!is_along(flat.normal, -slot.into) || below_mm < -kCoaxial_mm ||
        std::max(std::abs(flat.across.from), std::abs(flat.across.to)) >
            0.5 * shape.undercut_width_mm) {
      continue;
    }
    if (!least_mm || below_mm < *least_mm) least_mm = below_mm;
  }
  return least_mm;
}

/// The class that is stated for a side of the part.
std::string stated_fit(const Element& element, const SlotFrame& slot, const Range& depth) {
  for (const Feature& feature : element.features) {
    if (feature.kind != FeatureKind::Face || feature.fit.empty()) continue;
    const double depth_mm = slot.into.dot(feature.origin - slot.origin);
    if (std::abs(feature.direction.dot(slot.across)) >= 1.0 - kCoaxial_rad &&
        depth_mm >= depth.from && depth_mm <= depth.to) {
      return feature.fit;
    }
  }
  return {};
}

/// Nothing where the part does not stand in the slot.
std::optional<SlotPair> pair_of(const Instance& part, const Element& element,
                                const FacetedSolid& solid, const Instance& other,
                                const Feature& feature) {
  const SlotShape& shape = *feature.slot;
  const SlotFrame slot = seen_from(part.X_WI.inverse() * other.X_WI, feature);
  const std::vector<Flat> flats = flats_of(solid, slot);
  const bool is_tee = shape.type == SlotShape::Type::Tee;
  const double throat_mm = is_tee ? shape.throat_depth_mm : feature.depth_mm;
  const Sides sides =
      sides_between(flats, slot, 0.0, throat_mm, feature.diameter_mm, shape.length_mm);
  SlotPair pair;
  pair.instance = part.name;
  pair.slot_instance = other.name;
  pair.slot = &feature;
  if (sides.are_there()) {
    pair.width_mm = sides.across.to - sides.across.from;
    pair.off_mm = 0.5 * (sides.across.from + sides.across.to);
    pair.fit = stated_fit(element, slot, sides.depth);
  }
  if (is_tee) {
    const Sides foot = sides_between(flats, slot, throat_mm, feature.depth_mm,
                                     shape.undercut_width_mm, shape.length_mm);
    if (foot.are_there() && foot.across.to - foot.across.from > feature.diameter_mm) {
      pair.foot_width_mm = foot.across.to - foot.across.from;
      pair.foot_height_mm = foot.depth.to - foot.depth.from;
      pair.shoulder_mm = shoulder_below(flats, slot, shape);
    }
  }
  if (!pair.width_mm && !pair.foot_width_mm) return std::nullopt;
  Range depth;
  for (const Eigen::Vector3d& vertex : solid.vertices) {
    depth.extend(slot.into.dot(vertex - slot.origin));
  }
  pair.top_mm = depth.from;
  pair.floor_mm = feature.depth_mm - depth.to;
  return pair;
}

}  // namespace

std::vector<SlotPair> slot_pairs(const ProjectState& state, const ElementOf& element_of,
                                 const SolidOf& solid_of) {
  std::vector<SlotPair> pairs;
  const auto add = [&](const Instance& part, const Instance& other) {
    for (const Feature& feature : element_of(other).features) {
      if (!is_slot_with_floor(feature)) continue;
      if (auto pair = pair_of(part, element_of(part), *solid_of(part.element), other, feature)) {
        pairs.push_back(std::move(*pair));
      }
    }
  };
  for (const auto& [a, b] : near_pairs(state, element_of, 0.0, nullptr)) {
    add(*a, *b);
    add(*b, *a);
  }
  std::ranges::stable_sort(pairs, {}, [](const SlotPair& pair) {
    return std::tie(pair.instance, pair.slot_instance, pair.slot->name);
  });
  return pairs;
}

std::vector<std::pair<std::string, std::string>> keyed_parts(const ProjectState& state,
                                                             const std::vector<SlotPair>& pairs) {
  constexpr double kMostPlay_mm = 0.1;
  const auto into_W = [&](const SlotPair& pair) -> Eigen::Vector3d {
    return state.find(pair.slot_instance)->X_WI.rotation() * pair.slot->direction;
  };
  const auto is_close = [](const SlotPair& pair) {
    return pair.play_mm() && *pair.play_mm() <= kMostPlay_mm &&
           std::abs(pair.off_mm) <= 0.5 * kMostPlay_mm + kCoaxial_mm;
  };
  std::vector<std::pair<std::string, std::string>> keyed;
  for (const SlotPair& one : pairs) {
    const bool faces_another = is_close(one) && std::ranges::any_of(pairs, [&](const auto& other) {
                                 return other.instance == one.instance &&
                                        other.slot_instance != one.slot_instance &&
                                        is_close(other) && is_along(into_W(one), -into_W(other));
                               });
    if (faces_another) keyed.emplace_back(one.instance, one.slot_instance);
  }
  return keyed;
}

}  // namespace dowel
