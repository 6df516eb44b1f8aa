// What element is which fastener, by its name and features.

#include <algorithm>
#include <cmath>

#include "dowel/assembly/fastening.h"
#include "dowel/assembly/names.h"
#include "dowel/catalog/metric_thread.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// A washer's hole is wider than the thread by no more than this share of it (ISO 7089, 7093).
constexpr double kWasherPlay = 0.15;

/// How far the part reaches along `direction` from `origin`, by its faces square to it.
double reach_mm(const Element& element, const Eigen::Vector3d& origin,
                const Eigen::Vector3d& direction) {
  double most = 0.0;
  for (const Feature& face : element.features) {
    if (face.kind != FeatureKind::Face || face.direction.dot(direction) < 1.0 - kCoaxial_rad) {
      continue;
    }
    most = std::max(most, direction.dot(face.origin - origin));
  }
  return most;
}

/// Of the element across a direction, by its box: heads are round, hexagons or more.
struct Widths {
  double least_mm = 0.0;
  double most_mm = 0.0;
};

Widths widths_across(const Element& element, const Eigen::Vector3d& direction) {
  Eigen::Index along = 0;
  (element.obb.axes.transpose() * direction).cwiseAbs().maxCoeff(&along);
  const auto [least, most] = std::minmax(element.obb.half_extents_mm[(along + 1) % 3],
                                         element.obb.half_extents_mm[(along + 2) % 3]);
  return {2.0 * least, 2.0 * most};
}

/// Foot of a T-nut or T-bolt: its shoulder, and how wide it is, flat sides or round.
void measure_foot(Fastener& fastener, const Element& element, const Eigen::Vector3d& axis) {
  const Widths across = widths_across(element, axis);
  const bool has_sides = std::ranges::any_of(element.features, [&](const Feature& face) {
    return face.kind == FeatureKind::Face && std::abs(face.direction.dot(axis)) <= kCoaxial_rad;
  });
  fastener.foot_width_mm = across.most_mm;
  fastener.foot_diagonal_mm =
      has_sides ? std::hypot(across.least_mm, across.most_mm) : across.most_mm;
}

/// From `origin` along `direction` to the farthest face that looks against it; 0 where none does.
double shoulder_mm(const Element& element, const Eigen::Vector3d& origin,
                   const Eigen::Vector3d& direction) {
  double farthest_mm = 0.0;
  for (const Feature& face : element.features) {
    if (face.kind != FeatureKind::Face || face.direction.dot(direction) > kCoaxial_rad - 1.0) {
      continue;
    }
    farthest_mm = std::max(farthest_mm, direction.dot(face.origin - origin));
  }
  return farthest_mm;
}

/// Of the thread that is stated for a feature; 0, the coarse one, where none is.
double stated_pitch_mm(const Feature& feature) {
  const MetricThread* thread = find_metric_thread(feature.thread);
  return thread == nullptr ? 0.0 : thread->pitch_mm;
}

std::optional<Fastener> screw_of(const Element& element) {
  Fastener screw;
  for (const Feature& shaft : element.features) {
    if (shaft.kind != FeatureKind::Shaft) continue;
    const MetricThread* thread = thread_of_shaft(shaft.diameter_mm);
    if (thread == nullptr || (screw.nominal_mm > 0.0 && thread->nominal_mm >= screw.nominal_mm)) {
      continue;
    }
    screw.nominal_mm = thread->nominal_mm;
    screw.feature = shaft.name;
    screw.thread_end_mm = shaft.depth_mm;
    screw.pitch_mm = stated_pitch_mm(shaft);
    screw.head_diameter_mm = widths_across(element, shaft.direction).most_mm;
    screw.length_mm = std::max(shaft.depth_mm, reach_mm(element, shaft.origin, shaft.direction));
  }
  screw.element = element.name;
  if (screw.nominal_mm == 0.0 || screw.head_diameter_mm <= screw.nominal_mm + kBoxSlack_mm)
    return std::nullopt;
  return screw;
}

