// What is no solid, no box or no pose is refused with a reason, and never judged.

#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "collision_element.h"
#include "dowel/kernel/error.h"
#include "solids.h"

using dowel::BodyId;
using dowel::CollisionElement;
using dowel::CollisionScene;
using dowel::FacetedSolid;
using dowel::Obb;
using dowel::Pose;
using dowel::Verdict;
namespace testing = dowel::testing;

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

struct BadSolid {
  std::string reason;  ///< part of what is said
  FacetedSolid solid;
};

FacetedSolid cube() {
  return testing::box({10, 10, 10});
}

FacetedSolid beside(FacetedSolid solid) {
  return testing::transformed(Pose::from_translation({30, 0, 0}), std::move(solid));
}

/// Both as one solid.
FacetedSolid united(const FacetedSolid& a, const FacetedSolid& b) {
  FacetedSolid result = testing::merged(a, b);
  for (dowel::Face& face : result.faces) face.solid = 0;
  result.solid_count = 1;
  return result;
}

FacetedSolid open() {
  FacetedSolid solid = cube();
  solid.triangles.pop_back();
  solid.face_of.pop_back();
  return solid;
}

FacetedSolid with_one_turned() {
  FacetedSolid solid = cube();
  std::swap(solid.triangles[0][0], solid.triangles[0][1]);
  return solid;
}

FacetedSolid with_vertex(const Eigen::Vector3d& vertex) {
  FacetedSolid solid = cube();
  solid.vertices[3] = vertex;
  return solid;
}

FacetedSolid with_surface(std::size_t face, const dowel::Surface& surface) {
  FacetedSolid solid = cube();
  solid.faces[face].surface = surface;
  return solid;
}

FacetedSolid with_reversed_wall() {
  FacetedSolid solid = testing::tube(4, 6, 20, 24);
  solid.faces[3].reversed = false;
  return solid;
}

FacetedSolid not_welded() {
  FacetedSolid solid = cube();
  solid.vertices.push_back(solid.vertices[solid.triangles[0][0]]);
  solid.triangles[0][0] = static_cast<std::uint32_t>(solid.vertices.size() - 1);
  return solid;
}

FacetedSolid with_triangle(const dowel::Triangle& triangle) {
  FacetedSolid solid = cube();
  solid.triangles[0] = triangle;
  return solid;
}

std::vector<BadSolid> bad_solids() {
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  return {
      {"has no triangles", FacetedSolid()},
      {"the mesh is open", open()},
      {"disagree on which side", with_one_turned()},
      {"do not face outward", testing::inverted(cube())},
      {"do not face outward", testing::merged(cube(), testing::inverted(beside(cube())))},
      // Of one solid, so that its volume is positive.
      {"is no cavity", united(testing::box({20, 20, 20}), testing::inverted(beside(cube())))},
      {"not welded", united(cube(), cube())},
      {"not welded", not_welded()},
      {"is not finite", with_vertex({0, kNaN, 0})},
      {"is not finite", with_vertex({0, 0, -std::numeric_limits<double>::infinity()})},
      {"from the origin", with_vertex({1e9, 0, 0})},
      {"names vertex", with_triangle({0, 1, 99})},
      {"two equal vertices", with_triangle({0, 1, 1})},
      {"not of unit length", with_surface(1, dowel::PlaneSurface{{0, 0, 5}, 2.0 * up})},
      {"not of unit length", with_surface(1, dowel::PlaneSurface{{0, 0, 5}, kNaN * up})},
      {"mm off the surface", with_surface(1, dowel::PlaneSurface{{0, 0, 7}, up})},
      {"mm off the surface", with_surface(1, dowel::CylinderSurface{{0, 0, 0}, up, 6.0})},
      {"outside where its triangles have their inside",
       with_surface(1, dowel::PlaneSurface{{0, 0, 5}, -up})},
      {"outside where its triangles have their inside", with_reversed_wall()},
  };
}

std::shared_ptr<const CollisionElement> element(FacetedSolid solid, const Obb& obb) {
  auto shared = std::make_shared<const FacetedSolid>(std::move(solid));
  return std::make_shared<const CollisionElement>(obb, [shared] { return shared; });
}

const Obb kRoom{{0, 0, 0}, Eigen::Matrix3d::Identity(), {60, 60, 60}};

}  // namespace

TEST_CASE("what is no solid is refused by the first question that needs it", "[degenerate]") {
  for (const BadSolid& bad : bad_solids()) {
    CAPTURE(bad.reason);
    CollisionScene scene;
    const BodyId body = scene.add(element(bad.solid, kRoom), Pose());
    scene.add(testing::collision_element(cube()), Pose());
    const Pose pose;
    const auto ask = [&] { scene.check({&body, 1}, {&pose, 1}, {}); };
    CHECK_THROWS_AS(ask(), dowel::Error);
    CHECK_THROWS_WITH(ask(), Catch::Contains(bad.reason));  // and again
    CHECK_THROWS_AS(scene.check_all({}), dowel::Error);
    CHECK_THROWS_AS(
        scene.sweep({&body, 1}, {&pose, 1}, pose, Pose::from_translation({0, 0, 9}), {}),
        dowel::Error);
  }
}

