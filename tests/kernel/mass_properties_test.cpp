#include "dowel/kernel/mass_properties.h"

#include <numbers>

#include <catch2/catch.hpp>

#include "solids.h"

namespace {

using namespace dowel;
using namespace dowel::testing;

}  // namespace

TEST_CASE("a box has the moments of the textbook") {
  const MassProperties m = mass_properties(box({2, 4, 6}, {10, 20, 30}));
  CHECK(m.volume_mm3 == Approx(48.0));
  CHECK(m.surface_mm2 == Approx(88.0));
  CHECK((m.center_of_mass - Eigen::Vector3d(10, 20, 30)).norm() < 1e-12);
  const Eigen::Vector3d expected(48.0 / 12 * (16 + 36), 48.0 / 12 * (4 + 36), 48.0 / 12 * (4 + 16));
  CHECK((m.inertia_mm5 - Eigen::Matrix3d(expected.asDiagonal())).norm() < 1e-9);
}

TEST_CASE("a fine cylinder has the moments of the textbook") {
  const double r = 3.0;
  const double h = 10.0;
  const double v = std::numbers::pi * r * r * h;
  const MassProperties m = mass_properties(cylinder(r, h, 2000));
  CHECK(m.volume_mm3 == Approx(v).epsilon(1e-5));
  CHECK((m.center_of_mass - Eigen::Vector3d(0, 0, h / 2)).norm() < 1e-9);
  CHECK(m.inertia_mm5(2, 2) == Approx(v * r * r / 2).epsilon(1e-5));
  CHECK(m.inertia_mm5(0, 0) == Approx(v * (3 * r * r + h * h) / 12).epsilon(1e-5));
  CHECK(m.inertia_mm5(0, 1) == Approx(0.0).margin(1e-6));
}

TEST_CASE("moments turn with the part and do not care where it is", "[property]") {
  const FacetedSolid part = plate_with_holes({60, 40, 10}, hole_grid(2, 1, 25, 6), 24);
  const MassProperties at_home = mass_properties(part);
  RandomGeometry random(5);
  for (int round = 0; round < 50; ++round) {
    const Pose X_WB = random.pose(10000.0);
    const MassProperties moved = mass_properties(dowel::testing::transformed(X_WB, part));
    const Eigen::Matrix3d R_WB = X_WB.rotation_matrix();
    REQUIRE(moved.volume_mm3 == Approx(at_home.volume_mm3).epsilon(1e-12));
    REQUIRE(moved.surface_mm2 == Approx(at_home.surface_mm2).epsilon(1e-12));
    REQUIRE((moved.center_of_mass - X_WB * at_home.center_of_mass).norm() < 1e-9);
    const Eigen::Matrix3d turned = R_WB * at_home.inertia_mm5 * R_WB.transpose();
    REQUIRE((moved.inertia_mm5 - turned).norm() < 1e-9 * turned.norm());
  }
}

TEST_CASE("an inside-out mesh has a negative volume and the same centre") {
  const FacetedSolid part = wedge(0.5, 10, 4);
  const MassProperties out = mass_properties(part);
  const MassProperties in = mass_properties(inverted(part));
  CHECK(in.volume_mm3 == -out.volume_mm3);
  CHECK((in.center_of_mass - out.center_of_mass).norm() < 1e-12);
}

TEST_CASE("nothing has no moments", "[degenerate]") {
  CHECK(mass_properties(FacetedSolid()).volume_mm3 == 0.0);
  FacetedSolid flat;
  flat.vertices = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  flat.triangles = {{0, 1, 2}, {0, 2, 1}};
  const MassProperties m = mass_properties(flat);
  CHECK(m.volume_mm3 == 0.0);
  CHECK(m.surface_mm2 == 1.0);
  CHECK(m.center_of_mass.allFinite());
}
