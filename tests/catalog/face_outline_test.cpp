#include "dowel/catalog/face_outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/catalog/recognition.h"
#include "dowel/kernel/tolerance.h"
#include "plate_with_holes.h"
#include "solids.h"
#include "variants.h"

using namespace dowel;

namespace {

using Eigen::Vector3d;
using Type = OutlineEdge::Type;

struct OutlinedFace {
  Feature face;
  FaceOutline outline;
};

std::vector<OutlinedFace> outlined_faces(const FacetedSolid& solid) {
  const std::vector<Feature> features = recognise_features(solid);
  const std::vector<FaceOutline> outlines = face_outlines(solid, features);
  std::vector<OutlinedFace> faces;
  for (const Feature& feature : features) {
    if (feature.kind == FeatureKind::Face) faces.push_back({feature, {}});
  }
  REQUIRE(faces.size() == outlines.size());
  for (std::size_t i = 0; i < faces.size(); ++i) faces[i].outline = outlines[i];
  return faces;
}

OutlinedFace face_called(const FacetedSolid& solid, const std::string& name) {
  const std::vector<OutlinedFace> faces = outlined_faces(solid);
  const auto found = std::ranges::find_if(
      faces, [&name](const OutlinedFace& outlined) { return outlined.face.name == name; });
  REQUIRE(found != faces.end());
  return *found;
}

void check_point(const Vector3d& found, const Vector3d& expected) {
  CHECK((found - expected).norm() < 1e-9);
}

/// 120 x 80 x 30 with a through hole, a blind one and a counterbored one in its top.
FacetedSolid drilled_plate() {
  return testing::plate_with_holes({120.0, 80.0, 30.0},
                                   {{-45.0, -20.0, 6.0, 0.0, 0.0, 0.0},
                                    {-15.0, -20.0, 5.0, 18.0, 0.0, 0.0},
                                    {15.0, -20.0, 4.5, 0.0, 7.5, 8.0}},
                                   24);
}

}  // namespace

TEST_CASE("the outline of a drilled face is its rectangle, and a circle for each hole") {
  const OutlinedFace top = face_called(drilled_plate(), "top");
  const OutlineLoop& outer = top.outline.outer;
  REQUIRE(outer.size() == 4);
  const std::vector<Vector3d> corners{
      {-60.0, -40.0, 30.0}, {60.0, -40.0, 30.0}, {60.0, 40.0, 30.0}, {-60.0, 40.0, 30.0}};
  for (std::size_t i = 0; i < 4; ++i) {
    CHECK(outer[i].type == Type::Line);
    check_point(outer[i].from, corners[i]);
    check_point(outer[i].to, corners[(i + 1) % 4]);
  }
  REQUIRE(top.outline.inner.size() == 3);
  const std::vector<std::pair<double, double>> holes{{-45.0, 6.0}, {-15.0, 5.0}, {15.0, 7.5}};
  for (std::size_t i = 0; i < holes.size(); ++i) {
    REQUIRE(top.outline.inner[i].size() == 1);
    const OutlineEdge& circle = top.outline.inner[i].front();
    CHECK(circle.type == Type::Arc);
    check_point(circle.center, {holes[i].first, -20.0, 30.0});
    CHECK(circle.radius_mm == Approx(holes[i].second).margin(1e-9));
    CHECK(circle.turn_rad == Approx(-2.0 * std::numbers::pi));
    check_point(circle.from, circle.to);
  }
  CHECK(face_called(drilled_plate(), "bottom").outline.inner.size() == 2);
  CHECK(face_called(drilled_plate(), "right").outline.inner.empty());
}

TEST_CASE("the end of a cylinder is bounded by one circle") {
  const OutlinedFace top = face_called(testing::cylinder(10.0, 40.0, 32, 0.3), "top");
  REQUIRE(top.outline.outer.size() == 1);
  CHECK(top.outline.outer[0].type == Type::Arc);
  CHECK(top.outline.outer[0].radius_mm == Approx(10.0).margin(1e-9));
  CHECK(top.outline.outer[0].turn_rad == Approx(2.0 * std::numbers::pi));
  CHECK(top.outline.on_hull);
}

