// What lifts and supports: risers, spacers, columns, rest pads, rest buttons, adjustable supports.

#include <algorithm>
#include <string>

#include "builders.h"
#include "foot.h"
#include "holes.h"
#include "solids.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kRiserColour{0.62, 0.66, 0.70};
constexpr std::array<double, 3> kPadColour{0.35, 0.37, 0.40};
constexpr double kChamfer_mm = 1.0;

/// Turned body above the foot, chamfered at the top and, where asked, at the bottom.
TopoDS_Shape turned_body(const System& system, double diameter_mm, double height_mm,
                         bool chamfered_below) {
  const double radius_mm = diameter_mm / 2.0;
  std::vector<Eigen::Vector2d> outline = foot_outline(system);
  if (chamfered_below) {
    outline.emplace_back(radius_mm - kChamfer_mm, 0.0);
    outline.emplace_back(radius_mm, kChamfer_mm);
  } else {
    outline.emplace_back(radius_mm, 0.0);
  }
  outline.insert(outline.end(), {{radius_mm, height_mm - kChamfer_mm},
                                 {radius_mm - kChamfer_mm, height_mm},
                                 {0.0, height_mm}});
  return turned(outline);
}

Part hole_system_riser(const System& system, double height_mm) {
  Part part;
  const double width_mm = 2.0 * system.pitch_mm;
  const ThreadSize& thread = fastener_of(system).thread;
  part.description =
      "riser block, four counterbored holes at the pitch (C1, C4 located), one node on top";
  part.dimensions = {{"length", width_mm}, {"width", width_mm}, {"height", height_mm}};
  // The screw of a tall riser sinks in: what it holds stays 6 d long.
  const double counterbore_mm =
      std::max(thread.counterbore_depth_mm, height_mm - 6.0 * thread.diameter_mm);
  const double offset_mm = system.pitch_mm / 2.0;
  int number = 0;
  for (const double x_mm : {-offset_mm, offset_mm}) {
    for (const double y_mm : {-offset_mm, offset_mm}) {
      ++number;
      const bool located = number == 1 || number == 4;  // one diagonal
      part.features.push_back(screw_hole(system,
                                         {"C" + std::to_string(number), {x_mm, y_mm, height_mm}},
                                         height_mm, counterbore_mm, located));
    }
  }
  const bool through = height_mm <= system.plate_height_mm;
  part.features.push_back(node_hole(system, {"T0", {0.0, 0.0, height_mm}},
                                    through ? height_mm : system.node.value().thread_depth_mm,
                                    through));
  part.solid = machined(block(width_mm, width_mm, height_mm), part.features);
  return part;
}

Part slot_system_riser(const System& system, double height_mm) {
  Part part;
  const double length_mm = 2.0 * system.pitch_mm;
  const double width_mm = system.pitch_mm - 0.5;
  const ThreadSize& thread = fastener_of(system).thread;
  part.description = "riser block for one slot, key slot below, T-slot across its top";
  part.dimensions = {{"length", length_mm}, {"width", width_mm}, {"height", height_mm}};
  const double counterbore_mm =
      std::max(thread.counterbore_depth_mm, height_mm - 6.0 * thread.diameter_mm);
  for (const double side : {-1.0, 1.0}) {
    part.features.push_back(screw_hole(system,
                                       {"screw", {side * 0.75 * system.pitch_mm, 0.0, height_mm}},
                                       height_mm - system.key_depth_mm, counterbore_mm, false));
  }
  part.features.push_back(key_slot(system, {1.0, 0.0, 0.0}, length_mm));
  part.features.push_back(
      tee_slot("slot", *system.slot, {0.0, 0.0, height_mm}, {0.0, 1.0, 0.0}, width_mm));
  part.solid = machined(block(length_mm, width_mm, height_mm), part.features);
  return part;
}

Part riser(const System& system, int height) {
  Part part = system.node ? hole_system_riser(system, height) : slot_system_riser(system, height);
  const std::string width = plain((system.node ? 2.0 : 1.0) * system.pitch_mm);
  part.name = element_name(
      system, "riser-" + plain(2.0 * system.pitch_mm) + "x" + width + "x" + std::to_string(height));
  part.role = "riser";
  part.source = system.source;
  part.features.push_back(face("top", {0.0, 0.0, double(height)}, kUp));
  part.features.push_back(face("bottom", {0.0, 0.0, 0.0}, kDown));
  part.colour = kRiserColour;
  return part;
}

Part spacer(const System& system, int height) {
  Part part;
  const double height_mm = height;
  const double width_mm = system.pitch_mm - 0.5;  // neighbours on the next node do not touch
  part.name = element_name(system, "spacer-" + std::to_string(height));
  part.role = "riser";
  part.source = system.source;
  part.dimensions = {{"length", width_mm}, {"width", width_mm}, {"height", height_mm}};
  if (system.node) {
    part.description = "spacer for one node; the fit screw of what stands on it goes through";
    part.features = {fitted(
        plain_hole({"bore", {0.0, 0.0, height_mm}}, system.node->bore_mm, height_mm, true), "H7")};
  } else {
    // Thin ones have no room for keys.
    const double key_mm = height_mm >= 3.0 * system.key_depth_mm ? system.key_depth_mm : 0.0;
    part.description = "spacer for one slot; the screw of what stands on it goes through";
    part.features = {plain_hole({"screw", {0.0, 0.0, height_mm - key_mm}},
                                fastener_of(system).thread.clearance_hole_mm,
                                height_mm - 2.0 * key_mm, true)};
    if (key_mm > 0.0) {
      Feature upper = key_slot(system, {1.0, 0.0, 0.0}, width_mm);
      upper.origin.z() = height_mm;
      upper.direction = kDown;
      part.features.push_back(upper);
      part.features.push_back(key_slot(system, {1.0, 0.0, 0.0}, width_mm));
    }
  }
  part.solid = machined(block(width_mm, width_mm, height_mm), part.features);
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.features.push_back(face("bottom", {0.0, 0.0, 0.0}, kDown));
  part.colour = kRiserColour;
  return part;
}

