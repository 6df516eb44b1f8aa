#pragma once

// The linear equations of mates: which columns are whose, and their ranks.

#include <functional>
#include <optional>
#include <vector>

#include "dowel/assembly/mate_solver.h"

namespace dowel {

/// True where a joint of the mate is on `body`.
bool acts_on(const std::vector<Joint>& mate, std::size_t body);

/// The equations of several mates, one below the other.
struct MateEquations {
  Eigen::VectorXd value;
  Eigen::MatrixXd derivative;  ///< six columns for each body that has any
};

/// Which bodies may move, and the six columns of each.
class MateColumns {
 public:
  MateColumns() = default;
  MateColumns(const MateProblem& problem, const std::function<bool(std::size_t)>& is_free);

  Eigen::Index count() const { return count_; }
  bool has(std::size_t body) const { return first_[body].has_value(); }
  /// Expects: `has(body)`.
  Eigen::Index first(std::size_t body) const { return *first_[body]; }
  /// The point of a body about which its motion turns: the middle of its joints, near which
  /// equations are well scaled.
  Eigen::Vector3d center_W(std::size_t body, const Pose& X_WB) const {
    return X_WB * center_[body];
  }

  MateEquations equations(const MateProblem& problem, const std::vector<std::size_t>& mates,
                          const std::vector<Pose>& X_WB) const;

  /// The poses after `motion`, shortened so that no body turns by more than `most_rad`.
  std::vector<Pose> moved(const MateProblem& problem, const std::vector<Pose>& X_WB,
                          const Eigen::VectorXd& motion, double most_rad) const;

 private:
  std::vector<std::optional<Eigen::Index>> first_;
  std::vector<Eigen::Vector3d> center_;  // in the body's frame
  Eigen::Index count_ = 0;
};

/// Judges what each of the `accepted` mates takes, in their order, at the poses of `solution`, and
/// what motions are left.
void judge_ranks(const MateProblem& problem, const std::vector<std::size_t>& accepted,
                 MateSolution& solution);

}  // namespace dowel
