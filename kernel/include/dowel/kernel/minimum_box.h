#pragma once

#include <span>

#include "dowel/kernel/box.h"

namespace dowel {

/// Smallest box that contains `points`. Boxes flush with a face of their convex hull or along two
/// of its edges (rotating calipers in that plane) are tried and the best turned further; a box that
/// is flush with no face must be smaller by 1e-4 to be taken. Within 0.1 % of the best known volume
/// on the parts we measured; exact for boxes, prisms and bodies of revolution up to their facets.
/// The effort is bounded: of thousands of hull faces the largest and some in every direction are
/// tried. Deterministic: the same set of points in any order gives the same box. Ties go to the box
/// best aligned with the coordinate axes; axes are ordered and signed so that `axes` is as close to
/// the identity as the box allows. No point has a positive `face_distance_mm`. Flat and linear
/// input gives half extents of zero, up to rounding where it lies obliquely. Expects: at least one
/// point, all finite. Source: O'Rourke, "Finding Minimal Enclosing Boxes", 1985. Departs: a compass
/// search takes the place of its edge-edge cases.
Obb minimum_box(std::span<const Eigen::Vector3d> points);

}  // namespace dowel
