#include "dowel/assembly/joint.h"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "random_geometry.h"

using dowel::Joint;
using dowel::joint_equations;
using dowel::joint_off;
using dowel::kMateArm_mm;
using dowel::place_by_joint;
using dowel::Pose;
namespace testing = dowel::testing;

namespace {

/// Every way of holding that a mate uses, and more.
Joint random_joint(testing::RandomGeometry& random) {
  Joint joint{.a = 0, .b = 1, .X_AF = random.pose(300), .X_BG = random.pose(300)};
  const std::uint32_t turns = random.index(4);
  joint.holds_tilt = turns == 1 || turns == 2;
  joint.holds_spin = turns == 2;
  if (turns == 3) joint.angle_rad = random.uniform(0.05, 3.0);
  for (bool& held : joint.holds_slide) held = random.coin();
  return joint;
}

/// `pose` after turning about `center` by a rotation vector and sliding.
Pose after(const Pose& pose, const Eigen::Vector3d& center, const Eigen::Matrix<double, 6, 1>& by) {
  const Eigen::Vector3d turn = by.head<3>() / kMateArm_mm;
  if (turn.norm() == 0.0) return Pose::from_translation(by.tail<3>()) * pose;
  return Pose::from_translation(by.tail<3>()) *
         (Pose::about_axis(center, turn.normalized(), turn.norm()) * pose);
}

double angle_between(const Pose& a, const Pose& b) {
  return a.rotation().angularDistance(b.rotation());
}

}  // namespace

TEST_CASE("derivatives of a joint's equations are those of differences", "[property]") {
  const unsigned seed = GENERATE(range(0U, 300U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const Joint joint = random_joint(random);
  const Pose X_WA = random.pose(300);
  const Pose X_WB = random.pose(300);
  const Eigen::Vector3d c_A = random.point(300);
  const Eigen::Vector3d c_B = random.point(300);
  const auto at = joint_equations(joint, X_WA, X_WB, c_A, c_B);
  REQUIRE(at.value.size() == joint.equations());
  constexpr double kStep_mm = 1e-4;
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 6, 1> by = Eigen::Matrix<double, 6, 1>::Zero();
    by[i] = kStep_mm;
    const auto difference = [&](const auto& value_after) {
      return Eigen::VectorXd((value_after(by) - value_after(-by)) / (2.0 * kStep_mm));
    };
    const Eigen::VectorXd by_A = difference([&](const auto& motion) {
      return joint_equations(joint, after(X_WA, c_A, motion), X_WB, c_A, c_B).value;
    });
    const Eigen::VectorXd by_B = difference([&](const auto& motion) {
      return joint_equations(joint, X_WA, after(X_WB, c_B, motion), c_A, c_B).value;
    });
    CAPTURE(i, by_A.transpose(), at.motion_A.col(i).transpose());
    CHECK((by_A - at.motion_A.col(i)).norm() < 1e-5);
    CHECK((by_B - at.motion_B.col(i)).norm() < 1e-5);
  }
}

TEST_CASE("a body placed by a joint holds it, and no other such pose is nearer", "[property]") {
  const unsigned seed = GENERATE(range(1000U, 1200U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const Joint joint = random_joint(random);
  const Pose X_WA = random.pose(300);
  const Pose X_WB = random.pose(300);
  const auto check_holds = [&](const Pose& X_WA_now, const Pose& X_WB_now) {
    const auto off = joint_off(joint, X_WA_now, X_WB_now);
    CHECK(off.turn_rad.norm() < 1e-13);
    CHECK(off.slide_mm.norm() < 1e-11);
  };
  const Pose placed = place_by_joint(joint, X_WA, X_WB);
  check_holds(placed, X_WB);
  check_holds(X_WA, dowel::place_other_by_joint(joint, X_WA, X_WB));
  // About what is left free, every other turn is farther away.
  if (!joint.holds_spin && (joint.holds_tilt || joint.angle_rad)) {
    const Eigen::Vector3d axis =
        X_WB.rotation() * (joint.X_BG.rotation() * Eigen::Vector3d(0, 0, 1));
    for (int step = 1; step < 36; ++step) {
      const Pose other =
          Pose::about_axis({0, 0, 0}, axis.normalized(), step * std::numbers::pi / 18) * placed;
      CHECK(angle_between(X_WA, other) >= angle_between(X_WA, placed) - 1e-9);
    }
  }
  if (joint.equations() == 0) CHECK(placed == X_WA);
}

TEST_CASE("a body that points just the other way is turned over by a half turn", "[degenerate]") {
  Joint joint;
  joint.holds_tilt = true;
  const Pose over(Eigen::Quaterniond(0, 1, 0, 0), {0, 0, 5});
  CHECK(joint_off(joint, over, Pose()).turn_rad.norm() == Approx(std::numbers::pi));
  CHECK(joint_off(joint, place_by_joint(joint, over, Pose()), Pose()).turn_rad.norm() < 1e-13);
  CHECK(joint_equations(joint, over, Pose(), {0, 0, 0}, {0, 0, 0}).motion_A.allFinite());
  joint.holds_tilt = false;
  joint.angle_rad = 0.5;
  for (const Pose& along : {Pose(), over}) {
    CHECK(joint_equations(joint, along, Pose(), {0, 0, 0}, {0, 0, 0}).motion_A.allFinite());
    CHECK(joint_off(joint, place_by_joint(joint, along, Pose()), Pose()).turn_rad.norm() < 1e-13);
  }
}
