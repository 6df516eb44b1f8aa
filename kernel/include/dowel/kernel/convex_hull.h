#pragma once

#include <span>
#include <vector>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Convex hull of a point set. `vertices` index the input and are sorted; `triangles` index the
/// input and are outward. Flat or linear input (all points coplanar) gives no triangles and the
/// extreme points as vertices.
struct ConvexHull {
  std::vector<std::uint32_t> vertices;
  std::vector<Triangle> triangles;
};

/// Quickhull on exact predicates: topology never depends on rounding. The same points in another
/// order give the same hull. O(n log n) expected.
/// Source: Barber, Dobkin, Huhdanpaa, "The Quickhull Algorithm for Convex Hulls", 1996.
ConvexHull convex_hull(std::span<const Eigen::Vector3d> points);

}  // namespace dowel
