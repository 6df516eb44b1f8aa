#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "dowel/catalog/recognition.h"
#include "dowel/kernel/minimum_box.h"
#include "solids.h"
#include "variants.h"

using namespace dowel;

namespace {

ShapeClass shape_of(const FacetedSolid& solid) {
  return classify_shape(solid, recognise_features(solid));
}

/// A block with a round boss on its top: a blind hole drilled upwards.
FacetedSolid block_with_boss() {
  FacetedSolid solid = testing::plate_with_holes({60.0, 40.0, 20.0}, {{0.0, 0.0, 8.0, -25.0}}, 24);
  for (Face& face : solid.faces) {
    if (!std::holds_alternative<CylinderSurface>(face.surface)) continue;
    face.reversed = false;
    face.area_mm2 = std::abs(face.area_mm2);
  }
  solid.edges.clear();
  return solid;
}

}  // namespace

TEST_CASE("the box of a solid with flat faces is that of its corners", "[property]") {
  const auto seed = GENERATE(range(0U, 6U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const FacetedSolid solid =
      testing::transformed(random.pose(1000.0), testing::box({80.0, 40.0, 20.0}));
  const Obb box = enclosing_box(solid);
  const Obb corners = minimum_box(solid.vertices);
  CHECK(box.half_extents_mm.isApprox(corners.half_extents_mm, 1.0e-12));
  CHECK(box.volume_mm3() == Approx(64000.0).epsilon(1.0e-9));
}

TEST_CASE("holes and grooves do not inflate the box") {
  const FacetedSolid plate = testing::plate_with_holes(
      {120.0, 80.0, 30.0}, {{-30.0, 0.0, 20.0}, {30.0, 10.0, 6.0, 12.0, 9.0, 5.0}}, 8);
  CHECK(enclosing_box(plate).half_extents_mm.isApprox(Eigen::Vector3d(60.0, 40.0, 15.0), 1.0e-12));
}

TEST_CASE("the box contains the exact solid of revolution and fits it", "[property]") {
  const auto seed = GENERATE(range(0U, 20U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const std::uint32_t segments = 5 + random.index(30);
  const std::vector<Eigen::Vector2d> profile{
      {0.0, 0.0}, {8.0, 0.0}, {8.0, 40.0}, {6.0, 45.0}, {0.0, 45.0}};
  const Pose X_WB = random.pose(300.0);
  const FacetedSolid pin =
      testing::transformed(X_WB, testing::revolved(profile, segments, random.uniform(0.0, 1.0)));
  const Obb box = enclosing_box(pin);
  const Obb facets = minimum_box(pin.vertices);
  double worst_mm = -1.0;
  double facets_worst_mm = -1.0;
  for (const Eigen::Vector2d& corner : profile) {
    for (int i = 0; i < 720; ++i) {
      const double a = std::numbers::pi * i / 360.0;
      const Eigen::Vector3d p =
          X_WB * Eigen::Vector3d(corner.x() * std::cos(a), corner.x() * std::sin(a), corner.y());
      worst_mm = std::max(worst_mm, box.face_distance_mm(p));
      facets_worst_mm = std::max(facets_worst_mm, facets.face_distance_mm(p));
    }
  }
  CAPTURE(segments, facets_worst_mm);
  CHECK(worst_mm <= 1.0e-9);
  CHECK(facets_worst_mm > 1.0e-3);  // else the test would show nothing
  // 16 x 16 x 45 is the smallest box; the facets' own may stand askew by what they leave out.
  const double error_mm = 8.0 * (1.0 - std::cos(std::numbers::pi / segments));
  CHECK(box.volume_mm3() >= 11520.0 - 1.0e-6);
  CHECK(box.volume_mm3() <= (16.0 + 2.0 * error_mm) * (16.0 + 2.0 * error_mm) * 45.0 + 1.0e-6);
}

TEST_CASE("the box contains a sphere, exact and free-form alike") {
  const FacetedSolid ball = testing::sphere(10.0, 12);
  const Obb box = enclosing_box(ball);
  CHECK((box.half_extents_mm.array() >= 10.0 - 1.0e-12).all());
  CHECK((box.half_extents_mm.array() <= 10.0 + ball.faces[0].facet_error_mm).all());
  const Obb freeform = enclosing_box(testing::without_surfaces(ball));
  CHECK((freeform.half_extents_mm.array() >= 10.0 - 1.0e-12).all());
}

TEST_CASE("blocks, cylinders, blocks with cylinders and the rest are told apart") {
  CHECK(shape_of(testing::box({80.0, 40.0, 20.0})) == ShapeClass::Block);
  CHECK(shape_of(testing::plate_with_holes(
            {400.0, 300.0, 20.0}, testing::hole_grid(6, 5, 40.0, 6.0), 8)) == ShapeClass::Block);
  CHECK(shape_of(testing::cylinder(8.0, 45.0, 24)) == ShapeClass::Cylinder);
  CHECK(shape_of(testing::stepped_pin({{10.0, 8.0}, {6.0, 20.0}}, 24)) == ShapeClass::Cylinder);
  CHECK(shape_of(testing::tube(5.0, 15.0, 20.0, 24)) == ShapeClass::Cylinder);
  CHECK(shape_of(block_with_boss()) == ShapeClass::BlockCylinder);
  CHECK(shape_of(testing::wedge(0.5, 40.0, 20.0)) == ShapeClass::Compound);
  CHECK(shape_of(testing::sphere(10.0, 16)) == ShapeClass::Compound);
  // An angle: all faces square to each other, but it does not fill its box.
  CHECK(shape_of(testing::prism(
            {{0.0, 0.0}, {80.0, 0.0}, {80.0, 15.0}, {15.0, 15.0}, {15.0, 80.0}, {0.0, 80.0}},
            50.0)) == ShapeClass::Compound);
  // A block with a T-slot is still one.
  CHECK(shape_of(testing::prism({{0.0, 0.0},
                                 {80.0, 0.0},
                                 {80.0, 40.0},
                                 {47.0, 40.0},
                                 {47.0, 28.0},
                                 {51.0, 28.0},
                                 {51.0, 20.0},
                                 {29.0, 20.0},
                                 {29.0, 28.0},
                                 {33.0, 28.0},
                                 {33.0, 40.0},
                                 {0.0, 40.0}},
                                100.0)) == ShapeClass::Block);
}

TEST_CASE("a socket does not make a screw's head a block") {
  // A hexagon of 8 across flats sunk into a cylinder: its flanks look inwards.
  std::vector<Eigen::Vector2d> hexagon;
  for (int i = 0; i < 6; ++i) {
    const double a = std::numbers::pi / 3.0 * i;
    hexagon.emplace_back(4.6 * std::cos(a), 4.6 * std::sin(a));
  }
  const FacetedSolid socket =
      testing::transformed(Pose::from_translation({0.0, 0.0, 2.0}), testing::prism(hexagon, 8.0));
  CHECK(shape_of(testing::hollowed(testing::cylinder(6.0, 12.0, 24), socket)) ==
        ShapeClass::Cylinder);
}

TEST_CASE("the boss of a block is a shaft that grows out of it") {
  const std::vector<Feature> features = recognise_features(block_with_boss());
  REQUIRE(features.front().name == "pin1");
  CHECK((features.front().origin - Eigen::Vector3d(0.0, 0.0, 20.0)).norm() < 1.0e-9);
  CHECK((features.front().direction - Eigen::Vector3d::UnitZ()).norm() < 1.0e-9);
  CHECK(features.front().depth_mm == 25.0);
}

TEST_CASE("a moved solid keeps its shape class", "[property]") {
  const auto seed = GENERATE(range(0U, 4U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  CHECK(shape_of(testing::transformed(random.pose(1000.0), block_with_boss())) ==
        ShapeClass::BlockCylinder);
}
