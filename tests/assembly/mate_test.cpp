#include "dowel/assembly/mate.h"

#include <cmath>
#include <numbers>
#include <optional>

#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "fixture_elements.h"
#include "random_geometry.h"

using dowel::Feature;
using dowel::mate_residual;
using dowel::MateKind;
using dowel::MateOptions;
using dowel::MatePlacement;
using dowel::place_by_mate;
using dowel::PlacedFeature;
using dowel::Pose;
using dowel::SeatFaces;
namespace testing = dowel::testing;

namespace {

const Eigen::Vector3d kUp = Eigen::Vector3d::UnitZ();

Feature through_hole(double depth_mm) {
  return testing::hole_feature("h1", {7, -3, 11}, Eigen::Vector3d(1, 2, -2) / 3.0,
                               {{12.0, depth_mm}}, true);
}

Feature blind_hole(double depth_mm) {
  return testing::hole_feature("b1", {-4, 8, 2}, Eigen::Vector3d(2, -2, 1) / 3.0,
                               {{12.0, depth_mm}}, false);
}

Feature shaft(double length_mm) {
  return testing::shaft_feature("pin1", {1, 2, 3}, Eigen::Vector3d(-2, 1, 2) / 3.0, 11.9,
                                length_mm);
}

Eigen::Vector3d far_end(const PlacedFeature& f) {
  return f.origin_W() + f.feature->depth_mm * f.direction_W();
}

void check_near(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  CAPTURE(a.transpose(), b.transpose());
  CHECK((a - b).norm() < testing::kExact_mm);
}

double angle_between(const Pose& a, const Pose& b) {
  return Eigen::AngleAxisd(a.rotation().inverse() * b.rotation()).angle();
}

}  // namespace

