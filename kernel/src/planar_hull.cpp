#include "planar_hull.h"

#include <algorithm>
#include <numeric>

#include "dowel/kernel/predicates.h"

namespace dowel {

std::vector<std::uint32_t> planar_hull(std::span<const Eigen::Vector2d> points) {
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t i, std::uint32_t j) {
    const Eigen::Vector2d& a = points[i];
    const Eigen::Vector2d& b = points[j];
    if (a.x() != b.x()) return a.x() < b.x();
    if (a.y() != b.y()) return a.y() < b.y();
    return i < j;
  });
  order.erase(std::unique(order.begin(), order.end(),
                          [&](std::uint32_t i, std::uint32_t j) { return points[i] == points[j]; }),
              order.end());
  if (order.size() < 3) return order;

  // The lower chain from left to right, then the upper one back; each ends where the other starts.
  std::vector<std::uint32_t> hull;
  const auto add_chain = [&](auto first, auto last) {
    const std::size_t start = hull.size();
    for (; first != last; ++first) {
      while (hull.size() >= start + 2 &&
             orient2d(points[hull[hull.size() - 2]], points[hull.back()], points[*first]) <= 0) {
        hull.pop_back();
      }
      hull.push_back(*first);
    }
    hull.pop_back();
  };
  add_chain(order.begin(), order.end());
  add_chain(order.rbegin(), order.rend());
  return hull;
}

}  // namespace dowel
