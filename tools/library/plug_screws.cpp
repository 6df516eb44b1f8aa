// Plug screws: they keep chips and dust out of the nodes that nothing stands on.

#include <string>

#include "builders.h"
#include "solids.h"

namespace dowel::library {
namespace {

constexpr std::array<double, 3> kPlugColour{0.70, 0.66, 0.58};
constexpr double kPlay_mm = 0.1;      // between shank and bore: it closes, it does not locate
constexpr double kBelowTop_mm = 0.5;  // screwed down to the node's thread: an element goes over it
constexpr double kTipChamfer_mm = 1.0;

/// Screwed down from a plate's top at z = 0: a shank that fills the bore, a relief, one diameter of
/// thread. It ends where the bore ends, with its top a little below that of the plate.
Part plug_screw(const System& system) {
  Part part;
  const NodeSize& node = system.node.value();
  const ThreadSize& thread = fastener_of(system).thread;
  const double shank_mm = node.bore_mm - kPlay_mm;
  const double shank_length_mm = node.bore_depth_mm - kBelowTop_mm;
  const double relief_mm = system.foot.relief_diameter_mm;
  const double thread_z_mm = -shank_length_mm - system.foot.relief_length_mm;
  const double length_mm = thread.diameter_mm - thread_z_mm;
  const double radius_mm = thread.diameter_mm / 2.0;
  const double key_mm = thread.diameter_mm / 2.0;  // like set screws of ISO 4026
  const double key_depth_mm = thread.diameter_mm / 2.0;
  part.name = element_name(system, "plug-screw-" + std::string(system.thread));
  part.role = "fastener";
  part.description = "plug screw: keeps a node of the plate clean, lies below the plate's top";
  part.source = system.source;
  part.material = kAluminium;
  part.dimensions = {{"length", length_mm},
                     {"shank_diameter", shank_mm},
                     {"shank_length", shank_length_mm},
                     {"key", key_mm}};
  const TopoDS_Shape body = turned({{0.0, -length_mm},
                                    {radius_mm - kTipChamfer_mm, -length_mm},
                                    {radius_mm, -length_mm + kTipChamfer_mm},
                                    {radius_mm, thread_z_mm},
                                    {relief_mm / 2.0, thread_z_mm},
                                    {relief_mm / 2.0, -shank_length_mm},
                                    {shank_mm / 2.0, -shank_length_mm},
                                    {shank_mm / 2.0, 0.0},
                                    {0.0, 0.0}});
  part.solid = cut(body, {hexagon(key_mm, -key_depth_mm, 1.0)});
  part.features = {shaft_down("shank", 0.0, shank_mm, shank_length_mm),
                   shaft_down("relief", -shank_length_mm, relief_mm, system.foot.relief_length_mm),
                   threaded(shaft_down("thread", thread_z_mm, thread.diameter_mm,
                                       thread.diameter_mm - kTipChamfer_mm),
                            system.thread),
                   face("stop", {0.0, 0.0, -shank_length_mm}, kDown),
                   face("top", {0.0, 0.0, 0.0}, kUp)};
  part.colour = kPlugColour;
  return part;
}

}  // namespace

std::vector<Part> plug_screws(const System& system) {
  if (!system.node) return {};
  std::vector<Part> parts{plug_screw(system)};
  name_features(parts.back());
  return parts;
}

}  // namespace dowel::library
