#pragma once

#include <array>
#include <optional>

#include <Eigen/Core>

// Two flat triangles in space. Constructions: rounded, error a few ulp of the coordinates. Private.

namespace dowel {

using Corners = std::array<Eigen::Vector3d, 3>;

struct Segment {
  Eigen::Vector3d start;
  Eigen::Vector3d end;
};

/// Segment in which two triangles cross; nothing where they do not, or are coplanar. `normal_a`,
/// `normal_b`: their unit normals.
/// Source: Moller, "A Fast Triangle-Triangle Intersection Test", 1997, with the segment kept.
std::optional<Segment> crossing_segment(const Corners& a, const Eigen::Vector3d& normal_a,
                                        const Corners& b, const Eigen::Vector3d& normal_b);

/// Nearest points of two triangles: on the first and on the second; the same point where they
/// cross.
struct ClosestPair {
  Eigen::Vector3d on_a;
  Eigen::Vector3d on_b;
  double distance_squared_mm2;
};
ClosestPair closest_points(const Corners& a, const Eigen::Vector3d& normal_a, const Corners& b,
                           const Eigen::Vector3d& normal_b);

}  // namespace dowel
