#pragma once

// Mates that hold by next to nothing, or by nothing at all: two holes almost in one place, two axes
// almost parallel, holes in line, mates made again.

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "dowel/assembly/mate_solver.h"
#include "random_geometry.h"

namespace dowel::testing {

/// A hole's axis in a part: through `point`, tilted about x by `tilt_rad`.
inline Pose axis_at(const Eigen::Vector3d& point, double tilt_rad) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(tilt_rad, Eigen::Vector3d::UnitX())), point};
}

/// Axis on axis; `seated`: with its place along it.
inline Joint axis_joint(const Pose& X_AF, const Pose& X_BG, bool seated) {
  Joint joint;
  joint.a = 1;
  joint.b = 0;
  joint.X_AF = X_AF;
  joint.X_BG = X_BG;
  joint.holds_tilt = true;
  joint.holds_slide = {true, true, seated};
  return joint;
}

/// Part 1 has the same holes as the held part 0, and stands a little off them. The first hole is
/// seated.
struct HolesOnHoles {
  std::vector<Pose> holes;
  Pose X_WB;  ///< of the held part, and where the other one belongs
  Pose X_WA;  ///< where it is

  HolesOnHoles(std::vector<Pose> axes, RandomGeometry& random)
      : holes(std::move(axes)),
        X_WB(random.pose(1000.0)),
        X_WA(X_WB * Pose(Eigen::Quaterniond(Eigen::AngleAxisd(0.01, Eigen::Vector3d::UnitZ())),
                         {0.1, -0.2, 0.1})) {}

  MateSolution solve() const {
    MateProblem problem;
    problem.bodies = {{X_WB, true}, {X_WA, false}};
    for (std::size_t i = 0; i < holes.size(); ++i) {
      problem.mates.push_back({axis_joint(holes[i], holes[i], i == 0)});
    }
    return solve_mates(problem);
  }
};

/// What came of one.
struct HolesOutcome {
  MateStatus last = MateStatus::Holds;  ///< of the last hole
  bool is_held = false;                 ///< the mates take the turn, and not by next to nothing
  double turn_off_rad = 0.0;            ///< of the part, from where it belongs
  double slide_off_mm = 0.0;
};

/// Throws std::runtime_error at a pose that is none.
inline HolesOutcome outcome_of(const HolesOnHoles& given) {
  const MateSolution solution = given.solve();
  const Pose& X_WA = solution.X_WB[1];
  if (!X_WA.rotation().coeffs().allFinite() || !X_WA.translation().allFinite()) {
    throw std::runtime_error("the solver gave a pose that is not finite");
  }
  const bool is_held =
      solution.freedoms.cols() == 0 && solution.mates.back().status != MateStatus::NearlyRedundant;
  return {solution.mates.back().status, is_held,
          X_WA.rotation().angularDistance(given.X_WB.rotation()),
          (X_WA.translation() - given.X_WB.translation()).norm()};
}

inline std::vector<Pose> holes_apart(double apart_mm) {
  return {axis_at({0, 0, 0}, 0), axis_at({apart_mm, 0, 0}, 0)};
}

/// Through one point.
inline std::vector<Pose> axes_askew(double tilt_rad) {
  return {axis_at({0, 0, 0}, 0), axis_at({0, 0, 0}, std::min(tilt_rad, 0.5))};
}

/// Two that hold the turn, and a third one.
inline std::vector<Pose> holes_in_line() {
  return {axis_at({0, 0, 0}, 0), axis_at({40, 0, 0}, 0), axis_at({80, 0, 0}, 0)};
}

/// Two that hold the turn, and both of them made again.
inline std::vector<Pose> holes_again() {
  return {axis_at({0, 0, 0}, 0), axis_at({40, 0, 0}, 0), axis_at({40, 0, 0}, 0),
          axis_at({0, 0, 0}, 0)};
}

inline std::string_view name_of(MateStatus status) {
  switch (status) {
    case MateStatus::Holds:
      return "holds";
    case MateStatus::Redundant:
      return "redundant";
    case MateStatus::Conflicting:
      return "conflicting";
    case MateStatus::NearlyRedundant:
      return "nearly redundant";
  }
  return "";
}

}  // namespace dowel::testing
