#pragma once

#include <span>
#include <vector>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Sum that does not depend on the order of the terms, to the bit.
double ordered_sum(std::span<const double> terms);
Eigen::Vector3d ordered_sum(const std::vector<Eigen::Vector3d>& terms);

/// Corners of a triangle from its lexicographically smallest on: what is computed from them does
/// not depend on where the triangle starts.
std::array<Eigen::Vector3d, 3> canonical_corners(const FacetedSolid& solid, std::uint32_t triangle);

/// Twice the area, along the outward normal.
inline Eigen::Vector3d doubled_area(const std::array<Eigen::Vector3d, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}

/// Lexicographic by x, y, z.
bool less_by_coordinates(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// Some unit vector across `direction`, the same for equal directions.
Eigen::Vector3d any_perpendicular(const Eigen::Vector3d& direction);

}  // namespace dowel
