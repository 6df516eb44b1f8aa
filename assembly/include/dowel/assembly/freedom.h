#pragma once

#include <vector>

#include <Eigen/Core>

#include "dowel/assembly/mate_solver.h"

namespace dowel {

/// One way in which a part can still move, to first order about where it is.
struct Freedom {
  enum class Kind { Slide, Turn };
  Kind kind = Kind::Slide;
  Eigen::Vector3d axis_W = Eigen::Vector3d::UnitZ();  ///< unit; of two senses towards +x, +y or +z
  Eigen::Vector3d point_W = Eigen::Vector3d::Zero();  ///< turns: on the axis, near the part's mates
  double slide_mm_per_rad = 0.0;  ///< turns: how far it slides along the axis as it turns; a screw
};

/// Names the motions of a body, columns as in JointEquations about `center_W`: first the slides,
/// then the turns, together as many as the motions have dimensions. Axes are those of the world
/// where that can be.
std::vector<Freedom> freedoms_of(const Eigen::MatrixXd& motions, const Eigen::Vector3d& center_W);

/// Those of a body in a solution.
std::vector<Freedom> freedoms_of(const MateSolution& solution, std::size_t body);

}  // namespace dowel
