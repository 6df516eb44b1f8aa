// Standard fasteners: screws, studs, nuts, washers, dowel pins.

#include <cmath>
#include <numbers>
#include <string>

#include "builders.h"
#include "holes.h"
#include "solids.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kScrewColour{0.16, 0.16, 0.18};
constexpr std::array<double, 3> kFitScrewColour{0.30, 0.32, 0.20};
constexpr std::array<double, 3> kSteelColour{0.50, 0.50, 0.53};
constexpr std::array<double, 3> kBrightSteelColour{0.62, 0.62, 0.65};

double head_chamfer_mm(const SocketHead& head) {
  return 0.06 * head.head_diameter_mm;
}

/// Head of a socket head cap screw above z = 0, without its socket, as the end of an outline.
void add_head(std::vector<Eigen::Vector2d>& outline, const SocketHead& head) {
  const double radius_mm = head.head_diameter_mm / 2.0;
  const double chamfer_mm = head_chamfer_mm(head);
  outline.insert(outline.end(), {{radius_mm, 0.0},
                                 {radius_mm, head.head_height_mm - chamfer_mm},
                                 {radius_mm - chamfer_mm, head.head_height_mm},
                                 {0.0, head.head_height_mm}});
}

Feature head_shaft(const SocketHead& head) {
  const double top_mm = head.head_height_mm - head_chamfer_mm(head);
  return shaft_down("head", top_mm, head.head_diameter_mm, top_mm);
}

TopoDS_Shape with_socket(const TopoDS_Shape& screw, const SocketHead& head) {
  return cut(screw, {hexagon(head.key_size_mm, head.head_height_mm - head.key_depth_mm,
                             head.head_height_mm + 1.0)});
}

Part socket_screw(const System& system, const FastenerSize& size, int length) {
  Part part;
  const std::string thread(size.thread.name);
  const double length_mm = length;
  const double radius_mm = size.thread.diameter_mm / 2.0;
  const double chamfer_mm = size.thread.pitch_mm / 2.0;
  part.name = element_name(system, "screw-" + thread + "x" + std::to_string(length));
  part.role = "fastener";
  part.description = "socket head cap screw " + thread + "x" + std::to_string(length);
  part.source = "like ISO 4762";
  part.material = kScrewSteel;
  part.dimensions = {{"length", length_mm},
                     {"diameter", size.thread.diameter_mm},
                     {"head_diameter", size.socket.head_diameter_mm},
                     {"head_height", size.socket.head_height_mm},
                     {"key", size.socket.key_size_mm}};
  std::vector<Eigen::Vector2d> outline{{0.0, -length_mm},
                                       {radius_mm - chamfer_mm, -length_mm},
                                       {radius_mm, -length_mm + chamfer_mm},
                                       {radius_mm, 0.0}};
  add_head(outline, size.socket);
  part.solid = with_socket(turned(outline), size.socket);
  part.features = {
      threaded(shaft_down("thread", 0.0, size.thread.diameter_mm, length_mm - chamfer_mm), thread),
      head_shaft(size.socket), face("seat", {0.0, 0.0, 0.0}, kDown)};
  part.colour = kScrewColour;
  return part;
}

/// Locates and holds at once: its shank fits the bore of an element and of the node below.
Part fit_screw(const System& system, int length) {
  Part part;
  const FastenerSize& size = fastener_of(system);
  const std::string thread(size.thread.name);
  const double length_mm = length;
  const double radius_mm = size.thread.diameter_mm / 2.0;
  const double relief_mm = system.foot.relief_diameter_mm;
  const double chamfer_mm = 1.0;
  const double thread_mm = system.fit_screws.value().thread_length_mm;
  const double thread_z_mm = -length_mm + thread_mm;
  const double shank_mm = length_mm - thread_mm - system.foot.relief_length_mm;
  part.name = element_name(system, "fit-screw-" + thread + "x" + std::to_string(length));
  part.role = "fastener";
  part.description = "socket head fit screw, shank " + plain(size.thread.diameter_mm) + "g6 " +
                     plain(shank_mm) + " mm long";
  part.source = "dimensions of this library, head like ISO 4762";
  part.material = kScrewSteel;
  part.dimensions = {{"length", length_mm},
                     {"shank_length", shank_mm},
                     {"head_diameter", size.socket.head_diameter_mm},
                     {"head_height", size.socket.head_height_mm},
                     {"key", size.socket.key_size_mm}};
  std::vector<Eigen::Vector2d> outline{{0.0, -length_mm},
                                       {radius_mm - chamfer_mm, -length_mm},
                                       {radius_mm, -length_mm + chamfer_mm},
                                       {radius_mm, thread_z_mm},
                                       {relief_mm / 2.0, thread_z_mm},
                                       {relief_mm / 2.0, -shank_mm},
                                       {system.foot.shank_mm / 2.0, -shank_mm},
                                       {system.foot.shank_mm / 2.0, 0.0}};
  add_head(outline, size.socket);
  part.solid = with_socket(turned(outline), size.socket);
  part.features = {
      fitted(shaft_down("shank", 0.0, system.foot.shank_mm, shank_mm), "g6"),
      shaft_down("relief", -shank_mm, relief_mm, system.foot.relief_length_mm),
      threaded(shaft_down("thread", thread_z_mm, size.thread.diameter_mm, thread_mm - chamfer_mm),
               thread),
      head_shaft(size.socket), face("seat", {0.0, 0.0, 0.0}, kDown)};
  part.colour = kFitScrewColour;
  return part;
}

