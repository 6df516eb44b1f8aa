#include "spigot.h"

#include <string>

#include "dimensions.h"

namespace dowel::library {
namespace {

constexpr double kTipChamfer_mm = 1.0;
constexpr double kThreadStart_mm = kSpigotFit_mm + kSpigotRelief_mm;

}  // namespace

std::vector<Eigen::Vector2d> spigot_outline() {
  const double thread_mm = fastener_size(kSystemThread).thread.diameter_mm / 2.0;
  const double relief_mm = kSpigotReliefDiameter_mm / 2.0;
  return {{0.0, -kSpigotLength_mm},
          {thread_mm - kTipChamfer_mm, -kSpigotLength_mm},
          {thread_mm, -kSpigotLength_mm + kTipChamfer_mm},
          {thread_mm, -kThreadStart_mm},
          {relief_mm, -kThreadStart_mm},
          {relief_mm, -kSpigotFit_mm},
          {kShank_mm / 2.0, -kSpigotFit_mm},
          {kShank_mm / 2.0, 0.0}};
}

std::vector<DesignedFeature> spigot_features() {
  const Eigen::Vector3d down(0.0, 0.0, -1.0);
  return {fitted(shaft("shank", {0.0, 0.0, 0.0}, down, kShank_mm, kSpigotFit_mm), "g6"),
          threaded(shaft("thread", {0.0, 0.0, -kThreadStart_mm}, down,
                         fastener_size(kSystemThread).thread.diameter_mm,
                         kSpigotLength_mm - kTipChamfer_mm - kThreadStart_mm),
                   std::string(kSystemThread))};
}

}  // namespace dowel::library
