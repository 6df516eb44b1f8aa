// Pairs of triangles against CGAL: its exact predicate of intersection and its distance.

#include <array>
#include <cmath>

#include <CGAL/Exact_predicates_inexact_constructions_kernel.h>
#include <CGAL/squared_distance_3.h>
#include <catch2/catch.hpp>

#include "facet_pairs.h"
#include "random_geometry.h"
#include "triangle_pair.h"

using dowel::Corners;
namespace testing = dowel::testing;

namespace {

using Kernel = CGAL::Exact_predicates_inexact_constructions_kernel;

#ifdef DOWEL_SANITIZED
constexpr int kPairs = 5'000;
#else
constexpr int kPairs = 200'000;
#endif

constexpr double kReach_mm = 10.0;
/// Of coordinates of 10 mm; normals of the thinnest triangles here are off by some 1e-13.
constexpr double kRounding_mm = 1.0e-10;

Kernel::Point_3 to_cgal(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

Kernel::Triangle_3 to_cgal(const Corners& t) {
  return {to_cgal(t[0]), to_cgal(t[1]), to_cgal(t[2])};
}

Eigen::Vector3d normal_of(const Corners& t) {
  return (t[1] - t[0]).cross(t[2] - t[0]).normalized();
}

Eigen::Vector3d rounded(const Eigen::Vector3d& p) {
  return p.array().round().matrix();
}

/// Of any shape; slivers; on a lattice, where pairs share planes, edges and corners.
Corners random_triangle(testing::RandomGeometry& random, bool on_lattice) {
  while (true) {
    const double reach_mm = on_lattice ? 3.0 : kReach_mm;
    Corners t{random.point(reach_mm), random.point(reach_mm), random.point(reach_mm)};
    if (!on_lattice && random.index(8) == 0) {
      t[2] = t[0] + random.uniform(-0.5, 1.5) * (t[1] - t[0]) + random.point(0.01);
    }
    if (on_lattice) t = {rounded(t[0]), rounded(t[1]), rounded(t[2])};
    const double longest = std::max((t[1] - t[0]).norm(), (t[2] - t[0]).norm());
    if ((t[1] - t[0]).cross(t[2] - t[0]).norm() > 1e-4 * longest * longest) return t;
  }
}

struct TrianglePair {
  Corners a;
  Corners b;
};

/// Anywhere; beside each other in one plane, or nearly; on a lattice.
TrianglePair random_pair(testing::RandomGeometry& random) {
  const std::uint32_t kind = random.index(4);
  TrianglePair pair{random_triangle(random, kind == 0), random_triangle(random, kind == 0)};
  if (kind == 1) {
    const Eigen::Vector3d normal = normal_of(pair.a);
    const double height_mm = random.coin() ? 0.0 : random.uniform(-0.02, 0.02);
    for (Eigen::Vector3d& p : pair.b) p += (height_mm - normal.dot(p - pair.a[0])) * normal;
    const double doubled_area = (pair.b[1] - pair.b[0]).cross(pair.b[2] - pair.b[0]).norm();
    if (doubled_area < 1e-2) return random_pair(random);
  }
  return pair;
}

double distance_mm(const Corners& t, const Eigen::Vector3d& p) {
  return std::sqrt(CGAL::squared_distance(to_cgal(t), to_cgal(p)));
}

}  // namespace

TEST_CASE("two triangles cross, and are as far apart, as CGAL says", "[property]") {
  testing::RandomGeometry random(61);
  int crossing = 0;
  int borderline = 0;
  for (int i = 0; i < kPairs; ++i) {
    const auto [a, b] = random_pair(random);
    const Eigen::Vector3d normal_a = normal_of(a);
    const Eigen::Vector3d normal_b = normal_of(b);
    const bool meet = CGAL::do_intersect(to_cgal(a), to_cgal(b));
    const double truth_mm = meet ? 0.0 : std::sqrt(CGAL::squared_distance(to_cgal(a), to_cgal(b)));
    const auto closest = dowel::closest_points(a, normal_a, b, normal_b);
    // The two places prove that the triangles are no further apart, CGAL that they are no closer.
    const double said_mm = (closest.on_a - closest.on_b).norm();
    CAPTURE(i, meet, truth_mm, said_mm);
    REQUIRE(distance_mm(a, closest.on_a) < kRounding_mm);
    REQUIRE(distance_mm(b, closest.on_b) < kRounding_mm);
    REQUIRE(said_mm <= truth_mm + kRounding_mm);
    REQUIRE(std::sqrt(closest.distance_squared_mm2) == Approx(said_mm).margin(kRounding_mm));
    const auto segment = dowel::crossing_segment(a, normal_a, b, normal_b);
    if (segment.has_value() != meet) {
      REQUIRE(said_mm < kRounding_mm);  // an edge or a corner, or all of it, in the other's plane
      ++borderline;
    }
    if (!segment) continue;
    ++crossing;
    for (const Eigen::Vector3d& end : {segment->start, segment->end}) {
      REQUIRE(distance_mm(a, end) < kRounding_mm);
      REQUIRE(distance_mm(b, end) < kRounding_mm);
    }
  }
  CAPTURE(crossing, borderline);
  CHECK(crossing > kPairs / 20);
  CHECK(crossing < kPairs / 2);
  CHECK(borderline < kPairs / 5);
}

TEST_CASE("what rejects pairs of triangles is never further than they are", "[property]") {
  testing::RandomGeometry random(62);
  int tight = 0;
  for (int i = 0; i < kPairs; ++i) {
    const auto [a, b] = random_pair(random);
    dowel::ModelTriangle model_a;
    dowel::ModelTriangle model_b;
    model_a.corners = a;
    model_a.normal = normal_of(a);
    model_b.corners = b;
    model_b.normal = normal_of(b);
    const double truth_mm = std::sqrt(CGAL::squared_distance(to_cgal(a), to_cgal(b)));
    const double bound_mm = std::max(
        {dowel::apart_by_planes(model_a, {a, model_a.normal}, model_b), dowel::box_gap(a, b),
         dowel::beyond_edges(a, model_a.normal, b), dowel::beyond_edges(b, model_b.normal, a)});
    CAPTURE(i, truth_mm, bound_mm);
    REQUIRE(bound_mm <= truth_mm + kRounding_mm);
    tight += truth_mm > 0.1 && bound_mm > 0.9 * truth_mm ? 1 : 0;
  }
  CHECK(tight > kPairs / 10);
}