Part stud(const System& system, const StudSize& size) {
  Part part;
  const double diameter_mm = fastener_of(system).thread.diameter_mm;
  const double radius_mm = diameter_mm / 2.0;
  const double chamfer_mm = 1.0;
  part.name =
      element_name(system, "stud-" + std::string(system.thread) + "x" + plain(size.length_mm));
  part.role = "fastener";
  part.description = "stud, short thread at the lower end, long thread at the upper end";
  part.source = "like DIN 6379";
  part.material = kScrewSteel;
  part.dimensions = {{"length", size.length_mm},
                     {"lower_thread", size.lower_thread_mm},
                     {"upper_thread", size.upper_thread_mm}};
  part.solid = turned({{0.0, 0.0},
                       {radius_mm - chamfer_mm, 0.0},
                       {radius_mm, chamfer_mm},
                       {radius_mm, size.length_mm - chamfer_mm},
                       {radius_mm - chamfer_mm, size.length_mm},
                       {0.0, size.length_mm}});
  part.features = {threaded(shaft_down("thread", size.length_mm - chamfer_mm, diameter_mm,
                                       size.length_mm - 2.0 * chamfer_mm),
                            system.thread),
                   face("bottom", {0.0, 0.0, 0.0}, kDown),
                   face("top", {0.0, 0.0, size.length_mm}, kUp)};
  part.colour = kSteelColour;
  return part;
}

/// Solid of revolution that takes the corners off a hexagon end at 30 degrees.
std::vector<Eigen::Vector2d> chamfered_end(double across_flats_mm, double height_mm, bool below) {
  const double corner_mm = across_flats_mm / std::numbers::sqrt3 + 1.0;
  const double face_mm = 0.475 * across_flats_mm;
  const double drop_mm = (corner_mm - face_mm) * std::tan(std::numbers::pi / 6.0);
  if (below) return {{0.0, 0.0}, {face_mm, 0.0}, {corner_mm, drop_mm}};
  return {{corner_mm, height_mm - drop_mm}, {face_mm, height_mm}, {0.0, height_mm}};
}

Part hexagon_nut(const System& system, const FastenerSize& size, bool high) {
  Part part;
  const std::string thread(size.thread.name);
  const double width_mm = size.nut.width_mm;
  const double height_mm = high ? size.nut.high_height_mm : size.nut.height_mm;
  part.name = element_name(system, (high ? "clamp-nut-" : "nut-") + thread);
  part.role = "fastener";
  part.description = (high ? "hexagon nut 1.5 d high " : "hexagon nut ") + thread;
  part.source = high ? "like DIN 6330, flat ends" : "like ISO 4032";
  part.dimensions = {{"height", height_mm}, {"width_across_flats", width_mm}};
  std::vector<Eigen::Vector2d> outline = chamfered_end(width_mm, height_mm, true);
  const std::vector<Eigen::Vector2d> upper = chamfered_end(width_mm, height_mm, false);
  outline.insert(outline.end(), upper.begin(), upper.end());
  part.features = {tapped_hole({"thread", {0.0, 0.0, height_mm}}, size.thread, height_mm, true)};
  part.solid = machined(common(hexagon(width_mm, 0.0, height_mm), turned(outline)), part.features);
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.colour = kBrightSteelColour;
  return part;
}

/// The nut of DIN 6330 on a collar: no washer needed on a slotted strap.
Part collar_nut(const System& system, std::string_view thread) {
  Part part;
  const FastenerSize& size = fastener_size(thread);
  const double width_mm = size.nut.width_mm;
  const double height_mm = size.nut.high_height_mm;
  const auto [collar_mm, collar_height_mm] = size.collar;
  part.name = element_name(system, "collar-nut-" + std::string(thread));
  part.role = "fastener";
  part.description = "hexagon nut " + std::string(thread) + " with a collar, 1.5 d high";
  part.source = "like DIN 6331";
  part.dimensions = {{"height", height_mm},
                     {"width_across_flats", width_mm},
                     {"collar_diameter", collar_mm},
                     {"collar_height", collar_height_mm}};
  std::vector<Eigen::Vector2d> upper = chamfered_end(width_mm, height_mm, false);
  upper.insert(upper.begin(), {{0.0, 0.0}, {upper.front().x(), 0.0}});
  const TopoDS_Shape body =
      fuse(turned({{0.0, 0.0},
                   {collar_mm / 2.0, 0.0},
                   {collar_mm / 2.0, collar_height_mm},
                   {0.0, collar_height_mm}}),
           common(hexagon(width_mm, collar_height_mm / 2.0, height_mm), turned(upper)));
  part.features = {tapped_hole({"thread", {0.0, 0.0, height_mm}}, size.thread, height_mm, true)};
  part.solid = machined(body, part.features);
  part.features.push_back(shaft_down("collar", collar_height_mm, collar_mm, collar_height_mm));
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.colour = kBrightSteelColour;
  return part;
}

