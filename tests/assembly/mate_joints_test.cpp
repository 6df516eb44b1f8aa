// Mates beside insert and seat: what they ask, and of what.

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "dowel/assembly/mate.h"
#include "dowel/kernel/error.h"
#include "fixture_elements.h"
#include "random_geometry.h"

using dowel::Feature;
using dowel::FeatureKind;
using dowel::Joint;
using dowel::mate_joints;
using dowel::MateFeatures;
using dowel::MateKind;
using dowel::place_by_joint;
using dowel::Pose;
namespace testing = dowel::testing;

namespace {

using Vector = Eigen::Vector3d;

/// Where A goes by the mate, from X_WA.
Pose placed(const MateFeatures& mate, const Pose& X_WA, const Pose& X_WB) {
  return place_by_joint(mate_joints(mate, X_WB.inverse() * X_WA).front(), X_WA, X_WB);
}

/// A groove along y, 14 wide and 12 deep, with its mouth at z = 40.
Feature groove() {
  Feature slot;
  slot.name = "slot1";
  slot.kind = FeatureKind::Slot;
  slot.origin = {30, 0, 40};
  slot.direction = -Vector::UnitZ();
  slot.diameter_mm = 14.0;
  slot.depth_mm = 12.0;
  slot.slot.emplace();
  slot.slot->run = Vector::UnitY();
  slot.slot->length_mm = 200.0;
  return slot;
}

/// 42 x 22 x 20 with a tongue beneath that is `tongue_mm` wide, along x, with its middle at y = 3.
dowel::Element key(double tongue_mm) {
  dowel::Element element;
  element.features = {
      testing::face_feature("bottom", {1, 3, 0}, -Vector::UnitZ(), 500),
      testing::face_feature("front", {0, 3 - tongue_mm / 2, 5}, -Vector::UnitY(), 300),
      testing::face_feature("back", {0, 3 + tongue_mm / 2, 5}, Vector::UnitY(), 300),
      testing::face_feature("wide front", {0, -8, 15}, -Vector::UnitY(), 300),
      testing::face_feature("wide back", {0, 14, 15}, Vector::UnitY(), 300),
      testing::face_feature("left", {-21, 3, 10}, -Vector::UnitX(), 200),
      testing::face_feature("right", {21, 3, 10}, Vector::UnitX(), 200),
      testing::hole_feature("h1", {0, 3, 20}, -Vector::UnitZ(), {{10.2, 20}}, true)};
  return element;
}

}  // namespace

