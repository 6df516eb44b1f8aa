#include "dowel/catalog/recognition.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

#include <catch2/catch.hpp>

#include "solids.h"
#include "variants.h"

using namespace dowel;
using dowel::testing::DrilledHole;

namespace {

constexpr double kSame_mm = 1.0e-9;

const Feature& feature(const std::vector<Feature>& features, const std::string& name) {
  const auto found = std::find_if(features.begin(), features.end(),
                                  [&](const Feature& f) { return f.name == name; });
  INFO("no feature is called " << name);
  REQUIRE(found != features.end());
  return *found;
}

std::vector<Feature> of_kind(const std::vector<Feature>& features, FeatureKind kind) {
  std::vector<Feature> result;
  std::copy_if(features.begin(), features.end(), std::back_inserter(result),
               [&](const Feature& f) { return f.kind == kind; });
  return result;
}

std::string names(const std::vector<Feature>& features, FeatureKind kind) {
  std::string result;
  for (const Feature& f : of_kind(features, kind)) {
    result += (result.empty() ? "" : " ") + f.name;
  }
  return result;
}

void check_point(const Eigen::Vector3d& p, const Eigen::Vector3d& expected) {
  CAPTURE(p.transpose(), expected.transpose());
  CHECK((p - expected).norm() <= kSame_mm);
}

void check_segment(const HoleSegment& segment, HoleSegment::Type type, double diameter_mm,
                   double diameter_end_mm, double from_mm, double to_mm) {
  CHECK(segment.type == type);
  CHECK(segment.diameter_mm == Approx(diameter_mm).margin(kSame_mm));
  CHECK(segment.diameter_end_mm == Approx(diameter_end_mm).margin(kSame_mm));
  CHECK(segment.from_mm == Approx(from_mm).margin(kSame_mm));
  CHECK(segment.to_mm == Approx(to_mm).margin(kSame_mm));
}

constexpr auto kCylinder = HoleSegment::Type::Cylinder;
constexpr auto kCone = HoleSegment::Type::Cone;

/// Equal but for the indices of the faces.
bool are_equal(const Feature& a, const Feature& b, double tolerance_mm) {
  const auto near = [&](double p, double q) { return std::abs(p - q) <= tolerance_mm; };
  return a.name == b.name && a.kind == b.kind && a.through == b.through &&
         a.blind_end == b.blind_end && a.entry == b.entry &&
         (a.origin - b.origin).norm() <= tolerance_mm &&
         (a.direction - b.direction).norm() <= tolerance_mm && near(a.diameter_mm, b.diameter_mm) &&
         near(a.depth_mm, b.depth_mm) &&
         std::abs(a.area_mm2 - b.area_mm2) <= tolerance_mm * (1.0 + a.area_mm2) &&
         std::equal(a.segments.begin(), a.segments.end(), b.segments.begin(), b.segments.end(),
                    [&](const HoleSegment& p, const HoleSegment& q) {
                      return p.type == q.type && near(p.diameter_mm, q.diameter_mm) &&
                             near(p.diameter_end_mm, q.diameter_end_mm) &&
                             near(p.from_mm, q.from_mm) && near(p.to_mm, q.to_mm);
                    });
}

void check_equal(const std::vector<Feature>& a, const std::vector<Feature>& b,
                 double tolerance_mm) {
  REQUIRE(a.size() == b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    CAPTURE(a[i].name, b[i].name, a[i].origin.transpose(), b[i].origin.transpose(), a[i].depth_mm,
            b[i].depth_mm, a[i].entry, b[i].entry, a[i].diameter_mm, b[i].diameter_mm);
    CHECK(are_equal(a[i], b[i], tolerance_mm));
  }
}

/// A plate with a through, a blind, a counterbored and a blind counterbored hole.
FacetedSolid sample_plate() {
  return testing::plate_with_holes({120.0, 80.0, 30.0},
                                   {{-45.0, -20.0, 6.0},
                                    {-15.0, -20.0, 5.0, 18.0},
                                    {15.0, -20.0, 4.5, 0.0, 7.5, 8.0},
                                    {45.0, -20.0, 5.053, 25.0, 6.0, 15.0}},
                                   24);
}

/// A bore through a block of 40, turned about z: `profile` is the wall, from the top down.
FacetedSolid bushing(std::vector<Eigen::Vector2d> wall, std::uint32_t segments = 32) {
  std::vector<Eigen::Vector2d> profile{{30.0, 0.0}, {30.0, 40.0}};
  profile.insert(profile.end(), wall.begin(), wall.end());
  return testing::revolved(profile, segments, 0.1);
}

}  // namespace

