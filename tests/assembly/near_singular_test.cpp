// Mates that hold by next to nothing: the right place or a named refusal, never a jump.

#include <cmath>
#include <cstdio>
#include <string>

#include <catch2/catch.hpp>

#include "dowel/assembly/freedom.h"
#include "dowel/assembly/mate_solver.h"
#include "dowel/kernel/tolerance.h"
#include "random_geometry.h"

using dowel::Joint;
using dowel::MateProblem;
using dowel::MateSolution;
using dowel::MateStatus;
using dowel::Pose;
using dowel::testing::RandomGeometry;
using Eigen::Vector3d;

namespace {

/// A hole's axis in a part: through `point`, tilted about x by `tilt_rad`.
Pose axis_at(const Vector3d& point, double tilt_rad) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(tilt_rad, Vector3d::UnitX())), point};
}

/// Axis on axis; `seated`: with its place along it.
Joint on_axis(const Pose& X_AF, const Pose& X_BG, bool seated) {
  Joint joint;
  joint.a = 1;
  joint.b = 0;
  joint.X_AF = X_AF;
  joint.X_BG = X_BG;
  joint.holds_tilt = true;
  joint.holds_slide = {true, true, seated};
  return joint;
}

/// Part 1 has the same holes as the held part 0, and stands a little off them.
struct Case {
  std::vector<Pose> holes;
  Pose X_WB;  ///< of the held part, and where the other one belongs
  Pose X_WA;  ///< where it is
};

Case case_of(std::vector<Pose> holes, RandomGeometry& random) {
  Case result;
  result.holes = std::move(holes);
  result.X_WB = random.pose(1000.0);
  const Pose off(Eigen::Quaterniond(Eigen::AngleAxisd(0.01, Vector3d::UnitZ())), {0.1, -0.2, 0.1});
  result.X_WA = result.X_WB * off;
  return result;
}

MateSolution solve(const Case& given) {
  MateProblem problem;
  problem.bodies = {{given.X_WB, true}, {given.X_WA, false}};
  for (std::size_t i = 0; i < given.holes.size(); ++i) {
    problem.mates.push_back({on_axis(given.holes[i], given.holes[i], i == 0)});
  }
  return dowel::solve_mates(problem);
}

struct Outcome {
  MateStatus last = MateStatus::Holds;
  double turn_off_rad = 0.0;  ///< from where it belongs
  double slide_off_mm = 0.0;
};

Outcome outcome_of(const Case& given) {
  const MateSolution solution = solve(given);
  const Pose& X_WA = solution.X_WB[1];
  REQUIRE(X_WA.rotation().coeffs().allFinite());
  REQUIRE(X_WA.translation().allFinite());
  return {solution.mates.back().status, X_WA.rotation().angularDistance(given.X_WB.rotation()),
          (X_WA.translation() - given.X_WB.translation()).norm()};
}

std::string_view name_of(MateStatus status) {
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

/// What each power of ten of the lever gives: `holes_at(lever)` are two holes whose second tells
/// the turn by that much of a millimetre, or of a radian, alone.
template <class HolesAt>
std::vector<std::pair<double, Outcome>> table_of(HolesAt&& holes_at) {
  std::vector<std::pair<double, Outcome>> rows;
  RandomGeometry random(5);
  for (int exponent = 2; exponent >= -12; --exponent) {
    const double lever = std::pow(10.0, exponent);
    rows.emplace_back(lever, outcome_of(case_of(holes_at(lever), random)));
  }
  return rows;
}

std::vector<std::pair<double, Outcome>> holes_apart() {
  return table_of([](double apart_mm) {
    return std::vector<Pose>{axis_at({0, 0, 0}, 0), axis_at({apart_mm, 0, 0}, 0)};
  });
}

std::vector<std::pair<double, Outcome>> axes_askew() {
  return table_of([](double tilt_rad) {
    return std::vector<Pose>{axis_at({0, 0, 0}, 0), axis_at({0, 0, 0}, std::min(tilt_rad, 0.5))};
  });
}

/// `arm`: what makes the lever a share of one, as the solver counts.
void expect_sound(const std::vector<std::pair<double, Outcome>>& rows, double arm) {
  for (const auto& [lever, outcome] : rows) {
    CAPTURE(lever, name_of(outcome.last), outcome.turn_off_rad, outcome.slide_off_mm);
    // In its place, but for the turn, whatever the verdict is.
    CHECK(outcome.slide_off_mm < 1e-9);
    // A verdict or a refusal: nothing is placed by less than a millionth.
    const double share = std::min(lever, arm) / arm;
    if (share >= 2e-6) {
      CHECK(outcome.last == MateStatus::Holds);
      CHECK(outcome.turn_off_rad < 1e-11 / share);
    } else if (share <= 0.5e-6) {
      CHECK((outcome.last == MateStatus::NearlyRedundant || outcome.last == MateStatus::Redundant));
    }
    // No jump: it was 0.01 rad off and is not more now.
    CHECK(outcome.turn_off_rad < 0.0101);
  }
}

}  // namespace

