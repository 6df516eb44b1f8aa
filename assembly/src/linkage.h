#pragma once

// Motions of parts that hang together in loops: all of them follow the one that is driven. Internal
// to Session.

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "dowel/assembly/mate_solver.h"

namespace dowel {

/// What drives a linkage: a body turns, or its origin goes towards a place.
struct LinkageDrive {
  std::size_t body = 0;
  double turn_rad = 0.0;                              ///< not 0: a turn
  Eigen::Vector3d axis_W = Eigen::Vector3d::UnitZ();  ///< of the turn, unit
  Eigen::Vector3d by_mm_W = Eigen::Vector3d::Zero();  ///< else
};

/// Where all bodies of a problem are.
using Configuration = std::vector<Pose>;

/// The way of a linkage. Between two steps no body turns by more than 0.04 rad or goes farther than
/// 4 mm, so that a straight path between them keeps within some micrometres of the true one.
struct LinkagePath {
  std::vector<Configuration> steps;  ///< the first: where the bodies are
  double turned_rad = 0.0;           ///< how far the driven body has turned in the last
};

/// Follows the mates from where they hold, step by step: each is solved from what the one before
/// leads to expect, so that the bodies stay on their branch. A turn goes as far as the mates let
/// it; a slide to the place that is nearest to the goal on the curve that they leave. In each step
/// the mates hold as well as at the start, to 1e-9 mm at best.
LinkagePath linkage_path(const MateProblem& problem, const LinkageDrive& drive);

/// A configuration between two steps, `share` of the way, in which the mates hold.
Configuration between_steps(const MateProblem& problem, const Configuration& from,
                            const Configuration& to, double share);

}  // namespace dowel
