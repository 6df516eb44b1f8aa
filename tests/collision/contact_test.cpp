// The contact suite: pairs whose gap or depth is known by construction, in random world poses.

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <vector>

#include <catch2/catch.hpp>

#include "collision_element.h"
#include "contact_suite.h"
#include "dowel/collision/scene.h"
#include "random_geometry.h"
#include "solids.h"

using dowel::CollisionElement;
using dowel::CollisionScene;
using dowel::FacetedSolid;
using dowel::Pose;
using dowel::QueryOptions;
using dowel::Verdict;
using dowel::testing::ContactCase;
namespace testing = dowel::testing;

namespace {

using testing::collision_element;

#ifdef DOWEL_SANITIZED
constexpr int kWorldPoses = 20;
constexpr int kPins = 20;
#else
constexpr int kWorldPoses = 1'000;
constexpr int kPins = 400;
#endif

/// A case in a scene, to be asked at many poses. Nothing is remembered from one to the next: the
/// placed body is moved in between.
class PlacedCase {
 public:
  /// `X_EA`: pose of the first solid in the frame of its element.
  explicit PlacedCase(const ContactCase& c, const Pose& X_EA = Pose())
      : X_AE_(X_EA.inverse()), b_(scene_.add(collision_element(c.b), Pose())) {
    const auto solid = std::make_shared<const FacetedSolid>(testing::transformed(X_EA, c.a));
    a_ = scene_.add(std::make_shared<const CollisionElement>(
                        dowel::transformed(X_EA, testing::box_of(c.a)), [solid] { return solid; }),
                    Pose::from_translation({1e4, 0, 0}));
  }

  Verdict at(const Pose& X_BA, const Pose& X_WB, double tolerance_mm) {
    scene_.move(b_, X_WB);
    const std::array<dowel::BodyId, 1> moving{a_};
    const std::array<Pose, 1> poses{X_WB * X_BA * X_AE_};
    return worst(scene_.check(moving, poses, QueryOptions{.tolerance_mm = tolerance_mm}));
  }

 private:
  CollisionScene scene_;
  Pose X_AE_;
  dowel::BodyId b_;
  dowel::BodyId a_;
};

/// Asks at depths and gaps a tenth of the tolerance on either side of where the verdict changes.
void check_thresholds(const ContactCase& c, PlacedCase& placed, double t, const Pose& X_WB) {
  REQUIRE(placed.at(c.X_BA(0.0), X_WB, t) == Verdict::Contact);
  REQUIRE(placed.at(c.X_BA(0.9 * t), X_WB, t) == Verdict::Contact);
  REQUIRE(placed.at(c.X_BA(1.1 * t), X_WB, t) == Verdict::Interference);
  REQUIRE(placed.at(c.X_BA(0.5), X_WB, t) == Verdict::Interference);
  if (!c.has_gap) return;
  REQUIRE(placed.at(c.X_BA(-0.9 * t), X_WB, t) == Verdict::Contact);
  REQUIRE(placed.at(c.X_BA(-1.1 * t), X_WB, t) == Verdict::Clear);
}

}  // namespace

