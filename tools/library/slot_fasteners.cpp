// What goes into T-slots: T-nuts, T-bolts, keys.

#include <string>

#include "builders.h"
#include "dowel/kernel/check.h"
#include "holes.h"
#include "solids.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kSteelColour{0.50, 0.50, 0.53};

/// Foot with its bottom at z = 0 and, where it is lower than the whole, the neck above it.
TopoDS_Shape tee_body(const TeeNutSize& size) {
  const double foot_mm = size.width_mm / 2.0;
  const double neck_mm = (size.slot_mm - kTeeNutNeckPlay_mm) / 2.0;
  if (size.foot_height_mm == size.height_mm) {
    return block(size.width_mm, size.width_mm, size.height_mm);
  }
  const TopoDS_Shape foot = box({-foot_mm, -foot_mm, 0.0}, {foot_mm, foot_mm, size.foot_height_mm});
  const TopoDS_Shape neck =
      box({-foot_mm, -neck_mm, size.foot_height_mm}, {foot_mm, neck_mm, size.height_mm});
  return fuse(foot, neck);
}

Part tee_nut(const System& system, const TeeNutSize& size) {
  Part part;
  const std::string thread(size.thread);
  const bool has_neck = size.foot_height_mm < size.height_mm;
  part.name = element_name(system, "tee-nut-" + thread);
  part.role = "fastener";
  part.description =
      (has_neck ? "T-nut " : "nut without a neck ") + thread + " for slots " + plain(size.slot_mm);
  part.source = has_neck ? "like DIN 508" : std::string(system.source);
  part.dimensions = {{"slot", size.slot_mm},
                     {"width", size.width_mm},
                     {"height", size.height_mm},
                     {"foot_height", size.foot_height_mm}};
  part.features = {tapped_hole({"thread", {0.0, 0.0, size.height_mm}},
                               fastener_size(size.thread).thread, size.height_mm, true)};
  part.solid = machined(tee_body(size), part.features);
  part.features.push_back(face("bottom", {0.0, 0.0, 0.0}, kDown));
  part.colour = kSteelColour;
  return part;
}

/// Square head like the foot of the system's own T-nut, neck as high, thread above.
Part tee_bolt(const System& system, int length) {
  DOWEL_EXPECTS(!system.tee_nuts.empty());
  Part part;
  const TeeNutSize& head = system.tee_nuts.back();
  const double diameter_mm = fastener_of(system).thread.diameter_mm;
  const double radius_mm = diameter_mm / 2.0;
  const double chamfer_mm = 1.0;
  const double top_mm = head.foot_height_mm + length;
  part.name =
      element_name(system, "tee-bolt-" + std::string(system.thread) + "x" + std::to_string(length));
  part.role = "fastener";
  part.description = "T-bolt " + std::string(system.thread) + " for slots " + plain(head.slot_mm);
  part.source = head.foot_height_mm < head.height_mm ? "like DIN 787" : std::string(system.source);
  part.material = kScrewSteel;
  part.dimensions = {{"length", static_cast<double>(length)},
                     {"head_width", head.width_mm},
                     {"head_height", head.foot_height_mm}};
  part.solid = fuse(tee_body(head), turned({{0.0, head.foot_height_mm / 2.0},
                                            {radius_mm, head.foot_height_mm / 2.0},
                                            {radius_mm, top_mm - chamfer_mm},
                                            {radius_mm - chamfer_mm, top_mm},
                                            {0.0, top_mm}}));
  part.features = {threaded(shaft("thread", {0.0, 0.0, head.height_mm}, kUp, diameter_mm,
                                  top_mm - chamfer_mm - head.height_mm),
                            system.thread),
                   face("bottom", {0.0, 0.0, 0.0}, kDown)};
  part.colour = kSteelColour;
  return part;
}

Part key(const System& system, const KeySize& size) {
  Part part;
  const double half_mm = size.height_mm / 2.0;
  const double upper_mm = system.key_width_mm;
  part.name = element_name(system, "key-" + plain(size.width_mm) + "x" + plain(size.length_mm));
  part.role = "locator";
  part.description =
      "key " + plain(size.width_mm) + "h6 in a slot, " + plain(upper_mm) + "h6 in a key slot";
  part.source = system.source;
  part.material = kCaseHardenedSteel;
  part.dimensions = {{"length", size.length_mm},
                     {"width", size.width_mm},
                     {"upper_width", upper_mm},
                     {"height", size.height_mm}};
  part.features = {plain_hole({"screw", {0.0, 0.0, size.height_mm}},
                              fastener_size("M6").thread.clearance_hole_mm, size.height_mm, true)};
  const Eigen::Vector3d reach(size.length_mm / 2.0, size.width_mm / 2.0, half_mm);
  const Eigen::Vector3d upper_reach(size.length_mm / 2.0, upper_mm / 2.0, size.height_mm);
  const TopoDS_Shape body = fuse(box({-reach.x(), -reach.y(), 0.0}, reach),
                                 box({-reach.x(), -upper_reach.y(), half_mm}, upper_reach));
  part.solid = machined(body, part.features);
  part.features.push_back(face("bottom", {0.0, 0.0, 0.0}, kDown));
  for (const double side : {-1.0, 1.0}) {
    part.features.push_back(fitted(face(side > 0.0 ? "slot-back" : "slot-front",
                                        {0.0, side * reach.y(), half_mm / 2.0}, {0.0, side, 0.0}),
                                   "h6"));
    if (upper_mm == size.width_mm) continue;  // one face from bottom to top
    part.features.push_back(
        fitted(face(side > 0.0 ? "key-slot-back" : "key-slot-front",
                    {0.0, side * upper_reach.y(), 1.5 * half_mm}, {0.0, side, 0.0}),
               "h6"));
  }
  part.colour = kSteelColour;
  return part;
}

}  // namespace

std::vector<Part> tee_nuts(const System& system) {
  return each(system, system.tee_nuts, tee_nut);
}
std::vector<Part> tee_bolts(const System& system) {
  return each(system, system.tee_bolt_lengths_mm, tee_bolt);
}
std::vector<Part> keys(const System& system) {
  return each(system, system.keys, key);
}

}  // namespace dowel::library
