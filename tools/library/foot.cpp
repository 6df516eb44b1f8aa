#include "foot.h"

#include <string>

namespace dowel::library {
namespace {

constexpr double kTipChamfer_mm = 1.0;

double thread_start_mm(const FootSize& foot) {
  return foot.shank_length_mm + foot.relief_length_mm;
}

}  // namespace

std::vector<Eigen::Vector2d> foot_outline(const System& system) {
  const FootSize& foot = system.foot;
  const double thread_mm = fastener_of(system).thread.diameter_mm / 2.0;
  const double relief_mm = foot.relief_diameter_mm / 2.0;
  std::vector<Eigen::Vector2d> outline{{0.0, -foot.length_mm},
                                       {thread_mm - kTipChamfer_mm, -foot.length_mm},
                                       {thread_mm, -foot.length_mm + kTipChamfer_mm},
                                       {thread_mm, -thread_start_mm(foot)},
                                       {relief_mm, -thread_start_mm(foot)},
                                       {relief_mm, -foot.shank_length_mm}};
  if (foot.shank_length_mm > 0.0) {
    outline.emplace_back(foot.shank_mm / 2.0, -foot.shank_length_mm);
    outline.emplace_back(foot.shank_mm / 2.0, 0.0);
  }
  return outline;
}

std::vector<Feature> foot_features(const System& system) {
  const FootSize& foot = system.foot;
  const double thread_z_mm = -thread_start_mm(foot);
  std::vector<Feature> features{
      shaft_down("relief", -foot.shank_length_mm, foot.relief_diameter_mm, foot.relief_length_mm),
      threaded(shaft_down("thread", thread_z_mm, fastener_of(system).thread.diameter_mm,
                          foot.length_mm - kTipChamfer_mm + thread_z_mm),
               system.thread)};
  if (foot.shank_length_mm > 0.0) {
    features.push_back(fitted(shaft_down("shank", 0.0, foot.shank_mm, foot.shank_length_mm), "g6"));
  }
  return features;
}

}  // namespace dowel::library
