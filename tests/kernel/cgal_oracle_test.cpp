// Hulls, boxes and predicates against CGAL, which shares no code with ours.

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/Polygon_mesh_processing/measure.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/convex_hull_3.h>
#include <catch2/catch.hpp>

#include "cgal_box.h"
#include "dowel/kernel/convex_hull.h"
#include "dowel/kernel/minimum_box.h"
#include "dowel/kernel/predicates.h"
#include "solids.h"

namespace {

using namespace dowel::testing;
using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;
using Points = std::vector<Eigen::Vector3d>;

std::vector<Kernel::Point_3> to_cgal(const Points& points) {
  std::vector<Kernel::Point_3> result;
  for (const Eigen::Vector3d& p : points) result.emplace_back(p.x(), p.y(), p.z());
  return result;
}

double hull_volume_mm3(const Points& points, const dowel::ConvexHull& hull) {
  double volume_mm3 = 0.0;
  const Eigen::Vector3d& origin = points.front();
  for (const dowel::Triangle& t : hull.triangles) {
    volume_mm3 +=
        (points[t[0]] - origin).dot((points[t[1]] - origin).cross(points[t[2]] - origin)) / 6.0;
  }
  return volume_mm3;
}

struct Cloud {
  std::string name;
  Points points;
};

std::vector<Cloud> clouds() {
  RandomGeometry random(21);
  const dowel::Pose X = random.pose(1000.0);
  std::vector<Cloud> result{
      {"wedge", wedge(0.4, 30, 10).vertices},
      {"tube", tube(3, 5, 20, 24).vertices},
      {"cone", dowel::testing::transformed(X, cone(3, 10, 24)).vertices},
      {"plate",
       dowel::testing::transformed(X, plate_with_holes({200, 150, 30}, hole_grid(3, 2, 40, 6), 16))
           .vertices},
      {"ball", sphere(5, 16).vertices},
      {"bracket", prism({{0, 0}, {50, 0}, {50, 10}, {10, 40}, {0, 40}}, 25).vertices},
      {"two", merged(box({10, 20, 30}),
                     dowel::testing::transformed(random.pose(20.0), cylinder(4, 40, 24)))
                  .vertices}};
  for (const std::size_t count : {4U, 5U, 6U, 8U, 12U, 20U, 50U, 200U}) {
    for (int round = 0; round < 3; ++round) {
      Cloud cloud{"random " + std::to_string(count), random.points(count, 10.0)};
      if (round == 2) {
        for (Eigen::Vector3d& p : cloud.points)
          p = p.normalized().cwiseProduct(Eigen::Vector3d(3, 2, 1));
      }
      result.push_back(std::move(cloud));
    }
  }
  return result;
}

}  // namespace

TEST_CASE("hulls have the volume and the corners that CGAL finds", "[property]") {
  for (const Cloud& cloud : clouds()) {
    CAPTURE(cloud.name);
    const std::vector<Kernel::Point_3> points = to_cgal(cloud.points);
    CGAL::Surface_mesh<Kernel::Point_3> mesh;
    CGAL::convex_hull_3(points.begin(), points.end(), mesh);
    const double expected_mm3 = CGAL::Polygon_mesh_processing::volume(mesh);
    const dowel::ConvexHull hull = dowel::convex_hull(cloud.points);
    REQUIRE(hull_volume_mm3(cloud.points, hull) == Approx(expected_mm3).epsilon(1e-12));
    // CGAL may keep points within a facet or an edge; it cannot have fewer.
    REQUIRE(hull.vertices.size() <= mesh.number_of_vertices());
  }
}

TEST_CASE("boxes are within a thousandth of CGAL's or smaller", "[property]") {
  for (const Cloud& cloud : clouds()) {
    CAPTURE(cloud.name);
    REQUIRE(dowel::minimum_box(cloud.points).volume_mm3() <=
            1.001 * cgal_box_volume_mm3(cloud.points));
  }
}

TEST_CASE("orient3d agrees with CGAL where differences round", "[property]") {
  RandomGeometry random(5);
  std::array<std::size_t, 3> counts{};
  for (int round = 0; round < 20000; ++round) {
    // Four points of a rotated plane far from the origin: rounding alone decides.
    const Eigen::Vector3d origin = random.point(round % 2 == 0 ? 1e5 : 1.0);
    const Eigen::Vector3d u = random.direction();
    const Eigen::Vector3d v = u.unitOrthogonal();
    std::array<Eigen::Vector3d, 4> p;
    for (Eigen::Vector3d& q : p) {
      q = origin + random.uniform(-9, 9) * u + random.uniform(-9, 9) * v;
    }
    if (round % 5 == 0) p[3] = 0.5 * (p[0] + p[1]);
    const std::vector<Kernel::Point_3> c = to_cgal({p.begin(), p.end()});
    const int expected = static_cast<int>(CGAL::orientation(c[0], c[1], c[2], c[3]));
    ++counts[static_cast<std::size_t>(expected + 1)];
    REQUIRE(dowel::orient3d(p[0], p[1], p[2], p[3]) == expected);
  }
  CHECK(counts[0] > 1000);
  CHECK(counts[1] > 100);
  CHECK(counts[2] > 1000);
}
