#include "dowel/assembly/fixture_design.h"

#include <algorithm>
#include <array>

#include "dowel/kernel/check.h"

namespace dowel {
namespace {

constexpr std::array kRoles{
    Role::BasePlate, Role::Riser,    Role::Locator,   Role::Support, Role::AdjustableSupport,
    Role::Clamp,     Role::Fastener, Role::Workpiece, Role::Other};

constexpr double kMuch = 1.0e6;

// "Usual" values are those of machining practice; a project states its own by `limit`.
constexpr std::array kLimits{
    Limit{"assembly_order", 0.0, 0.0, 1.0,
          "1: look for an order of assembly, which takes sweeps of all parts; 0: do not"},
    Limit{"clamp_clearance_mm", 5.0, 0.0, kMuch,
          "least distance of clamps and locators from a critical point, where a tool works"},
    Limit{"chip_relief_mm", 1.0, 0.0, kMuch, "least free space around the root of a locator"},
    Limit{"clamp_lift_mm", 1.0, 0.0, kMuch,
          "way that a clamp opens for loading, beyond what the workpiece may be higher"},
    Limit{"condition", 10.0, 1.0, kMuch, "largest condition number of the locators"},
    Limit{"cutter_clearance_mm", 5.0, 0.0, kMuch,
          "least gap of a cutter and what is not to be machined"},
    Limit{"edge_in_diameters", 1.5, 0.0, 10.0,
          "least distance of a hole in use from the edge of a part of one's own, in diameters"},
    Limit{"engagement_in_diameters", 1.0, 0.1, 10.0,
          "least length of full threads in use, in diameters: steel in steel"},
    Limit{"error_share", 0.5, 0.0, 1.0,
          "share of a point's tolerance that the error of the locators may take"},
    Limit{"floor_gap_mm", 1.0, 0.0, kMuch, "least gap of a screw's tip and the floor of a T-slot"},
    Limit{"friction", 0.15, 0.0, 1.0, "coefficient of friction of steel on steel, oiled"},
    Limit{"gap_element_mm", 0.5, 0.0, 10.0, "least gap of two elements that do not touch"},
    Limit{"gap_workpiece_mm", 2.0, 0.0, 10.0,
          "least gap of the workpiece and what is not to touch"},
    Limit{"grid_mm", 0.02, 0.0, kMuch, "largest distance of a part's hole from the plate's"},
    Limit{"hand_mm", 60.0, 0.0, 1000.0, "room that a hand needs beside a clamp"},
    Limit{"head_bearing_in_diameters", 0.1, 0.0, 10.0,
          "least width of the ring on which a head or nut bears, in diameters of the thread"},
    Limit{"height_mm", 1000.0, 0.0, kMuch, "largest height of the fixture with its workpiece"},
    Limit{"level_mm", 0.02, 0.0, kMuch, "largest difference in height of the primary supports"},
    Limit{"lift_mm", 20.0, 0.0, 1000.0, "way that the workpiece needs to come out of the fixture"},
    Limit{"lifting_mass_kg", 25.0, 0.0, kMuch, "largest mass that is lifted by hand"},
    Limit{"locating_clearance_um", 50.0, 0.0, kMuch, "largest clearance of a locating fit"},
    Limit{"locator_error_mm", 0.01, 0.0, 10.0,
          "error of a locator along its normal, as plus or minus, where none is given"},
    Limit{"mass_kg", 1000.0, 0.0, kMuch, "largest mass of the fixture with its workpiece"},
    Limit{"pad_share_clamp", 0.9, 0.0, 1.0, "least share of a clamp's pad that bears"},
    Limit{"pad_share_locator", 0.8, 0.0, 1.0, "least share of a locator's pad that bears"},
    Limit{"pin_angle_deg", 0.1, 0.0, 90.0, "largest turn that the play of two pins leaves"},
    Limit{"pin_slenderness", 6.0, 0.1, kMuch, "largest length of a locating pin, in diameters"},
    Limit{"pin_spread", 0.5, 0.0, 1.0,
          "least distance of two pins, by the diagonal of the workpiece's box across them"},
    Limit{"pressure_N_per_mm2", 100.0, 0.0, kMuch,
          "largest pressure of a clamp: half the yield strength of soft steel"},
    Limit{"safety", 2.0, 1.0, 100.0, "factor on cutting loads"},
    Limit{"screw_yield_N_per_mm2", 640.0, 1.0, kMuch,
          "yield strength of screws: property class 8.8"},
    Limit{"seating_N", 0.0, -kMuch, kMuch, "least force on a locator when the clamps are tight"},
    Limit{"slenderness", 3.0, 0.1, 100.0, "largest height of a stack by its least width"},
    Limit{"slot_line_mm", 0.5, 0.0, kMuch,
          "how far a bore over a slot may be off the middle of the slot"},
    Limit{"slot_play_mm", 0.1, 0.0, kMuch, "least play of a T-nut's neck in its slot"},
    Limit{"stack_pieces", 3.0, 1.0, 100.0, "largest number of spacers on each other"},
    Limit{"stack_tolerance_mm", 0.05, 0.0, kMuch,
          "largest sum of the tolerances of a stack's pieces"},
    Limit{"strap_lever", 0.5, 0.0, 1.0,
          "least share of the screw's force that a strap puts on the workpiece"},
    Limit{"strap_tilt_deg", 3.0, 0.0, 90.0, "largest tilt of a strap without spherical washers"},
    Limit{"support_margin_share", 0.05, 0.0, 1.0,
          "how far inside the supports the centre of mass is, by the workpiece's half diagonal"},
    Limit{"swing_deg", 60.0, 0.0, 360.0, "least angle through which a wrench swings"},
};

constexpr std::array kStatedQuantities{
    StatedQuantity{"centre_tolerance_mm", 0.0, kMuch, "a workpiece or pin",
                   "tolerance of its distance from the other hole or pin, as plus or minus"},
    StatedQuantity{"chip_relief_mm", 0.0, kMuch, "a locator", "free space around its root"},
    StatedQuantity{"cutter_length_mm", 1.0, kMuch, "a critical point",
                   "length of the cutter and its holder, up from the point"},
    StatedQuantity{"cutter_mm", 0.1, kMuch, "a critical point",
                   "diameter of the cutter that comes down to it"},
    StatedQuantity{"height_max_mm", -kMuch, kMuch, "a clamp or support",
                   "largest height over the base plate at which it can touch the workpiece"},
    StatedQuantity{"height_min_mm", -kMuch, kMuch, "a clamp or support",
                   "least height over the base plate at which it can touch the workpiece"},
    StatedQuantity{"height_tolerance_mm", 0.0, kMuch, "a workpiece or a piece of a stack",
                   "tolerance of its height, as plus or minus"},
    StatedQuantity{"land_mm", 0.01, kMuch, "a diamond pin", "width of its cylindrical land"},
    StatedQuantity{"machined", 0.0, 1.0, "a face of the workpiece",
                   "1: a datum or machined; 0: rough"},
    StatedQuantity{"manual", 0.0, 1.0, "a clamp", "1: a hand works it; 0: a wrench or fluid does"},
    StatedQuantity{"pad_mm2", 0.01, kMuch, "a clamp or locator",
                   "area of its pad, where that is less than a face of it"},
    StatedQuantity{"preload_N", 0.0, kMuch, "a screw", "force that it is tightened to"},
    StatedQuantity{"stock", 0.0, kMuch, "an element", "how many of it there are in the shop"},
    StatedQuantity{"stroke_mm", 0.0, kMuch, "a clamp", "way that it opens"},
    StatedQuantity{"thread_length_mm", 0.01, kMuch, "a screw",
                   "length of its thread from the tip, where it does not reach the head"},
};

}  // namespace

std::string_view to_string(Role role) {
  switch (role) {
    case Role::BasePlate:
      return "base plate";
    case Role::Riser:
      return "riser";
    case Role::Locator:
      return "locator";
    case Role::Support:
      return "support";
    case Role::AdjustableSupport:
      return "adjustable support";
    case Role::Clamp:
      return "clamp";
    case Role::Fastener:
      return "fastener";
    case Role::Workpiece:
      return "workpiece";
    case Role::Other:
      return "other";
  }
  DOWEL_EXPECTS(false && "a known role");
  return {};
}

std::optional<Role> role_from(std::string_view text) {
  for (const Role role : kRoles) {
    if (to_string(role) == text) return role;
  }
  return std::nullopt;
}

std::span<const Limit> limits() {
  return kLimits;
}

const Limit* find_limit(std::string_view name) {
  const auto* const found = std::ranges::find(kLimits, name, &Limit::name);
  return found == kLimits.end() ? nullptr : found;
}

std::span<const StatedQuantity> stated_quantities() {
  return kStatedQuantities;
}

const StatedQuantity* find_stated_quantity(std::string_view name) {
  const auto* const found = std::ranges::find(kStatedQuantities, name, &StatedQuantity::name);
  return found == kStatedQuantities.end() ? nullptr : found;
}

double FixtureDesign::limit(std::string_view name) const {
  const auto given = limits.find(std::string(name));
  if (given != limits.end()) return given->second;
  const Limit* usual = find_limit(name);
  DOWEL_EXPECTS(usual != nullptr);
  return usual->value;
}

std::optional<double> FixtureDesign::stated_value(std::string_view quantity,
                                                  const std::string& subject) const {
  const auto found = stated.find({std::string(quantity), subject});
  return found == stated.end() ? std::nullopt : std::optional(found->second.value);
}

void FixtureDesign::forget(const std::string& instance) {
  std::erase_if(stated, [&](const auto& entry) {
    const std::string& subject = entry.first.second;
    return subject == instance || subject.starts_with(instance + ".");
  });
  roles.erase(instance);
  clamp_forces_N.erase(instance);
  locator_errors_mm.erase(instance);
}

}  // namespace dowel