TEST_CASE("an element that its box does not hold, or without a box, is refused", "[degenerate]") {
  const auto load = [] { return std::make_shared<const FacetedSolid>(cube()); };
  const Obb small{{0, 0, 0}, Eigen::Matrix3d::Identity(), {5, 5, 4.9}};
  CollisionScene scene;
  const BodyId body = scene.add(std::make_shared<const CollisionElement>(small, load), Pose());
  scene.add(testing::collision_element(cube()), Pose());
  const Pose pose;
  CHECK_THROWS_WITH(scene.check({&body, 1}, {&pose, 1}, {}), Catch::Contains("outside the box"));

  const auto make = [&](const Obb& obb) { CollisionElement(obb, load); };
  CHECK_NOTHROW(make(kRoom));
  CHECK_THROWS_AS(make({{0, kNaN, 0}, Eigen::Matrix3d::Identity(), {5, 5, 5}}), std::logic_error);
  CHECK_THROWS_AS(make({{0, 0, 0}, 2.0 * Eigen::Matrix3d::Identity(), {5, 5, 5}}),
                  std::logic_error);
  CHECK_THROWS_AS(make({{0, 0, 0}, Eigen::Matrix3d::Identity(), {5, -5, 5}}), std::logic_error);
  CHECK_THROWS_AS(CollisionElement(kRoom, nullptr), std::logic_error);
}

TEST_CASE("what a loader throws passes through, and it is asked again", "[fault]") {
  int calls = 0;
  const auto flaky = std::make_shared<const CollisionElement>(
      kRoom, [&calls]() -> std::shared_ptr<const FacetedSolid> {
        if (++calls == 1) throw std::runtime_error("the disk is away");
        if (calls == 2) return nullptr;
        return std::make_shared<const FacetedSolid>(cube());
      });
  CollisionScene scene;
  const BodyId body = scene.add(flaky, Pose());
  scene.add(testing::collision_element(cube()), Pose());
  const Pose pose;
  const auto ask = [&] { return worst(scene.check({&body, 1}, {&pose, 1}, {})); };
  CHECK_THROWS_WITH(ask(), "the disk is away");
  CHECK_THROWS_AS(ask(), std::logic_error);
  CHECK(ask() == Verdict::Interference);
}

TEST_CASE("bodies, poses and tolerances that are none meet a check", "[degenerate]") {
  CollisionScene scene;
  const BodyId body = scene.add(testing::collision_element(cube()), Pose());
  const BodyId gone = scene.add(testing::collision_element(cube()), Pose());
  scene.remove(gone);
  const std::array<Pose, 2> poses;
  const auto ask = [&](BodyId id, std::size_t count, double tolerance_mm) {
    scene.check({&id, 1}, std::span(poses).first(count), {.tolerance_mm = tolerance_mm});
  };
  CHECK_NOTHROW(ask(body, 1, 0.01));
  CHECK_THROWS_AS(ask(gone, 1, 0.01), std::logic_error);
  CHECK_THROWS_AS(ask(BodyId{77}, 1, 0.01), std::logic_error);
  CHECK_THROWS_AS(ask(body, 2, 0.01), std::logic_error);
  for (const double tolerance_mm : {0.0, -1.0, 1e9, kNaN}) {
    CHECK_THROWS_AS(ask(body, 1, tolerance_mm), std::logic_error);
    CHECK_THROWS_AS(scene.check_all({.tolerance_mm = tolerance_mm}), std::logic_error);
    CHECK_THROWS_AS(
        scene.sweep({&body, 1}, {poses.data(), 1}, Pose(), Pose(), {.tolerance_mm = tolerance_mm}),
        std::logic_error);
  }
  CHECK_THROWS_AS(scene.add(nullptr, Pose()), std::logic_error);
  // Poses that are not rigid cannot be made.
  CHECK_THROWS_AS(Pose(Eigen::Quaterniond(1, 1, 0, 0), {0, 0, 0}), std::logic_error);
  CHECK_THROWS_AS(Pose::from_translation({kNaN, 0, 0}), std::logic_error);
  CHECK_THROWS_AS(
      Pose::from_matrix(Eigen::Vector3d(1, 1, -1).asDiagonal().toDenseMatrix(), {0, 0, 0}),
      std::logic_error);
}

TEST_CASE("triangles without area change no verdict", "[degenerate]") {
  // One side of the cube's bottom is parted at its middle on one side only: a triangle without area
  // closes the gap.
  FacetedSolid solid = cube();
  const dowel::Triangle first = solid.triangles[0];
  const auto middle = static_cast<std::uint32_t>(solid.vertices.size());
  solid.vertices.emplace_back(0.5 * (solid.vertices[first[0]] + solid.vertices[first[1]]));
  solid.triangles[0] = {first[0], middle, first[2]};
  solid.triangles.push_back({middle, first[1], first[2]});
  solid.triangles.push_back({first[0], first[1], middle});
  solid.face_of.insert(solid.face_of.end(), 2, solid.face_of[0]);
  CollisionScene scene;
  scene.add(testing::collision_element(testing::box({40, 40, 10}, {0, 0, -5})), Pose());
  const BodyId body = scene.add(testing::collision_element(solid), Pose());
  testing::RandomGeometry random(71);
  for (int i = 0; i < 1'000; ++i) {
    const Eigen::AngleAxisd turn(random.uniform(0, 7), Eigen::Vector3d::UnitZ());
    for (const double lift_mm : {-0.011, -0.009, 0.0, 0.009, 0.011}) {
      const Pose pose(Eigen::Quaterniond(turn),
                      {random.uniform(-9, 9), random.uniform(-9, 9), 5 + lift_mm});
      CAPTURE(i, lift_mm);
      REQUIRE(worst(scene.check({&body, 1}, {&pose, 1}, {})) ==
              (lift_mm < -0.01  ? Verdict::Interference
               : lift_mm < 0.01 ? Verdict::Contact
                                : Verdict::Clear));
    }
  }
}
