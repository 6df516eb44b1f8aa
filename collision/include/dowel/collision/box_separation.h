#pragma once

#include <cmath>

#include "dowel/kernel/box.h"

namespace dowel {

/// A plane between two boxes, or that none was found.
struct BoxSeparation {
  /// 0-2: parallel to a face of the first box (type 1), 3-5: to a face of the second (type 2),
  /// 6-14: to an edge of each (type 3, 6 + 3 i + j for edges i and j). -1: none, the boxes overlap.
  int plane = -1;
  /// Distance between the boxes along the plane's normal: a lower bound of their distance. 0 or
  /// less where `plane` is -1.
  double gap_mm = 0.0;
};

/// First plane that keeps `a` and `b` more than `margin_mm` apart, both boxes in one frame.
///
/// Conservative: never separates boxes that are nearer than the margin by more than rounding. That
/// is below 1e-14 of the boxes' distance and size for planes of types 1 and 2, and below
/// 1e-10 of them for type 3 at worst, where it is divided by a sine of 1e-5. Type 3 planes of edges
/// that are more nearly parallel are skipped, as a type 1 or 2 plane serves there. `hint`: the
/// plane that separated them last is tried first; -1: none. Source: Peng et al. 2009, section 5.2
/// (types 1 and 2 before type 3). Departs: vertices are not transformed; each box's reach along a
/// normal is computed from its axes (Gottschalk 1996).
BoxSeparation separate(const Obb& a, const Obb& b, double margin_mm, int hint = -1);

/// Distance of the boxes along the normal of face `i` of `a`; negative where they overlap along it.
inline double gap_along_face(const Obb& a, int i, const Obb& b) {
  const auto normal = a.axes.col(i);  // not a copy, which would be read before it is written
  double reach_b = 0.0;
  for (int k = 0; k < 3; ++k) reach_b += std::abs(normal.dot(b.axes.col(k))) * b.half_extents_mm[k];
  return std::abs(normal.dot(b.center - a.center)) - a.half_extents_mm[i] - reach_b;
}

/// The same along the normal of a plane of type 3; -infinity where edges are parallel and give
/// none.
double gap_along_edges(const Obb& a, const Obb& b, int plane);

/// The same along the normal of any of the planes (numbered as in `BoxSeparation`).
inline double gap_along(const Obb& a, const Obb& b, int plane) {
  if (plane < 3) return gap_along_face(a, plane, b);
  return plane < 6 ? gap_along_face(b, plane - 3, a) : gap_along_edges(a, b, plane);
}

/// The same question answered from the 2 x 8 corners and all 15 planes: the plane with the largest
/// gap. Reference for tests.
BoxSeparation separate_brute_force(const Obb& a, const Obb& b, double margin_mm);

}  // namespace dowel
