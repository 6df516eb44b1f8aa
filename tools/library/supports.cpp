// Base plates and what lifts: risers, spacers, columns, rest pads and rest buttons.

#include <algorithm>
#include <string>

#include "builders.h"
#include "dimensions.h"
#include "holes.h"
#include "solids.h"
#include "spigot.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kPlateColour{0.55, 0.58, 0.62};
constexpr std::array<double, 3> kRiserColour{0.62, 0.66, 0.70};
constexpr std::array<double, 3> kPadColour{0.35, 0.37, 0.40};

/// Feature name of a node: rows A, B, C from low y, columns 1, 2, 3 from low x.
std::string node_name(int column, int row) {
  return std::string(1, static_cast<char>('A' + row)) + std::to_string(column + 1);
}

/// Two flats for a wrench: `body` keeps `across_mm` along y between two heights.
TopoDS_Shape with_flats(const TopoDS_Shape& body, double radius_mm, double across_mm,
                        double low_z_mm, double high_z_mm) {
  const double out_mm = radius_mm + 1.0;
  const double flat_mm = across_mm / 2.0;
  return cut(body, {box({-out_mm, flat_mm, low_z_mm}, {out_mm, out_mm, high_z_mm}),
                    box({-out_mm, -out_mm, low_z_mm}, {out_mm, -flat_mm, high_z_mm})});
}

Part base_plate(const PlateSize& size) {
  Part part;
  const double length_mm = size.nodes_x * kPitch_mm;
  const double width_mm = size.nodes_y * kPitch_mm;
  const std::string nodes = std::to_string(size.nodes_x) + "x" + std::to_string(size.nodes_y);
  part.name = element_name("plate-" + nodes);
  part.role = "base plate";
  part.description = "base plate, " + nodes + " nodes 12H7 over M12 every 40 mm";
  part.source = kSystemSource;
  part.dimensions = {{"length", length_mm},
                     {"width", width_mm},
                     {"height", kPlateHeight_mm},
                     {"pitch", kPitch_mm}};
  for (int row = 0; row < size.nodes_y; ++row) {
    for (int column = 0; column < size.nodes_x; ++column) {
      const Eigen::Vector3d place((column + 0.5) * kPitch_mm - length_mm / 2.0,
                                  (row + 0.5) * kPitch_mm - width_mm / 2.0, kPlateHeight_mm);
      part.features.push_back(node_hole({node_name(column, row), place}, kPlateHeight_mm, true));
    }
  }
  part.solid = drilled(block(length_mm, width_mm, kPlateHeight_mm), part.features);
  part.features.push_back(face("top", {0.0, 0.0, kPlateHeight_mm}, kUp));
  part.features.push_back(face("bottom", {0.0, 0.0, 0.0}, kDown));
  part.colour = kPlateColour;
  return part;
}

Part riser(int height) {
  Part part;
  const double height_mm = height;
  const double width_mm = 2.0 * kPitch_mm;
  const ThreadSize& thread = fastener_size(kSystemThread).thread;
  part.name = element_name("riser-80x80x" + std::to_string(height));
  part.role = "riser";
  part.description =
      "riser block, four counterbored holes at the pitch (C1, C4 located), one node on top";
  part.source = kSystemSource;
  part.dimensions = {{"length", width_mm}, {"width", width_mm}, {"height", height_mm}};
  // The screw of a tall riser sinks in: what it holds stays 72 mm (6 d) long.
  const double counterbore_mm = std::max(thread.counterbore_depth_mm, height_mm - 72.0);
  const double offset_mm = kPitch_mm / 2.0;
  int number = 0;
  for (const double x_mm : {-offset_mm, offset_mm}) {
    for (const double y_mm : {-offset_mm, offset_mm}) {
      ++number;
      const bool located = number == 1 || number == 4;  // one diagonal
      part.features.push_back(screw_hole({"C" + std::to_string(number), {x_mm, y_mm, height_mm}},
                                         height_mm, counterbore_mm, located));
    }
  }
  const bool through = height_mm <= kPlateHeight_mm;
  part.features.push_back(
      node_hole({"T0", {0.0, 0.0, height_mm}}, through ? height_mm : kThreadDepth_mm, through));
  part.solid = drilled(block(width_mm, width_mm, height_mm), part.features);
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.features.push_back(face("bottom", {0.0, 0.0, 0.0}, kDown));
  part.colour = kRiserColour;
  return part;
}

