#include "dowel/kernel/mesh_defect.h"

#include <limits>
#include <numbers>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>

#include <catch2/catch.hpp>

#include "dowel/kernel/mass_properties.h"
#include "dowel/kernel/tolerance.h"
#include "outline.h"
#include "outlined_solids.h"
#include "solids.h"

namespace {

using namespace dowel;
using namespace dowel::testing;

/// Three vertices of its own for each triangle, as in an STL file.
FacetedSolid exploded(const FacetedSolid& solid) {
  FacetedSolid result = solid;
  result.vertices.clear();
  for (std::uint32_t i = 0; i < solid.triangles.size(); ++i) {
    const auto first = static_cast<std::uint32_t>(result.vertices.size());
    for (const Eigen::Vector3d& corner : solid.corners(i)) result.vertices.push_back(corner);
    result.triangles[i] = {first, first + 1, first + 2};
  }
  return result;
}

std::string defect_of(const FacetedSolid& solid) {
  return find_defect(solid).value_or("none");
}

}  // namespace

TEST_CASE("a fillet that is smaller than its facets are off is no defect, but inside out") {
  // The chords of an eighth of a turn are 0.76 mm off the rim, beyond the axis of the tube.
  constexpr double kQuarterTurn = 0.5 * std::numbers::pi;
  const Outline low = {{0, 0}, {9.5, 0, kQuarterTurn}, {10, 0.5}, {10, 20}, {0, 20}};
  const Outline high = {{0, 0}, {10, 0}, {10, 19.5, kQuarterTurn}, {9.5, 20}, {0, 20}};
  for (const Outline& outline : {low, high}) {
    Facets facets;
    facets.per_turn = 8;
    FacetedSolid pin = revolved_outline(outline, facets);
    CHECK(defect_of(pin) == "none");
    for (Face& face : pin.faces) {
      if (std::holds_alternative<TorusSurface>(face.surface)) face.reversed = !face.reversed;
    }
    CHECK_THAT(defect_of(pin), Catch::Contains("outside where its triangles have their inside"));
  }
}