TEST_CASE("a drilled plate gives its holes with diameter, depth, end and entry") {
  const std::vector<Feature> features = recognise_features(sample_plate());
  REQUIRE(names(features, FeatureKind::Hole) == "h1 b1 cb1 cb2");

  const Feature& through = feature(features, "h1");
  check_point(through.origin, {-45.0, -20.0, 30.0});
  check_point(through.direction, {0.0, 0.0, -1.0});
  CHECK(through.through);
  CHECK(through.blind_end.empty());
  CHECK(through.diameter_mm == 12.0);
  CHECK(through.depth_mm == 30.0);
  CHECK(through.entry == "top");
  REQUIRE(through.segments.size() == 1);
  check_segment(through.segments[0], kCylinder, 12.0, 12.0, 0.0, 30.0);

  const Feature& blind = feature(features, "b1");
  CHECK_FALSE(blind.through);
  CHECK(blind.blind_end == "flat");
  CHECK(blind.depth_mm == 18.0);
  CHECK(blind.diameter_mm == 10.0);

  const Feature& counterbored = feature(features, "cb1");
  CHECK(counterbored.through);
  CHECK(counterbored.diameter_mm == 9.0);
  REQUIRE(counterbored.segments.size() == 2);
  check_segment(counterbored.segments[0], kCylinder, 15.0, 15.0, 0.0, 8.0);
  check_segment(counterbored.segments[1], kCylinder, 9.0, 9.0, 8.0, 30.0);

  const Feature& tapped = feature(features, "cb2");
  CHECK_FALSE(tapped.through);
  CHECK(tapped.diameter_mm == 10.106);
  REQUIRE(tapped.segments.size() == 2);
  check_segment(tapped.segments[0], kCylinder, 12.0, 12.0, 0.0, 15.0);
  check_segment(tapped.segments[1], kCylinder, 10.106, 10.106, 15.0, 25.0);
}

TEST_CASE("the six sides of a plate carry their names, its floors and rings none") {
  const std::vector<Feature> features = recognise_features(sample_plate());
  CHECK(names(features, FeatureKind::Face) == "top bottom right left back front");
  check_point(feature(features, "right").direction, {1.0, 0.0, 0.0});
  check_point(feature(features, "right").origin, {60.0, 0.0, 15.0});
  check_point(feature(features, "front").origin, {0.0, -40.0, 15.0});
  CHECK(feature(features, "front").area_mm2 == Approx(120.0 * 30.0));
}

TEST_CASE("area and centroid of a face with holes are those of the exact face") {
  const std::vector<Feature> features = recognise_features(sample_plate());
  const double plate = 120.0 * 80.0;
  const std::vector<std::pair<double, double>> holes{
      {-45.0, 6.0}, {-15.0, 5.0}, {15.0, 7.5}, {45.0, 6.0}};
  double area = plate;
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  for (const auto& [x, r] : holes) {
    const double disc = std::numbers::pi * r * r;
    area -= disc;
    moment -= disc * Eigen::Vector2d(x, -20.0);
  }
  const Feature& top = feature(features, "top");
  CHECK(top.area_mm2 == Approx(area));
  check_point(top.origin, {moment.x() / area, moment.y() / area, 30.0});
}

