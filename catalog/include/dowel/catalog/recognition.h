#pragma once

#include <functional>
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

/// Largest `direction . p` over an exact solid for a unit vector, from above, by `slack_mm` at
/// most.
using ExactReachFunction = std::function<double(const Eigen::Vector3d& direction, double slack_mm)>;

/// Smallest box that was found around the exact solid. From the facets alone it is grown by what
/// the faces can stand out of them; with the exact reach it fits to some ten thousandths.
Obb enclosing_box(const FacetedSolid& solid);
Obb enclosing_box(const FacetedSolid& solid, const ExactReachFunction& reach_mm);

}  // namespace dowel
