#include <algorithm>
#include <cmath>
#include <numbers>

#include "element.h"
#include "solids.h"

namespace dowel::bench {

void add_cylinder_balls(std::vector<Ball>& balls, double radius_mm, double low_z, double high_z) {
  const double ball_mm = std::min(0.3 * radius_mm, 0.5 * (high_z - low_z));
  constexpr int kLevels = 5;
  constexpr int kAround = 8;
  for (int level = 0; level < kLevels; ++level) {
    const double z = low_z + ball_mm + (high_z - low_z - 2.0 * ball_mm) * level / (kLevels - 1);
    balls.push_back({{0.0, 0.0, z}, ball_mm});
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kAround;
      const double r = radius_mm - ball_mm;
      balls.push_back({{r * std::cos(angle), r * std::sin(angle), z}, ball_mm});
    }
  }
}

Element turned(std::string name, const std::vector<Eigen::Vector2d>& profile,
               std::uint32_t segments) {
  Aabb box;
  for (const Eigen::Vector2d& p : profile) {
    box.extend(Eigen::Vector3d(-p.x(), -p.x(), p.y()));
    box.extend(Eigen::Vector3d(p.x(), p.x(), p.y()));
  }
  Element result = element(std::move(name), testing::revolved(profile, segments), box);
  result.hull.clear();
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const double low = std::min(profile[i].y(), profile[i + 1].y());
    const double high = std::max(profile[i].y(), profile[i + 1].y());
    const double wide = std::max(profile[i].x(), profile[i + 1].x());
    const double narrow = std::min(profile[i].x(), profile[i + 1].x());
    if (low == high) continue;
    result.hull.push_back(box_of(-wide, -wide, low, wide, wide, high));
    const double inner = narrow * std::numbers::sqrt2 / 2.0;
    if (narrow == 0.0) continue;
    result.core.push_back(box_of(-inner, -inner, low, inner, inner, high));
    add_cylinder_balls(result.core_balls, narrow, low, high);
  }
  return result;
}

Element tube(std::string name, double inner_mm, double outer_mm, double height_mm,
             std::uint32_t segments) {
  return element(std::move(name), testing::tube(inner_mm, outer_mm, height_mm, segments),
                 box_of(-outer_mm, -outer_mm, 0.0, outer_mm, outer_mm, height_mm));
}

Element locator(double shank_mm, std::uint32_t segments) {
  return turned("locator",
                {{0.0, 0.0},
                 {shank_mm - 1.0, 0.0},
                 {shank_mm, 1.0},
                 {shank_mm, 20.0},
                 {11.0, 20.0},
                 {12.0, 21.0},
                 {12.0, 26.0},
                 {7.0, 26.0},
                 {8.0, 28.0},
                 {8.0, 38.0},
                 {6.0, 41.0},
                 {0.0, 41.0}},
                segments);
}

}  // namespace dowel::bench