TEST_CASE("drill points, countersinks and chamfers are segments of their hole") {
  SECTION("a drill point closes a blind hole") {
    // Blind: no wall below the tip, so the profile runs from the axis to the axis.
    const FacetedSolid solid = testing::revolved(
        {{0.0, 0.0}, {30.0, 0.0}, {30.0, 40.0}, {5.0, 40.0}, {5.0, 15.0}, {0.0, 12.0}}, 32);
    const std::vector<Feature> features = recognise_features(solid);
    REQUIRE(names(features, FeatureKind::Hole) == "b1");
    const Feature& hole = feature(features, "b1");
    CHECK(hole.blind_end == "cone");
    CHECK(hole.depth_mm == Approx(28.0).margin(kSame_mm));
    CHECK(hole.diameter_mm == 10.0);
    REQUIRE(hole.segments.size() == 2);
    check_segment(hole.segments[0], kCylinder, 10.0, 10.0, 0.0, 25.0);
    check_segment(hole.segments[1], kCone, 10.0, 0.0, 25.0, 28.0);
  }
  SECTION("a countersink opens a through hole") {
    const std::vector<Feature> features =
        recognise_features(bushing({{10.0, 40.0}, {5.0, 35.0}, {5.0, 0.0}}));
    REQUIRE(names(features, FeatureKind::Hole) == "cs1");
    const Feature& hole = feature(features, "cs1");
    CHECK(hole.through);
    CHECK(hole.entry == "top");
    REQUIRE(hole.segments.size() == 2);
    check_segment(hole.segments[0], kCone, 20.0, 10.0, 0.0, 5.0);
    check_segment(hole.segments[1], kCylinder, 10.0, 10.0, 5.0, 40.0);
  }
  SECTION("chamfers at both ends leave a plain hole that opens at the wider one") {
    const std::vector<Feature> features =
        recognise_features(bushing({{6.0, 40.0}, {5.0, 39.0}, {5.0, 2.0}, {7.0, 0.0}}));
    REQUIRE(names(features, FeatureKind::Hole) == "h1");
    const Feature& hole = feature(features, "h1");
    check_point(hole.origin, Eigen::Vector3d::Zero());
    check_point(hole.direction, {0.0, 0.0, 1.0});
    CHECK(hole.entry == "bottom");
    REQUIRE(hole.segments.size() == 3);
    check_segment(hole.segments[0], kCone, 14.0, 10.0, 0.0, 2.0);
    check_segment(hole.segments[2], kCone, 10.0, 12.0, 39.0, 40.0);
  }
  SECTION("a counterbore at the bottom turns the hole over") {
    const std::vector<Feature> features =
        recognise_features(bushing({{5.0, 40.0}, {5.0, 10.0}, {9.0, 10.0}, {9.0, 0.0}}));
    REQUIRE(names(features, FeatureKind::Hole) == "cb1");
    check_point(feature(features, "cb1").direction, {0.0, 0.0, 1.0});
    CHECK(feature(features, "cb1").entry == "bottom");
  }
  SECTION("a groove inside a bore is one of its segments") {
    const std::vector<Feature> features = recognise_features(bushing(
        {{10.0, 40.0}, {10.0, 30.0}, {11.0, 30.0}, {11.0, 28.0}, {10.0, 28.0}, {10.0, 0.0}}));
    REQUIRE(names(features, FeatureKind::Hole) == "h1");
    CHECK(feature(features, "h1").segments.size() == 3);
    CHECK(feature(features, "h1").diameter_mm == 20.0);
    CHECK(feature(features, "h1").faces.size() == 5);
    CHECK(names(features, FeatureKind::Face) == "top bottom");
  }
}

TEST_CASE("a groove round a boss is no hole, and the boss is a shaft") {
  // A ring groove from 10 to 20 around a boss as high as the rim.
  const FacetedSolid solid = testing::revolved({{0.0, 0.0},
                                                {30.0, 0.0},
                                                {30.0, 20.0},
                                                {20.0, 20.0},
                                                {20.0, 12.0},
                                                {10.0, 12.0},
                                                {10.0, 20.0},
                                                {0.0, 20.0}},
                                               32);
  const std::vector<Feature> features = recognise_features(solid);
  CHECK(names(features, FeatureKind::Hole).empty());
  REQUIRE(names(features, FeatureKind::Shaft) == "pin1 pin2");
  CHECK(feature(features, "pin1").diameter_mm == 20.0);
  check_point(feature(features, "pin1").origin, {0.0, 0.0, 12.0});
  check_point(feature(features, "pin1").direction, {0.0, 0.0, 1.0});
}

