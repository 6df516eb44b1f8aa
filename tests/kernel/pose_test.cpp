#include "dowel/kernel/pose.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "random_geometry.h"

namespace {

using namespace dowel;
using dowel::testing::RandomGeometry;

}  // namespace

TEST_CASE("poses compose and invert as matrices do", "[property]") {
  RandomGeometry random(1);
  for (int round = 0; round < 200; ++round) {
    const Pose X_AB = random.pose(1000.0);
    const Pose X_BC = random.pose(1000.0);
    const Eigen::Vector3d p_C = random.point(1000.0);
    REQUIRE(((X_AB * X_BC) * p_C - X_AB * (X_BC * p_C)).norm() < 1e-11);
    REQUIRE((X_AB.inverse() * (X_AB * p_C) - p_C).norm() < 1e-11);
    const Pose copy = Pose::from_matrix(X_AB.rotation_matrix(), X_AB.translation());
    REQUIRE((copy * p_C - X_AB * p_C).norm() < 1e-11);
  }
}

TEST_CASE("a rotation about an axis leaves the axis where it is") {
  const Eigen::Vector3d point(1, 2, 3);
  const Pose X = Pose::about_axis(point, Eigen::Vector3d::UnitZ(), std::numbers::pi / 2);
  CHECK((X * Eigen::Vector3d(1, 2, 77) - Eigen::Vector3d(1, 2, 77)).norm() < 1e-13);
  CHECK((X * Eigen::Vector3d(2, 2, 3) - Eigen::Vector3d(1, 3, 3)).norm() < 1e-13);
}

TEST_CASE("a pose that was normalised survives to the bit") {
  RandomGeometry random(4);
  for (int round = 0; round < 1000; ++round) {
    const Pose X = random.pose(10.0);
    REQUIRE(Pose(X.rotation(), X.translation()) == X);
  }
}

TEST_CASE("the canonical pose is the same placement with w >= 0") {
  const Eigen::Quaterniond q(-0.5, 0.5, 0.5, 0.5);
  const Pose X(q, {1, 2, 3});
  CHECK(X.canonical().rotation().w() == 0.5);
  CHECK((X.canonical() * Eigen::Vector3d(4, 5, 6) - X * Eigen::Vector3d(4, 5, 6)).norm() < 1e-14);
}

TEST_CASE("interpolation goes the short way and meets both ends") {
  const Pose to = Pose::about_axis({0, 0, 0}, Eigen::Vector3d::UnitX(), 1.5 * std::numbers::pi);
  CHECK(
      (interpolate(Pose(), to, 0.0) * Eigen::Vector3d::UnitY() - Eigen::Vector3d::UnitY()).norm() <
      1e-14);
  CHECK((interpolate(Pose(), to, 1.0) * Eigen::Vector3d::UnitY() - to * Eigen::Vector3d::UnitY())
            .norm() < 1e-14);
  // Halfway of -90 degrees, not of 270.
  CHECK((interpolate(Pose(), to, 0.5) * Eigen::Vector3d::UnitY()).y() ==
        Approx(std::cos(std::numbers::pi / 4)));
}

TEST_CASE("a million small moves keep a pose rigid") {
  const Pose step = Pose::about_axis({10, 20, 30}, Eigen::Vector3d(1, 2, 3).normalized(), 1e-3);
  Pose X;
  for (int i = 0; i < 1000000; ++i) X = step * X;
  CHECK(std::abs(X.rotation().norm() - 1.0) < 1e-15);
  const Pose direct =
      Pose::about_axis({10, 20, 30}, Eigen::Vector3d(1, 2, 3).normalized(), 1e-3 * 1e6);
  CHECK((X * Eigen::Vector3d(1000, 0, 0) - direct * Eigen::Vector3d(1000, 0, 0)).norm() < 1e-6);
}

TEST_CASE("what is no pose is refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(Pose(Eigen::Quaterniond(2, 0, 0, 0), {0, 0, 0}), std::logic_error);
  CHECK_THROWS_AS(Pose(Eigen::Quaterniond(1, 0, 0, 0), {0, nan, 0}), std::logic_error);
  CHECK_THROWS_AS(Pose(Eigen::Quaterniond(nan, 0, 0, 0), {0, 0, 0}), std::logic_error);
  CHECK_THROWS_AS(Pose::from_matrix(-Eigen::Matrix3d::Identity(), {0, 0, 0}), std::logic_error);
  CHECK_THROWS_AS(Pose::from_matrix(2.0 * Eigen::Matrix3d::Identity(), {0, 0, 0}),
                  std::logic_error);
}
