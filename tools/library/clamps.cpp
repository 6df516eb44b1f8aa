// Clamps: strap and heel screw, edge clamp, swing clamp and its arm.

#include <cmath>
#include <numbers>
#include <string>

#include "builders.h"
#include "foot.h"
#include "holes.h"
#include "solids.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kClampColour{0.72, 0.30, 0.22};
constexpr std::array<double, 3> kSteelColour{0.50, 0.50, 0.53};
constexpr double kChamfer_mm = 1.0;

/// Seen from the side: two feet, a relief between them, a nose that slopes down.
Part strap(const System& system, const StrapSize& size) {
  Part part;
  const double half_mm = size.length_mm / 2.0;
  const double heel_foot_mm = 30.0;
  const double nose_foot_mm = 12.0;
  const double relief_mm = 2.0;
  const double nose_height_mm = size.height_mm / 2.0;
  const double nose_slope_mm = 20.0;
  part.name = element_name(system, "strap-" + plain(size.slot_mm) + "x" + plain(size.length_mm));
  part.role = "clamp";
  part.description =
      "clamp strap, nose at +x, heel foot at -x, slot for a stud " + std::string(system.thread);
  part.source = "like DIN 6314";
  part.dimensions = {{"length", size.length_mm},
                     {"width", size.width_mm},
                     {"height", size.height_mm},
                     {"slot_width", size.slot_mm},
                     {"slot_length", size.slot_length_mm}};
  const TopoDS_Shape body = prism_y({{-half_mm, 0.0},
                                     {-half_mm, size.height_mm},
                                     {half_mm - nose_slope_mm, size.height_mm},
                                     {half_mm, nose_height_mm},
                                     {half_mm, 0.0},
                                     {half_mm - nose_foot_mm, 0.0},
                                     {half_mm - nose_foot_mm, relief_mm},
                                     {-half_mm + heel_foot_mm, relief_mm},
                                     {-half_mm + heel_foot_mm, 0.0}},
                                    size.width_mm);
  part.features = {straight_slot("slot", SlotShape::Type::Through, {0.0, 0.0, size.height_mm},
                                 kDown, size.slot_mm, size.height_mm - relief_mm,
                                 size.slot_length_mm)};
  part.solid = machined(body, part.features);
  part.features.push_back(face("nose", {half_mm - nose_foot_mm / 2.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("heel", {-half_mm + heel_foot_mm / 2.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("top", {-nose_slope_mm / 2.0, 0.0, size.height_mm}, kUp));
  part.colour = kClampColour;
  return part;
}

/// Threaded shank of a screw from z = 0 down, as the outline of a turned part.
TopoDS_Shape threaded_shank(double diameter_mm, double length_mm) {
  const double radius_mm = diameter_mm / 2.0;
  return turned({{0.0, -length_mm},
                 {radius_mm - kChamfer_mm, -length_mm},
                 {radius_mm, -length_mm + kChamfer_mm},
                 {radius_mm, 0.0},
                 {0.0, 0.0}});
}

/// Its feature and the seat of a head.
std::vector<Feature> shank_features(const System& system, double length_mm) {
  return {threaded(shaft_down("thread", 0.0, fastener_of(system).thread.diameter_mm,
                              length_mm - kChamfer_mm),
                   system.thread),
          face("seat", {0.0, 0.0, 0.0}, kDown)};
}

/// Hexagon head of heel and support screws.
struct HeadSize {
  double height_mm;
  double width_mm;  ///< across flats: that of the nut
};
HeadSize head_of(const System& system) {
  const FastenerSize& size = fastener_of(system);
  return {std::round(0.8 * size.thread.diameter_mm), size.nut.width_mm};
}

Part heel_screw(const System& system, int length) {
  Part part;
  const double length_mm = length;
  const HeadSize head = head_of(system);
  const double corner_mm = head.width_mm / std::numbers::sqrt3;
  const double face_mm = 0.475 * head.width_mm;  // radius of the flat end face
  const double drop_mm = (corner_mm + 1.0 - face_mm) * std::tan(std::numbers::pi / 6.0);
  part.name = element_name(
      system, "heel-screw-" + std::string(system.thread) + "x" + std::to_string(length));
  part.role = "clamp";
  part.description = "adjustable heel support: hexagon screw with a flat face, for a lock nut";
  part.source = "dimensions of this library";
  part.material = kScrewSteel;
  part.dimensions = {{"length", length_mm},
                     {"head_height", head.height_mm},
                     {"width_across_flats", head.width_mm}};
  const TopoDS_Shape prism = common(hexagon(head.width_mm, 0.0, head.height_mm),
                                    turned({{0.0, 0.0},
                                            {corner_mm + 1.0, 0.0},
                                            {corner_mm + 1.0, head.height_mm - drop_mm},
                                            {face_mm, head.height_mm},
                                            {0.0, head.height_mm}}));
  part.solid = fuse(prism, threaded_shank(fastener_of(system).thread.diameter_mm, length_mm));
  part.features = shank_features(system, length_mm);
  part.features.push_back(face("heel", {0.0, 0.0, head.height_mm}, kUp));
  part.colour = kSteelColour;
  return part;
}

/// Like a heel screw, with a domed head that touches in a point.
Part support_screw(const System& system, int length) {
  Part part;
  const double length_mm = length;
  const HeadSize head = head_of(system);
  const double dome_mm = head.width_mm;  // radius
  part.name = element_name(
      system, "support-screw-" + std::string(system.thread) + "x" + std::to_string(length));
  part.role = "support";
  part.description = "support screw: hexagon head with a domed face, for a lock nut";
  part.source = "dimensions of this library";
  part.material = kScrewSteel;
  part.dimensions = {{"length", length_mm},
                     {"head_height", head.height_mm},
                     {"width_across_flats", head.width_mm},
                     {"dome_radius", dome_mm}};
  const TopoDS_Shape prism = common(hexagon(head.width_mm, 0.0, head.height_mm + 1.0),
                                    ball(dome_mm, head.height_mm - dome_mm));
  part.solid = fuse(prism, threaded_shank(fastener_of(system).thread.diameter_mm, length_mm));
  part.features = shank_features(system, length_mm);
  part.colour = kSteelColour;
  return part;
}

/// A block for two screws with a thrust screw between them, which presses along +x.
Part edge_clamp(const System& system, int height) {
  Part part;
  const double height_mm = height;
  const double width_mm = 2.0 * system.pitch_mm - 0.5;
  const double length_mm = 0.9 * system.pitch_mm;
  const ThreadSize& thread = fastener_of(system).thread;
  part.name = element_name(system, "edge-clamp-" + std::to_string(height));
  part.role = "clamp";
  part.description = "edge clamp body for two screws across x; a thrust screw " +
                     std::string(system.thread) + " between them presses along +x";
  part.source = system.source;
  part.dimensions = {{"length", length_mm}, {"width", width_mm}, {"height", height_mm}};
  const double thrust_z_mm = 0.6 * height_mm;
  part.features = {tapped_hole({"thrust", {length_mm / 2.0, 0.0, thrust_z_mm}, {-1.0, 0.0, 0.0}},
                               thread, length_mm, true)};
  for (const double side : {-1.0, 1.0}) {
    part.features.push_back(screw_hole(
        system, {"screw", {0.0, side * system.pitch_mm / 2.0, height_mm}},
        height_mm - system.key_depth_mm, thread.counterbore_depth_mm, system.node.has_value()));
  }
  if (!system.node) part.features.push_back(key_slot(system, {0.0, 1.0, 0.0}, width_mm));
  part.solid = machined(block(length_mm, width_mm, height_mm), part.features);
  part.features.push_back(face("press", {length_mm / 2.0, 0.0, height_mm / 2.0}, {1.0, 0.0, 0.0}));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.colour = kClampColour;
  return part;
}

/// Screw-in post: a base, a cylinder that the arm turns about, a thread for the nut on top of it.
Part swing_clamp(const System& system, const SwingClampSize& size) {
  Part part;
  const double base_mm = 1.6 * system.swing_post_mm;
  const double post_mm = system.swing_post_mm;
  const double thread_mm = fastener_of(system).thread.diameter_mm;
  const double post_top_mm = size.base_height_mm + size.post_length_mm;
  const double top_mm = post_top_mm + size.thread_length_mm;
  part.name = element_name(system, "swing-clamp-" + plain(size.base_height_mm));
  part.role = "clamp";
  part.description =
      "screw-in post of a swing clamp, for an arm and a nut " + std::string(system.thread);
  part.source = system.source;
  part.dimensions = {{"base_diameter", base_mm},
                     {"base_height", size.base_height_mm},
                     {"post_diameter", post_mm},
                     {"post_length", size.post_length_mm},
                     {"height", top_mm}};
  std::vector<Eigen::Vector2d> outline = foot_outline(system);
  outline.insert(outline.end(), {{base_mm / 2.0, 0.0},
                                 {base_mm / 2.0, size.base_height_mm},
                                 {post_mm / 2.0, size.base_height_mm},
                                 {post_mm / 2.0, post_top_mm},
                                 {thread_mm / 2.0, post_top_mm},
                                 {thread_mm / 2.0, top_mm - kChamfer_mm},
                                 {thread_mm / 2.0 - kChamfer_mm, top_mm},
                                 {0.0, top_mm}});
  part.solid = turned(outline);
  part.features = foot_features(system);
  part.features.push_back(shaft_down("base", size.base_height_mm, base_mm, size.base_height_mm));
  part.features.push_back(fitted(
      shaft("post", {0.0, 0.0, size.base_height_mm}, kUp, post_mm, size.post_length_mm), "h9"));
  part.features.push_back(threaded(
      shaft("nut", {0.0, 0.0, post_top_mm}, kUp, thread_mm, size.thread_length_mm - kChamfer_mm),
      system.thread));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.colour = kClampColour;
  return part;
}

/// Bar with round ends: a bore for the post at -x, a thread for the pressure screw at +x.
Part swing_arm(const System& system, int length) {
  Part part;
  const double length_mm = length;  // between the axes
  const double height_mm = system.swing_arm_thickness_mm;
  const double width_mm = 2.0 * system.swing_post_mm;
  part.name = element_name(system, "swing-arm-" + std::to_string(length));
  part.role = "clamp";
  part.description = "arm of a swing clamp, bore for the post at -x, thread " +
                     std::string(system.thread) + " at +x";
  part.source = system.source;
  part.dimensions = {{"length", length_mm}, {"width", width_mm}, {"height", height_mm}};
  part.features = {fitted(plain_hole({"post", {-length_mm / 2.0, 0.0, height_mm}},
                                     system.swing_post_mm, height_mm, true),
                          "H9"),
                   tapped_hole({"pressure screw", {length_mm / 2.0, 0.0, height_mm}},
                               fastener_of(system).thread, height_mm, true)};
  part.solid = machined(oblong(0.0, length_mm + width_mm, width_mm, 0.0, height_mm), part.features);
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.colour = kClampColour;
  return part;
}

}  // namespace

std::vector<Part> straps(const System& system) {
  return each(system, system.straps, strap);
}
std::vector<Part> heel_screws(const System& system) {
  return each(system, system.heel_screw_lengths_mm, heel_screw);
}
std::vector<Part> support_screws(const System& system) {
  return each(system, system.support_screw_lengths_mm, support_screw);
}
std::vector<Part> edge_clamps(const System& system) {
  return each(system, system.edge_clamp_heights_mm, edge_clamp);
}
std::vector<Part> swing_clamps(const System& system) {
  return each(system, system.swing_clamps, swing_clamp);
}
std::vector<Part> swing_arms(const System& system) {
  return each(system, system.swing_arm_lengths_mm, swing_arm);
}

}  // namespace dowel::library
