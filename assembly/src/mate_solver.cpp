#include "dowel/assembly/mate_solver.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include <Eigen/QR>

#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"
#include "mate_rank.h"

namespace dowel {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

/// Steps of a solution; ten are usual.
constexpr int kMaxSteps = 200;

/// A step turns no body further than this, so that it stays near the linear equations.
constexpr double kLargestTurn_rad = 0.5;

/// Damping where the equations are off by a radian, and bounds of it.
constexpr double kDamping = 1.0e-3;
constexpr double kLeastDamping = 1.0e-24;
constexpr double kMostDamping = 1.0e6;

/// A mate that is off by no more than this holds: moving its body would only stir the rounding.
constexpr double kSettled_mm = 1.0e-11;

/// Starts that a body with several mates is tried from where the first finds nothing: turned about
/// the axis of one of them.
constexpr int kSpins = 8;

using Poses = std::vector<Pose>;
using MateSet = std::vector<std::size_t>;  // indices of mates, ascending

double off_mm(const JointOff& off) {
  return std::max(kMateArm_mm * off.turn_rad.norm(), off.slide_mm.norm());
}

bool is_within_slack(const JointOff& off) {
  return off.turn_rad.norm() <= kCoaxial_rad && off.slide_mm.norm() <= kCoaxial_mm;
}

/// One placing of the bodies with some of the mates.
class Placing {
 public:
  Placing(const MateProblem& problem, const MateSet& mates, Poses start)
      : problem_(problem), poses_(std::move(start)), active_(mates) {}

  /// Closed form for what hangs on one mate, steps for the rest.
  Poses run() {
    std::vector<Hanging> order;
    while (const auto hanging = find_hanging()) {
      order.push_back(*hanging);
      is_placed_later_[hanging->body] = true;
      std::erase(active_, hanging->mate);
    }
    solve_core();
    for (auto hanging = order.rbegin(); hanging != order.rend(); ++hanging) place(*hanging);
    return poses_;
  }

 private:
  struct Hanging {
    std::size_t body;
    std::size_t mate;
  };

  bool is_free(std::size_t body) const {
    return !problem_.bodies[body].held && !is_placed_later_[body];
  }

  /// The last free body on which just one active mate acts, if every joint of that mate is its own.
  std::optional<Hanging> find_hanging() const {
    std::vector<int> mates_on(problem_.bodies.size(), 0);
    std::vector<std::size_t> mate_of(problem_.bodies.size(), 0);
    for (const std::size_t mate : active_) {
      std::vector<std::size_t> touched;
      for (const Joint& joint : problem_.mates[mate]) {
        touched.push_back(joint.a);
        touched.push_back(joint.b);
      }
      std::ranges::sort(touched);
      touched.erase(std::unique(touched.begin(), touched.end()), touched.end());
      for (const std::size_t body : touched) {
        ++mates_on[body];
        mate_of[body] = mate;
      }
    }
    for (std::size_t body = problem_.bodies.size(); body-- > 0;) {
      if (!is_free(body) || mates_on[body] != 1) continue;
      const std::vector<Joint>& joints = problem_.mates[mate_of[body]];
      const bool is_first =
          std::ranges::all_of(joints, [=](const Joint& j) { return j.a == body; });
      if (is_first || (joints.size() == 1 && joints[0].b == body))
        return Hanging{body, mate_of[body]};
    }
    return std::nullopt;
  }

  void place(const Hanging& hanging) {
    const std::vector<Joint>& joints = problem_.mates[hanging.mate];
    if (worst_off_mm({hanging.mate}) <= kSettled_mm) return;
    Pose& X_WB = poses_[hanging.body];
    const Joint& first = joints.front();
    if (first.a != hanging.body) {
      X_WB = place_other_by_joint(first, poses_[first.a], X_WB);
      return;
    }
    X_WB = place_by_joint(first, X_WB, poses_[first.b]);
    // A seat: the first joint leaves its axis free, and along it the part slides onto the face.
    const Vector3d axis_W =
        poses_[first.b].rotation() * (first.X_BG.rotation() * Vector3d::UnitZ());
    for (std::size_t i = 1; i < joints.size(); ++i) {
      const Joint& seat = joints[i];
      const Vector3d normal_W =
          poses_[seat.b].rotation() * (seat.X_BG.rotation() * Vector3d::UnitZ());
      const double gap_mm = joint_off(seat, X_WB, poses_[seat.b]).slide_mm.z();
      X_WB = Pose(X_WB.rotation(), X_WB.translation() - gap_mm / normal_W.dot(axis_W) * axis_W);
    }
  }

