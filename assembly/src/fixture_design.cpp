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
    Limit{"clamp_clearance_mm", 5.0, 0.0, kMuch,
          "least distance of clamps and locators from a critical point, where a tool works"},
    Limit{"condition", 10.0, 1.0, kMuch, "largest condition number of the locators"},
    Limit{"engagement_in_diameters", 1.0, 0.1, 10.0,
          "least length of full threads in use, in diameters: steel in steel"},
    Limit{"error_share", 0.5, 0.0, 1.0,
          "share of a point's tolerance that the error of the locators may take"},
    Limit{"friction", 0.15, 0.0, 1.0, "coefficient of friction of steel on steel, oiled"},
    Limit{"gap_element_mm", 0.5, 0.0, 10.0, "least gap of two elements that do not touch"},
    Limit{"gap_workpiece_mm", 2.0, 0.0, 10.0,
          "least gap of the workpiece and what is not to touch"},
    Limit{"height_mm", 1000.0, 0.0, kMuch, "largest height of the fixture with its workpiece"},
    Limit{"level_mm", 0.02, 0.0, kMuch, "largest difference in height of the primary supports"},
    Limit{"lift_mm", 20.0, 0.0, 1000.0, "way that the workpiece needs to come out of the fixture"},
    Limit{"lifting_mass_kg", 25.0, 0.0, kMuch, "largest mass that is lifted by hand"},
    Limit{"locating_clearance_um", 50.0, 0.0, kMuch, "largest clearance of a locating fit"},
    Limit{"locator_error_mm", 0.01, 0.0, 10.0,
          "error of a locator along its normal, as plus or minus, where none is given"},
    Limit{"mass_kg", 1000.0, 0.0, kMuch, "largest mass of the fixture with its workpiece"},
    Limit{"pressure_N_per_mm2", 100.0, 0.0, kMuch,
          "largest pressure of a clamp: half the yield strength of soft steel"},
    Limit{"safety", 2.0, 1.0, 100.0, "factor on cutting loads"},
    Limit{"seating_N", 0.0, -kMuch, kMuch, "least force on a locator when the clamps are tight"},
    Limit{"slenderness", 3.0, 0.1, 100.0, "largest height of a stack by its least width"},
    Limit{"stack_pieces", 3.0, 1.0, 100.0, "largest number of spacers on each other"},
    Limit{"support_margin_share", 0.05, 0.0, 1.0,
          "how far inside the supports the centre of mass is, by the workpiece's half diagonal"},
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

double FixtureDesign::limit(std::string_view name) const {
  const auto given = limits.find(std::string(name));
  if (given != limits.end()) return given->second;
  const Limit* usual = find_limit(name);
  DOWEL_EXPECTS(usual != nullptr);
  return usual->value;
}

void FixtureDesign::forget(const std::string& instance) {
  roles.erase(instance);
  clamp_forces_N.erase(instance);
  locator_errors_mm.erase(instance);
}

}  // namespace dowel