Part spacer(int height) {
  Part part;
  const double height_mm = height;
  const double width_mm = kPitch_mm - 0.5;  // neighbours on the next node do not touch
  part.name = element_name("spacer-" + std::to_string(height));
  part.role = "riser";
  part.description = "spacer for one node; the fit screw of what stands on it goes through";
  part.source = kSystemSource;
  part.dimensions = {{"length", width_mm}, {"width", width_mm}, {"height", height_mm}};
  part.features = {
      fitted(plain_hole({"bore", {0.0, 0.0, height_mm}}, kBore_mm, height_mm, true), "H7")};
  part.solid = drilled(block(width_mm, width_mm, height_mm), part.features);
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.features.push_back(face("bottom", {0.0, 0.0, 0.0}, kDown));
  part.colour = kRiserColour;
  return part;
}

Part column(int height) {
  Part part;
  const double height_mm = height;
  const double radius_mm = 18.0;
  const double chamfer_mm = 1.0;
  part.name = element_name("column-36x" + std::to_string(height));
  part.role = "riser";
  part.description = "screw-in column, spigot 12g6 and M12 below, one node on top, wrench 30";
  part.source = kSystemSource;
  part.dimensions = {{"diameter", 2.0 * radius_mm}, {"height", height_mm}};
  std::vector<Eigen::Vector2d> outline = spigot_outline();
  outline.insert(outline.end(), {{radius_mm - chamfer_mm, 0.0},
                                 {radius_mm, chamfer_mm},
                                 {radius_mm, height_mm - chamfer_mm},
                                 {radius_mm - chamfer_mm, height_mm},
                                 {0.0, height_mm}});
  part.features = spigot_features();
  part.features.push_back(node_hole({"T0", {0.0, 0.0, height_mm}}, kThreadDepth_mm, false));
  part.solid = with_flats(drilled(turned(outline), part.features), radius_mm, 30.0, 4.0, 14.0);
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.colour = kRiserColour;
  return part;
}

Part rest_pad(int height) {
  Part part;
  const double height_mm = height;
  const double radius_mm = 9.0;
  const double chamfer_mm = 1.0;
  part.name = element_name("rest-pad-" + std::to_string(height));
  part.role = "support";
  part.description = "screw-in rest pad with a flat face, spigot 12g6 and M12 below, wrench 15";
  part.source = kSystemSource;
  part.dimensions = {{"diameter", 2.0 * radius_mm}, {"height", height_mm}};
  std::vector<Eigen::Vector2d> outline = spigot_outline();
  outline.insert(outline.end(), {{radius_mm, 0.0},
                                 {radius_mm, height_mm - chamfer_mm},
                                 {radius_mm - chamfer_mm, height_mm},
                                 {0.0, height_mm}});
  part.features = spigot_features();
  part.solid = with_flats(turned(outline), radius_mm, 15.0, 3.0, 11.0);
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("rest", {0.0, 0.0, height_mm}, kUp));
  part.colour = kPadColour;
  return part;
}

Part rest_button(int height) {
  Part part;
  const double height_mm = height;
  const double radius_mm = 18.0;
  const double chamfer_mm = 1.0;
  part.name = element_name("rest-button-" + std::to_string(height));
  part.role = "support";
  part.description = "rest button for a fit screw, for stacks on spacers";
  part.source = kSystemSource;
  part.dimensions = {{"diameter", 2.0 * radius_mm}, {"height", height_mm}};
  part.features = {screw_hole({"screw", {0.0, 0.0, height_mm}}, height_mm,
                              fastener_size(kSystemThread).thread.counterbore_depth_mm, true)};
  part.solid = drilled(turned({{0.0, 0.0},
                               {radius_mm, 0.0},
                               {radius_mm, height_mm - chamfer_mm},
                               {radius_mm - chamfer_mm, height_mm},
                               {0.0, height_mm}}),
                       part.features);
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("rest", {0.0, 0.0, height_mm}, kUp));
  part.colour = kPadColour;
  return part;
}

template <class Sizes, class Make>
std::vector<Part> each(const Sizes& sizes, const Make& make) {
  std::vector<Part> parts;
  for (const auto& size : sizes) parts.push_back(make(size));
  return parts;
}

}  // namespace

std::vector<Part> base_plates() {
  return each(kPlates, base_plate);
}
std::vector<Part> risers() {
  return each(kRiserHeights_mm, riser);
}
std::vector<Part> spacers() {
  return each(kSpacerHeights_mm, spacer);
}
std::vector<Part> columns() {
  return each(kColumnHeights_mm, column);
}
std::vector<Part> rest_pads() {
  return each(kRestPadHeights_mm, rest_pad);
}
std::vector<Part> rest_buttons() {
  return each(kRestButtonHeights_mm, rest_button);
}

}  // namespace dowel::library
