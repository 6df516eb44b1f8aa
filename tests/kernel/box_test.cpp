#include "dowel/kernel/box.h"

#include <catch2/catch.hpp>

#include "random_geometry.h"

namespace {

using namespace dowel;
using dowel::testing::RandomGeometry;

}  // namespace

TEST_CASE("the bounds of nothing are empty and overlap nothing", "[degenerate]") {
  const Aabb none = bounds(std::span<const Eigen::Vector3d>());
  CHECK(none.is_empty());
  const Aabb one{{0, 0, 0}, {1, 1, 1}};
  CHECK_FALSE(none.overlaps(one));
  CHECK_FALSE(one.overlaps(none));
  CHECK_FALSE(one.is_empty());
}

TEST_CASE("boxes that only touch overlap") {
  const Aabb a{{0, 0, 0}, {1, 1, 1}};
  CHECK(a.overlaps({{1, 1, 1}, {2, 2, 2}}));
  CHECK_FALSE(a.overlaps({{1.0001, 0, 0}, {2, 2, 2}}));
  CHECK(a.padded(0.001).overlaps({{1.0001, 0, 0}, {2, 2, 2}}));
  CHECK(a.contains(a));
  CHECK_FALSE(a.contains(a.padded(0.001)));
}

TEST_CASE("an oriented box keeps its corners on its faces in every frame", "[property]") {
  RandomGeometry random(2);
  for (int round = 0; round < 100; ++round) {
    Obb box;
    box.center = random.point(100.0);
    box.axes = random.pose(0.0).rotation_matrix();
    box.half_extents_mm = {random.uniform(0.0, 9.0), random.uniform(0.0, 9.0), 3.0};
    const Obb moved = transformed(random.pose(1000.0), box);
    CHECK(moved.volume_mm3() == Approx(box.volume_mm3()));
    const Aabb around = bounds(moved).padded(1e-10);
    for (const Eigen::Vector3d& corner : moved.corners()) {
      REQUIRE(moved.face_distance_mm(corner) == Approx(0.0).margin(1e-10));
      REQUIRE(moved.padded(1.0).face_distance_mm(corner) == Approx(-1.0).margin(1e-10));
      REQUIRE(around.contains(Aabb{corner, corner}));
    }
    REQUIRE(moved.face_distance_mm(moved.center) == Approx(-box.half_extents_mm.minCoeff()));
  }
}
