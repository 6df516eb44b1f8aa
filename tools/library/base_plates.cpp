// Base plates with a grid of nodes, with T-slots along x, or with T-slots both ways.

#include <string>

#include "builders.h"
#include "holes.h"
#include "solids.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kPlateColour{0.55, 0.58, 0.62};

/// Place of line `index` of `count` that lie `pitch_mm` apart about 0.
double on_grid(int index, int count, double pitch_mm) {
  return (index - (count - 1) / 2.0) * pitch_mm;
}

void add_nodes(Part& part, const System& system, const PlateSize& size) {
  for (int row = 0; row < size.rows; ++row) {
    for (int column = 0; column < size.columns; ++column) {
      const Eigen::Vector3d place(on_grid(column, size.columns, system.pitch_mm),
                                  on_grid(row, size.rows, system.pitch_mm), system.plate_height_mm);
      // Rows A, B, C from low y, columns 1, 2, 3 from low x.
      part.features.push_back(
          named(node_hole(system, {"node", place}, system.plate_height_mm, true),
                std::string(1, static_cast<char>('A' + row)) + std::to_string(column + 1)));
    }
  }
}

void add_slots(Part& part, const System& system, const PlateSize& size, double length_mm,
               double width_mm) {
  for (int row = 0; row < size.rows; ++row) {
    part.features.push_back(
        tee_slot("slot", *system.slot,
                 {0.0, on_grid(row, size.rows, system.pitch_mm), system.plate_height_mm},
                 {1.0, 0.0, 0.0}, length_mm));
  }
  for (int column = 0; column < size.columns; ++column) {
    part.features.push_back(
        tee_slot("slot", *system.slot,
                 {on_grid(column, size.columns, system.pitch_mm), 0.0, system.plate_height_mm},
                 {0.0, 1.0, 0.0}, width_mm));
  }
}

Part base_plate(const System& system, const PlateSize& size) {
  Part part;
  const double length_mm = size.columns > 0 ? size.columns * system.pitch_mm : size.length_mm;
  const double width_mm = size.rows * system.pitch_mm;
  const double height_mm = system.plate_height_mm;
  const std::string count = std::to_string(size.columns) + "x" + std::to_string(size.rows);
  part.role = "base plate";
  part.source = system.source;
  part.material = kCastIron;
  part.dimensions = {{"length", length_mm},
                     {"width", width_mm},
                     {"height", height_mm},
                     {"pitch", system.pitch_mm}};
  const std::string pitch = plain(system.pitch_mm) + " mm";
  if (system.node) {
    const std::string bore = plain(system.node->bore_mm);
    part.name = element_name(system, "plate-" + count);
    part.description = "base plate, " + count + " nodes " + bore + "H7 over " +
                       std::string(system.thread) + " every " + pitch;
    add_nodes(part, system, size);
  } else {
    const std::string throat = plain(system.slot.value().throat_mm);
    const bool crossing = size.columns > 0;
    part.name = element_name(
        system, "plate-" + (crossing ? count : std::to_string(size.rows) + "x" + plain(length_mm)));
    part.description = "base plate, T-slots " + throat + " every " + pitch +
                       (crossing ? " along x and y" : " along x");
    add_slots(part, system, size, length_mm, width_mm);
  }
  part.solid = machined(block(length_mm, width_mm, height_mm), part.features);
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.features.push_back(face("bottom", {0.0, 0.0, 0.0}, kDown));
  part.colour = kPlateColour;
  return part;
}

}  // namespace

std::vector<Part> base_plates(const System& system) {
  return each(system, system.plates, base_plate);
}

}  // namespace dowel::library