TEST_CASE("what is between the loops is the area of the face") {
  for (const OutlinedFace& outlined : outlined_faces(drilled_plate())) {
    CAPTURE(outlined.face.name);
    CHECK(outlined.outline.area_mm2(outlined.face.direction) ==
          Approx(outlined.face.area_mm2).epsilon(1e-9));
  }
}

TEST_CASE("a face is on the hull where nothing of the element stands in front of it") {
  // An L: the two sides of its notch are behind its corners.
  const FacetedSolid angle = testing::prism(
      {{0.0, 0.0}, {60.0, 0.0}, {60.0, 20.0}, {20.0, 20.0}, {20.0, 60.0}, {0.0, 60.0}}, 30.0);
  std::size_t on_hull = 0;
  for (const OutlinedFace& outlined : outlined_faces(angle)) {
    const Vector3d& p = outlined.face.origin;
    const bool is_notch = std::abs(p.x() - 20.0) < 1e-9 || std::abs(p.y() - 20.0) < 1e-9;
    CAPTURE(outlined.face.name);
    CHECK(outlined.outline.on_hull == !is_notch);
    if (outlined.outline.on_hull) ++on_hull;
  }
  CHECK(on_hull == 6);
}

TEST_CASE("a curved face that stands out between its facets takes a face off the hull") {
  // A bar of radius 10 in eight facets, with a flat as far out as the middle of a facet and one
  // that is farther out than the bar; the facets' corners tell the first one from nothing.
  constexpr double kApothem_mm = 9.238795325112868;  // 10 cos 22.5 deg
  FacetedSolid solid =
      testing::merged(testing::cylinder(10.0, 30.0, 8, std::numbers::pi / 8.0),
                      testing::box({4.0, 4.0, 4.0}, {kApothem_mm + 0.1 - 2.0, 30.0, 10.0}));
  REQUIRE(face_called(solid, "right").face.origin.x() == Approx(kApothem_mm + 0.1));
  CHECK_FALSE(face_called(solid, "right").outline.on_hull);
  solid = testing::merged(testing::cylinder(10.0, 30.0, 8, std::numbers::pi / 8.0),
                          testing::box({4.0, 4.0, 4.0}, {10.0 - 2.0, 30.0, 10.0}));
  CHECK(face_called(solid, "right").outline.on_hull);
}

TEST_CASE("outlines do not depend on the order of facets and faces", "[property]") {
  const FacetedSolid plate = drilled_plate();
  const std::vector<OutlinedFace> expected = outlined_faces(plate);
  for (unsigned seed = 0; seed < 5; ++seed) {
    CAPTURE(seed);
    testing::RandomGeometry random(seed);
    const FacetedSolid same = seed % 2 == 0 ? testing::shuffled(plate, random)
                                            : testing::with_split_faces(plate, 3.0 * seed);
    const std::vector<OutlinedFace> found = outlined_faces(same);
    REQUIRE(found.size() == expected.size());
    for (std::size_t i = 0; i < found.size(); ++i) {
      const OutlineLoop& a = found[i].outline.outer;
      const OutlineLoop& b = expected[i].outline.outer;
      REQUIRE(a.size() == b.size());
      for (std::size_t e = 0; e < a.size(); ++e) check_point(a[e].from, b[e].from);
      REQUIRE(found[i].outline.inner.size() == expected[i].outline.inner.size());
      for (std::size_t l = 0; l < found[i].outline.inner.size(); ++l) {
        REQUIRE(found[i].outline.inner[l].size() == 1);
        check_point(found[i].outline.inner[l][0].center, expected[i].outline.inner[l][0].center);
      }
    }
  }
}

TEST_CASE("a face that the solid does not have has an empty outline", "[fault]") {
  Feature face = face_called(drilled_plate(), "top").face;
  face.faces = {4711};
  const std::vector<FaceOutline> outlines = face_outlines(drilled_plate(), {face});
  REQUIRE(outlines.size() == 1);
  CHECK(outlines[0].outer.empty());
}