TEST_CASE("align puts axis on axis in the sense that is nearer, and nothing else", "[property]") {
  const unsigned seed = GENERATE(range(0U, 60U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const Feature f =
      testing::hole_feature("h2", random.point(50), random.direction(), {{9, 20}}, true);
  const Feature g = testing::shaft_feature("pin", random.point(50), random.direction(), 8.9, 20);
  const Pose X_WA = random.pose(300);
  const Pose X_WB = random.pose(300);
  MateFeatures mate;
  mate.kind = MateKind::Align;
  mate.moving = &f;
  mate.fixed = &g;
  mate.flip = nearest_flip(mate, X_WB.inverse() * X_WA);
  const Vector axis_W = X_WB.rotation() * g.direction;
  const double before = (X_WA.rotation() * f.direction).dot(axis_W);
  const Pose X_WA_now = placed(mate, X_WA, X_WB);
  CHECK((X_WA_now.rotation() * f.direction).dot(axis_W) == Approx(before < 0 ? -1.0 : 1.0));
  const Vector off = X_WA_now * f.origin - X_WB * g.origin;
  CHECK(off.cross(axis_W).norm() < testing::kExact_mm);
  // It keeps its place along the axis, once it has been turned about its origin.
  const Vector turned = X_WA_now.rotation() * f.origin + X_WA.translation() - X_WB * g.origin;
  CHECK(off.dot(axis_W) == Approx(turned.dot(axis_W)).margin(testing::kExact_mm));
}

TEST_CASE("a key stands in the middle of its slot, along it, on its floor", "[property]") {
  const unsigned seed = GENERATE(range(100U, 160U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const dowel::Element element = key(14.0);
  const Feature slot = groove();
  const Pose X_WA = random.pose(300);
  const Pose X_WB = random.pose(300);
  MateFeatures mate;
  mate.kind = MateKind::KeyInSlot;
  mate.moving_element = &element;
  mate.moving = element.find_feature("bottom");
  mate.fixed = &slot;
  mate.offset_mm = random.uniform(0, 3);
  mate.flip = nearest_flip(mate, X_WB.inverse() * X_WA);
  // In the frame of the slot's part: the key's middle line y = 3 at x = 30, its bottom at z = 28.
  const Pose X_BA = X_WB.inverse() * placed(mate, X_WA, X_WB);
  const Vector bottom = X_BA * Vector(1, 3, 0);
  CHECK(bottom.x() == Approx(30.0).margin(testing::kExact_mm));
  CHECK(bottom.z() == Approx(28.0 + mate.offset_mm).margin(testing::kExact_mm));
  CHECK((X_BA.rotation() * Vector::UnitZ() - Vector::UnitZ()).norm() < 1e-12);
  CHECK(std::abs((X_BA.rotation() * Vector::UnitX()).y()) == Approx(1.0));

  // By its hole it stands in the middle, too, but at any height.
  mate.moving = element.find_feature("h1");
  const Joint loose = mate_joints(mate, Pose()).front();
  CHECK(loose.equations() == 4);
  const Pose X_BA_loose = X_WB.inverse() * placed(mate, X_WA, X_WB);
  CHECK((X_BA_loose * Vector(0, 3, 0)).x() == Approx(30.0).margin(testing::kExact_mm));
}

TEST_CASE("an angle is opened about the axis across, fixed parts keep their places", "[property]") {
  const unsigned seed = GENERATE(range(200U, 260U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const Feature f = testing::face_feature("side", random.point(50), random.direction(), 9);
  const Feature g = testing::face_feature("top", random.point(50), random.direction(), 9);
  const Pose X_WA = random.pose(300);
  const Pose X_WB = random.pose(300);
  MateFeatures mate;
  mate.kind = MateKind::Angle;
  mate.moving = &f;
  mate.fixed = &g;
  for (const double angle_rad : {0.0, 0.3, std::numbers::pi / 2, 3.0, std::numbers::pi}) {
    CAPTURE(angle_rad);
    mate.angle_rad = angle_rad;
    const Pose X_WA_now = placed(mate, X_WA, X_WB);
    const double cosine = (X_WA_now.rotation() * f.direction).dot(X_WB.rotation() * g.direction);
    CHECK(cosine == Approx(std::cos(angle_rad)).margin(1e-12));
    CHECK(X_WA_now.translation() == X_WA.translation());
  }
  MateFeatures fixed;
  fixed.kind = MateKind::Fix;
  fixed.X_BA_held = random.pose(100);
  const Pose expected = X_WB * fixed.X_BA_held;
  const Pose X_WA_now = placed(fixed, X_WA, X_WB);
  CHECK((X_WA_now.translation() - expected.translation()).norm() < testing::kExact_mm);
  CHECK(X_WA_now.rotation().angularDistance(expected.rotation()) < 1e-7);
}

TEST_CASE("a key that is too wide, and what is no key, no axis, no angle, is refused") {
  const dowel::Element wide = key(14.1);
  const dowel::Element narrow = key(14.0);
  const Feature slot = groove();
  MateFeatures mate;
  mate.kind = MateKind::KeyInSlot;
  mate.moving_element = &wide;
  mate.moving = wide.find_feature("bottom");
  mate.fixed = &slot;
  CHECK_THROWS_WITH(mate_joints(mate, Pose()), Catch::Contains("14.1") && Catch::Contains("14.0"));
  const dowel::Element bare;
  mate.moving_element = &bare;
  CHECK_THROWS_WITH(mate_joints(mate, Pose()), Catch::Contains("no two opposite flat sides"));
  mate.moving_element = &narrow;
  mate.fixed = narrow.find_feature("h1");
  CHECK_THROWS_AS(mate_joints(mate, Pose()), dowel::Error);
  mate.kind = MateKind::Align;
  CHECK_THROWS_AS(mate_joints(mate, Pose()), dowel::Error);
  mate.kind = MateKind::Angle;
  for (const double angle_rad : {-0.1, 3.2}) {
    mate.angle_rad = angle_rad;
    CHECK_THROWS_AS(mate_joints(mate, Pose()), dowel::Error);
  }
}