Part column(const System& system, int height) {
  Part part;
  const double height_mm = height;
  const auto [diameter_mm, wrench_mm] = system.column;
  part.name = element_name(system, "column-" + plain(diameter_mm) + "x" + std::to_string(height));
  part.role = "riser";
  part.description = "screw-in column, one " + std::string(system.node ? "node" : "thread") +
                     " on top, wrench " + plain(wrench_mm);
  part.source = system.source;
  part.dimensions = {{"diameter", diameter_mm}, {"height", height_mm}};
  part.features = foot_features(system);
  part.features.push_back(top_hole(system, {"T0", {0.0, 0.0, height_mm}}));
  part.solid =
      with_flats(machined(turned_body(system, diameter_mm, height_mm, true), part.features),
                 diameter_mm, wrench_mm, 4.0, 14.0);
  part.features.push_back(
      shaft_down("body", height_mm - kChamfer_mm, diameter_mm, height_mm - 2.0 * kChamfer_mm));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.colour = kRiserColour;
  return part;
}

Part rest_pad(const System& system, int height) {
  Part part;
  const double height_mm = height;
  const auto [diameter_mm, wrench_mm] = system.rest_pad;
  part.name = element_name(system, "rest-pad-" + std::to_string(height));
  part.role = "support";
  part.description = "screw-in rest pad with a flat face, wrench " + plain(wrench_mm);
  part.source = system.source;
  part.material = kCaseHardenedSteel;
  part.dimensions = {{"diameter", diameter_mm}, {"height", height_mm}};
  part.features = foot_features(system);
  part.solid = with_flats(turned_body(system, diameter_mm, height_mm, false), diameter_mm,
                          wrench_mm, 3.0, 11.0);
  part.features.push_back(
      shaft_down("body", height_mm - kChamfer_mm, diameter_mm, height_mm - kChamfer_mm));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("rest", {0.0, 0.0, height_mm}, kUp));
  part.colour = kPadColour;
  return part;
}

Part rest_button(const System& system, int height) {
  Part part;
  const double height_mm = height;
  const double diameter_mm = 3.0 * fastener_of(system).thread.diameter_mm;
  const double radius_mm = diameter_mm / 2.0;
  part.name = element_name(system, "rest-button-" + std::to_string(height));
  part.role = "support";
  part.description = "rest button for a fit screw, for stacks on spacers";
  part.source = system.source;
  part.material = kCaseHardenedSteel;
  part.dimensions = {{"diameter", diameter_mm}, {"height", height_mm}};
  part.features = {screw_hole(system, {"screw", {0.0, 0.0, height_mm}}, height_mm,
                              fastener_of(system).thread.counterbore_depth_mm, true)};
  part.solid = machined(turned({{0.0, 0.0},
                                {radius_mm, 0.0},
                                {radius_mm, height_mm - kChamfer_mm},
                                {radius_mm - kChamfer_mm, height_mm},
                                {0.0, height_mm}}),
                        part.features);
  part.features.push_back(
      shaft_down("body", height_mm - kChamfer_mm, diameter_mm, height_mm - kChamfer_mm));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("rest", {0.0, 0.0, height_mm}, kUp));
  part.colour = kPadColour;
  return part;
}

/// Hexagonal carrier of a support screw.
Part adjustable_support(const System& system, int height) {
  Part part;
  const double height_mm = height;
  const ThreadSize& thread = fastener_of(system).thread;
  const double wrench_mm = system.column.wrench_mm;
  part.name = element_name(system, "adjustable-support-" + std::to_string(height));
  part.role = "support";
  part.description = "screw-in hexagonal body, thread on top for a support screw and its lock nut";
  part.source = system.source;
  part.dimensions = {{"height", height_mm}, {"width_across_flats", wrench_mm}};
  part.features = foot_features(system);
  part.features.push_back(
      tapped_hole({"thread", {0.0, 0.0, height_mm}}, thread, 2.5 * thread.diameter_mm, false));
  std::vector<Eigen::Vector2d> outline = foot_outline(system);
  outline.emplace_back(0.0, 0.0);
  part.solid = machined(fuse(hexagon(wrench_mm, 0.0, height_mm), turned(outline)), part.features);
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.colour = kRiserColour;
  return part;
}

}  // namespace

std::vector<Part> risers(const System& system) {
  return each(system, system.riser_heights_mm, riser);
}
std::vector<Part> spacers(const System& system) {
  return each(system, system.spacer_heights_mm, spacer);
}
std::vector<Part> columns(const System& system) {
  return each(system, system.column_heights_mm, column);
}
std::vector<Part> rest_pads(const System& system) {
  return each(system, system.rest_pad_heights_mm, rest_pad);
}
std::vector<Part> rest_buttons(const System& system) {
  return each(system, system.rest_button_heights_mm, rest_button);
}
std::vector<Part> adjustable_supports(const System& system) {
  return each(system, system.adjustable_support_heights_mm, adjustable_support);
}

}  // namespace dowel::library
