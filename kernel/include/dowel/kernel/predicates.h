#pragma once

#include <Eigen/Core>

namespace dowel {

/// Predicate: exact. Sign (+1, 0, -1) of the determinant |b-a, c-a, d-a|: +1 where a, b, c are
/// counter-clockwise seen from the side that d is NOT on ... see the definition: d lies below the
/// plane through a, b, c where "above" is the side from which a, b, c turn counter-clockwise gives
/// -1; above gives +1. A static filter answers almost always; expansion arithmetic decides the
/// rest. Expects: finite coordinates of magnitude below 1e60 and above 1e-60 or zero.
/// Source: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates", 1997. Departs: two stages only, filter and exact.
int orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
             const Eigen::Vector3d& d);

/// Predicate: exact. Sign of twice the signed area of a, b, c: +1 for a counter-clockwise turn.
int orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

}  // namespace dowel
