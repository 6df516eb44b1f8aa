#include "dowel/collision/model.h"

#include <array>
#include <cmath>

#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "random_geometry.h"
#include "solids.h"

using dowel::CollisionModel;
using dowel::FacetedSolid;
using dowel::NearestPoint;
namespace testing = dowel::testing;

namespace {

#ifdef DOWEL_SANITIZED
constexpr int kNearest = 1'000;
#else
constexpr int kNearest = 100'000;
#endif

CollisionModel model_of(FacetedSolid solid) {
  return {std::make_shared<const FacetedSolid>(std::move(solid)), {}};
}

/// Signed distance from a solid cylinder on z = 0, negative inside.
double cylinder_distance(const Eigen::Vector3d& p, double radius, double height) {
  const double radial = std::hypot(p.x(), p.y()) - radius;
  const double axial = std::max(-p.z(), p.z() - height);
  if (radial > 0 && axial > 0) return std::hypot(radial, axial);
  return std::max(radial, axial);
}

double signed_distance(const NearestPoint& near) {
  return near.inside ? -near.distance_mm : near.distance_mm;
}

}  // namespace

TEST_CASE("the distance from a coarse cylinder is that of the exact cylinder", "[property]") {
  const auto segments = GENERATE(16U, 26U, 90U);
  CAPTURE(segments);
  const CollisionModel model = model_of(testing::cylinder(6.0, 20.0, segments));
  CHECK(model.max_slack_mm() > 1e-4);
  testing::RandomGeometry random(5);
  int inside = 0;
  double worst = 0.0;
  for (int i = 0; i < 20'000; ++i) {
    Eigen::Vector3d p = random.point(12.0) + Eigen::Vector3d(0, 0, 10);
    if (i % 2 == 0) {  // close to the wall, within the facet error of a coarse mesh
      const double angle = random.uniform(0, 7);
      const double r = 6.0 + random.uniform(-0.2, 0.2);
      p = {r * std::cos(angle), r * std::sin(angle), random.uniform(-0.3, 20.3)};
    }
    const double truth = cylinder_distance(p, 6.0, 20.0);
    const double measured = signed_distance(model.nearest(p));
    inside += truth < 0 ? 1 : 0;
    worst = std::max(worst, std::abs(measured - truth));
    if (std::abs(truth) > 1e-9) REQUIRE((measured < 0) == (truth < 0));
  }
  CHECK(worst < 1e-9);
  CHECK(inside > 4000);
}

