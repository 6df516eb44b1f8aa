// What locates the workpiece: edge locators, pins and their holders, V-blocks.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include "builders.h"
#include "foot.h"
#include "holes.h"
#include "solids.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kLocatorColour{0.20, 0.42, 0.66};
constexpr std::array<double, 3> kPinColour{0.75, 0.66, 0.30};

Part edge_locator(const System& system, int height) {
  Part part;
  const double height_mm = height;
  const double pitch_mm = system.pitch_mm;
  const double width_mm = pitch_mm - 0.5;  // neighbours on the next row do not touch
  const double contact_height_mm = 0.625 * pitch_mm;
  const double relief_mm = 1.0;
  part.name = element_name(system, "edge-locator-" + std::to_string(height));
  part.role = "locator";
  part.description =
      system.node ? "edge locator for two fit screws; its face stands half a pitch from a node"
                  : "edge locator for two screws in one slot, key slot below";
  part.source = system.source;
  part.material = kCaseHardenedSteel;
  part.dimensions = {{"length", 2.0 * pitch_mm},
                     {"width", width_mm},
                     {"height", height_mm},
                     {"contact_height", contact_height_mm}};
  const double counterbore_mm = fastener_of(system).thread.counterbore_depth_mm;
  for (const double side : {1.0, -1.0}) {
    part.features.push_back(
        screw_hole(system, {side > 0.0 ? "front" : "rear", {side * pitch_mm / 2.0, 0.0, height_mm}},
                   height_mm - system.key_depth_mm, counterbore_mm, system.node.has_value()));
  }
  const double contact_z_mm = height_mm - contact_height_mm;
  if (!system.node) {
    Feature key = key_slot(system, {1.0, 0.0, 0.0}, 2.0 * pitch_mm - relief_mm);
    key.origin.x() = -relief_mm / 2.0;
    part.features.push_back(key);
  }
  const TopoDS_Shape body = prism_y({{-pitch_mm, 0.0},
                                     {-pitch_mm, height_mm},
                                     {pitch_mm, height_mm},
                                     {pitch_mm, contact_z_mm},
                                     {pitch_mm - relief_mm, contact_z_mm},
                                     {pitch_mm - relief_mm, 0.0}},
                                    width_mm);
  part.solid = machined(body, part.features);
  part.features.push_back(
      face("locate", {pitch_mm, 0.0, contact_z_mm + contact_height_mm / 2.0}, {1.0, 0.0, 0.0}));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.colour = kLocatorColour;
  return part;
}

/// Cross-section that leaves two lands of a diamond pin: its lands face +-y, so that it gives way
/// along x.
TopoDS_Shape diamond_envelope(const PinSize& size) {
  const double radius_mm = size.diameter_mm / 2.0;
  const double land_mm = size.land_mm / 2.0;
  const double half_width_mm = 0.35 * size.diameter_mm;
  const double land_y_mm = std::sqrt(radius_mm * radius_mm - land_mm * land_mm);
  const double side_y_mm = land_y_mm - (half_width_mm - land_mm);  // flanks at 45 degrees
  const double out_mm = size.diameter_mm;
  return prism_z({{half_width_mm, -side_y_mm},
                  {half_width_mm, side_y_mm},
                  {land_mm, land_y_mm},
                  {land_mm, out_mm},
                  {-land_mm, out_mm},
                  {-land_mm, land_y_mm},
                  {-half_width_mm, side_y_mm},
                  {-half_width_mm, -side_y_mm},
                  {-land_mm, -land_y_mm},
                  {-land_mm, -out_mm},
                  {land_mm, -out_mm},
                  {land_mm, -land_y_mm}},
                 0.0, size.head_length_mm);
}

