#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// A plane facet of a convex hull: its extreme points, counter-clockwise seen from outside,
/// starting at the lowest index, no three on a line.
using HullFacet = std::vector<std::uint32_t>;

/// Facets of the convex polyhedron that `triangles` bound: exactly coplanar neighbours are one, and
/// vertices inside a facet or within an edge are gone. The result is the same for every
/// triangulation of the same polyhedron: facets in lexicographic order.
/// Expects: `triangles` closed, outward, convex, none degenerate.
std::vector<HullFacet> hull_facets(std::span<const Eigen::Vector3d> points,
                                   std::span<const Triangle> triangles);

/// Each facet as a fan around its first vertex.
std::vector<Triangle> fan_triangles(const std::vector<HullFacet>& facets);

}  // namespace dowel
