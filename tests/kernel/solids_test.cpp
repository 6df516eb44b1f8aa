#include "solids.h"

#include <cmath>
#include <numbers>
#include <string>
#include <utility>

#include <catch2/catch.hpp>

#include "dowel/kernel/mass_properties.h"
#include "dowel/kernel/mesh_defect.h"

namespace {

using namespace dowel;
using namespace dowel::testing;

struct Sample {
  std::string name;
  FacetedSolid solid;
};

std::vector<DrilledHole> mixed_holes() {
  std::vector<DrilledHole> holes = hole_grid(4, 3, 40.0, 6.0);
  holes[1].depth_mm = 10.0;
  holes[2].counterbore_radius_mm = 10.0;
  holes[2].counterbore_depth_mm = 8.0;
  holes[6].counterbore_radius_mm = 9.0;
  holes[6].counterbore_depth_mm = 5.0;
  holes[6].depth_mm = 20.0;
  holes[7].x += 7.0;
  return holes;
}

/// 20 long with round ends of radius 4, one of them with a bore of radius 2.
std::vector<Outline> link() {
  return {{{-6, -4}, {6, -4, std::numbers::pi}, {6, 4}, {-6, 4, std::numbers::pi}},
          reversed(circle({6, 0}, 2.0, 0.3))};
}

/// Radius 5, height 12, with a bead of radius 2 about it and a rounded foot.
Outline beaded_pin() {
  return {{0, 0}, {4, 0, 0.5 * std::numbers::pi}, {5, 1}, {5, 4, std::numbers::pi}, {5, 8}, {5, 12},
          {0, 12}};
}

std::vector<Sample> samples() {
  std::vector<Sample> result{{"box", box({1, 2, 3}, {5, 6, 7})},
                             {"cylinder", cylinder(3.0, 10.0, 64, 0.1)},
                             {"tube", tube(2.0, 3.0, 5.0, 64)},
                             {"cone", cone(3.0, 4.0, 64)},
                             {"pin", stepped_pin({{3.0, 4.0}, {5.0, 2.0}, {2.0, 8.0}}, 48)},
                             {"wedge", wedge(0.3, 10.0, 5.0)},
                             {"sphere", sphere(5.0, 64)},
                             {"link", extruded(link(), 3.0, 40)},
                             {"beaded pin", revolved_outline(beaded_pin(), {.per_turn = 40})},
                             {"plate", plate_with_holes({200, 150, 30}, mixed_holes(), 48)},
                             {"coarse plate", plate_with_holes({200, 150, 30}, mixed_holes(), 5)},
                             {"plain plate", plate_with_holes({200, 150, 30}, {}, 48)},
                             {"hollow", hollowed(box({10, 10, 10}), sphere(3.0, 32))},
                             {"two", merged(box({1, 1, 1}), box({1, 1, 1}, {1, 0, 0.5}))}};
  const std::size_t count = result.size();
  for (std::size_t i = 0; i < count; ++i) {
    result.push_back(
        {"moved " + result[i].name,
         dowel::testing::transformed(RandomGeometry(i).pose(2000.0), result[i].solid)});
  }
  return result;
}

}  // namespace