TEST_CASE("depth and gap decide the verdict within a tenth of the tolerance, in any pose",
          "[property]") {
  // In their own frame faces that lie in one plane may do so to the bit; askew they do not.
  const bool is_askew = GENERATE(false, true);
  testing::RandomGeometry random(11);
  const Pose X_EA = is_askew ? random.pose(10.0) : Pose();
  for (const ContactCase& c : testing::contact_suite()) {
    PlacedCase placed(c, X_EA);
    for (int i = 0; i < kWorldPoses; ++i) {
      const Pose X_WB = random.pose(i == 0 ? 0.0 : 10'000.0);
      const double t = i % 2 == 0 ? 0.01 : 0.001;
      CAPTURE(c.name, t, i);
      check_thresholds(c, placed, t, X_WB);
    }
  }
}

TEST_CASE("a rim that stands on a plane is judged by its circle, not by its chords", "[property]") {
  testing::RandomGeometry random(16);
  const FacetedSolid table = testing::box({600, 600, 20}, {0, 0, -10});
  const double t = 0.01;
  for (int i = 0; i < 100; ++i) {
    // Two flat cones, base to base: their chords are off the rim by many tolerances.
    const double radius = random.uniform(5, 200);
    const double height = radius * random.uniform(0.03, 0.4);
    const ContactCase c{"",
                        testing::revolved({{0, 0}, {radius, height}, {0, 2 * height}},
                                          16 + random.index(60), random.uniform(0, 1)),
                        table,
                        {}};
    const double tilt = random.uniform(std::atan2(height, radius) + 0.1, 1.5);
    const double lowest = height * std::cos(tilt) - radius * std::sin(tilt);
    const auto at = [&](double gap) {
      return Pose(Eigen::Quaterniond(Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX())),
                  {0, 0, gap - lowest});
    };
    CAPTURE(i, radius, height, tilt);
    PlacedCase placed(c);
    const Pose X_WB = random.pose(1000);
    CHECK(placed.at(at(0.5 * t), X_WB, t) == Verdict::Contact);
    CHECK(placed.at(at(0.0), X_WB, t) == Verdict::Contact);
    CHECK(placed.at(at(1.1 * t), X_WB, t) == Verdict::Clear);
  }
}

TEST_CASE("a fine ball in a coarse one interferes as deep as they are", "[property]") {
  testing::RandomGeometry random(17);
  const double t = 0.01;
  for (int i = 0; i < 60; ++i) {
    // Facets of the large one are off by hundreds of tolerances.
    const double radius = random.uniform(40, 90);
    const double small = random.uniform(2, 5);
    const auto at = [&](double depth) {
      return Pose::from_translation((radius + small - depth) * random.direction());
    };
    const ContactCase c{"", testing::sphere(small, 24 + random.index(24)),
                        testing::sphere(radius, 10 + random.index(8)), at, true};
    CAPTURE(i, radius, small);
    PlacedCase placed(c);
    check_thresholds(c, placed, t, random.pose(1000));
  }
}

TEST_CASE("a tip in a coarse ball interferes as deep as they are", "[property]") {
  testing::RandomGeometry random(18);
  const double t = 0.01;
  for (int i = 0; i < 100; ++i) {
    const double radius = random.uniform(20, 60);
    const double half_angle = random.uniform(0.3, 1.2);
    const double height = random.uniform(2, 10);
    const Eigen::Vector3d axis = random.direction();
    const auto turn = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), -axis);
    const auto at = [&](double depth) {
      return Pose(turn, (radius + height - testing::tip_height_mm(depth, half_angle)) * axis);
    };
    const ContactCase c{"", testing::cone(height * std::tan(half_angle), height, 24),
                        testing::sphere(radius, 10 + random.index(8)), at, true};
    CAPTURE(i, radius, half_angle, height);
    PlacedCase placed(c);
    check_thresholds(c, placed, t, random.pose(1000));
  }
}

