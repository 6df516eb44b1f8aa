#pragma once

#include <span>

#include "dowel/kernel/box.h"

namespace dowel {

/// Smallest box that contains `points`, among the boxes flush with a face of their convex hull
/// (rotating calipers in that face's plane). Within 0.1 % of the best known volume on the parts we
/// measured; exact for boxes, prisms and bodies of revolution up to their facets. Deterministic:
/// the same set of points in any order gives the same box. Ties go to the box best aligned with the
/// coordinate axes; axes are ordered and signed so that `axes` is as close to the identity as the
/// box allows. Flat and linear input gives half extents of zero.
/// Expects: at least one point, all finite.
/// Source: O'Rourke, "Finding Minimal Enclosing Boxes", 1985, without its edge-edge cases.
Obb minimum_box(std::span<const Eigen::Vector3d> points);

}  // namespace dowel