TEST_CASE("near any hole the distance is that of the exact bore, also under its overhanging rim",
          "[property]") {
  // Several holes: facets of the plate then meet a rim at a vertex, or only across another facet.
  const auto segments = GENERATE(9U, 24U, 64U);
  CAPTURE(segments);
  const auto holes = testing::hole_grid(5, 3, 40, 6.0);
  const CollisionModel model = model_of(testing::plate_with_holes({240, 160, 20}, holes, segments));
  testing::RandomGeometry random(6);
  int in_air = 0;
  for (int i = 0; i < 20'000; ++i) {
    const testing::DrilledHole& hole =
        holes[random.index(static_cast<std::uint32_t>(holes.size()))];
    const double angle = random.uniform(0, 7);
    const double r = 6.0 + random.uniform(-0.3, 0.3);
    const double z = i % 2 == 0 ? 20.0 - random.uniform(-0.02, 0.02) : random.uniform(-0.3, 20.3);
    const Eigen::Vector3d p(hole.x + r * std::cos(angle), hole.y + r * std::sin(angle), z);
    // Near the bore the plate is the outside of a cylinder between two planes.
    const double radial = 6.0 - r;
    const double axial = std::max(-p.z(), p.z() - 20.0);
    const double truth =
        radial > 0 && axial > 0 ? std::hypot(radial, axial) : std::max(radial, axial);
    const double measured = signed_distance(model.nearest(p));
    in_air += truth > 0 ? 1 : 0;
    CAPTURE(i, r, angle, z);
    REQUIRE(measured == Approx(truth).margin(1e-9));
  }
  CHECK(in_air > 5000);
  CHECK(in_air < 15'000);
}

TEST_CASE("the tree finds what brute force finds", "[property]") {
  const CollisionModel model = model_of(testing::merged(
      testing::plate_with_holes({60, 40, 20}, testing::hole_grid(3, 2, 18, 5.0), 20),
      testing::transformed(dowel::Pose::from_translation({0, 0, 60}), testing::cone(10, 25, 24))));
  testing::RandomGeometry random(7);
  for (int i = 0; i < kNearest; ++i) {
    const Eigen::Vector3d p = random.point(60) + Eigen::Vector3d(0, 0, 30);
    const NearestPoint fast = model.nearest(p);
    const NearestPoint slow = model.nearest_brute_force(p);
    REQUIRE(std::abs(fast.distance_mm - slow.distance_mm) < 1e-12);  // rounding of a node's box
  }
}

TEST_CASE("a walk over a face leads to the triangle that the point is over", "[property]") {
  const CollisionModel model = model_of(testing::cylinder(6.0, 20.0, 26));
  const auto is_over = [&](std::uint32_t triangle, const Eigen::Vector3d& p) {
    const dowel::ModelTriangle& t = model.triangles()[triangle];
    for (std::size_t i = 0; i < 3; ++i) {
      const Eigen::Vector3d edge = t.corners[(i + 1) % 3] - t.corners[i];
      if (edge.cross(t.normal).dot(p - t.corners[i]) > 1e-9) return false;
    }
    return true;
  };
  testing::RandomGeometry random(7);
  int walks = 0;
  int moved = 0;
  int arrived = 0;
  while (walks < kNearest) {  // steps of a slide over the top
    const Eigen::Vector3d from(random.uniform(-6, 6), random.uniform(-6, 6), 20.0);
    const Eigen::Vector3d to = from + random.point(1.0).cwiseProduct(Eigen::Vector3d(1, 1, 0));
    if (std::max(from.head<2>().norm(), to.head<2>().norm()) > 5.9) continue;
    ++walks;
    const std::uint32_t start = model.nearest(from).triangle;
    const auto [end, ends_over] = model.walk_towards(start, to);
    REQUIRE(model.triangles()[end].face == model.triangles()[start].face);
    moved += is_over(start, to) ? 0 : 1;
    REQUIRE((!ends_over || is_over(end, to)));
    arrived += ends_over ? 1 : 0;
  }
  CHECK(moved > walks / 10);
  CHECK(arrived > walks - walks / 100);
}

TEST_CASE("a triangle without area is near where its edge is, and not along its line") {
  FacetedSolid solid = testing::box({10, 10, 10});
  // The other side of the first triangle's first edge goes over the edge's middle, and a triangle
  // without area closes the gap, as meshers do it.
  const dowel::Triangle first = solid.triangles[0];
  const auto has_edge = [&](const dowel::Triangle& t, std::size_t i) {
    return t[i] == first[1] && t[(i + 1) % 3] == first[0];
  };
  const Eigen::Vector3d a = solid.vertices[first[0]];
  const Eigen::Vector3d b = solid.vertices[first[1]];
  const auto middle = static_cast<std::uint32_t>(solid.vertices.size());
  solid.vertices.emplace_back(0.5 * (a + b));
  const std::size_t count = solid.triangles.size();
  for (std::size_t t = 1; t < count; ++t) {
    const dowel::Triangle other = solid.triangles[t];
    for (std::size_t i = 0; i < 3; ++i) {
      if (!has_edge(other, i)) continue;
      solid.triangles[t] = {first[1], middle, other[(i + 2) % 3]};
      solid.triangles.push_back({middle, first[0], other[(i + 2) % 3]});
      solid.face_of.push_back(solid.face_of[t]);
    }
  }
  solid.triangles.push_back({first[1], first[0], middle});
  solid.face_of.push_back(solid.face_of[0]);
  REQUIRE(solid.triangles.size() == count + 2);
  const CollisionModel model = model_of(solid);
  for (const double beyond : {-0.25, 0.25, 0.5, 1.0, 1.5, 7.0}) {
    const Eigen::Vector3d p = a + beyond * (b - a);
    CAPTURE(p.transpose());
    const double outside = (p.cwiseAbs().array() - 5.0).cwiseMax(0.0).matrix().norm();
    CHECK(model.nearest(p).distance_mm == Approx(outside).margin(1e-12));
    CHECK(model.nearest_brute_force(p).distance_mm == Approx(outside).margin(1e-12));
  }
}

TEST_CASE("the nearest place within a radius is the nearest one where that is near enough",
          "[property]") {
  const CollisionModel model =
      model_of(testing::plate_with_holes({60, 40, 20}, testing::hole_grid(3, 2, 18, 5.0), 20));
  testing::RandomGeometry random(9);
  int found = 0;
  for (int i = 0; i < kNearest; ++i) {
    const Eigen::Vector3d p = random.point(35);
    const double radius_mm = std::pow(10.0, random.uniform(-2.0, 1.3));
    const NearestPoint all = model.nearest(p);
    const auto within = model.nearest_within(p, radius_mm);
    REQUIRE(within.has_value() == (all.distance_mm < radius_mm));
    if (!within) continue;
    REQUIRE(within->distance_mm == all.distance_mm);
    REQUIRE(within->inside == all.inside);
    ++found;
  }
  CHECK(found > kNearest / 10);
  CHECK(found < kNearest * 9 / 10);
}

TEST_CASE("what a ray leaves and enters agrees with the winding number", "[property]") {
  const FacetedSolid plate =
      testing::plate_with_holes({60, 40, 20}, testing::hole_grid(3, 2, 18, 5.0), 12);
  // Two solids of one element, partly in each other, and a part with a cavity.
  const FacetedSolid block = testing::box({24, 20, 16}, {5, 4, 12});
  const std::array<FacetedSolid, 3> solids{
      plate, testing::merged(plate, block),
      testing::hollowed(testing::box({50, 50, 50}), testing::cylinder(12, 18, 16))};
  const FacetedSolid& solid = solids.at(GENERATE(0U, 1U, 2U));
  const CollisionModel model = model_of(solid);
  testing::RandomGeometry random(8);
  int inside = 0;
  int judged = 0;
  for (int i = 0; i < kNearest / 2; ++i) {
    Eigen::Vector3d p = random.point(32);
    if (i % 4 == 0)
      p = {std::round(p.x()), std::round(p.y()), std::round(p.z())};  // on edges, planes
    if (i % 4 == 1) {  // hardly off a corner, where this is asked
      const auto& corners = solid.vertices;
      p = corners[random.index(static_cast<std::uint32_t>(corners.size()))] + random.point(1e-3);
    }
    const double winding = model.winding_number(p);
    if (std::abs(winding - std::round(winding)) > 1e-6) continue;  // on the surface
    REQUIRE(model.facets_contain(p) == (winding > 0.5));
    inside += winding > 0.5 ? 1 : 0;
    ++judged;
  }
  CHECK(judged > kNearest / 3);
  CHECK(inside > judged / 20);
}

TEST_CASE("each component has a point deep inside it, and a cavity has none") {
  const CollisionModel two = model_of(testing::merged(
      testing::box({10, 20, 30}),
      testing::transformed(dowel::Pose::from_translation({100, 0, 0}), testing::sphere(8, 24))));
  REQUIRE(two.inner_points().size() == 2);
  for (const auto& inner : two.inner_points()) CHECK(inner.depth_mm > 3.0);
  const CollisionModel hollow =
      model_of(testing::hollowed(testing::box({30, 30, 30}), testing::box({20, 20, 20})));
  for (const auto& inner : hollow.inner_points()) {
    CHECK(inner.depth_mm > 1.0);
    CHECK(inner.depth_mm < 5.0 + 1e-9);
    CHECK(inner.point.cwiseAbs().maxCoeff() > 10.0);
  }
}

TEST_CASE("an open mesh is refused") {
  FacetedSolid open = testing::box({1, 1, 1});
  open.triangles.pop_back();
  open.face_of.pop_back();
  CHECK_THROWS_AS(model_of(open), dowel::Error);
}

TEST_CASE("a point by the wall where two solids of one element touch is inside") {
  // A pin in its bore, without play, and a block beside the plate.
  const CollisionModel model = model_of(
      testing::merged(testing::merged(testing::plate_with_holes({40, 40, 20}, {{0, 0, 6.0}}, 16),
                                      testing::cylinder(6.0, 20.0, 21, 0.1)),
                      testing::transformed(dowel::Pose::from_translation({25, 0, 10}),
                                           testing::box({10, 36, 20}))));
  testing::RandomGeometry random(62);
  for (int i = 0; i < 2'000; ++i) {
    const double angle = random.uniform(0.0, 6.3);
    const double off_mm = random.uniform(-1.0, 1.0);
    const double z = random.uniform(2.0, 18.0);
    const Eigen::Vector3d by_bore((6.0 + off_mm) * std::cos(angle),
                                  (6.0 + off_mm) * std::sin(angle), z);
    const Eigen::Vector3d by_block(20.0 + off_mm, random.uniform(-15.0, 15.0), z);
    for (const Eigen::Vector3d& p : {by_bore, by_block}) {
      CAPTURE(i, off_mm, p.transpose());
      const auto near = model.nearest(p);
      REQUIRE(near.inside);
      REQUIRE(near.distance_mm == Approx(std::abs(off_mm)).margin(2e-9));
    }
  }
}
