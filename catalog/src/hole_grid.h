#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Geometry>

#include "dowel/catalog/feature.h"

namespace dowel {

/// Right and up as seen by someone who looks against `normal` at the plane: up is +y on a plane
/// that lies (closer to level than 45 degrees), +z on one that stands. Right, up and `normal` are
/// right-handed.
struct ViewFrame {
  Eigen::Vector3d right = Eigen::Vector3d::UnitX();
  Eigen::Vector3d up = Eigen::Vector3d::UnitY();
};

ViewFrame view_frame(const Eigen::Vector3d& normal);

/// Place of a hole in its grid, both from 0.
struct GridPlace {
  std::size_t hole = 0;  ///< index into the holes
  std::size_t row = 0;
  std::size_t column = 0;
};

/// Equal holes on a regular lattice of their common opening plane, at least 3 x 2 of them.
struct HoleGrid {
  std::vector<GridPlace> places;  ///< by row, then column
};

/// All grids among `holes`: the largest first, among equals that of the smaller holes, then the one
/// nearer the top, then by its first hole's position. No hole is in two.
std::vector<HoleGrid> find_hole_grids(const std::vector<Feature>& holes);

}  // namespace dowel
