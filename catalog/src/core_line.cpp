#include "core_line.h"

#include <algorithm>
#include <array>
#include <limits>
#include <optional>
#include <utility>

#include "dowel/kernel/predicates.h"
#include "facet_geometry.h"

namespace dowel {
namespace {

/// Height of a crossing, and whether the line leaves the material there.
using Crossing = std::pair<double, bool>;

/// All crossings with the line through `point` of the plane; nothing where it meets an edge of a
/// facet (then the crossing would count twice or not at all).
std::optional<std::vector<Crossing>> crossings(const FacetedSolid& solid, std::uint32_t lump,
                                               const std::vector<Eigen::Vector2d>& flat,
                                               const std::vector<double>& height,
                                               const Eigen::Vector2d& point) {
  std::vector<Crossing> result;
  for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
    const Triangle& triangle = solid.triangles[t];
    const Eigen::Vector2d& a = flat[triangle[0]];
    const Eigen::Vector2d& b = flat[triangle[1]];
    const Eigen::Vector2d& c = flat[triangle[2]];
    if (point.x() < std::min({a.x(), b.x(), c.x()}) ||
        point.x() > std::max({a.x(), b.x(), c.x()}) ||
        point.y() < std::min({a.y(), b.y(), c.y()}) ||
        point.y() > std::max({a.y(), b.y(), c.y()})) {
      continue;
    }
    if (solid.faces[solid.face_of[t]].solid != lump) continue;
    const std::array<int, 3> side{orient2d(b, c, point), orient2d(c, a, point),
                                  orient2d(a, b, point)};
    const bool has_left = side[0] > 0 || side[1] > 0 || side[2] > 0;
    const bool has_right = side[0] < 0 || side[1] < 0 || side[2] < 0;
    if (has_left && has_right) continue;
    if (side[0] == 0 || side[1] == 0 || side[2] == 0) return std::nullopt;
    const auto weight = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
      return (p.x() - point.x()) * (q.y() - point.y()) - (p.y() - point.y()) * (q.x() - point.x());
    };
    const double wa = weight(b, c);
    const double wb = weight(c, a);
    const double wc = weight(a, b);
    const double sum = wa + wb + wc;
    if (sum == 0.0) return std::nullopt;
    const double h =
        (wa * height[triangle[0]] + wb * height[triangle[1]] + wc * height[triangle[2]]) / sum;
    result.emplace_back(h, has_left);  // counter-clockwise from above: the facet faces up
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<VoidStretch> stretches(const std::vector<Crossing>& crossings) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<VoidStretch> result{{-kInfinity, kInfinity}};
  for (const auto& [height, leaves] : crossings) {
    if (leaves) {
      result.push_back({height, kInfinity});
    } else {
      result.back().high_mm = std::min(result.back().high_mm, height);
    }
  }
  return result;
}

}  // namespace

std::vector<VoidStretch> void_along(const FacetedSolid& solid, std::uint32_t lump, const Axis& axis,
                                    double offset_mm) {
  const Eigen::Vector3d u = any_perpendicular(axis.direction);
  const Eigen::Vector3d v = axis.direction.cross(u);
  std::vector<Eigen::Vector2d> flat;
  std::vector<double> height;
  flat.reserve(solid.vertices.size());
  height.reserve(solid.vertices.size());
  for (const Eigen::Vector3d& p : solid.vertices) {
    const Eigen::Vector3d q = p - axis.origin;
    flat.emplace_back(u.dot(q), v.dot(q));
    height.push_back(axis.direction.dot(q));
  }
  // Directions without a simple ratio to any drawn angle.
  constexpr std::array<std::array<double, 2>, 5> kOffsets{
      {{0.877, 0.479}, {-0.353, 0.917}, {0.211, -0.871}, {-0.733, -0.293}, {0.419, 0.607}}};
  for (const auto& [x, y] : kOffsets) {
    const auto found = crossings(solid, lump, flat, height, offset_mm * Eigen::Vector2d(x, y));
    if (found) return stretches(*found);
  }
  return {};
}

}  // namespace dowel