TEST_CASE("a pin in its hole is judged by the exact cylinders, not by the facets", "[property]") {
  testing::RandomGeometry random(13);
  const double t = 0.001;
  std::map<Verdict, int> seen;
  for (int k = 0; k < kPins; ++k) {
    // Radial clearance of 1 um to 1 mm, or as much too little; coarse facets at random phases.
    const double size = std::pow(10.0, random.uniform(-3.0, 0.0));
    const double clearance = random.index(4) == 0 ? -size : size;
    const double hole = random.uniform(3.0, 12.0);
    const ContactCase c{
        "",
        testing::cylinder(hole - clearance, 30, 12 + random.index(28), random.uniform(0, 7)),
        testing::plate_with_holes({60, 60, 20}, {{0, 0, hole}}, 12 + random.index(28)),
        {}};
    PlacedCase placed(c);
    for (int i = 0; i < 10; ++i) {
      // Off the axis by as much as leaves play, or somewhat more.
      const double offset = clearance > 0 ? random.uniform(0.0, 1.0) * (clearance + 2 * t) : 0.0;
      const double play = clearance - offset;  // negative: overlap, whose depth it is
      if (std::abs(play + t) < 0.1 * t || std::abs(play - t) < 0.1 * t) continue;
      const double direction = random.uniform(0, 7);
      const Pose X_BA(
          Eigen::Quaterniond(Eigen::AngleAxisd(random.uniform(0, 7), Eigen::Vector3d::UnitZ())),
          {offset * std::cos(direction), offset * std::sin(direction), random.uniform(-8, -2)});
      const Verdict expected = play < -t   ? Verdict::Interference
                               : play <= t ? Verdict::Contact
                                           : Verdict::Clear;
      CAPTURE(k, i, hole, clearance, offset, play);
      REQUIRE(placed.at(X_BA, random.pose(10'000), t) == expected);
      ++seen[expected];
    }
  }
  CAPTURE(seen[Verdict::Clear], seen[Verdict::Contact], seen[Verdict::Interference]);
  for (const auto& [verdict, count] : seen) CHECK(count > kPins / 2);
  CHECK(seen.size() == 3);
}

TEST_CASE("a pin tilts in its bore until it jams, by the exact cylinders", "[property]") {
  testing::RandomGeometry random(42);
  const double t = 0.001;
  const double length = 20.0;
  const double hole = 6.0;
  std::map<Verdict, int> seen;
  for (int k = 0; k < kPins; ++k) {
    const double clearance = std::pow(10.0, random.uniform(-3.0, 0.0));
    PlacedCase placed(
        {"",
         testing::cylinder(hole - clearance, 60, 12 + random.index(28), random.uniform(0, 7)),
         testing::plate_with_holes({60, 60, length}, {{0, 0, hole}}, 12 + random.index(28)),
         {}});
    for (int i = 0; i < 10; ++i) {
      const double angle = random.uniform(0.0, 1.0) * (2.0 * clearance + 4.0 * t) / length;
      // Tilted about the bore's middle: at each mouth the elliptic section, whose half axis is the
      // radius by cos(angle), is off by half the length times tan(angle).
      const double play =
          hole - (hole - clearance) / std::cos(angle) - 0.5 * length * std::tan(angle);
      // The largest ball lies in the corner of a mouth: it fits into the triangle of bore, face and
      // pin.
      const double depth = -play * (1.0 - std::tan(0.5 * angle));
      if (std::abs(play * std::cos(angle) - t) < 0.1 * t || std::abs(depth - t) < 0.1 * t) continue;
      const Verdict expected = depth > t                     ? Verdict::Interference
                               : play * std::cos(angle) <= t ? Verdict::Contact
                                                             : Verdict::Clear;
      const double turn = random.uniform(0.0, 7.0);
      const Eigen::Vector3d about(std::cos(turn), std::sin(turn), 0.0);
      const Pose X_BA = Pose::about_axis({0, 0, 0.5 * length}, about, angle) *
                        Pose::from_translation({0, 0, -20});
      CAPTURE(k, i, clearance, angle, play, depth);
      REQUIRE(placed.at(X_BA, random.pose(10'000), t) == expected);
      ++seen[expected];
    }
  }
  CAPTURE(seen[Verdict::Clear], seen[Verdict::Contact], seen[Verdict::Interference]);
  for (const auto& [verdict, count] : seen) CHECK(count > kPins / 4);
  CHECK(seen.size() == 3);
}

TEST_CASE("solids inside one another and identical solids interfere") {
  const FacetedSolid big = testing::box({100, 100, 100});
  const FacetedSolid small = testing::box({10, 10, 10});
  const FacetedSolid pin = testing::stepped_pin({{5.993, 12}, {9.0, 6}}, 12);
  // In the cavity of a hollow part there is room.
  const FacetedSolid core = testing::box({50, 50, 50});
  const FacetedSolid hollow = testing::hollowed(big, core);
  // Of several solids, one is reached.
  const FacetedSolid two = testing::merged(
      core, testing::transformed(Pose::from_translation({200, 0, 0}), testing::box({60, 60, 60})));
  struct Nested {
    FacetedSolid a;
    FacetedSolid b;
    Eigen::Vector3d at;
    Verdict verdict;
  };
  const std::vector<Nested> nested{
      {small, big, {0, 0, 0}, Verdict::Interference},
      {big, small, {0, 0, 0}, Verdict::Interference},
      {big, big, {0, 0, 0}, Verdict::Interference},
      {pin, pin, {0, 0, 0}, Verdict::Interference},
      {hollow, hollow, {0, 0, 0}, Verdict::Interference},
      {small, hollow, {0, 0, 0}, Verdict::Clear},
      {core, hollow, {0, 0, 0}, Verdict::Contact},
      {small, two, {200, 0, 0}, Verdict::Interference},
      {two, small, {-200, 0, 0}, Verdict::Interference},
      {small, two, {100, 0, 0}, Verdict::Clear},
  };
  for (std::size_t k = 0; k < nested.size(); ++k) {
    PlacedCase placed({"", nested[k].a, nested[k].b, {}});
    testing::RandomGeometry random(14);
    for (int i = 0; i < kWorldPoses; ++i) {
      CAPTURE(k, i);
      REQUIRE(placed.at(Pose::from_translation(nested[k].at), random.pose(10'000), 0.01) ==
              nested[k].verdict);
    }
  }
}

TEST_CASE("identical sheets interfere once they are thicker than the tolerance", "[property]") {
  const double t = 0.01;
  for (const double share : {0.9, 1.1}) {
    const FacetedSolid sheet = testing::box({30, 20, share * t});
    PlacedCase placed({"", sheet, sheet, {}});
    testing::RandomGeometry random(16);
    for (int i = 0; i < kWorldPoses; ++i) {
      CAPTURE(share, i);
      REQUIRE(placed.at(Pose(), random.pose(10'000), t) ==
              (share > 1.0 ? Verdict::Interference : Verdict::Contact));
    }
  }
}

TEST_CASE("in mode paper a pin too thick for its hole goes unseen, in mode exact it does not") {
  FacetedSolid plate = testing::plate_with_holes({60, 60, 20}, {{0, 0, 6.0}}, 24);
  std::vector<std::uint32_t> walls;
  for (std::uint32_t i = 0; i < plate.faces.size(); ++i) {
    if (plate.faces[i].reversed) walls.push_back(i);
  }
  REQUIRE(walls.size() == 1);
  const dowel::Aabb box = dowel::bounds(plate.vertices);
  const auto shared = std::make_shared<const FacetedSolid>(std::move(plate));
  const auto plate_element = std::make_shared<const CollisionElement>(
      dowel::Obb{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()},
      [shared] { return shared; }, walls);
  CollisionScene scene;
  scene.add(plate_element, Pose());
  // Ends inside the plate on both sides, so that only the wall can tell.
  const auto pin = scene.add(collision_element(testing::cylinder(6.5, 10, 24)),
                             Pose::from_translation({0, 0, 5}));
  const std::array<dowel::BodyId, 1> moving{pin};
  const std::array<Pose, 1> poses{scene.pose(pin)};
  CHECK(worst(scene.check(moving, poses, {.holes = dowel::HoleMode::Exact})) ==
        Verdict::Interference);
  CHECK(worst(scene.check(moving, poses, {.holes = dowel::HoleMode::Paper})) !=
        Verdict::Interference);
}
