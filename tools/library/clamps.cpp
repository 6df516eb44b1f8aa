// The strap clamp and what belongs to it: strap, heel screw, stud.

#include <cmath>
#include <numbers>
#include <string>

#include "builders.h"
#include "dimensions.h"
#include "solids.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kClampColour{0.72, 0.30, 0.22};
constexpr std::array<double, 3> kSteelColour{0.50, 0.50, 0.53};

/// Seen from the side: two feet, a relief between them, a nose that slopes down.
Part strap(const StrapSize& size) {
  Part part;
  const double half_mm = size.length_mm / 2.0;
  const double heel_foot_mm = 30.0;
  const double nose_foot_mm = 12.0;
  const double relief_mm = 2.0;
  const double nose_height_mm = size.height_mm / 2.0;
  const double nose_slope_mm = 20.0;
  part.name = element_name("strap-" + plain(size.slot_mm) + "x" + plain(size.length_mm));
  part.role = "clamp";
  part.description = "clamp strap, nose at +x, heel foot at -x, slot for an M12 stud";
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
  part.solid =
      cut(body, {oblong(0.0, size.slot_length_mm, size.slot_mm, -1.0, size.height_mm + 1.0)});
  DesignedFeature slot;
  slot.geometry.name = "slot";
  slot.geometry.kind = FeatureKind::Slot;
  slot.geometry.origin = {0.0, 0.0, size.height_mm};
  slot.geometry.direction = kDown;
  slot.geometry.diameter_mm = size.slot_mm;
  slot.geometry.depth_mm = size.height_mm - relief_mm;
  slot.geometry.through = true;
  part.features = {slot, face("nose", {half_mm - nose_foot_mm / 2.0, 0.0, 0.0}, kDown),
                   face("heel", {-half_mm + heel_foot_mm / 2.0, 0.0, 0.0}, kDown),
                   face("top", {-nose_slope_mm / 2.0, 0.0, size.height_mm}, kUp)};
  part.colour = kClampColour;
  return part;
}

Part heel_screw(int length) {
  Part part;
  const double length_mm = length;
  const double radius_mm = fastener_size(kSystemThread).thread.diameter_mm / 2.0;
  const double chamfer_mm = 1.0;
  const double corner_mm = kHeelScrewWidth_mm / std::numbers::sqrt3;
  const double face_mm = 0.475 * kHeelScrewWidth_mm;  // radius of the flat end face
  const double drop_mm = (corner_mm + 1.0 - face_mm) * std::tan(std::numbers::pi / 6.0);
  part.name = element_name("heel-screw-M12x" + std::to_string(length));
  part.role = "clamp";
  part.description = "adjustable heel support: hexagon screw with a flat face, for a lock nut";
  part.source = "dimensions of this library";
  part.dimensions = {{"length", length_mm},
                     {"head_height", kHeelScrewHead_mm},
                     {"width_across_flats", kHeelScrewWidth_mm}};
  const TopoDS_Shape head = common(hexagon(kHeelScrewWidth_mm, 0.0, kHeelScrewHead_mm),
                                   turned({{0.0, 0.0},
                                           {corner_mm + 1.0, 0.0},
                                           {corner_mm + 1.0, kHeelScrewHead_mm - drop_mm},
                                           {face_mm, kHeelScrewHead_mm},
                                           {0.0, kHeelScrewHead_mm}}));
  part.solid = fuse(head, turned({{0.0, -length_mm},
                                  {radius_mm - chamfer_mm, -length_mm},
                                  {radius_mm, -length_mm + chamfer_mm},
                                  {radius_mm, 0.0},
                                  {0.0, 0.0}}));
  part.features = {
      threaded(shaft("thread", {0.0, 0.0, 0.0}, kDown, 2.0 * radius_mm, length_mm - chamfer_mm),
               std::string(kSystemThread)),
      face("heel", {0.0, 0.0, kHeelScrewHead_mm}, kUp), face("seat", {0.0, 0.0, 0.0}, kDown)};
  part.colour = kSteelColour;
  return part;
}

Part stud(const StudSize& size) {
  Part part;
  const double radius_mm = fastener_size(kSystemThread).thread.diameter_mm / 2.0;
  const double chamfer_mm = 1.0;
  part.name = element_name("stud-M12x" + plain(size.length_mm));
  part.role = "fastener";
  part.description = "stud, short thread at the lower end, long thread at the upper end";
  part.source = "like DIN 6379";
  part.dimensions = {{"length", size.length_mm},
                     {"lower_thread", size.lower_thread_mm},
                     {"upper_thread", size.upper_thread_mm}};
  part.solid = turned({{0.0, 0.0},
                       {radius_mm - chamfer_mm, 0.0},
                       {radius_mm, chamfer_mm},
                       {radius_mm, size.length_mm - chamfer_mm},
                       {radius_mm - chamfer_mm, size.length_mm},
                       {0.0, size.length_mm}});
  part.features = {threaded(shaft("thread", {0.0, 0.0, chamfer_mm}, kUp, 2.0 * radius_mm,
                                  size.length_mm - 2.0 * chamfer_mm),
                            std::string(kSystemThread)),
                   face("bottom", {0.0, 0.0, 0.0}, kDown),
                   face("top", {0.0, 0.0, size.length_mm}, kUp)};
  part.colour = kSteelColour;
  return part;
}

}  // namespace

std::vector<Part> straps() {
  std::vector<Part> parts;
  for (const StrapSize& size : kStraps) parts.push_back(strap(size));
  return parts;
}

std::vector<Part> heel_screws() {
  std::vector<Part> parts;
  for (const int length : kHeelScrewLengths_mm) parts.push_back(heel_screw(length));
  return parts;
}

std::vector<Part> studs() {
  std::vector<Part> parts;
  for (const StudSize& size : kStuds) parts.push_back(stud(size));
  return parts;
}

}  // namespace dowel::library
