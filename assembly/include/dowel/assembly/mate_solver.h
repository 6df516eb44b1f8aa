#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "dowel/assembly/joint.h"
#include "dowel/kernel/pose.h"

namespace dowel {

/// Of two equations of unit size, what one adds to the other and is smaller than this is rounding:
/// a thousand times that of a part 10 m from its joints.
inline constexpr double kMateDependent = 1.0e-10;

/// What adds less than this is too little to place a part by: two holes a tenth of a micrometre
/// apart, two axes 1e-6 rad from parallel.
inline constexpr double kMateIndependent = 1.0e-6;

/// Bodies and the mates between them. A mate is one or more joints that hold together.
struct MateProblem {
  struct Body {
    Pose X_WB;          ///< where it is now
    bool held = false;  ///< never moves
  };
  std::vector<Body> bodies;
  std::vector<std::vector<Joint>> mates;  ///< in the order in which they were made
};

/// What a mate does beside the ones made before it, to first order about the solution.
enum class MateStatus {
  Holds,           ///< takes freedoms
  Redundant,       ///< holds, but takes none that earlier mates have not taken
  Conflicting,     ///< cannot hold together with earlier ones; it is left out of the solution
  NearlyRedundant  ///< holds, but what it takes hangs on next to nothing: parts would jump
};

struct MateVerdict {
  MateStatus status = MateStatus::Holds;
  int freedoms_taken = 0;
  double off_mm = 0.0;   ///< largest slide by which it is off in the solution
  double off_rad = 0.0;  ///< largest turn
};

struct MateSolution {
  std::vector<Pose> X_WB;          ///< one for each body; those that need not move are untouched
  std::vector<MateVerdict> mates;  ///< one for each mate
  /// Every motion that is left: orthonormal columns, six rows for each body (as in JointEquations,
  /// turning about `centers_W`); zero for held ones.
  Eigen::MatrixXd freedoms;
  std::vector<Eigen::Vector3d> centers_W;

  /// True where every mate holds and none only just.
  bool is_sound() const;
};

/// Places the bodies so that all mates hold.
///
/// Bodies that hang on the rest by one mate are placed in closed form, exact to rounding; a loop,
/// or several mates on one body, by Levenberg-Marquardt steps from where the bodies are, so that of
/// several solutions it is the one nearby. A body whose mates hold already does not move. Where the
/// mates contradict each other, the later ones are left out, told as conflicting, and the rest is
/// solved. Mates that miss each other by no more than kCoaxial_mm and kCoaxial_rad do not
/// contradict: the bodies go where the squares of what is off are least.
///
/// Ranks are those of the linear equations at the solution, turns counted at kMateArm_mm: what
/// counts less than kMateDependent (and than the mates' own slack could feign) is none, what counts
/// less than kMateIndependent is NearlyRedundant.
///
/// Deterministic. Cost: cubic in the bodies that may move. Expects: joints between two bodies of
/// the problem; finite poses.
MateSolution solve_mates(const MateProblem& problem);

}  // namespace dowel
