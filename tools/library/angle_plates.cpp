// Angle plates: an upright with a grid of nodes or tapped holes, on a foot that is screwed down.

#include <string>

#include "builders.h"
#include "holes.h"
#include "solids.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kPlateColour{0.62, 0.66, 0.70};

/// The upright stands at +x and looks that way; its holes are named as one sees them.
void add_grid(Part& part, const System& system, const AnglePlateSize& size, double face_x_mm,
              double thickness_mm) {
  for (int row = 0; row < size.rows; ++row) {
    for (int column = 0; column < size.columns; ++column) {
      const Eigen::Vector3d place(face_x_mm, (column - (size.columns - 1) / 2.0) * system.pitch_mm,
                                  size.foot_height_mm + (row + 0.5) * system.pitch_mm);
      const HolePlace hole{"node", place, {-1.0, 0.0, 0.0}};
      Feature feature = system.node
                            ? node_hole(system, hole, thickness_mm, true)
                            : tapped_hole(hole, fastener_of(system).thread, thickness_mm, true);
      // Six and more equal holes are a grid in a catalogue; fewer are numbered.
      if (size.rows * size.columns >= 6) {
        feature = named(feature,
                        std::string(1, static_cast<char>('A' + row)) + std::to_string(column + 1));
      }
      part.features.push_back(feature);
    }
  }
}

void add_screw_holes(Part& part, const System& system, const AnglePlateSize& size) {
  const double counterbore_mm = fastener_of(system).thread.counterbore_depth_mm;
  const double height_mm = size.foot_height_mm;
  if (!system.node) {
    for (const double x_mm : {-system.pitch_mm, 0.0}) {
      part.features.push_back(screw_hole(system, {"screw", {x_mm, 0.0, height_mm}},
                                         height_mm - system.key_depth_mm, counterbore_mm, false));
    }
    return;
  }
  const double y_mm = (size.columns - 1) / 2.0 * system.pitch_mm;
  for (const double x_mm : {-system.pitch_mm, 0.0}) {
    for (const double side : {-1.0, 1.0}) {
      part.features.push_back(screw_hole(system, {"screw", {x_mm, side * y_mm, height_mm}},
                                         height_mm, counterbore_mm, true));
    }
  }
}

Part angle_plate(const System& system, const AnglePlateSize& size) {
  Part part;
  const double length_mm = 3.0 * system.pitch_mm;
  const double width_mm = size.columns * system.pitch_mm - 0.5;
  const double height_mm = size.foot_height_mm + size.rows * system.pitch_mm;
  const double thickness_mm = system.node ? system.plate_height_mm : 0.6 * system.pitch_mm;
  const double half_mm = length_mm / 2.0;
  part.name = element_name(
      system, "angle-plate-" + std::to_string(size.columns) + "x" + std::to_string(size.rows));
  part.role = "riser";
  part.description = "angle plate, " + std::to_string(size.columns) + "x" +
                     std::to_string(size.rows) + (system.node ? " nodes" : " threads") +
                     " on its upright, which looks along +x";
  part.source = system.source;
  part.material = kCastIron;
  part.dimensions = {{"length", length_mm},
                     {"width", width_mm},
                     {"height", height_mm},
                     {"foot_height", size.foot_height_mm},
                     {"thickness", thickness_mm}};
  add_grid(part, system, size, half_mm, thickness_mm);
  add_screw_holes(part, system, size);
  if (!system.node) part.features.push_back(key_slot(system, {1.0, 0.0, 0.0}, length_mm));
  const TopoDS_Shape body = prism_y({{-half_mm, 0.0},
                                     {-half_mm, size.foot_height_mm},
                                     {half_mm - thickness_mm, size.foot_height_mm},
                                     {half_mm - thickness_mm, height_mm},
                                     {half_mm, height_mm},
                                     {half_mm, 0.0}},
                                    width_mm);
  part.solid = machined(body, part.features);
  part.features.push_back(face("upright", {half_mm, 0.0, height_mm / 2.0}, {1.0, 0.0, 0.0}));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.colour = kPlateColour;
  return part;
}

}  // namespace

std::vector<Part> angle_plates(const System& system) {
  return each(system, system.angle_plates, angle_plate);
}

}  // namespace dowel::library