TEST_CASE("each defect is named with its place") {
  using Catch::Contains;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  FacetedSolid s = box({2, 2, 2});
  REQUIRE(defect_of(s) == "none");
  SECTION("nothing") {
    CHECK_THAT(defect_of(FacetedSolid()), Contains("no triangles"));
  }
  SECTION("open") {
    s.triangles.pop_back();
    s.face_of.pop_back();
    CHECK_THAT(defect_of(s), Contains("is used by 1 triangle, expected 2: the mesh is open"));
  }
  SECTION("three at an edge") {
    s.vertices.push_back({5, 5, 5});
    s.triangles.push_back({s.triangles[0][0], s.triangles[0][1], 8});
    s.face_of.push_back(0);
    CHECK_THAT(defect_of(s), Contains("used by 3 triangles"));
  }
  SECTION("one triangle turned") {
    std::swap(s.triangles[3][0], s.triangles[3][1]);
    CHECK_THAT(defect_of(s), Contains("disagree on which side is outside"));
  }
  SECTION("inside out") {
    CHECK_THAT(defect_of(inverted(s)), Contains("solid 0 encloses -8"));
  }
  SECTION("one of two inside out") {
    CHECK_THAT(defect_of(merged(s, inverted(box({1, 1, 1}, {9, 9, 9})))),
               Contains("solid 1 encloses -1"));
  }
  SECTION("double vertex") {
    s.vertices.push_back(s.vertices[3]);
    CHECK_THAT(defect_of(s), Contains("vertices 3 and 8"));
  }
  SECTION("zero of either sign is one place") {
    s.vertices.push_back({0.0, 5.0, 5.0});
    s.vertices.push_back({-0.0, 5.0, 5.0});
    CHECK_THAT(defect_of(s), Contains("vertices 8 and 9"));
  }
  SECTION("not finite") {
    s.vertices[4].y() = nan;
    CHECK_THAT(defect_of(s), Contains("vertex 4 is not finite"));
  }
  SECTION("far away") {
    s.vertices[4].y() = 2.0 * kMaxCoordinate_mm;
    CHECK_THAT(defect_of(s), Contains("vertex 4 is more than 100000 mm"));
  }
  SECTION("index of a vertex") {
    s.triangles[5][1] = 8;
    CHECK_THAT(defect_of(s), Contains("triangle 5 names vertex 8 of 8"));
  }
  SECTION("equal vertices") {
    s.triangles[5][1] = s.triangles[5][0];
    CHECK_THAT(defect_of(s), Contains("triangle 5 has two equal vertices"));
  }
  SECTION("index of a face") {
    s.face_of[5] = 6;
    CHECK_THAT(defect_of(s), Contains("triangle 5 names face 6 of 6"));
  }
  SECTION("missing face index") {
    s.face_of.pop_back();
    CHECK_THAT(defect_of(s), Contains("12 triangles have 11 face indices"));
  }
  SECTION("index of a solid") {
    s.faces[2].solid = 1;
    CHECK_THAT(defect_of(s), Contains("face 2 names solid 1 of 1"));
  }
  SECTION("more solids than faces") {
    s.solid_count = 4000000000U;
    CHECK_THAT(defect_of(s), Contains("4000000000 solids have 6 faces"));
  }
  SECTION("a face of another solid") {
    s.solid_count = 2;
    s.faces[2].solid = 1;
    CHECK_THAT(defect_of(s), Contains("shared by two solids"));
  }
  SECTION("surfaces") {
    s.faces[1].surface = CylinderSurface{{0, 0, 0}, {0, 0, 1}, 0.0};
    CHECK_THAT(defect_of(s), Contains("face 1 lies on a cylinder without a positive radius"));
    s.faces[1].surface = PlaneSurface{{0, 0, 0}, {0, 0, 0.9}};
    CHECK_THAT(defect_of(s), Contains("whose normal is not of unit length"));
    s.faces[1].surface = ConeSurface{{0, nan, 0}, {0, 0, 1}, 0.4};
    CHECK_THAT(defect_of(s), Contains("a cone without a finite apex"));
    s.faces[1].surface = ConeSurface{{0, 0, 0}, {0, 0, 1}, 1.6};
    CHECK_THAT(defect_of(s), Contains("half angle"));
    s.faces[1].surface = TorusSurface{{0, 0, 0}, {0, 0, 1}, 1.0, 2.0};
    CHECK_THAT(defect_of(s), Contains("minor < major"));
  }
  SECTION("measures") {
    s.faces[1].area_mm2 = nan;
    CHECK_THAT(defect_of(s), Contains("face 1 has no finite area"));
    s.faces[1].area_mm2 = 0.0;
    s.faces[1].facet_error_mm = -1.0;
    CHECK_THAT(defect_of(s), Contains("face 1 has no finite facet error"));
  }
  SECTION("edges") {
    s.edges[3].faces = {2, 2};
    CHECK_THAT(defect_of(s), Contains("face edge 3 is between faces 2 and 2"));
    s.edges[3].faces = {2, 3};
    s.edges[3].end.x() = nan;
    CHECK_THAT(defect_of(s), Contains("face edge 3 is not finite"));
    s.edges[3].end.x() = 0.0;
    s.edges[3].curve = CurveKind::Circle;
    CHECK_THAT(defect_of(s), Contains("face edge 3 has no sound axis"));
  }
}

TEST_CASE("welding an exploded mesh brings the solid back", "[property]") {
  const FacetedSolid part = plate_with_holes({200, 150, 30}, hole_grid(3, 2, 40, 6), 24);
  FacetedSolid loose = exploded(part);
  REQUIRE(find_defect(loose).has_value());
  weld(loose);
  CHECK(find_defect(loose) == std::nullopt);
  CHECK(loose.vertices.size() == part.vertices.size());
  CHECK(loose.triangles.size() == part.triangles.size());
  CHECK(loose.face_of == part.face_of);
  CHECK(mass_properties(loose).volume_mm3 == Approx(mass_properties(part).volume_mm3));
}

