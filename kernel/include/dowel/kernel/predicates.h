#pragma once

#include <Eigen/Core>

namespace dowel {

/// Predicate: exact. On which side of the plane through a, b, c the point d lies: the sign of
/// (b - a) x (c - a) . (d - a). +1 where d is on the side that the normal (b - a) x (c - a) points
/// to, from which a, b, c turn counter-clockwise; -1 on the other side; 0 in the plane, or where a,
/// b, c have none. For a triangle of a solid, +1 is outside.
/// A filter answers almost always; expansion arithmetic decides the rest.
/// Expects: coordinates finite, of magnitude above 1e-60 and below 1e60, or zero.
/// Source: Shewchuk, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
/// Predicates", 1997. Departs: two stages only, filter and exact; the sign is the opposite.
int orient3d(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c,
             const Eigen::Vector3d& d);

/// Predicate: exact. Sign of the area of a, b, c: +1 for a counter-clockwise turn, 0 on one line.
/// Expects: as above.
int orient2d(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c);

}  // namespace dowel
