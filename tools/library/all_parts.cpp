#include <iterator>

#include "builders.h"

namespace dowel::library {

std::vector<Part> all_parts() {
  std::vector<Part> parts;
  for (const auto& make :
       {base_plates, risers, spacers, columns, rest_pads, rest_buttons, edge_locators,
        locating_pins, pin_holders, vee_blocks, straps, heel_screws, studs, socket_screws,
        fit_screws, nuts, washers, dowel_pins, workpieces}) {
    std::vector<Part> made = make();
    parts.insert(parts.end(), std::make_move_iterator(made.begin()),
                 std::make_move_iterator(made.end()));
  }
  return parts;
}

}  // namespace dowel::library