TEST_CASE("welding drops what collapses and keeps the order of the rest") {
  FacetedSolid s;
  s.solid_count = 1;
  s.faces.resize(3);
  s.vertices = {{9, 9, 9}, {0, 0, 0}, {1, 0, 0}, {-0.0, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  s.triangles = {{1, 2, 4}, {1, 3, 5}, {3, 5, 4}};
  s.face_of = {2, 1, 0};
  weld(s);
  CHECK(s.vertices.size() == 4);
  CHECK(s.triangles == std::vector<Triangle>{{0, 1, 2}, {0, 3, 2}});
  CHECK(s.face_of == std::vector<std::uint32_t>{2, 0});
  CHECK(s.faces.size() == 3);
}

TEST_CASE("welding survives numbers that are not finite and refuses bad indices", "[degenerate]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  FacetedSolid s = box({1, 1, 1});
  for (Eigen::Vector3d& v : s.vertices) v.x() = nan;
  weld(s);
  CHECK(find_defect(s).has_value());
  s = box({1, 1, 1});
  s.triangles[0][0] = 99;
  CHECK_THROWS_AS(weld(s), std::logic_error);
  FacetedSolid none;
  weld(none);
  CHECK(none.vertices.empty());
}

TEST_CASE("inside-out components are turned with their faces and edges", "[property]") {
  const FacetedSolid part = plate_with_holes({200, 150, 30}, hole_grid(2, 2, 40, 6), 24);
  FacetedSolid turned = inverted(part);
  orient_outward(turned);
  CHECK(find_defect(turned) == std::nullopt);
  for (std::size_t f = 0; f < part.faces.size(); ++f) {
    REQUIRE(turned.faces[f].reversed == part.faces[f].reversed);
    if (const auto* plane = std::get_if<PlaneSurface>(&part.faces[f].surface)) {
      REQUIRE(std::get<PlaneSurface>(turned.faces[f].surface).normal == plane->normal);
    }
  }
  for (std::size_t e = 0; e < part.edges.size(); ++e) {
    REQUIRE(turned.edges[e].convexity == part.edges[e].convexity);
  }
}

TEST_CASE("a right part stays as it is, to the last index") {
  const FacetedSolid part = hollowed(box({10, 10, 10}), sphere(3, 16));
  FacetedSolid same = part;
  orient_outward(same);
  CHECK(same.triangles == part.triangles);
}

TEST_CASE("cavities stay cavities, whichever way the file had them") {
  const FacetedSolid hollow = hollowed(box({10, 10, 10}), sphere(3, 16));
  const double volume_mm3 = mass_properties(hollow).volume_mm3;
  FacetedSolid all_turned = inverted(hollow);
  orient_outward(all_turned);
  CHECK(mass_properties(all_turned).volume_mm3 == Approx(volume_mm3));

  FacetedSolid outer_turned = hollowed(inverted(box({10, 10, 10})), sphere(3, 16));
  orient_outward(outer_turned);
  CHECK(mass_properties(outer_turned).volume_mm3 == Approx(volume_mm3));
}

TEST_CASE("one solid inside another is no cavity of it") {
  FacetedSolid nested = merged(box({10, 10, 10}), inverted(box({2, 2, 2})));
  orient_outward(nested);
  CHECK(find_defect(nested) == std::nullopt);
  CHECK(mass_properties(nested).volume_mm3 == Approx(1008.0));
}

TEST_CASE("open components are left alone") {
  FacetedSolid open = inverted(box({2, 2, 2}));
  open.triangles.pop_back();
  open.face_of.pop_back();
  const std::vector<Triangle> before = open.triangles;
  orient_outward(open);
  CHECK(open.triangles == before);
  FacetedSolid none;
  orient_outward(none);
  CHECK(none.triangles.empty());
}
