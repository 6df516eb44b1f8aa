#include "dowel/kernel/convex_hull.h"

#include <algorithm>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include <catch2/catch.hpp>

#include "dowel/kernel/predicates.h"
#include "solids.h"

namespace {

using namespace dowel;
using namespace dowel::testing;
using Points = std::vector<Eigen::Vector3d>;

/// What makes a hull a hull, asked of exact predicates: closed, nothing outside, all corners used.
void require_hull(const Points& points, const ConvexHull& hull) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> uses;
  std::set<std::uint32_t> used;
  for (const Triangle& t : hull.triangles) {
    for (std::size_t k = 0; k < 3; ++k) {
      ++uses[{t[k], t[(k + 1) % 3]}];
      used.insert(t[k]);
    }
  }
  for (const auto& [edge, count] : uses) {
    REQUIRE(count == 1);
    REQUIRE(uses.count({edge.second, edge.first}) == 1);
  }
  std::size_t outside = 0;
  std::size_t degenerate = 0;
  for (const Triangle& t : hull.triangles) {
    bool has_depth = false;
    for (const Eigen::Vector3d& p : points) {
      const int side = orient3d(points[t[0]], points[t[1]], points[t[2]], p);
      if (side > 0) ++outside;
      if (side < 0) has_depth = true;
    }
    if (!has_depth) ++degenerate;
  }
  REQUIRE(outside == 0);
  REQUIRE(degenerate == 0);
  REQUIRE(std::is_sorted(hull.vertices.begin(), hull.vertices.end()));
  if (!hull.triangles.empty()) {
    REQUIRE(std::vector<std::uint32_t>(used.begin(), used.end()) == hull.vertices);
    REQUIRE(hull.triangles.size() == 2 * hull.vertices.size() - 4);
  }
}

Points grid(int n, double pitch_mm) {
  Points points;
  for (int x = 0; x < n; ++x) {
    for (int y = 0; y < n; ++y) {
      for (int z = 0; z < n; ++z) points.push_back(pitch_mm * Eigen::Vector3d(x, y, z));
    }
  }
  return points;
}

void shuffle(Points& points, RandomGeometry& random) {
  for (auto i = static_cast<std::uint32_t>(points.size()); i > 1; --i) {
    std::swap(points[i - 1], points[random.index(i)]);
  }
}

/// Triangles by the places of their corners, to compare hulls of shuffled points.
std::vector<std::array<double, 9>> places(const Points& points, const ConvexHull& hull) {
  std::vector<std::array<double, 9>> result;
  for (const Triangle& t : hull.triangles) {
    std::array<double, 9> row{};
    for (std::size_t k = 0; k < 9; ++k) row[k] = points[t[k / 3]][static_cast<int>(k % 3)];
    result.push_back(row);
  }
  return result;
}

}  // namespace

TEST_CASE("the hull of a grid has its eight corners alone", "[degenerate]") {
  for (const double pitch_mm : {1.0, 0.1}) {
    const Points points = grid(10, pitch_mm);
    const ConvexHull hull = convex_hull(points);
    require_hull(points, hull);
    if (pitch_mm == 1.0) CHECK(hull.vertices.size() == 8);
  }
}

TEST_CASE("the hull of random points holds them all", "[property]") {
  const unsigned seed = GENERATE(range(1U, 21U));
  CAPTURE(seed);
  RandomGeometry random(seed);
  const Points points = random.points(4 + random.index(400), 10.0);
  require_hull(points, convex_hull(points));
}

TEST_CASE("the hull of crowded small grids holds them all", "[property][degenerate]") {
  std::size_t flat = 0;
  std::size_t solid = 0;
  for (unsigned seed = 0; seed < 500; ++seed) {
    CAPTURE(seed);
    RandomGeometry random(seed);
    const std::uint32_t range = 1 + random.index(4);
    Points points;
    for (std::uint32_t i = 3 + random.index(60); i > 0; --i) {
      points.emplace_back(random.index(range), random.index(range), random.index(range));
    }
    const ConvexHull hull = convex_hull(points);
    require_hull(points, hull);
    ++(hull.triangles.empty() ? flat : solid);
  }
  CHECK(flat > 50);
  CHECK(solid > 200);
}

TEST_CASE("nearly coplanar points do not upset the hull", "[property][degenerate]") {
  const unsigned seed = GENERATE(range(1U, 11U));
  RandomGeometry random(seed);
  const Pose X = random.pose(2000.0);
  Points points = grid(7, 10.0);
  for (Eigen::Vector3d& p : points) p = X * p;
  const ConvexHull hull = convex_hull(points);
  require_hull(points, hull);
  CHECK(hull.vertices.size() >= 8);
}

TEST_CASE("cospherical points are all extreme", "[degenerate]") {
  const FacetedSolid ball = sphere(50.0, 40);
  const ConvexHull hull = convex_hull(ball.vertices);
  require_hull(ball.vertices, hull);
  CHECK(hull.vertices.size() == ball.vertices.size());
}

TEST_CASE("the order of the points has no say", "[determinism]") {
  RandomGeometry random(8);
  for (Points points : {grid(5, 1.0), random.points(300, 5.0), sphere(5.0, 16).vertices}) {
    points.push_back(points.front());
    const auto expected = places(points, convex_hull(points));
    for (int round = 0; round < 5; ++round) {
      shuffle(points, random);
      REQUIRE(places(points, convex_hull(points)) == expected);
    }
  }
}

TEST_CASE("of equal points the first stands for all") {
  Points points = box({1, 1, 1}).vertices;
  const Points twice = points;
  points.insert(points.end(), twice.begin(), twice.end());
  CHECK(convex_hull(points).vertices == std::vector<std::uint32_t>{0, 1, 2, 3, 4, 5, 6, 7});
}

TEST_CASE("flat input gives its extreme points and no triangles", "[degenerate]") {
  using Indices = std::vector<std::uint32_t>;
  CHECK(convex_hull(Points{}).vertices.empty());
  CHECK(convex_hull(Points{{1, 2, 3}}).vertices == Indices{0});
  CHECK(convex_hull(Points{{1, 2, 3}, {1, 2, 3}}).vertices == Indices{0});
  CHECK(convex_hull(Points{{1, 1, 1}, {0, 0, 0}, {3, 3, 3}, {2, 2, 2}}).vertices == Indices{1, 2});
  const ConvexHull square =
      convex_hull(Points{{0, 0, 0}, {1, 0, 1}, {2, 0, 2}, {2, 2, 2}, {0, 2, 0}, {1, 1, 1}});
  CHECK(square.vertices == Indices{0, 2, 3, 4});
  CHECK(square.triangles.empty());
  // A sliver that rounded cross products call a line.
  const double up = std::nextafter(1.0, 2.0);
  CHECK(convex_hull(Points{{0, 0, 0}, {1, 1, 1}, {2, 2, 2 * up}, {3, 3, 3}}).vertices.size() == 3);
}

TEST_CASE("sixty thousand points are a matter of less than a second") {
  // Time is not measured here; quadratic behaviour would run into the limit of the test.
  const FacetedSolid rod = cylinder(30.0, 100.0, 30000);
  CHECK(convex_hull(rod.vertices).vertices.size() == 60000);
  CHECK(convex_hull(grid(39, 0.5)).vertices.size() == 8);
}

TEST_CASE("numbers that are not finite are refused") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_AS(convex_hull(Points{{0, 0, nan}}), std::logic_error);
}
