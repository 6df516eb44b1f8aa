#include "dowel/collision/box_separation.h"

#include <catch2/catch.hpp>

#include "random_geometry.h"

using dowel::Obb;
using dowel::Pose;
using dowel::separate;
using dowel::separate_brute_force;

namespace {

Obb random_box(dowel::testing::RandomGeometry& random, double reach_mm) {
  const Pose X_WB = random.pose(reach_mm);
  return transformed(X_WB,
                     {Eigen::Vector3d::Zero(),
                      Eigen::Matrix3d::Identity(),
                      {random.uniform(0.5, 20), random.uniform(0.5, 20), random.uniform(0.5, 20)}});
}

}  // namespace

TEST_CASE("boxes that only touch are not separated") {
  const Obb a{{0, 0, 0}, Eigen::Matrix3d::Identity(), {1, 1, 1}};
  Obb b = a;
  b.center.x() = 2.0;
  CHECK(separate(a, b, 0.0).plane == -1);
  b.center.x() = 2.0 + 1e-9;
  CHECK(separate(a, b, 0.0).plane == 0);
  CHECK(separate(a, b, 0.01).plane == -1);
}

TEST_CASE("each of the fifteen planes separates some pair of boxes", "[property]") {
  dowel::testing::RandomGeometry random(7);
  std::array<int, 15> used{};
  for (int i = 0; i < 200'000; ++i) {
    const Obb a = random_box(random, 15.0);
    const Obb b = random_box(random, 15.0);
    const auto found = separate(a, b, 0.0);
    if (found.plane >= 0) ++used.at(static_cast<std::size_t>(found.plane));
  }
  for (const int count : used) CHECK(count > 0);
}

TEST_CASE("the plane test agrees with the corners of both boxes", "[property]") {
  dowel::testing::RandomGeometry random(1);
  int separated = 0;
  constexpr int kPairs = 100'000;
  for (int i = 0; i < kPairs; ++i) {
    const Obb a = random_box(random, 20.0);
    const Obb b = random_box(random, 20.0);
    const double margin = i % 2 == 0 ? 0.0 : 1.0;
    const auto fast = separate(a, b, margin, i % 3 == 0 ? i % 15 : -1);
    const auto slow = separate_brute_force(a, b, margin);
    separated += slow.plane >= 0 ? 1 : 0;
    if (std::abs(slow.gap_mm - margin) < 1e-9) continue;  // within rounding of the threshold
    REQUIRE((fast.plane >= 0) == (slow.plane >= 0));
    if (fast.plane >= 0) REQUIRE(fast.gap_mm <= slow.gap_mm + 1e-9);
  }
  CHECK(separated > kPairs / 5);
  CHECK(separated < kPairs * 4 / 5);
}

TEST_CASE("boxes with parallel edges need no plane of edges") {
  const Obb a{{0, 0, 0}, Eigen::Matrix3d::Identity(), {1, 1, 1}};
  Obb b{
      {0, 0, 2.5}, Eigen::AngleAxisd(0.3, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {1, 1, 1}};
  CHECK(separate(a, b, 0.0).plane == 2);
  CHECK(separate(a, b, 0.0).gap_mm == Approx(0.5));
}
