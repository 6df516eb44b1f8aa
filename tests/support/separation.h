#pragma once

#include <Eigen/Core>

#include "dowel/kernel/pose.h"
#include "exact_shape.h"

namespace dowel::testing {

/// How far two shapes are apart, between bounds: their gap where that is positive; where it is
/// negative, minus their depth, the diameter of the largest ball that fits into both.
struct Separation {
  double low_mm = 0.0;
  double high_mm = 0.0;  ///< attained at `place_B`
  /// A point within high_mm / 2 of both shapes, or that deep in both.
  Eigen::Vector3d place_B = Eigen::Vector3d::Zero();
};

struct SeparationEffort {
  double resolution_mm = 0.0;  ///< bounds as close as this are close enough
  int max_evaluations = 0;
};

/// Branch and bound over boxes for the least m of f(p) = max(distance of p from a, from b), both
/// signed; the separation is 2 m.
///
/// Proof. Apart by a gap g, every p has distances that sum up to g or more, so f >= g / 2, and the
/// middle of the shortest connection has f = g / 2. Overlapping, -f(p) is the radius of the largest
/// ball about p in both. Either place is in the box around the boxes of both. Signed distances are
/// no steeper than 1, and so is f: in a box with centre c and half diagonal h it is f(c) - h or
/// more.
///
/// Bounds hold within rounding, whatever the effort.
Separation separation(const ExactShape& a, const ExactShape& b, const Pose& X_BA,
                      const SeparationEffort& effort);

}  // namespace dowel::testing
