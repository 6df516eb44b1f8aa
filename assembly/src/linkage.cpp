#include "linkage.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include <Eigen/Geometry>

#include "allowed_motion.h"
#include "dowel/assembly/freedom.h"
#include "dowel/kernel/check.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// Steps of the driven body, and what the others may do meanwhile.
constexpr double kTurn_rad = 0.01;
constexpr double kSlide_mm = 1.0;
constexpr double kMostTurn_rad = 0.04;
constexpr double kMostSlide_mm = 4.0;

/// A step that has to be shorter than this share of a whole one leads nowhere.
constexpr double kLeastShare = 1.0e-6;

/// Mates hold to this, in mm at kMateArm_mm, where they did so at the start.
constexpr double kHolds_mm = 1.0e-9;

/// A goal is reached, or as near as can be, where this little is left.
constexpr double kArrived_mm = 1.0e-9;

double turn_between(const Pose& a, const Pose& b) {
  return a.rotation().angularDistance(b.rotation());
}

bool is_short_step(const Configuration& from, const Configuration& to) {
  for (std::size_t i = 0; i < from.size(); ++i) {
    if ((to[i].translation() - from[i].translation()).norm() > kMostSlide_mm ||
        turn_between(from[i], to[i]) > kMostTurn_rad) {
      return false;
    }
  }
  return true;
}

/// `share` of the way from `from` to `to`; beyond 1 it goes on as before.
Pose along(const Pose& from, const Pose& to, double share) {
  const Eigen::AngleAxisd turn(to.rotation() * from.rotation().conjugate());
  // Of the two senses the shorter.
  const Eigen::AngleAxisd part(share * turn.angle(), turn.axis());
  return {(Eigen::Quaterniond(part) * from.rotation()).normalized(),
          from.translation() + share * (to.translation() - from.translation())};
}

Configuration along(const Configuration& from, const Configuration& to, double share) {
  Configuration result;
  for (std::size_t i = 0; i < from.size(); ++i) result.push_back(along(from[i], to[i], share));
  return result;
}

double worst_off_mm(const MateSolution& solution) {
  double worst = 0.0;
  for (const MateVerdict& mate : solution.mates) {
    worst = std::max({worst, mate.off_mm, kMateArm_mm * mate.off_rad});
  }
  return worst;
}

class Walk {
 public:
  Walk(const MateProblem& problem, const LinkageDrive& drive) : problem_(problem), drive_(drive) {
    for (const MateProblem::Body& body : problem.bodies) start_.push_back(body.X_WB);
    const MateSolution solution = solve_mates(problem_);
    most_off_mm_ = std::max(kHolds_mm, 2.0 * worst_off_mm(solution));
    path_.steps.push_back(start_);
    // The drive is a mate with a body that stays.
    world_ = problem_.bodies.size();
    problem_.bodies.push_back({Pose(), true});
  }

  LinkagePath turn() {
    const double whole_rad = std::copysign(kTurn_rad, drive_.turn_rad);
    double share = 1.0;
    double last_rad = 0.0;
    while (std::abs(path_.turned_rad) < std::abs(drive_.turn_rad) && share > kLeastShare) {
      const double left_rad = drive_.turn_rad - path_.turned_rad;
      double step_rad = share * whole_rad;
      if (std::abs(step_rad) >= std::abs(left_rad)) step_rad = left_rad;
      const bool is_last = step_rad == left_rad;
      const double to_rad = is_last ? drive_.turn_rad : path_.turned_rad + step_rad;
      if (!go(turned_to(to_rad), last_rad == 0.0 ? 0.0 : step_rad / last_rad)) {
        share *= 0.5;
        continue;
      }
      path_.turned_rad = to_rad;
      last_rad = step_rad;
      share = std::min(1.0, 2.0 * share);
    }
    return std::move(path_);
  }

