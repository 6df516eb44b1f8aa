#include "dowel/collision/silhouette.h"

#include <cmath>

namespace dowel {
namespace {

/// How far a silhouette reaches from its centre along `normal`, times the length of that.
double reach(const Silhouette& s, const Eigen::Vector2d& normal) {
  return std::abs(normal.dot(s.arms[0])) + std::abs(normal.dot(s.arms[1])) +
         std::abs(normal.dot(s.arms[2]));
}

/// Whether a line along a side of `sides` keeps the two apart.
bool side_separates(const Silhouette& sides, const Silhouette& other, double margin_mm) {
  for (const Eigen::Vector2d& arm : sides.arms) {
    const Eigen::Vector2d normal(-arm.y(), arm.x());
    const double distance = std::abs(normal.dot(other.center - sides.center));
    if (distance > reach(sides, normal) + reach(other, normal) + margin_mm * normal.norm()) {
      return true;
    }
  }
  return false;
}

}  // namespace

Silhouette silhouette(const Obb& box) {
  Silhouette result{box.center.head<2>(), {}};
  for (Eigen::Index i = 0; i < 3; ++i) {
    result.arms[static_cast<std::size_t>(i)] = box.half_extents_mm[i] * box.axes.col(i).head<2>();
  }
  return result;
}

bool are_apart(const Silhouette& a, const Silhouette& b, double margin_mm) {
  return side_separates(a, b, margin_mm) || side_separates(b, a, margin_mm);
}

}  // namespace dowel