TEST_CASE("a pocket around a hub with a bore is no hole, and the bore is one") {
  const FacetedSolid solid = testing::revolved({{5.0, 0.0},
                                                {30.0, 0.0},
                                                {30.0, 20.0},
                                                {25.0, 20.0},
                                                {25.0, 4.0},
                                                {10.0, 4.0},
                                                {10.0, 20.0},
                                                {5.0, 20.0}},
                                               32);
  const std::vector<Feature> features = recognise_features(solid);
  REQUIRE(names(features, FeatureKind::Hole) == "h1");
  CHECK(feature(features, "h1").diameter_mm == 10.0);
  CHECK(names(features, FeatureKind::Shaft) == "pin1 pin2");
}

TEST_CASE("a floor closes a bore although something opens in its middle") {
  // The hub in the pocket is low, and its bore goes through.
  const FacetedSolid solid = testing::revolved({{5.0, 0.0},
                                                {30.0, 0.0},
                                                {30.0, 20.0},
                                                {25.0, 20.0},
                                                {25.0, 4.0},
                                                {10.0, 4.0},
                                                {10.0, 6.0},
                                                {5.0, 6.0}},
                                               32);
  const std::vector<Feature> features = recognise_features(solid);
  REQUIRE(names(features, FeatureKind::Hole) == "b1 h1");
  CHECK(feature(features, "b1").diameter_mm == 50.0);
  CHECK(feature(features, "b1").depth_mm == 16.0);
  CHECK(feature(features, "b1").blind_end == "flat");
  CHECK(feature(features, "h1").depth_mm == 6.0);
}

TEST_CASE("a closed cavity is no hole") {
  const FacetedSolid cavity = testing::transformed(Pose::from_translation({0.0, 0.0, -5.0}),
                                                   testing::cylinder(5.0, 10.0, 24));
  const std::vector<Feature> features =
      recognise_features(testing::hollowed(testing::box({40.0, 40.0, 40.0}), cavity));
  CHECK(names(features, FeatureKind::Hole).empty());
}

TEST_CASE("two blind holes on one axis with material between them are two holes") {
  const FacetedSolid solid = testing::revolved({{0.0, 10.0},
                                                {5.0, 10.0},
                                                {5.0, 0.0},
                                                {30.0, 0.0},
                                                {30.0, 40.0},
                                                {5.0, 40.0},
                                                {5.0, 25.0},
                                                {0.0, 25.0}},
                                               32);
  const std::vector<Feature> features = recognise_features(solid);
  REQUIRE(names(features, FeatureKind::Hole) == "b1 b2");
  check_point(feature(features, "b1").origin, {0.0, 0.0, 40.0});
  CHECK(feature(features, "b1").depth_mm == 15.0);
  check_point(feature(features, "b2").origin, {0.0, 0.0, 0.0});
  CHECK(feature(features, "b2").depth_mm == 10.0);
}

TEST_CASE("fillets and the rounded ends of slots are neither holes nor shafts") {
  // A stadium: two half cylinders of radius 10; then the same as a slot through a plate would be
  // its inside. Built as a prism whose round ends are given their exact cylinders.
  constexpr std::uint32_t kArc = 12;
  std::vector<Eigen::Vector2d> outline;
  for (std::uint32_t i = 0; i <= kArc; ++i) {
    const double a = -0.5 * std::numbers::pi + std::numbers::pi * i / kArc;
    outline.emplace_back(20.0 + 10.0 * std::cos(a), 10.0 * std::sin(a));
  }
  for (std::uint32_t i = 0; i <= kArc; ++i) {
    const double a = 0.5 * std::numbers::pi + std::numbers::pi * i / kArc;
    outline.emplace_back(-20.0 + 10.0 * std::cos(a), 10.0 * std::sin(a));
  }
  FacetedSolid solid = testing::prism(outline, 15.0);
  for (std::uint32_t side = 0; side < outline.size(); ++side) {
    const bool is_right = side < kArc;
    const bool is_left = side > kArc && side < 2 * kArc + 1;
    if (!is_right && !is_left) continue;
    solid.faces[2 + side].surface =
        CylinderSurface{{is_right ? 20.0 : -20.0, 0.0, 0.0}, Eigen::Vector3d::UnitZ(), 10.0};
  }
  CHECK(of_kind(recognise_features(solid), FeatureKind::Shaft).empty());
  // The slot: the same walls around a void inside a box.
  FacetedSolid slot = testing::inverted(solid);
  CHECK(of_kind(recognise_features(slot), FeatureKind::Hole).empty());
}

