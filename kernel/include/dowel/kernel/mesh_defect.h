#pragma once

#include <optional>
#include <string>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// First violation of FacetedSolid's invariants as one sentence that names the triangle, edge or
/// vertex ("edge 12-57 is used by 1 triangle, expected 2: the mesh is open"); nothing where the
/// solid is sound. Parameters of surfaces and edges are looked at too; each of the solids must be
/// closed and enclose a positive volume, each of its components unless it is a cavity; and exact
/// faces must be where their triangles are, with the same side outward. O(n log n).
std::optional<std::string> find_defect(const FacetedSolid& solid);

/// Welds vertices with equal coordinates, drops triangles with two equal vertices and vertices
/// that no triangle uses. Order is kept. Faces, edges and face_of stay consistent.
/// Expects: indices in range.
void weld(FacetedSolid& solid);

/// Turns every closed component that encloses negative volume inside out, unless it is a cavity
/// (it lies inside another component of the same solid). Inside a component that turned, the rest
/// of its solid follows: cavities negative, islands in them positive. Faces that turned get the
/// sense of their facets (plane normal, `reversed`), and edges between two of them trade convex for
/// concave. Components that are open are left alone. Expects: indices in range.
void orient_outward(FacetedSolid& solid);

}  // namespace dowel