TEST_CASE("mates put the features where their kind says, at random poses", "[property]") {
  const unsigned seed = GENERATE(range(0U, 60U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const Feature moving_shaft = shaft(20);
  const Feature fixed_hole = through_hole(40);
  const Feature riser_hole = through_hole(80);
  const Feature cap_hole = blind_hole(15);
  const Feature stud = shaft(50);
  const Pose X_WA(random.rotation(), random.point(500));
  const Pose X_WB(random.rotation(), random.point(500));
  const double lift = random.uniform(-20, 20);
  const MateOptions options{.offset_mm = lift, .rotation_rad = random.uniform(-3, 3)};
  const PlacedFeature hole{&fixed_hole, X_WB};
  const Eigen::Vector3d in = hole.direction_W();

  SECTION("shaft in hole: shoulder at the opening") {
    const MatePlacement placed = place_by_mate({&moving_shaft, X_WA}, hole, {}, options);
    CHECK(placed.kind == MateKind::ShaftInHole);
    const PlacedFeature f{&moving_shaft, placed.X_WA};
    check_near(f.direction_W(), in);
    check_near(f.origin_W(), hole.origin_W() - lift * in);
  }
  SECTION("shaft in hole, flipped: the free end is the shoulder") {
    const MatePlacement placed =
        place_by_mate({&moving_shaft, X_WA}, hole, {}, {.offset_mm = lift, .flip = true});
    const PlacedFeature f{&moving_shaft, placed.X_WA};
    check_near(f.direction_W(), -in);
    check_near(far_end(f), hole.origin_W() - lift * in);
  }
  SECTION("through hole on hole: it stands on it with its far end") {
    const MatePlacement placed = place_by_mate({&riser_hole, X_WA}, hole, {}, options);
    CHECK(placed.kind == MateKind::HoleOnHole);
    const PlacedFeature f{&riser_hole, placed.X_WA};
    check_near(f.direction_W(), in);
    check_near(far_end(f), hole.origin_W() - lift * in);
  }
  SECTION("blind hole on hole: the openings face each other") {
    const MatePlacement placed = place_by_mate({&cap_hole, X_WA}, hole, {}, options);
    CHECK(placed.kind == MateKind::BlindHoleOnHole);
    const PlacedFeature f{&cap_hole, placed.X_WA};
    check_near(f.direction_W(), -in);
    check_near(f.origin_W(), hole.origin_W() - lift * in);
  }
  SECTION("through hole over shaft: turned least, next end on the shoulder") {
    const PlacedFeature g{&stud, X_WB};
    const bool along = (X_WA.rotation() * riser_hole.direction).dot(g.direction_W()) > 0.0;
    const MatePlacement placed = place_by_mate({&riser_hole, X_WA}, g, {}, options);
    CHECK(placed.kind == MateKind::HoleOverShaft);
    const PlacedFeature f{&riser_hole, placed.X_WA};
    check_near(f.direction_W(), along ? g.direction_W() : Eigen::Vector3d(-g.direction_W()));
    check_near(along ? f.origin_W() : far_end(f), g.origin_W() + lift * g.direction_W());
    const MatePlacement other = place_by_mate({&riser_hole, X_WA}, g, {}, {.flip = true});
    CHECK(f.direction_W().dot(other.X_WA.rotation() * riser_hole.direction) == Approx(-1.0));
  }
  SECTION("blind hole over shaft: the opening at the shoulder") {
    const PlacedFeature g{&stud, X_WB};
    const MatePlacement placed = place_by_mate({&cap_hole, X_WA}, g, {}, {});
    const PlacedFeature f{&cap_hole, placed.X_WA};
    check_near(f.direction_W(), g.direction_W());
    check_near(f.origin_W(), g.origin_W());
  }
  SECTION("face on face: planes coincide, nothing moves in the plane") {
    const Feature under =
        testing::face_feature("bottom", {5, 6, 7}, Eigen::Vector3d(2, 1, -2) / 3, 9);
    const Feature over = testing::face_feature("top", {-1, 0, 4}, Eigen::Vector3d(2, 2, 1) / 3, 9);
    const PlacedFeature g{&over, X_WB};
    const PlacedFeature before{&under, X_WA};
    const MatePlacement placed = place_by_mate(before, g, {}, options);
    CHECK(placed.kind == MateKind::FaceOnFace);
    const PlacedFeature f{&under, placed.X_WA};
    const Eigen::Vector3d n = g.direction_W();
    check_near(f.direction_W(), -n);
    CHECK(n.dot(f.origin_W() - g.origin_W()) == Approx(lift).margin(testing::kExact_mm));
    const Eigen::Vector3d moved = f.origin_W() - before.origin_W();
    check_near(moved - n.dot(moved) * n, Eigen::Vector3d::Zero());
  }
}

TEST_CASE("of all turns about the axis a mate takes the nearest, then adds the one asked for",
          "[property]") {
  const unsigned seed = GENERATE(range(100U, 130U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const Feature f = shaft(20);
  const Feature g = through_hole(40);
  const Pose X_WA(random.rotation(), random.point(100));
  const PlacedFeature hole{&g, Pose(random.rotation(), random.point(100))};
  const Pose nearest = place_by_mate({&f, X_WA}, hole, {}, {}).X_WA;
  const Eigen::Vector3d out = -hole.direction_W();
  // Any other turn about the axis is farther from where the part was.
  for (int step = 1; step < 72; ++step) {
    const Pose other =
        Pose::about_axis(hole.origin_W(), out, step * std::numbers::pi / 36.0) * nearest;
    CHECK(angle_between(X_WA, other) >= angle_between(X_WA, nearest) - 1e-9);
  }
  const Pose turned = place_by_mate({&f, X_WA}, hole, {}, {.rotation_rad = 0.5}).X_WA;
  const Pose expected = Pose::about_axis(hole.origin_W(), out, 0.5) * nearest;
  check_near(turned.translation(), expected.translation());
  CHECK(angle_between(turned, expected) < 1e-7);
}

TEST_CASE("a seat takes over place and sense along the axis", "[property]") {
  const unsigned seed = GENERATE(range(200U, 240U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  // Faces square to the axes, on either side of the part.
  const Feature f = shaft(20);
  const Feature g = through_hole(40);
  const bool under = random.coin();
  const bool below = random.coin();
  const Feature moving_face = testing::face_feature(
      "m", random.point(30), under ? f.direction : Eigen::Vector3d(-f.direction), 1);
  const Feature fixed_face = testing::face_feature(
      "s", random.point(30), below ? g.direction : Eigen::Vector3d(-g.direction), 1);
  const Pose X_WA(random.rotation(), random.point(300));
  const Pose X_WB(random.rotation(), random.point(300));
  const double lift = random.uniform(0, 9);
  const SeatFaces seat{&moving_face, {&fixed_face, X_WB}};
  const PlacedFeature hole{&g, X_WB};
  const MatePlacement placed =
      place_by_mate({&f, X_WA}, hole, seat, {.offset_mm = lift, .rotation_rad = 1.0});
  const PlacedFeature m{&moving_face, placed.X_WA};
  const PlacedFeature s{&fixed_face, X_WB};
  check_near(m.direction_W(), -s.direction_W());
  CHECK(s.direction_W().dot(m.origin_W() - s.origin_W()) ==
        Approx(lift).margin(testing::kExact_mm));
  const PlacedFeature shaft_W{&f, placed.X_WA};
  const Eigen::Vector3d off = shaft_W.origin_W() - hole.origin_W();
  check_near(off.cross(hole.direction_W()), Eigen::Vector3d::Zero());
  check_near(shaft_W.direction_W().cross(hole.direction_W()), Eigen::Vector3d::Zero());
}

TEST_CASE("a fresh mate has no residual and a disturbed one tells by how much", "[property]") {
  const unsigned seed = GENERATE(range(300U, 340U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const std::vector<Feature> moving{
      shaft(20), through_hole(30), blind_hole(12),
      testing::face_feature("bottom", {5, 6, 7}, Eigen::Vector3d(2, 1, -2) / 3, 9)};
  const std::vector<Feature> fixed{
      through_hole(40), shaft(60),
      testing::face_feature("top", {-1, 0, 4}, Eigen::Vector3d(2, 2, 1) / 3, 9)};
  int mates = 0;
  for (const Feature& f : moving) {
    for (const Feature& g : fixed) {
      const bool flip = random.coin() && (f.kind == dowel::FeatureKind::Shaft || f.through);
      const MateOptions options{random.uniform(-5, 5), random.uniform(-3, 3), flip};
      const PlacedFeature there{&g, Pose(random.rotation(), random.point(200))};
      const Pose X_WA(random.rotation(), random.point(200));
      std::optional<MatePlacement> placed;
      try {
        placed = place_by_mate({&f, X_WA}, there, {}, options);
      } catch (const dowel::Error&) {
        continue;
      }
      ++mates;
      const auto off = mate_residual({&f, placed->X_WA}, there, {}, options);
      CHECK(off.axis_mm < testing::kExact_mm);
      CHECK(off.angle_rad < 1e-9);
      CHECK(std::abs(off.along_mm) < testing::kExact_mm);

      const bool is_face = g.kind == dowel::FeatureKind::Face;
      const Eigen::Vector3d axis = there.direction_W();
      const Eigen::Vector3d side = axis.unitOrthogonal();
      const Pose moved = Pose::from_translation(0.3 * axis + 0.4 * side) * placed->X_WA;
      const auto disturbed = mate_residual({&f, moved}, there, {}, options);
      CHECK(disturbed.axis_mm == Approx(is_face ? 0.0 : 0.4).margin(testing::kExact_mm));
      CHECK(std::abs(disturbed.along_mm) == Approx(0.3).margin(testing::kExact_mm));
      const Pose tilted = Pose::about_axis(there.origin_W(), side, 0.01) * placed->X_WA;
      CHECK(mate_residual({&f, tilted}, there, {}, options).angle_rad == Approx(0.01).margin(1e-9));
    }
  }
  CHECK(mates == 6);
}

TEST_CASE("a part whose axis points the wrong way is turned over about an axis of its own",
          "[degenerate]") {
  const Feature f = testing::shaft_feature("pin1", {0, 0, 0}, kUp, 10, 20);
  const Feature g = testing::hole_feature("h1", {0, 0, 0}, -kUp, {{12, 20}}, true);
  const Pose placed = place_by_mate({&f, Pose()}, {&g, Pose()}, {}, {}).X_WA;
  check_near(placed.rotation() * kUp, -kUp);
  check_near(placed.rotation() * Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitX());
  // Nearly opposite directions lose no digits.
  for (const double off : {1e-3, 1e-6, 1e-8, 1e-10, 1e-14}) {
    CAPTURE(off);
    const Pose X_WA(Eigen::Quaterniond(Eigen::AngleAxisd(off, Eigen::Vector3d(3, 4, 0) / 5.0)),
                    {100, 0, 0});
    const PlacedFeature result{&f, place_by_mate({&f, X_WA}, {&g, Pose()}, {}, {}).X_WA};
    CHECK((result.direction_W() + kUp).norm() < 1e-14);
  }
}

TEST_CASE("a part that is upright already keeps its orientation to the bit") {
  const Feature f = testing::hole_feature("h1", {0, 0, 40}, -kUp, {{13, 40}}, true);
  const Feature g = testing::hole_feature("C4", {60, -20, 40}, -kUp, {{12, 40}}, true);
  const Pose placed = place_by_mate({&f, Pose()}, {&g, Pose()}, {}, {}).X_WA;
  CHECK(placed == Pose::from_translation({60, -20, 40}));
}

TEST_CASE("a face on a face of the same sense is turned over, not mirrored", "[degenerate]") {
  const Feature f = testing::face_feature("top", {0, 0, 20}, kUp, 1);
  const Feature g = testing::face_feature("top", {5, 0, 40}, kUp, 1);
  const Pose placed =
      place_by_mate({&f, Pose::from_translation({9, 8, 0})}, {&g, Pose()}, {}, {}).X_WA;
  check_near(placed * Eigen::Vector3d(0, 0, 20), {9, 8, 40});
  check_near(placed.rotation() * kUp, -kUp);
}

TEST_CASE("mates that make no sense are refused") {
  const Feature pin = shaft(20);
  const Feature hole = through_hole(40);
  const Feature blind = blind_hole(10);
  const Feature face = testing::face_feature("top", {0, 0, 0}, kUp, 1);
  Feature slot = face;
  slot.kind = dowel::FeatureKind::Slot;
  const auto refused = [](const Feature& f, const Feature& g, const std::optional<SeatFaces>& seat,
                          const MateOptions& options) {
    CHECK_THROWS_AS(place_by_mate({&f, Pose()}, {&g, Pose()}, seat, options), dowel::Error);
  };
  refused(pin, pin, {}, {});
  refused(face, hole, {}, {});
  refused(pin, face, {}, {});
  refused(slot, hole, {}, {});
  refused(blind, hole, {}, {.flip = true});
  refused(face, face, {}, {.flip = true});
  const SeatFaces askew{&face, {&face, Pose()}};
  refused(pin, hole, askew, {});  // the faces are not square to the axes
  refused(face, face, askew, {});
  const SeatFaces no_faces{&pin, {&hole, Pose()}};
  refused(pin, hole, no_faces, {});
}

TEST_CASE("an element stands on a tilted face with its bottom", "[property]") {
  const unsigned seed = GENERATE(range(400U, 420U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  const Feature bottom = testing::face_feature("bottom", {3, 4, -5}, -kUp, 1);
  const Feature top = testing::face_feature("top", random.point(50), random.direction(), 1);
  const PlacedFeature on{&top, Pose(random.rotation(), random.point(100))};
  const PlacedFeature placed{&bottom, dowel::standing_pose(bottom, on)};
  check_near(placed.origin_W(), on.origin_W());
  check_near(placed.direction_W(), -on.direction_W());
}