TEST_CASE("a stepped pin gives a shaft for each step, from its shoulder to its free end") {
  const std::vector<Feature> features =
      recognise_features(testing::stepped_pin({{10.0, 8.0}, {5.995, 20.0}, {3.0, 5.0}}, 24));
  REQUIRE(names(features, FeatureKind::Shaft) == "pin1 pin2 pin3");
  const Feature& middle = feature(features, "pin2");
  CHECK(middle.diameter_mm == 11.99);
  CHECK(middle.depth_mm == 20.0);
  check_point(middle.origin, {0.0, 0.0, 8.0});
  check_point(middle.direction, {0.0, 0.0, 1.0});
  // Both ends of the head are free: like a pin it points down.
  const Feature& head = feature(features, "pin3");
  check_point(head.origin, {0.0, 0.0, 8.0});
  check_point(head.direction, {0.0, 0.0, -1.0});
}

TEST_CASE("a lead-in chamfer is no part of a shaft's length") {
  const FacetedSolid pin = testing::revolved(
      {{0.0, 0.0}, {5.0, 0.0}, {6.0, 2.0}, {6.0, 18.0}, {5.5, 20.0}, {0.0, 20.0}}, 24);
  const std::vector<Feature> features = recognise_features(pin);
  REQUIRE(names(features, FeatureKind::Shaft) == "pin1");
  CHECK(feature(features, "pin1").depth_mm == 16.0);
  check_point(feature(features, "pin1").origin, {0.0, 0.0, 18.0});
  CHECK(of_kind(features, FeatureKind::Hole).empty());
}

TEST_CASE("a tube is a shaft with a hole through it") {
  const std::vector<Feature> features = recognise_features(testing::tube(4.0, 9.0, 12.0, 24));
  CHECK(names(features, FeatureKind::Hole) == "h1");
  CHECK(names(features, FeatureKind::Shaft) == "pin1");
  CHECK(feature(features, "top").area_mm2 == Approx(std::numbers::pi * (81.0 - 16.0)));
  check_point(feature(features, "top").origin, {0.0, 0.0, 12.0});
}

TEST_CASE("solids of one element keep their own features, also one inside the other") {
  // A pin that fills a bore: the bore's axis runs in the material of the other solid.
  const FacetedSolid both =
      testing::merged(testing::tube(5.0, 15.0, 20.0, 24), testing::cylinder(5.0, 30.0, 24));
  const std::vector<Feature> features = recognise_features(both);
  CHECK(names(features, FeatureKind::Hole) == "h1");
  CHECK(names(features, FeatureKind::Shaft) == "pin1 pin2");
}

TEST_CASE("faces are classified as plane, hole and other, and every triangle is counted") {
  const FacetedSolid solid = sample_plate();
  const std::vector<Feature> features = recognise_features(solid);
  const std::vector<FacetClass> classes = classify_faces(solid, features);
  for (std::size_t f = 0; f < solid.faces.size(); ++f) {
    CHECK(classes[f] == (is_plane(solid.faces[f].surface) ? FacetClass::Plane : FacetClass::Hole));
  }
  const TriangleCounts counts = count_triangles(solid, classes);
  CHECK(counts.total == solid.triangles.size());
  CHECK(counts.plane + counts.hole + counts.other == counts.total);
  CHECK(counts.hole == 6 * 24 * 2);  // six walls
  const FacetedSolid pin = testing::cylinder(5.0, 10.0, 24);
  CHECK(count_triangles(pin, classify_faces(pin, recognise_features(pin))).other == 48);
}