TEST_CASE("two holes that come near to each other hold the turn or are refused") {
  expect_sound(holes_apart(), dowel::kMateArm_mm);
}

TEST_CASE("two axes that come near to parallel hold the turn or are refused") {
  expect_sound(axes_askew(), 1.0);
}

TEST_CASE("a third hole in line with two is redundant, and so is any mate made again") {
  RandomGeometry random(7);
  for (int round = 0; round < 20; ++round) {
    const Case given =
        case_of({axis_at({0, 0, 0}, 0), axis_at({40, 0, 0}, 0), axis_at({80, 0, 0}, 0),
                 axis_at({40, 0, 0}, 0), axis_at({0, 0, 0}, 0)},
                random);
    const MateSolution solution = solve(given);
    CHECK(solution.mates[0].freedoms_taken == 5);
    CHECK(solution.mates[1].freedoms_taken == 1);
    for (const std::size_t i : {2U, 3U, 4U})
      CHECK(solution.mates[i].status == MateStatus::Redundant);
    CHECK((solution.X_WB[1].translation() - given.X_WB.translation()).norm() < 1e-9);
    CHECK(solution.X_WB[1].rotation().angularDistance(given.X_WB.rotation()) < 1e-11);
    CHECK(dowel::freedoms_of(solution, 1).empty());
  }
}

TEST_CASE("holes whose pitches differ share it where it is play, and conflict where it is not") {
  for (const double miss_mm : {1e-9, 1e-6, 1e-3, 0.015, 0.05, 1.0}) {
    CAPTURE(miss_mm);
    MateProblem problem;
    problem.bodies = {{Pose(), true}, {Pose::from_translation({0.1, 0.1, 0.1}), false}};
    problem.mates = {{on_axis(axis_at({0, 0, 0}, 0), axis_at({0, 0, 0}, 0), true)},
                     {on_axis(axis_at({40 + miss_mm, 0, 0}, 0), axis_at({40, 0, 0}, 0), false)}};
    const MateSolution solution = dowel::solve_mates(problem);
    const bool is_play = miss_mm <= dowel::kCoaxial_mm;
    CHECK(solution.is_sound() == is_play);
    CHECK(solution.mates[1].status == (is_play ? MateStatus::Holds : MateStatus::Conflicting));
    // Half of it at either end.
    const double expected_mm = is_play ? -0.5 * miss_mm : 0.0;
    CHECK(solution.X_WB[1].translation().x() == Approx(expected_mm).margin(1e-9));
  }
}

TEST_CASE("condition against error of mates that hold by little", "[.table]") {
  const auto print = [](const char* title, const auto& rows) {
    std::printf("\n%s\n%10s  %-17s  %12s  %12s\n", title, "lever", "verdict", "turn off/rad",
                "slide off/mm");
    for (const auto& [lever, outcome] : rows) {
      std::printf("%10.0e  %-17s  %12.1e  %12.1e\n", lever,
                  std::string(name_of(outcome.last)).c_str(), outcome.turn_off_rad,
                  outcome.slide_off_mm);
    }
  };
  print("second hole, mm from the first", holes_apart());
  print("second axis through the first, rad askew (at most 0.5)", axes_askew());
}
