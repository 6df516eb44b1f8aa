// Spherical washers and the conical seats they turn in: they keep a nut's pressure on the axis of
// its stud where the strap below it is not level.

#include <cmath>
#include <numbers>
#include <string>

#include "builders.h"
#include "holes.h"
#include "solids.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kBrightSteelColour{0.62, 0.62, 0.65};

/// Flat on top, a ball below that ends in the washer's hole at z = 0.
Part spherical_washer(const System& system, const FastenerSize& size) {
  Part part;
  const SphericalWasherSize& washer = size.spherical;
  const double inner_radius_mm = washer.inner_mm / 2.0;
  const double outer_radius_mm = washer.outer_mm / 2.0;
  const double radius_mm = washer.ball_radius_mm;
  const double center_z_mm = std::sqrt(radius_mm * radius_mm - inner_radius_mm * inner_radius_mm);
  const double rim_z_mm =
      center_z_mm - std::sqrt(radius_mm * radius_mm - outer_radius_mm * outer_radius_mm);
  part.name = element_name(system, "spherical-washer-" + std::string(size.thread.name));
  part.role = "fastener";
  part.description =
      "spherical washer " + std::string(size.thread.name) + ", turns in a conical seat";
  part.source = "like DIN 6319 form C";
  part.material = kCaseHardenedSteel;
  part.dimensions = {{"inner_diameter", washer.inner_mm},
                     {"outer_diameter", washer.outer_mm},
                     {"height", washer.height_mm},
                     {"ball_radius", radius_mm}};
  // The ring stands out below, where the ball ends it.
  part.solid = common(turned({{inner_radius_mm, -1.0},
                              {outer_radius_mm, -1.0},
                              {outer_radius_mm, washer.height_mm},
                              {inner_radius_mm, washer.height_mm}}),
                      ball(radius_mm, center_z_mm));
  part.features = {
      plain_hole({"hole", {0.0, 0.0, washer.height_mm}}, washer.inner_mm, washer.height_mm, true),
      shaft_down("rim", washer.height_mm, washer.outer_mm, washer.height_mm - rim_z_mm),
      face("top", {0.0, 0.0, washer.height_mm}, kUp)};
  part.colour = kBrightSteelColour;
  return part;
}

/// Height of a seat and the spherical washer in it, level: the ball touches the cone in the circle
/// where both have one normal.
double pair_height_mm(const SphericalWasherSize& size, double seat_height_mm) {
  const double half_angle_rad = kConicalSeat_deg / 360.0 * std::numbers::pi;
  const double touch_radius_mm = size.ball_radius_mm * std::cos(half_angle_rad);
  const double touch_z_mm =
      seat_height_mm - (size.seat_mouth_mm / 2.0 - touch_radius_mm) / std::tan(half_angle_rad);
  const double center_z_mm = touch_z_mm + size.ball_radius_mm * std::sin(half_angle_rad);
  return center_z_mm -
         std::sqrt(std::pow(size.ball_radius_mm, 2) - std::pow(size.inner_mm / 2, 2)) +
         size.height_mm;
}

Part conical_seat(const System& system, const FastenerSize& size, bool wide) {
  Part part;
  const SphericalWasherSize& washer = size.spherical;
  const double outer_mm = wide ? washer.wide_outer_mm : washer.outer_mm;
  const double height_mm = wide ? washer.wide_height_mm : washer.seat_height_mm;
  const double cone_mm = (washer.seat_mouth_mm - washer.seat_inner_mm) / 2.0 /
                         std::tan(kConicalSeat_deg / 360.0 * std::numbers::pi);
  part.name = element_name(
      system, (wide ? "wide-conical-seat-" : "conical-seat-") + std::string(size.thread.name));
  part.role = "fastener";
  part.description = std::string(wide ? "conical seat for slotted holes, " : "conical seat ") +
                     "for a spherical washer " + std::string(size.thread.name);
  part.source = wide ? "like DIN 6319 form G" : "like DIN 6319 form D";
  part.material = wide ? kSteel : kCaseHardenedSteel;
  part.dimensions = {{"inner_diameter", washer.seat_inner_mm},
                     {"outer_diameter", outer_mm},
                     {"height", height_mm},
                     {"mouth_diameter", washer.seat_mouth_mm},
                     {"pair_height", pair_height_mm(washer, height_mm)}};
  Feature hole = plain_hole({"seat", {0.0, 0.0, height_mm}}, washer.seat_inner_mm, height_mm, true);
  hole.segments.front().from_mm = cone_mm;
  hole.segments.insert(hole.segments.begin(), {HoleSegment::Type::Cone, washer.seat_mouth_mm,
                                               washer.seat_inner_mm, 0.0, cone_mm});
  part.features = {hole, shaft_down("rim", height_mm, outer_mm, height_mm)};
  part.solid = machined(
      turned({{0.0, 0.0}, {outer_mm / 2.0, 0.0}, {outer_mm / 2.0, height_mm}, {0.0, height_mm}}),
      part.features);
  part.features.push_back(face("bottom", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.colour = kBrightSteelColour;
  return part;
}

}  // namespace

std::vector<Part> spherical_washers(const System& system) {
  return each(system, system.washer_threads, [](const System& of, std::string_view thread) {
    return spherical_washer(of, fastener_size(thread));
  });
}

std::vector<Part> conical_seats(const System& system) {
  std::vector<Part> parts;
  for (const bool wide : {false, true}) {
    for (const std::string_view thread : system.washer_threads) {
      parts.push_back(conical_seat(system, fastener_size(thread), wide));
      name_features(parts.back());
    }
  }
  return parts;
}

}  // namespace dowel::library
