// Facts about spherical washers and the conical seats that they turn in.

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "fact_source.h"

namespace dowel {
namespace {

/// The cone of a seat, from mouth to bottom. Source: DIN 6319, by general knowledge.
constexpr double kSeatCone_rad = 2.0 / 3.0 * std::numbers::pi;
constexpr double kSameCone_rad = 0.02;

/// How far the middle of a ball may be off the axis of its seat.
constexpr double kOffSeatAxis_mm = 0.1;

bool is_washer(FactSource& source, const Instance& instance) {
  const auto& features = source.element(instance).features;
  return source.role(instance) == Role::Fastener &&
         std::ranges::any_of(features, [](const Feature& feature) {
           return feature.kind == FeatureKind::Hole && feature.through && feature.thread.empty();
         });
}

/// The ball below a washer: the largest of the solid. World.
std::optional<SphereSurface> ball_of(FactSource& source, const Instance& instance) {
  std::optional<SphereSurface> largest;
  for (const Face& face : source.solid(instance.element)->faces) {
    const auto* const sphere = std::get_if<SphereSurface>(&face.surface);
    if (sphere == nullptr || (largest && largest->radius_mm >= sphere->radius_mm)) continue;
    largest = SphereSurface{instance.X_WI * sphere->center, sphere->radius_mm};
  }
  return largest;
}

/// The hole whose mouth is the cone of a seat.
const Feature* seat_of(const Element& element) {
  for (const Feature& hole : element.features) {
    if (hole.kind != FeatureKind::Hole || !hole.through || hole.segments.empty()) continue;
    const HoleSegment& mouth = hole.segments.front();
    const double length_mm = mouth.to_mm - mouth.from_mm;
    if (mouth.type != HoleSegment::Type::Cone || length_mm <= 0.0) continue;
    const double cone_rad =
        2.0 * std::atan2(0.5 * (mouth.diameter_mm - mouth.diameter_end_mm), length_mm);
    if (std::abs(cone_rad - kSeatCone_rad) <= kSameCone_rad) return &hole;
  }
  return nullptr;
}

bool is_over(const SphereSurface& ball_W, const Instance& seat, const Feature& hole) {
  const Eigen::Vector3d to_ball = ball_W.center - seat.X_WI * hole.origin;
  const Eigen::Vector3d into_W = seat.X_WI.rotation() * hole.direction;
  return into_W.dot(to_ball) < 0.0 && into_W.cross(to_ball).norm() <= kOffSeatAxis_mm;
}

FactRows spherical_washers(FactSource& source) {
  std::map<std::string, std::pair<const char*, std::string>> partners;
  std::map<std::string, SphereSurface> balls_W;
  for (const auto& [name, instance] : source.state().instances) {
    if (!is_washer(source, instance)) continue;
    if (const auto ball_W = ball_of(source, instance)) {
      balls_W.emplace(name, *ball_W);
      partners[name].first = "ball";
    } else if (seat_of(source.element(instance)) != nullptr) {
      partners[name].first = "cone";
    }
  }
  const auto note = [&](const std::string& washer, const std::string& seat) {
    const auto ball_W = balls_W.find(washer);
    const auto cone = partners.find(seat);
    if (ball_W == balls_W.end() || cone == partners.end() || balls_W.contains(seat)) return;
    const Instance& placed = *source.state().find(seat);
    if (!is_over(ball_W->second, placed, *seat_of(source.element(placed)))) return;
    partners[washer].second = seat;
    cone->second.second = washer;
  };
  for (const Touch& touch : source.touches()) {
    note(touch.instance, touch.with);
    note(touch.with, touch.instance);
  }
  FactRows rows;
  for (const auto& [name, partner] : partners) {
    rows.push_back({name, std::string(partner.first), text_or_null(partner.second)});
  }
  return rows;
}

}  // namespace

std::vector<FactTable> washer_facts() {
  return {{"spherical_washers",
           "Washers with a ball below, and seats with a cone of 120 degrees for them.",
           {{"instance", "washer or seat"},
            {"side", "ball or cone"},
            {"partner", "the one that it turns in, or that turns in it; NULL where there is none"}},
           FromParts | FromDesign | FromTolerance,
           spherical_washers}};
}

}  // namespace dowel