  double worst_off_mm(const MateSet& mates) const {
    double worst = 0.0;
    for (const std::size_t mate : mates) {
      for (const Joint& joint : problem_.mates[mate]) {
        worst = std::max(worst, off_mm(joint_off(joint, poses_[joint.a], poses_[joint.b])));
      }
    }
    return worst;
  }

  bool is_solved() const {
    return std::ranges::all_of(active_, [&](std::size_t mate) {
      return std::ranges::all_of(problem_.mates[mate], [&](const Joint& joint) {
        return is_within_slack(joint_off(joint, poses_[joint.a], poses_[joint.b]));
      });
    });
  }

  void solve_core() {
    if (active_.empty() || worst_off_mm(active_) <= kSettled_mm) return;
    columns_ = MateColumns(problem_, [&](std::size_t body) {
      return is_free(body) && std::ranges::any_of(active_, [&](std::size_t mate) {
               return acts_on(problem_.mates[mate], body);
             });
    });
    if (columns_.count() == 0) return;
    const Poses start = poses_;
    descend();
    if (is_solved()) return;
    const Poses first_try = poses_;
    for (int spin = 0; spin < kSpins; ++spin) {
      poses_ = start;
      place_one_by_one(2.0 * std::numbers::pi * spin / kSpins);
      descend();
      if (is_solved()) return;
    }
    poses_ = first_try;
  }

  /// Another start: each body of the core by its first mate with one that is placed, turned by
  /// `spin_rad` about the z axis of that mate.
  void place_one_by_one(double spin_rad) {
    std::vector<bool> is_placed(problem_.bodies.size());
    for (std::size_t body = 0; body < is_placed.size(); ++body) {
      is_placed[body] = !columns_.has(body);
    }
    for (const std::size_t mate : active_) {
      const Joint& joint = problem_.mates[mate].front();
      if (is_placed[joint.a] == is_placed[joint.b]) continue;
      const std::size_t body = is_placed[joint.a] ? joint.b : joint.a;
      Pose& X_WB = poses_[body];
      X_WB = body == joint.a ? place_by_joint(joint, X_WB, poses_[joint.b])
                             : place_other_by_joint(joint, poses_[joint.a], X_WB);
      const Pose X_WG = poses_[joint.b] * joint.X_BG;
      X_WB = Pose::about_axis(X_WG.translation(),
                              (X_WG.rotation() * Vector3d::UnitZ()).normalized(), spin_rad) *
             X_WB;
      is_placed[body] = true;
    }
  }

  /// Levenberg-Marquardt steps until the equations, or the sum of their squares, cannot be
  /// bettered.
  void descend() {
    MateEquations equations = columns_.equations(problem_, active_, poses_);
    double raise = 1.0;
    for (int step = 0; step < kMaxSteps; ++step) {
      const double norm_mm = equations.value.norm();
      if (norm_mm <= kSettled_mm) return;
      // Damping that falls with the square of what is off keeps convergence quadratic even where
      // solutions are not isolated (Yamashita and Fukushima 2001).
      const double damping = std::clamp(raise * kDamping * std::pow(norm_mm / kMateArm_mm, 2),
                                        kLeastDamping, kMostDamping);
      const VectorXd motion = damped_step(equations, damping);
      if (!motion.allFinite()) return;
      const Poses moved = columns_.moved(problem_, poses_, motion, kLargestTurn_rad);
      MateEquations next = columns_.equations(problem_, active_, moved);
      const bool is_better = next.value.norm() < norm_mm;
      const bool is_last = motion.norm() <= kSettled_mm;
      if (is_better) {
        poses_ = moved;
        equations = std::move(next);
        raise = std::max(1.0, 0.1 * raise);
      } else {
        if (is_last || damping >= kMostDamping) return;
        raise *= 10.0;
      }
      if (is_last) return;
    }
  }

