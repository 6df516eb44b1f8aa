#pragma once

#include <array>

#include <Eigen/Core>

#include "dowel/kernel/box.h"

namespace dowel {

/// Outline of a box seen along z, in the plane of x and y: all points `center` plus parts, from -1
/// to 1, of the three arms. A rectangle where two axes of the box lie in that plane, a hexagon
/// otherwise.
struct Silhouette {
  Eigen::Vector2d center;
  std::array<Eigen::Vector2d, 3> arms;  ///< projections of the half axes; may be 0
};

Silhouette silhouette(const Obb& box);

/// Whether a line keeps two silhouettes more than `margin_mm` apart. Conservative: never told of
/// silhouettes that are nearer by more than rounding.
///
/// This is the case that Peng et al. 2009 leave out (their situation (c)): intervals that overlap
/// on both axes, silhouettes that do not. The sides are parallel to the arms, so that six
/// directions are all there is to try, and no outline is ever built.
bool are_apart(const Silhouette& a, const Silhouette& b, double margin_mm);

}  // namespace dowel