/// The widest cylinder about a hole, by depth in it.
struct Rim {
  double diameter_mm = 0.0;
  double from_mm = 0.0;
  double to_mm = 0.0;
};

std::optional<Rim> rim_of(const Element& element, const Feature& hole) {
  std::optional<Rim> widest;
  for (const Feature& rim : element.features) {
    if (rim.kind != FeatureKind::Shaft || (widest && rim.diameter_mm <= widest->diameter_mm)) {
      continue;
    }
    const double at_mm = hole.direction.dot(rim.origin - hole.origin);
    const double end_mm = at_mm + rim.depth_mm * hole.direction.dot(rim.direction);
    widest = Rim{rim.diameter_mm, std::min(at_mm, end_mm), std::max(at_mm, end_mm)};
  }
  return widest;
}

std::optional<Fastener> ring_of(const Element& element, Fastener::Kind kind) {
  const Feature* hole = nullptr;
  Fastener ring;
  for (const Feature& feature : element.features) {
    if (feature.kind != FeatureKind::Hole) continue;
    if (hole != nullptr || !feature.through) return std::nullopt;
    hole = &feature;
  }
  if (hole == nullptr) return std::nullopt;
  const std::optional<Rim> rim = rim_of(element, *hole);
  if (rim) ring.head_diameter_mm = rim->diameter_mm;
  ring.kind = kind;
  ring.element = element.name;
  ring.length_mm = hole->depth_mm;
  ring.feature = hole->name;
  ring.hole_diameter_mm = hole->diameter_mm;
  if (kind == Fastener::Kind::Nut) {
    const MetricThread* thread = thread_of_core_hole(hole->diameter_mm);
    if (thread == nullptr) return std::nullopt;
    ring.nominal_mm = thread->nominal_mm;
    ring.pitch_mm = thread->pitch_mm;
    const double flats_mm = widths_across(element, hole->direction).least_mm;
    ring.has_collar = ring.head_diameter_mm > flats_mm - kCoaxial_mm;
    ring.flip = ring.has_collar && rim->from_mm < kCoincident_mm;
    if (!ring.has_collar) ring.head_diameter_mm = flats_mm;
    return ring;
  }
  for (const MetricThread& thread : metric_threads()) {
    const double play = hole->diameter_mm / thread.nominal_mm - 1.0;
    if (play > 0.0 && play <= kWasherPlay) ring.nominal_mm = thread.nominal_mm;
  }
  if (ring.nominal_mm == 0.0) return std::nullopt;
  return ring;
}

/// A nut with a foot, and a neck where it has one.
std::optional<Fastener> tee_nut_of(const Element& element) {
  auto nut = ring_of(element, Fastener::Kind::Nut);
  if (!nut) return std::nullopt;
  nut->kind = Fastener::Kind::TeeNut;
  const Feature& hole = *element.find_feature(nut->feature);
  nut->neck_height_mm = shoulder_mm(element, hole.origin, hole.direction);
  nut->foot_height_mm = nut->length_mm - nut->neck_height_mm;
  measure_foot(*nut, element, hole.direction);
  return nut;
}

/// A screw whose head is the foot of a T-nut.
std::optional<Fastener> tee_bolt_of(const Element& element) {
  auto bolt = screw_of(element);
  if (!bolt) return std::nullopt;
  bolt->kind = Fastener::Kind::TeeBolt;
  const Feature& shaft = *element.find_feature(bolt->feature);
  const Eigen::Vector3d to_head = -shaft.direction;
  bolt->neck_height_mm = shoulder_mm(element, shaft.origin, to_head);
  bolt->foot_height_mm = reach_mm(element, shaft.origin, to_head) - bolt->neck_height_mm;
  bolt->length_mm += bolt->neck_height_mm;
  bolt->thread_end_mm += bolt->neck_height_mm;
  measure_foot(*bolt, element, shaft.direction);
  return bolt;
}