  /// Least squares of the equations and of the motion, by its damping, without squaring either.
  static VectorXd damped_step(const MateEquations& equations, double damping) {
    const Index rows = equations.value.size();
    const Index columns = equations.derivative.cols();
    MatrixXd system = MatrixXd::Zero(rows + columns, columns);
    system.topRows(rows) = equations.derivative;
    system.bottomRows(columns).diagonal().setConstant(std::sqrt(damping));
    VectorXd value = VectorXd::Zero(rows + columns);
    value.head(rows) = -equations.value;
    return system.householderQr().solve(value);
  }

  const MateProblem& problem_;
  Poses poses_;
  MateSet active_;
  std::vector<bool> is_placed_later_ = std::vector<bool>(problem_.bodies.size(), false);
  MateColumns columns_;
};

bool hold(const MateProblem& problem, const MateSet& mates, const Poses& X_WB) {
  return std::ranges::all_of(mates, [&](std::size_t mate) {
    return std::ranges::all_of(problem.mates[mate], [&](const Joint& joint) {
      return is_within_slack(joint_off(joint, X_WB[joint.a], X_WB[joint.b]));
    });
  });
}

void expect_sound(const MateProblem& problem) {
  for (const std::vector<Joint>& joints : problem.mates) {
    DOWEL_EXPECTS(!joints.empty());
    for (const Joint& joint : joints) {
      DOWEL_EXPECTS(joint.a < problem.bodies.size() && joint.b < problem.bodies.size());
      DOWEL_EXPECTS(joint.a != joint.b);
    }
  }
}

/// Adds the mates one by one and leaves out those that cannot hold.
MateSet solve_step_by_step(const MateProblem& problem, Poses& X_WB) {
  MateSet accepted;
  for (std::size_t mate = 0; mate < problem.mates.size(); ++mate) {
    MateSet more = accepted;
    more.push_back(mate);
    Poses placed = Placing(problem, more, X_WB).run();
    if (!hold(problem, more, placed)) continue;
    accepted = std::move(more);
    X_WB = std::move(placed);
  }
  return accepted;
}

}  // namespace

bool MateSolution::is_sound() const {
  return std::ranges::all_of(mates, [](const MateVerdict& mate) {
    return mate.status == MateStatus::Holds || mate.status == MateStatus::Redundant;
  });
}

MateSolution solve_mates(const MateProblem& problem) {
  expect_sound(problem);
  MateSolution solution;
  for (const MateProblem::Body& body : problem.bodies) solution.X_WB.push_back(body.X_WB);
  MateSet all(problem.mates.size());
  for (std::size_t mate = 0; mate < all.size(); ++mate) all[mate] = mate;
  Poses placed = Placing(problem, all, solution.X_WB).run();
  MateSet accepted = all;
  if (hold(problem, all, placed)) {
    solution.X_WB = std::move(placed);
  } else {
    accepted = solve_step_by_step(problem, solution.X_WB);
  }
  solution.mates.resize(problem.mates.size());
  for (const std::size_t mate : all) {
    MateVerdict& verdict = solution.mates[mate];
    for (const Joint& joint : problem.mates[mate]) {
      const JointOff off = joint_off(joint, solution.X_WB[joint.a], solution.X_WB[joint.b]);
      verdict.off_mm = std::max(verdict.off_mm, off.slide_mm.norm());
      verdict.off_rad = std::max(verdict.off_rad, off.turn_rad.norm());
    }
    if (!std::ranges::binary_search(accepted, mate)) verdict.status = MateStatus::Conflicting;
  }
  judge_ranks(problem, accepted, solution);
  return solution;
}

}  // namespace dowel
