#include "dowel/kernel/minimum_box.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

#include <catch2/catch.hpp>

#include "solids.h"

namespace {

using namespace dowel;
using namespace dowel::testing;
using Points = std::vector<Eigen::Vector3d>;

void require_box_around(const Points& points, const Obb& box) {
  REQUIRE((box.axes.transpose() * box.axes - Eigen::Matrix3d::Identity()).norm() < 1e-14);
  REQUIRE(box.axes.determinant() > 0.0);
  double most = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : points) most = std::max(most, box.face_distance_mm(p));
  REQUIRE(most <= 0.0);
}

Eigen::Vector3d sorted_extents(const Obb& box) {
  Eigen::Vector3d e = box.half_extents_mm;
  std::sort(e.begin(), e.end());
  return e;
}

}  // namespace

TEST_CASE("the box of a box is itself, with the axes of the coordinates") {
  const Obb box = minimum_box(dowel::testing::box({2, 4, 6}, {10, 20, 30}).vertices);
  CHECK(box.axes == Eigen::Matrix3d::Identity());
  CHECK(box.center == Eigen::Vector3d(10, 20, 30));
  CHECK(box.half_extents_mm == Eigen::Vector3d(1, 2, 3));
}

TEST_CASE("parts have the same box wherever they lie", "[property]") {
  const std::vector<std::pair<FacetedSolid, Eigen::Vector3d>> parts{
      {dowel::testing::box({10, 20, 30}), {5, 10, 15}},
      {plate_with_holes({300, 200, 30}, hole_grid(4, 3, 40, 6), 32), {15, 100, 150}},
      {cylinder(3, 40, 64),
       {3 * std::cos(std::numbers::pi / 64), 3 * std::cos(std::numbers::pi / 64), 20}},
      {stepped_pin({{8, 10}, {3, 20}}, 48),
       {8 * std::cos(std::numbers::pi / 48), 8 * std::cos(std::numbers::pi / 48), 15}}};
  RandomGeometry random(6);
  for (const auto& [part, half_extents_mm] : parts) {
    for (int round = 0; round < 5; ++round) {
      const Points points = dowel::testing::transformed(random.pose(5000.0), part).vertices;
      const Obb box = minimum_box(points);
      require_box_around(points, box);
      REQUIRE((sorted_extents(box) - half_extents_mm).norm() < 1e-8);
    }
  }
}

TEST_CASE("a box may touch by edges alone") {
  // A tetrahedron stands in its cube; no face of the best box of an octahedron is flush.
  const Points tetrahedron{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
  CHECK(minimum_box(tetrahedron).volume_mm3() == Approx(8.0));
  const Points octahedron{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  CHECK(minimum_box(octahedron).volume_mm3() == Approx(64.0 / 27.0).epsilon(1e-5));
}

TEST_CASE("flat, linear and single points have boxes without volume", "[degenerate]") {
  const Obb one = minimum_box(Points{{1, 2, 3}, {1, 2, 3}});
  CHECK(one.center == Eigen::Vector3d(1, 2, 3));
  CHECK(one.half_extents_mm == Eigen::Vector3d::Zero());

  const Points line{{0, 5, 5}, {4, 5, 5}, {1, 5, 5}};
  require_box_around(line, minimum_box(line));
  CHECK(minimum_box(line).half_extents_mm == Eigen::Vector3d(2, 0, 0));

  const Points level{{0, 0, 7}, {4, 0, 7}, {4, 2, 7}, {0, 2, 7}, {1, 1, 7}};
  CHECK(minimum_box(level).half_extents_mm == Eigen::Vector3d(2, 1, 0));
  CHECK(minimum_box(level).axes == Eigen::Matrix3d::Identity());

  const Points oblique{{0, 0, 0}, {3, 0, 3}, {3, 5, 3}, {0, 5, 0}};
  require_box_around(oblique, minimum_box(oblique));
  CHECK((sorted_extents(minimum_box(oblique)) - Eigen::Vector3d(0, 1.5 * std::sqrt(2.0), 2.5))
            .norm() < 1e-14);
}

TEST_CASE("random points are inside, in whatever order they come", "[property][determinism]") {
  const unsigned seed = GENERATE(range(1U, 11U));
  CAPTURE(seed);
  RandomGeometry random(seed);
  Points points = random.points(4 + random.index(60), 10.0);
  const Obb box = minimum_box(points);
  require_box_around(points, box);
  std::reverse(points.begin(), points.end());
  points.push_back(points[1]);
  const Obb again = minimum_box(points);
  CHECK(again.axes == box.axes);
  CHECK(again.center == box.center);
  CHECK(again.half_extents_mm == box.half_extents_mm);
}

TEST_CASE("large curved bodies get a tight box with bounded effort") {
  FacetedSolid ellipsoid = sphere(50.0, 160);
  for (Eigen::Vector3d& p : ellipsoid.vertices) p = p.cwiseProduct(Eigen::Vector3d(1, 1.5, 0.7));
  const Obb box = minimum_box(ellipsoid.vertices);
  require_box_around(ellipsoid.vertices, box);
  CHECK(box.volume_mm3() <= 8.0 * 50.0 * 75.0 * 35.0 * 1.0001);
}

TEST_CASE("no points have no box") {
  CHECK_THROWS_AS(minimum_box(Points{}), std::logic_error);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(minimum_box(Points{{0, 0, nan}}), std::logic_error);
}