Part washer(const System& system, const FastenerSize& size, bool heavy) {
  Part part;
  const double inner_mm = heavy ? size.washer.heavy_inner_mm : size.washer.inner_mm;
  const double outer_mm = heavy ? size.washer.heavy_outer_mm : size.washer.outer_mm;
  const double height_mm = heavy ? size.washer.heavy_height_mm : size.washer.height_mm;
  const std::string thread(size.thread.name);
  part.name = element_name(system, (heavy ? "clamp-washer-" : "washer-") + thread);
  part.role = "fastener";
  part.description = (heavy ? "heavy washer for clamping " : "plain washer ") + thread;
  part.source = heavy ? "like DIN 6340" : "like ISO 7089";
  part.dimensions = {
      {"inner_diameter", inner_mm}, {"outer_diameter", outer_mm}, {"height", height_mm}};
  part.features = {plain_hole({"hole", {0.0, 0.0, height_mm}}, inner_mm, height_mm, true),
                   shaft_down("rim", height_mm, outer_mm, height_mm)};
  part.solid = turned({{inner_mm / 2.0, 0.0},
                       {outer_mm / 2.0, 0.0},
                       {outer_mm / 2.0, height_mm},
                       {inner_mm / 2.0, height_mm}});
  part.features.push_back(face("seat", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(face("top", {0.0, 0.0, height_mm}, kUp));
  part.colour = kBrightSteelColour;
  return part;
}

Part dowel_pin(const System& system, const DowelPinSize& size) {
  Part part;
  const double radius_mm = size.diameter_mm / 2.0;
  const double drop_mm = size.chamfer_mm * std::tan(kPinLeadIn_deg / 180.0 * std::numbers::pi);
  part.name =
      element_name(system, "dowel-pin-" + plain(size.diameter_mm) + "x" + plain(size.length_mm));
  part.role = "fastener";
  part.description = "hardened parallel pin, chamfered at both ends";
  part.source = "like ISO 8734";
  part.material = kHardenedSteel;
  part.dimensions = {{"diameter", size.diameter_mm}, {"length", size.length_mm}};
  part.solid = turned({{0.0, 0.0},
                       {radius_mm - drop_mm, 0.0},
                       {radius_mm, size.chamfer_mm},
                       {radius_mm, size.length_mm - size.chamfer_mm},
                       {radius_mm - drop_mm, size.length_mm},
                       {0.0, size.length_mm}});
  part.features = {fitted(shaft_down("pin", size.length_mm - size.chamfer_mm, size.diameter_mm,
                                     size.length_mm - 2.0 * size.chamfer_mm),
                          "m6"),
                   face("bottom", {0.0, 0.0, 0.0}, kDown),
                   face("top", {0.0, 0.0, size.length_mm}, kUp)};
  part.colour = kBrightSteelColour;
  return part;
}

/// The normal and the heavy one for each thread.
template <class Make>
std::vector<Part> both_of_each(const System& system, const std::vector<std::string_view>& threads,
                               const Make& make) {
  std::vector<Part> parts;
  for (const bool heavy : {false, true}) {
    for (const std::string_view thread : threads) {
      parts.push_back(make(system, fastener_size(thread), heavy));
      name_features(parts.back());
    }
  }
  return parts;
}

}  // namespace

std::vector<Part> socket_screws(const System& system) {
  std::vector<Part> parts;
  for (const ScrewSizes& screws : system.screws) {
    for (const int length : screws.lengths_mm) {
      parts.push_back(socket_screw(system, fastener_size(screws.thread), length));
      name_features(parts.back());
    }
  }
  return parts;
}

std::vector<Part> fit_screws(const System& system) {
  if (!system.fit_screws) return {};
  return each(system, system.fit_screws->lengths_mm, fit_screw);
}

std::vector<Part> studs(const System& system) {
  return each(system, system.studs, stud);
}

std::vector<Part> nuts(const System& system) {
  return both_of_each(system, system.nut_threads, hexagon_nut);
}

std::vector<Part> collar_nuts(const System& system) {
  return each(system, system.nut_threads, collar_nut);
}

std::vector<Part> washers(const System& system) {
  return both_of_each(system, system.washer_threads, washer);
}

std::vector<Part> dowel_pins(const System& system) {
  return each(system, system.dowel_pins, dowel_pin);
}

}  // namespace dowel::library
