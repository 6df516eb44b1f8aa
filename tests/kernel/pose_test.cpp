#include "dowel/kernel/pose.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "random_geometry.h"

namespace {

using namespace dowel;
using dowel::testing::RandomGeometry;

struct Drift {
  double slide_mm = 0.0;
  double turn_rad = 0.0;
};

/// What is left of `count` random small moves in the world's frame (or the body's own) after each
/// was taken back, the last one first, by its inverse.
Drift drift_of(int count, bool in_body) {
  // Drawn by number, so that the way back needs no list.
  const auto small_move = [](int number) {
    std::uint64_t bits = static_cast<std::uint64_t>(number) * 0x9e3779b97f4a7c15U;
    const auto next = [&bits] {  // splitmix64, in [-1, 1)
      bits += 0x9e3779b97f4a7c15U;
      std::uint64_t z = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
      z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
      return static_cast<double>((z ^ (z >> 31U)) >> 11U) * 0x1p-52 - 1.0;
    };
    const double x = next();
    const double y = next();
    const double z = next();
    const Eigen::Quaterniond turn(1.0, 5e-3 * x, 5e-3 * y, 5e-3 * z);
    const double dx = next();
    const double dy = next();
    return Pose(turn.normalized(), 0.1 * Eigen::Vector3d(dx, dy, next()));
  };
  RandomGeometry random(6);
  const Pose start = random.pose(1000.0);
  Pose X = start;
  const auto go = [&](const Pose& move) { X = in_body ? X * move : move * X; };
  for (int i = 0; i < count; ++i) go(small_move(i));
  for (int i = count; i-- > 0;) go(small_move(i).inverse());
  const Eigen::Quaterniond turned = start.rotation().conjugate() * X.rotation();
  return {(X.translation() - start.translation()).norm(), 2.0 * turned.vec().norm()};
}

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
  CHECK(std::abs(X.rotation().norm() - 1.0) < 1e-14);
  const Pose direct =
      Pose::about_axis({10, 20, 30}, Eigen::Vector3d(1, 2, 3).normalized(), 1e-3 * 1e6);
  CHECK((X * Eigen::Vector3d(1000, 0, 0) - direct * Eigen::Vector3d(1000, 0, 0)).norm() < 1e-6);
}

TEST_CASE("small moves and their inverses leave a pose where it was") {
  const bool in_body = GENERATE(false, true);
  const Drift drift = drift_of(500000, in_body);
  CHECK(drift.slide_mm < 3e-10);
  CHECK(drift.turn_rad < 3e-13);
}

TEST_CASE("ten million small moves and their inverses leave a pose where it was", "[.long]") {
  const bool in_body = GENERATE(false, true);
  const Drift drift = drift_of(10000000, in_body);
  WARN("drift " << drift.slide_mm << " mm, " << drift.turn_rad << " rad");
  CHECK(drift.slide_mm < 1e-9);
  CHECK(drift.turn_rad < 1e-12);
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
