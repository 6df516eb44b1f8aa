#include <iterator>
#include <utility>

#include "builders.h"

namespace dowel::library {

std::vector<Part> parts_of(const System& system) {
  std::vector<Part> parts;
  for (const auto& make : {base_plates,
                           risers,
                           spacers,
                           angle_plates,
                           columns,
                           rest_pads,
                           rest_buttons,
                           edge_locators,
                           adjustable_supports,
                           support_screws,
                           locating_pins,
                           pin_holders,
                           vee_blocks,
                           straps,
                           heel_screws,
                           edge_clamps,
                           swing_clamps,
                           swing_arms,
                           studs,
                           socket_screws,
                           fit_screws,
                           nuts,
                           collar_nuts,
                           washers,
                           spherical_washers,
                           conical_seats,
                           plug_screws,
                           tee_nuts,
                           tee_bolts,
                           keys,
                           dowel_pins}) {
    std::vector<Part> made = make(system);
    parts.insert(parts.end(), std::make_move_iterator(made.begin()),
                 std::make_move_iterator(made.end()));
  }
  return parts;
}

std::vector<Part> all_parts() {
  std::vector<Part> parts;
  for (const System& system : systems()) {
    for (Part& part : parts_of(system)) parts.push_back(std::move(part));
  }
  for (Part& part : workpieces()) parts.push_back(std::move(part));
  return parts;
}

}  // namespace dowel::library
