#include "dowel/kernel/surface.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "random_geometry.h"

namespace {

using namespace dowel;
using dowel::testing::RandomGeometry;

constexpr double kRounding_mm = 1e-11;

std::array<Surface, 5> random_surfaces(RandomGeometry& random) {
  return {PlaneSurface{random.point(50.0), random.direction()},
          CylinderSurface{random.point(50.0), random.direction(), random.uniform(0.5, 30.0)},
          ConeSurface{random.point(50.0), random.direction(), random.uniform(0.05, 1.5)},
          SphereSurface{random.point(50.0), random.uniform(0.5, 30.0)},
          TorusSurface{random.point(50.0), random.direction(), random.uniform(20.0, 40.0),
                       random.uniform(0.5, 15.0)}};
}

}  // namespace

TEST_CASE("signed distances are positive on the natural side") {
  CHECK(signed_distance_mm(PlaneSurface{{0, 0, 2}, {0, 0, 1}}, {7, 8, 5}) == 3.0);
  CHECK(signed_distance_mm(PlaneSurface{{0, 0, 2}, {0, 0, -1}}, {7, 8, 5}) == -3.0);
  const CylinderSurface cylinder{{1, 1, 99}, {0, 0, 1}, 5.0};
  CHECK(signed_distance_mm(cylinder, {4, 5, -3}) == Approx(0.0).margin(kRounding_mm));
  CHECK(signed_distance_mm(cylinder, {1, 1, 0}) == Approx(-5.0));
  CHECK(signed_distance_mm(SphereSurface{{1, 2, 3}, 2.0}, {1, 2, 8}) == Approx(3.0));
  const TorusSurface torus{{0, 0, 0}, {0, 0, 1}, 10.0, 3.0};
  CHECK(signed_distance_mm(torus, {10, 0, 0}) == Approx(-3.0));
  CHECK(signed_distance_mm(torus, {0, 0, 0}) == Approx(7.0));
  CHECK(signed_distance_mm(torus, {0, 15, 0}) == Approx(2.0));
}

TEST_CASE("a cone has one nappe, and behind its apex the apex is closest") {
  const ConeSurface cone{{0, 0, 10}, {0, 0, -1}, std::numbers::pi / 4};
  CHECK(signed_distance_mm(cone, {3, 0, 7}) == Approx(0.0).margin(kRounding_mm));
  CHECK(signed_distance_mm(cone, {0, 0, 8}) == Approx(-std::sqrt(2.0)));
  CHECK(signed_distance_mm(cone, {0, 0, 13}) == Approx(3.0));
  CHECK(signed_distance_mm(cone, {3, 0, 13}) == Approx(std::sqrt(18.0)));
  CHECK(closest_point(cone, {0, 0, 13}).isApprox(Eigen::Vector3d(0, 0, 10)));
}

TEST_CASE("the closest point lies on the surface at the signed distance, along the gradient",
          "[property]") {
  RandomGeometry random(GENERATE(range(1U, 11U)));
  std::size_t inside = 0;
  std::size_t outside = 0;
  for (int round = 0; round < 100; ++round) {
    for (const Surface& surface : random_surfaces(random)) {
      const Eigen::Vector3d p = random.point(80.0);
      const double distance = signed_distance_mm(surface, p);
      const Eigen::Vector3d q = closest_point(surface, p);
      CAPTURE(surface.index(), p.transpose());
      REQUIRE(signed_distance_mm(surface, q) == Approx(0.0).margin(kRounding_mm));
      REQUIRE((q - p).norm() == Approx(std::abs(distance)).margin(kRounding_mm));
      REQUIRE(distance_gradient(surface, p).norm() == Approx(1.0));
      // No point of the surface is closer, as far as random ones tell.
      const Eigen::Vector3d other = closest_point(surface, random.point(80.0));
      REQUIRE((other - p).norm() >= std::abs(distance) - kRounding_mm);
      ++(distance < 0.0 ? inside : outside);
    }
  }
  CHECK(inside > 50);
  CHECK(outside > 50);
}

TEST_CASE("the gradient is the derivative of the signed distance", "[property]") {
  RandomGeometry random(7);
  constexpr double kStep_mm = 1e-5;
  for (int round = 0; round < 200; ++round) {
    for (const Surface& surface : random_surfaces(random)) {
      const Eigen::Vector3d p = random.point(80.0);
      const Eigen::Vector3d d = random.direction();
      const double slope = (signed_distance_mm(surface, p + kStep_mm * d) -
                            signed_distance_mm(surface, p - kStep_mm * d)) /
                           (2.0 * kStep_mm);
      CAPTURE(surface.index(), p.transpose());
      REQUIRE(distance_gradient(surface, p).dot(d) == Approx(slope).margin(1e-4));
    }
  }
}

TEST_CASE("where the gradient is not unique it is still a unit vector", "[degenerate]") {
  const auto is_unit = [](const Eigen::Vector3d& v) { return std::abs(v.norm() - 1.0) < 1e-12; };
  const Eigen::Vector3d tiny(1e-200, 0, 0);
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(0, 0, 5), tiny}) {
    CHECK(is_unit(distance_gradient(CylinderSurface{{0, 0, 0}, {0, 0, 1}, 2.0}, p)));
    CHECK(is_unit(distance_gradient(ConeSurface{{0, 0, 0}, {0, 0, 1}, 0.5}, p)));
    CHECK(is_unit(distance_gradient(ConeSurface{{0, 0, 0}, {0, 0, -1}, 0.5}, p)));
    CHECK(is_unit(distance_gradient(SphereSurface{{0, 0, 0}, 2.0}, p)));
    CHECK(is_unit(distance_gradient(TorusSurface{{0, 0, 0}, {0, 0, 1}, 5.0, 1.0}, p)));
  }
  CHECK(is_unit(distance_gradient(TorusSurface{{0, 0, 0}, {0, 0, 1}, 5.0, 1.0}, {5, 0, 0})));
}

TEST_CASE("a moved surface has the same distances to moved points", "[property]") {
  RandomGeometry random(3);
  for (int round = 0; round < 100; ++round) {
    const Pose X_WB = random.pose(2000.0);
    for (const Surface& surface_B : random_surfaces(random)) {
      const Eigen::Vector3d p_B = random.point(80.0);
      const Surface surface_W = transformed(X_WB, surface_B);
      REQUIRE(signed_distance_mm(surface_W, X_WB * p_B) ==
              Approx(signed_distance_mm(surface_B, p_B)).margin(1e-9));
      REQUIRE((distance_gradient(surface_W, X_WB * p_B) -
               X_WB.rotation() * distance_gradient(surface_B, p_B))
                  .norm() < 1e-9);
    }
  }
}

TEST_CASE("other surfaces have no distance and keep every point") {
  const Surface other = OtherSurface{};
  CHECK_THROWS_AS(signed_distance_mm(other, {1, 2, 3}), std::logic_error);
  CHECK_THROWS_AS(distance_gradient(other, {1, 2, 3}), std::logic_error);
  CHECK(closest_point(other, {1, 2, 3}) == Eigen::Vector3d(1, 2, 3));
  CHECK(transformed(Pose(), other).index() == other.index());
  CHECK_FALSE(is_plane(other));
  CHECK(is_plane(PlaneSurface{}));
}