Part locating_pin(const System& system, const PinSize& size, bool diamond) {
  Part part;
  const double head_mm = size.fit_diameter_mm / 2.0;
  const double shank_mm = size.shank_diameter_mm / 2.0;
  const double shank_lead_mm = kShankLeadIn_mm;
  const double shank_drop_mm = shank_lead_mm * std::tan(kPinLeadIn_deg / 180.0 * std::numbers::pi);
  const double lead_mm = size.head_length_mm * kPinLeadInShare;
  const double lead_drop_mm = lead_mm * std::tan(kPinLeadIn_deg / 180.0 * std::numbers::pi);
  part.name =
      element_name(system, (diamond ? "pin-diamond-" : "pin-round-") + plain(size.diameter_mm));
  part.role = "locator";
  part.description = diamond ? "flattened locating pin, gives way along x, to press into a holder"
                             : "round locating pin, to press into a holder";
  part.source = diamond ? "like DIN 6321 form C" : "like DIN 6321 form B";
  part.material = kHardenedSteel;
  part.dimensions = {{"diameter", size.diameter_mm},
                     {"head_length", size.head_length_mm},
                     {"shank_diameter", size.shank_diameter_mm},
                     {"shank_length", size.shank_length_mm}};
  if (diamond) part.dimensions.push_back({"land", size.land_mm});
  const std::vector<Eigen::Vector2d> shank{{0.0, -size.shank_length_mm},
                                           {shank_mm - shank_drop_mm, -size.shank_length_mm},
                                           {shank_mm, -size.shank_length_mm + shank_lead_mm},
                                           {shank_mm, 0.0}};
  const std::vector<Eigen::Vector2d> head{{head_mm, 0.0},
                                          {head_mm, size.head_length_mm - lead_mm},
                                          {head_mm - lead_drop_mm, size.head_length_mm},
                                          {0.0, size.head_length_mm}};
  std::vector<Eigen::Vector2d> outline = shank;
  if (diamond) {
    std::vector<Eigen::Vector2d> upper{{0.0, 0.0}};
    upper.insert(upper.end(), head.begin(), head.end());
    outline.emplace_back(0.0, 0.0);
    part.solid = fuse(common(turned(upper), diamond_envelope(size)), turned(outline));
  } else {
    outline.insert(outline.end(), head.begin(), head.end());
    part.solid = turned(outline);
    const double straight_mm = size.head_length_mm - lead_mm;
    part.features.push_back(
        fitted(shaft_down("head", straight_mm, size.fit_diameter_mm, straight_mm), "g6"));
  }
  part.features.push_back(
      fitted(shaft_down("shank", 0.0, size.shank_diameter_mm, size.shank_length_mm - shank_lead_mm),
             "n6"));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.colour = kPinColour;
  return part;
}

Part pin_holder(const System& system, const PinHolderSize& size) {
  Part part;
  const auto [diameter_mm, wrench_mm] = system.pin_holder;
  const double radius_mm = diameter_mm / 2.0;
  const double height_mm = std::max(20.0, size.depth_mm + 6.0);
  const double chamfer_mm = 1.0;
  part.name = element_name(system, "pin-holder-" + plain(size.bore_mm));
  part.role = "locator";
  part.description = "screw-in holder for a locating pin with a shank of " + plain(size.bore_mm) +
                     " mm, wrench " + plain(wrench_mm);
  part.source = system.source;
  part.dimensions = {{"diameter", diameter_mm}, {"height", height_mm}, {"bore", size.bore_mm}};
  std::vector<Eigen::Vector2d> outline = foot_outline(system);
  outline.insert(outline.end(), {{radius_mm, 0.0},
                                 {radius_mm, height_mm - chamfer_mm},
                                 {radius_mm - chamfer_mm, height_mm},
                                 {0.0, height_mm}});
  part.features = foot_features(system);
  part.features.push_back(fitted(
      plain_hole({"bore", {0.0, 0.0, height_mm}}, size.bore_mm, size.depth_mm, false), "H7"));
  part.solid =
      with_flats(machined(turned(outline), part.features), diameter_mm, wrench_mm, 3.0, 11.0);
  part.features.push_back(
      shaft_down("body", height_mm - chamfer_mm, diameter_mm, height_mm - chamfer_mm));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.colour = kLocatorColour;
  return part;
}

