#pragma once

#include <vector>

#include "dowel/catalog/element.h"
#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Holes, shafts, planar faces and slots of `solid`, named and in canonical order: holes (grid
/// holes by row and column, then the others), shafts, faces, slots; within a kind by position. The
/// same solid gives the same features whatever the order of its faces. See catalog/README.md for
/// the rules.
std::vector<Feature> recognise_features(const FacetedSolid& solid);

/// Circles of equal holes among named features, those of one opening plane: evenly spaced, three or
/// more. Holes of a grid are on none; of circles that share holes the one with more of them counts.
/// Their holes are listed from the right around, seen against their direction.
std::vector<BoltCircle> find_bolt_circles(const std::vector<Feature>& features);

ShapeClass classify_shape(const FacetedSolid& solid, const std::vector<Feature>& features);

/// Class of every face: planar faces are Plane, curved walls of holes are Hole, the rest Other.
std::vector<FacetClass> classify_faces(const FacetedSolid& solid,
                                       const std::vector<Feature>& features);

TriangleCounts count_triangles(const FacetedSolid& solid, const std::vector<FacetClass>& classes);

/// Smallest box of the facets grown by what the exact faces can stand out of them, so that it
/// contains the exact solid.
Obb enclosing_box(const FacetedSolid& solid);

}  // namespace dowel