  LinkagePath slide() {
    const Vector3d goal_W = origin_W() + drive_.by_mm_W;
    double share = 1.0;
    double last_mm = 0.0;
    while (share > kLeastShare) {
      const Vector3d rest_mm = goal_W - origin_W();
      const Vector3d allowed_mm = allowed_slide(freedoms(), rest_mm);
      if (allowed_mm.norm() <= kArrived_mm) break;
      const double step_mm = std::min(share * kSlide_mm, allowed_mm.norm());
      const Vector3d by_mm = step_mm * allowed_mm.normalized();
      const double of_last = last_mm == 0.0 ? 0.0 : step_mm / last_mm;
      // Without a turn, where the mates let it.
      const bool went = go(slid_by(by_mm, true), of_last) || go(slid_by(by_mm, false), of_last);
      if (!went || (goal_W - origin_W()).norm() >= rest_mm.norm()) {
        if (went) path_.steps.pop_back();
        share *= 0.5;
        continue;
      }
      last_mm = step_mm;
      share = std::min(1.0, 2.0 * share);
    }
    return std::move(path_);
  }

 private:
  const Configuration& now() const { return path_.steps.back(); }
  Vector3d origin_W() const { return now()[drive_.body].translation(); }

  std::vector<Freedom> freedoms() {
    put(now());
    return freedoms_of(solve_mates(problem_), drive_.body);
  }

  void put(const Configuration& at) {
    for (std::size_t i = 0; i < at.size(); ++i) problem_.bodies[i].X_WB = at[i];
  }

  Joint driver() const {
    Joint joint;
    joint.a = drive_.body;
    joint.b = world_;
    return joint;
  }

  Joint turned_to(double angle_rad) const {
    Joint joint = driver();
    joint.holds_tilt = true;
    joint.holds_spin = true;
    joint.X_BG = Pose(Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, drive_.axis_W)) *
                          start_[drive_.body].rotation(),
                      Vector3d::Zero());
    return joint;
  }

  /// Its origin by so much along `by_mm`; aside as the mates ask.
  Joint slid_by(const Vector3d& by_mm, bool holds_turn) const {
    Joint joint = driver();
    joint.holds_slide = {false, false, true};
    joint.X_BG = frame_on_axis(origin_W() + by_mm, by_mm.normalized(), by_mm.unitOrthogonal());
    joint.holds_tilt = holds_turn;
    joint.holds_spin = holds_turn;
    joint.X_AF =
        Pose(now()[drive_.body].rotation().conjugate() * joint.X_BG.rotation(), Vector3d::Zero());
    return joint;
  }

  /// Solves the next step, from where the last one leads on to; false where there is none near by.
  bool go(const Joint& driver, double of_last) {
    Configuration guess = now();
    if (of_last != 0.0) guess = along(path_.steps[path_.steps.size() - 2], now(), 1.0 + of_last);
    put(guess);
    problem_.mates.push_back({driver});
    const MateSolution solution = solve_mates(problem_);
    problem_.mates.pop_back();
    const bool holds = std::ranges::none_of(solution.mates, [](const MateVerdict& mate) {
      return mate.status == MateStatus::Conflicting;
    });
    if (!holds || worst_off_mm(solution) > most_off_mm_) return false;
    const Configuration next(solution.X_WB.begin(),
                             solution.X_WB.begin() + static_cast<std::ptrdiff_t>(world_));
    if (!is_short_step(now(), next)) return false;
    path_.steps.push_back(next);
    return true;
  }

  MateProblem problem_;
  LinkageDrive drive_;
  Configuration start_;
  std::size_t world_ = 0;
  double most_off_mm_ = 0.0;
  LinkagePath path_;
};

}  // namespace

LinkagePath linkage_path(const MateProblem& problem, const LinkageDrive& drive) {
  DOWEL_EXPECTS(drive.body < problem.bodies.size() && !problem.bodies[drive.body].held);
  Walk walk(problem, drive);
  return drive.turn_rad != 0.0 ? walk.turn() : walk.slide();
}

Configuration between_steps(const MateProblem& problem, const Configuration& from,
                            const Configuration& to, double share) {
  MateProblem there = problem;
  const Configuration guess = along(from, to, share);
  for (std::size_t i = 0; i < guess.size(); ++i) there.bodies[i].X_WB = guess[i];
  return solve_mates(there).X_WB;
}

}  // namespace dowel
