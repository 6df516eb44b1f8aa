#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace dowel {

/// Extreme points of a plane point set, counter-clockwise from the lexicographically smallest, as
/// indices into the input; of equal points the first. Points on a straight piece are left out: a
/// set on a line gives its two ends, one place one point. Exact; O(n log n).
/// Source: Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions", 1979.
std::vector<std::uint32_t> planar_hull(std::span<const Eigen::Vector2d> points);

}  // namespace dowel