/// `hole` where its opening lies `depth_mm` deeper, still in its first segment.
Feature opened_deeper(Feature hole, double depth_mm) {
  hole.origin += depth_mm * hole.direction;
  hole.depth_mm -= depth_mm;
  for (HoleSegment& segment : hole.segments) {
    segment.from_mm = std::max(0.0, segment.from_mm - depth_mm);
    segment.to_mm -= depth_mm;
  }
  return hole;
}

/// Screws through the bottom of the V: one, or two at the pitch in a wide block.
void add_vee_screws(Part& part, const System& system, const VeeBlockSize& size) {
  const double counterbore_mm = size.height_mm - size.screw_seat_mm;
  const auto add = [&](const char* use, double y_mm) {
    part.features.push_back(screw_hole(system, {use, {0.0, y_mm, size.height_mm}},
                                       size.height_mm - system.key_depth_mm, counterbore_mm,
                                       system.node.has_value()));
  };
  if (size.width_mm < 2.0 * system.pitch_mm) {
    add("screw", 0.0);
  } else {
    add("screw1", -system.pitch_mm / 2.0);
    add("screw2", system.pitch_mm / 2.0);
  }
  if (!system.node) part.features.push_back(key_slot(system, {0.0, 1.0, 0.0}, size.width_mm));
}

Part vee_block(const System& system, const VeeBlockSize& size) {
  Part part;
  const double half_mm = size.width_mm / 2.0;
  const double opening_mm = 0.8 * half_mm;  // half of it
  const double half_angle_rad = size.angle_deg / 360.0 * std::numbers::pi;
  const double apex_z_mm = size.height_mm - opening_mm / std::tan(half_angle_rad);
  part.name =
      element_name(system, "vee-block-" + plain(size.width_mm) + "-" + plain(size.angle_deg));
  part.role = "locator";
  part.description = "V-block of " + plain(size.angle_deg) +
                     " degrees along y, held by screws through the bottom of the V";
  part.source = system.source;
  part.material = kCaseHardenedSteel;
  part.dimensions = {{"length", size.width_mm},
                     {"width", size.width_mm},
                     {"height", size.height_mm},
                     {"opening", 2.0 * opening_mm},
                     {"apex_height", apex_z_mm}};
  add_vee_screws(part, system, size);
  const TopoDS_Shape body = prism_y({{-half_mm, 0.0},
                                     {-half_mm, size.height_mm},
                                     {-opening_mm, size.height_mm},
                                     {0.0, apex_z_mm},
                                     {opening_mm, size.height_mm},
                                     {half_mm, size.height_mm},
                                     {half_mm, 0.0}},
                                    size.width_mm);
  part.solid = machined(body, part.features);
  // The drill starts at the height of the block; what is left of the hole opens in the V.
  for (Feature& feature : part.features) {
    if (feature.kind == FeatureKind::Hole) {
      feature = opened_deeper(feature, size.height_mm - apex_z_mm);
    }
  }
  const double flank_z_mm = (apex_z_mm + size.height_mm) / 2.0;
  const Eigen::Vector3d right(-std::cos(half_angle_rad), 0.0, std::sin(half_angle_rad));
  const Eigen::Vector3d left(std::cos(half_angle_rad), 0.0, std::sin(half_angle_rad));
  part.features.push_back(face("vee-right", {opening_mm / 2.0, 0.0, flank_z_mm}, right));
  part.features.push_back(face("vee-left", {-opening_mm / 2.0, 0.0, flank_z_mm}, left));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.colour = kLocatorColour;
  return part;
}

}  // namespace

std::vector<Part> edge_locators(const System& system) {
  return each(system, system.edge_locator_heights_mm, edge_locator);
}

std::vector<Part> locating_pins(const System& system) {
  std::vector<Part> parts;
  for (const bool diamond : {false, true}) {
    for (const PinSize& size : system.pins) {
      parts.push_back(locating_pin(system, size, diamond));
      name_features(parts.back());
    }
  }
  return parts;
}

std::vector<Part> pin_holders(const System& system) {
  return each(system, system.pin_holders, pin_holder);
}

std::vector<Part> vee_blocks(const System& system) {
  return each(system, system.vee_blocks, vee_block);
}

}  // namespace dowel::library