TEST_CASE("test solids are sound and their facets lie on their faces, outward", "[property]") {
  for (const Sample& sample : samples()) {
    CAPTURE(sample.name);
    const FacetedSolid& solid = sample.solid;
    REQUIRE(find_defect(solid) == std::nullopt);
    std::vector<double> error_mm(solid.faces.size(), 0.0);
    for (std::uint32_t i = 0; i < solid.triangles.size(); ++i) {
      const Face& face = solid.faces[solid.face_of[i]];
      const auto corners = solid.corners(i);
      const Eigen::Vector3d center = (corners[0] + corners[1] + corners[2]) / 3.0;
      for (const Eigen::Vector3d& corner : corners) {
        REQUIRE(std::abs(signed_distance_mm(face.surface, corner)) < 1e-9);
      }
      const Eigen::Vector3d normal =
          (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
      const Eigen::Vector3d outward =
          (face.reversed ? -1.0 : 1.0) * distance_gradient(face.surface, center);
      REQUIRE(normal.dot(outward) > 0.7);
      double& error = error_mm[solid.face_of[i]];
      error = std::max(error, std::abs(signed_distance_mm(face.surface, center)));
    }
    for (std::size_t f = 0; f < solid.faces.size(); ++f) {
      REQUIRE(error_mm[f] <= solid.faces[f].facet_error_mm + 1e-9);
    }
  }
}

TEST_CASE("the facet error of a cylinder is its sagitta") {
  const FacetedSolid solid = cylinder(10.0, 30.0, 32);
  CHECK(solid.faces[1].facet_error_mm == Approx(10.0 * (1.0 - std::cos(std::numbers::pi / 32))));
  CHECK(solid.faces[0].facet_error_mm == 0.0);
}

TEST_CASE("edges of a plate with a counterbore are convex but for the floor's") {
  DrilledHole hole;
  hole.radius_mm = 5.0;
  hole.counterbore_radius_mm = 8.0;
  hole.counterbore_depth_mm = 4.0;
  const FacetedSolid plate = plate_with_holes({60, 60, 20}, {hole}, 32);
  std::size_t concave = 0;
  std::size_t circles = 0;
  for (const Edge& edge : plate.edges) {
    if (edge.convexity == Convexity::Concave) {
      ++concave;
      CHECK(edge.radius_mm == 8.0);
      CHECK(edge.center.z() == 16.0);
    }
    if (edge.curve == CurveKind::Circle) ++circles;
  }
  CHECK(plate.edges.size() == 16);
  CHECK(concave == 1);
  CHECK(circles == 4);
}

TEST_CASE("edges of a link with a bore are lines and arcs, smooth where its ends blend") {
  const FacetedSolid solid = extruded(link(), 3.0, 40);
  std::size_t smooth = 0;
  double arcs_mm = 0.0;
  for (const Edge& edge : solid.edges) {
    if (edge.convexity == Convexity::Smooth) ++smooth;
    if (edge.curve == CurveKind::Circle) arcs_mm += edge.length_mm;
  }
  CHECK(solid.edges.size() == 18);
  CHECK(smooth == 6);  // four where an end begins, two in the bore
  CHECK(arcs_mm == Approx(2 * 12 * std::numbers::pi));
}

TEST_CASE("finer and finer solids reach the volume of the exact ones") {
  const double pi = std::numbers::pi;
  CHECK(mass_properties(cylinder(3, 10, 720)).volume_mm3 == Approx(pi * 90).epsilon(1e-4));
  CHECK(mass_properties(cone(3, 10, 720)).volume_mm3 == Approx(pi * 30).epsilon(1e-4));
  CHECK(mass_properties(sphere(3, 200)).volume_mm3 == Approx(pi * 36).epsilon(1e-3));
  CHECK(mass_properties(extruded(link(), 3.0, 720)).volume_mm3 ==
        Approx(3 * (12 * 8 + 16 * pi - 4 * pi)).epsilon(1e-4));
  // The bead, and the ring that the rounded foot lacks, by Pappus's theorem.
  const double bead = 2 * pi * (5 + 8 / (3 * pi)) * 2 * pi;
  const double lacking = 2 * pi * (4.5 - (4 + 4 / (3 * pi)) * pi / 4);
  CHECK(mass_properties(revolved_outline(beaded_pin(), {.per_turn = 720, .per_arc = 180}))
            .volume_mm3 == Approx(300 * pi + bead - lacking).epsilon(1e-4));
  CHECK(mass_properties(plate_with_holes({100, 80, 10}, hole_grid(2, 2, 40, 5), 720)).volume_mm3 ==
        Approx(80000 - 4 * pi * 250).epsilon(1e-4));
}
