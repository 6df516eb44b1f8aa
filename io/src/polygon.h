#pragma once

#include <cstdint>
#include <span>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Cuts a simple polygon over vertices of `mesh` into triangles with the same sense and appends
/// them. Convex polygons become fans, others are cut by ears on exact signs in the coordinate plane
/// that they face most. A polygon that is not simple gives some triangles, whose edges still run
/// along it; nothing is invented outside its corners. O(n^2).
/// Expects: three corners or more, indices in range, finite vertices.
/// Source: Meisters, "Polygons Have Ears", 1975.
void append_polygon(std::span<const std::uint32_t> corners, FacetedSolid& mesh);

}  // namespace dowel