TEST_CASE("the order of vertices, triangles and faces does not matter, to the bit",
          "[property][determinism]") {
  const auto seed = GENERATE(range(0U, 6U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  FacetedSolid solid = sample_plate();
  if (seed % 2 == 1) solid = testing::transformed(random.pose(500.0), solid);
  const std::vector<Feature> features = recognise_features(solid);
  CHECK(features.size() == 10);
  check_equal(recognise_features(testing::shuffled(solid, random)), features, 0.0);
}

TEST_CASE("a moved solid has the same features, moved", "[property]") {
  const auto seed = GENERATE(range(0U, 8U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const Pose X_WB = random.pose(2000.0);
  const FacetedSolid solid = bushing({{10.0, 40.0}, {10.0, 30.0}, {5.0, 25.0}, {5.0, 0.0}});
  const Feature before = of_kind(recognise_features(solid), FeatureKind::Hole).at(0);
  const Feature after =
      of_kind(recognise_features(testing::transformed(X_WB, solid)), FeatureKind::Hole).at(0);
  CHECK((after.origin - X_WB * before.origin).norm() <= 1.0e-8);
  CHECK((after.direction - X_WB.rotation() * before.direction).norm() <= 1.0e-9);
  CHECK(after.depth_mm == Approx(before.depth_mm).margin(1.0e-8));
  CHECK(after.segments.size() == before.segments.size());
}

TEST_CASE("a mirrored plate has its holes on the other side") {
  const std::vector<Feature> features = recognise_features(testing::mirrored(sample_plate()));
  REQUIRE(names(features, FeatureKind::Hole) == "cb1 cb2 b1 h1");
  check_point(feature(features, "h1").origin, {45.0, -20.0, 30.0});
  check_point(feature(features, "b1").origin, {15.0, -20.0, 30.0});
}

TEST_CASE("faces split in halves are the same features") {
  const FacetedSolid solid = sample_plate();
  const double at_x = GENERATE(-45.0, 15.0, 45.0);
  const FacetedSolid split = testing::with_split_faces(solid, at_x);
  REQUIRE(split.faces.size() > solid.faces.size());
  check_equal(recognise_features(split), recognise_features(solid), 1.0e-9);
}

TEST_CASE("free-form faces that are planes, cylinders and cones give the same features") {
  const FacetedSolid solid =
      GENERATE(sample_plate(), bushing({{10.0, 40.0}, {5.0, 35.0}, {5.0, 2.0}, {7.0, 0.0}}));
  const FacetedSolid freeform = testing::without_surfaces(solid);
  const std::vector<Feature> features = recognise_features(freeform);
  check_equal(features, recognise_features(solid), 1.0e-3);
  const auto classes = classify_faces(freeform, features);
  const auto expected = classify_faces(solid, recognise_features(solid));
  CHECK(classes == expected);
}

TEST_CASE("a free-form face that leaves its cylinder between its vertices is none") {
  FacetedSolid barrel = testing::without_surfaces(testing::cylinder(10.0, 20.0, 24));
  REQUIRE(of_kind(recognise_features(barrel), FeatureKind::Shaft).size() == 1);
  barrel.faces[1].facet_error_mm = 0.5;
  CHECK(of_kind(recognise_features(barrel), FeatureKind::Shaft).empty());
}

TEST_CASE("the facets of curved walls in a mesh file are no faces") {
  // What a mesh file gives: every coplanar patch a plane of its own.
  std::vector<Eigen::Vector2d> round;
  for (int i = 0; i < 16; ++i) {
    const double a = std::numbers::pi * i / 8.0;
    round.emplace_back(20.0 * std::cos(a), 20.0 * std::sin(a));
  }
  CHECK(names(recognise_features(testing::prism(round, 10.0)), FeatureKind::Face) == "top bottom");
  // A block with shallow chamfers is not meant.
  const FacetedSolid chamfered = testing::prism(
      {{0.0, 0.0}, {60.0, 0.0}, {60.0, 20.0}, {50.0, 25.0}, {10.0, 25.0}, {0.0, 20.0}}, 30.0);
  CHECK(of_kind(recognise_features(chamfered), FeatureKind::Face).size() == 8);
}

TEST_CASE("solids without planes, cylinders or faces of their own have no features") {
  CHECK(recognise_features(FacetedSolid{}).empty());
  CHECK(recognise_features(testing::sphere(10.0, 16)).empty());
}
