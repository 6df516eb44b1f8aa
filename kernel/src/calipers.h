#pragma once

#include <span>
#include <vector>

#include <Eigen/Core>

namespace dowel {

/// Rectangle around a convex polygon with a side along one of its edges.
struct FlushRectangle {
  Eigen::Vector2d along = Eigen::Vector2d::UnitX();  ///< unit vector along that edge
  double area_mm2 = 0.0;
};

/// One rectangle for each edge, in order. Construction: rounded.
/// Expects: `polygon` convex, counter-clockwise, at least two points (two: a segment).
/// Source: Toussaint, "Solving Geometric Problems with the Rotating Calipers", 1983.
std::vector<FlushRectangle> flush_rectangles(std::span<const Eigen::Vector2d> polygon);

}  // namespace dowel
