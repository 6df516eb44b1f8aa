#pragma once

#include <vector>

#include "part.h"
#include "systems.h"

/// The elements of a system by kind; none where it has none of the kind. Each call makes its solids
/// anew.
namespace dowel::library {

std::vector<Part> base_plates(const System& system);
std::vector<Part> risers(const System& system);
std::vector<Part> spacers(const System& system);
std::vector<Part> angle_plates(const System& system);
std::vector<Part> columns(const System& system);
std::vector<Part> rest_pads(const System& system);
std::vector<Part> rest_buttons(const System& system);
std::vector<Part> adjustable_supports(const System& system);
std::vector<Part> support_screws(const System& system);
std::vector<Part> edge_locators(const System& system);
std::vector<Part> locating_pins(const System& system);
std::vector<Part> pin_holders(const System& system);
std::vector<Part> vee_blocks(const System& system);
std::vector<Part> straps(const System& system);
std::vector<Part> heel_screws(const System& system);
std::vector<Part> edge_clamps(const System& system);
std::vector<Part> swing_clamps(const System& system);
std::vector<Part> swing_arms(const System& system);
std::vector<Part> studs(const System& system);
std::vector<Part> socket_screws(const System& system);
std::vector<Part> fit_screws(const System& system);
std::vector<Part> nuts(const System& system);
std::vector<Part> collar_nuts(const System& system);
std::vector<Part> washers(const System& system);
std::vector<Part> spherical_washers(const System& system);
std::vector<Part> conical_seats(const System& system);
std::vector<Part> plug_screws(const System& system);
std::vector<Part> tee_nuts(const System& system);
std::vector<Part> tee_bolts(const System& system);
std::vector<Part> keys(const System& system);
std::vector<Part> dowel_pins(const System& system);

/// All elements of a system, in the order of the manifest.
std::vector<Part> parts_of(const System& system);

/// Workpieces to design fixtures for; they belong to no system.
std::vector<Part> workpieces();

/// All of them, in the order of the manifest.
std::vector<Part> all_parts();

/// One part a size.
template <class Sizes, class Make>
std::vector<Part> each(const System& system, const Sizes& sizes, const Make& make) {
  std::vector<Part> parts;
  for (const auto& size : sizes) {
    parts.push_back(make(system, size));
    name_features(parts.back());
  }
  return parts;
}

}  // namespace dowel::library
