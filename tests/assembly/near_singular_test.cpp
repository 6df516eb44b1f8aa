// Mates that hold by next to nothing: the right place or a named refusal, never a jump.

#include "near_singular.h"

#include <cmath>
#include <string>

#include <catch2/catch.hpp>

#include "dowel/assembly/freedom.h"
#include "dowel/kernel/tolerance.h"

using dowel::MateProblem;
using dowel::MateSolution;
using dowel::MateStatus;
using dowel::Pose;
using dowel::testing::axis_at;
using dowel::testing::axis_joint;
using dowel::testing::HolesOnHoles;
using dowel::testing::HolesOutcome;
using dowel::testing::name_of;
using dowel::testing::RandomGeometry;

namespace {

/// What each power of ten of the lever gives: `holes_at(lever)` are two holes whose second tells
/// the turn by that much of a millimetre, or of a radian, alone.
template <class HolesAt>
std::vector<std::pair<double, HolesOutcome>> outcomes_of(HolesAt&& holes_at) {
  std::vector<std::pair<double, HolesOutcome>> rows;
  RandomGeometry random(5);
  for (int exponent = 2; exponent >= -12; --exponent) {
    const double lever = std::pow(10.0, exponent);
    rows.emplace_back(lever, outcome_of(HolesOnHoles(holes_at(lever), random)));
  }
  return rows;
}

/// `arm`: what makes the lever a share of one, as the solver counts.
void expect_sound(const std::vector<std::pair<double, HolesOutcome>>& rows, double arm) {
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
  expect_sound(outcomes_of(dowel::testing::holes_apart), dowel::kMateArm_mm);
}

TEST_CASE("two axes that come near to parallel hold the turn or are refused") {
  expect_sound(outcomes_of(dowel::testing::axes_askew), 1.0);
}

TEST_CASE("a third hole in line with two is redundant, and so is any mate made again") {
  RandomGeometry random(7);
  for (int round = 0; round < 20; ++round) {
    const HolesOnHoles given({axis_at({0, 0, 0}, 0), axis_at({40, 0, 0}, 0), axis_at({80, 0, 0}, 0),
                              axis_at({40, 0, 0}, 0), axis_at({0, 0, 0}, 0)},
                             random);
    const MateSolution solution = given.solve();
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
    problem.mates = {{axis_joint(axis_at({0, 0, 0}, 0), axis_at({0, 0, 0}, 0), true)},
                     {axis_joint(axis_at({40 + miss_mm, 0, 0}, 0), axis_at({40, 0, 0}, 0), false)}};
    const MateSolution solution = dowel::solve_mates(problem);
    const bool is_play = miss_mm <= dowel::kCoaxial_mm;
    CHECK(solution.is_sound() == is_play);
    CHECK(solution.mates[1].status == (is_play ? MateStatus::Holds : MateStatus::Conflicting));
    // Half of it at either end.
    const double expected_mm = is_play ? -0.5 * miss_mm : 0.0;
    CHECK(solution.X_WB[1].translation().x() == Approx(expected_mm).margin(1e-9));
  }
}