/// A washer with a ball below: by the circles in which that ends, of hole and rim.
std::optional<Fastener> spherical_washer_of(const Element& element) {
  auto washer = ring_of(element, Fastener::Kind::Washer);
  if (!washer) return std::nullopt;
  washer->kind = Fastener::Kind::SphericalWasher;
  const auto rim = rim_of(element, *element.find_feature(washer->feature));
  if (!rim) return std::nullopt;
  washer->flip = rim->from_mm > kCoincident_mm;
  const double rise_mm = washer->length_mm - (rim->to_mm - rim->from_mm);
  if (rise_mm <= kCoincident_mm) return std::nullopt;
  const double inner_mm = 0.5 * washer->hole_diameter_mm;
  const double outer_mm = 0.5 * washer->head_diameter_mm;
  const double center_mm =
      (outer_mm * outer_mm + rise_mm * rise_mm - inner_mm * inner_mm) / (2.0 * rise_mm);
  washer->ball_radius_mm = std::hypot(inner_mm, center_mm);
  return washer;
}

/// A ring with a cone that a ball stands in.
std::optional<Fastener> conical_seat_of(const Element& element) {
  Fastener seat;
  seat.kind = Fastener::Kind::ConicalSeat;
  seat.element = element.name;
  for (const Feature& feature : element.features) {
    if (feature.kind != FeatureKind::Hole || !feature.through) continue;
    if (const auto rim = rim_of(element, feature)) seat.head_diameter_mm = rim->diameter_mm;
    seat.feature = feature.name;
    seat.length_mm = feature.depth_mm;
    seat.hole_diameter_mm = feature.diameter_mm;
    for (const HoleSegment& cone : feature.segments) {
      if (cone.type != HoleSegment::Type::Cone || cone.diameter_mm <= cone.diameter_end_mm) {
        continue;
      }
      seat.mouth_mm = cone.diameter_mm;
      seat.cone_rad =
          std::atan2(0.5 * (cone.diameter_mm - cone.diameter_end_mm), cone.to_mm - cone.from_mm);
    }
  }
  if (seat.mouth_mm == 0.0) return std::nullopt;
  return seat;
}

}  // namespace

std::optional<double> pair_height_mm(const Fastener& spherical_washer, const Fastener& seat) {
  /// The seat's hole is wider, so that the screw may lean; beyond that it is of another size.
  constexpr double kWidest = 1.25;
  const double radius_mm = spherical_washer.ball_radius_mm;
  const double touch_radius_mm = radius_mm * std::cos(seat.cone_rad);
  if (seat.hole_diameter_mm < spherical_washer.hole_diameter_mm ||
      seat.hole_diameter_mm > kWidest * spherical_washer.hole_diameter_mm ||
      2.0 * touch_radius_mm < seat.hole_diameter_mm || 2.0 * touch_radius_mm > seat.mouth_mm) {
    return std::nullopt;
  }
  const double touch_mm =
      seat.length_mm - (0.5 * seat.mouth_mm - touch_radius_mm) / std::tan(seat.cone_rad);
  const double center_mm = touch_mm + radius_mm * std::sin(seat.cone_rad);
  const double ball_end_mm =
      std::sqrt(radius_mm * radius_mm - std::pow(0.5 * spherical_washer.hole_diameter_mm, 2));
  return center_mm - ball_end_mm + spherical_washer.length_mm;
}

std::optional<Fastener> fastener_of(const Element& element) {
  const std::string role = role_of(element.name);
  const auto is_a = [&](const char* word) { return element.name.find(word) != std::string::npos; };
  if (role == "SCREW") return screw_of(element);
  if (role == "WASHER") return ring_of(element, Fastener::Kind::Washer);
  if (role == "NUT" || is_a("collar-nut")) return ring_of(element, Fastener::Kind::Nut);
  if (role == "TEE") return is_a("tee-bolt") ? tee_bolt_of(element) : tee_nut_of(element);
  if (is_a("spherical-washer")) return spherical_washer_of(element);
  if (is_a("conical-seat")) return conical_seat_of(element);
  return std::nullopt;
}

}  // namespace dowel
