// The contact suite: pairs whose gap or depth is known by construction, in random world poses.

#include <functional>
#include <string>

#include <catch2/catch.hpp>

#include "collision_element.h"
#include "dowel/collision/scene.h"
#include "random_geometry.h"
#include "solids.h"

using dowel::BodyVerdict;
using dowel::CollisionElement;
using dowel::CollisionScene;
using dowel::FacetedSolid;
using dowel::Pose;
using dowel::QueryOptions;
using dowel::Verdict;
namespace testing = dowel::testing;

namespace {

constexpr double kPi = 3.14159265358979323846;

using testing::collision_element;

#ifdef DOWEL_SANITIZED
constexpr int kWorldPoses = 20;
#else
constexpr int kWorldPoses = 1'000;
#endif

/// Two bodies, and where the first has a wanted depth in the second (negative: gap).
struct Case {
  std::string name;
  FacetedSolid a;
  FacetedSolid b;
  std::function<Pose(double)> X_BA;  ///< places A in B for a given depth (> 0) or gap (< 0)
};

Pose lifted(double z) {
  return Pose::from_translation({0, 0, z});
}

/// Height of an obtuse-free tip whose largest ball under a plane has diameter `depth`.
double tip_height(double depth, double half_angle) {
  const double sine = std::sin(half_angle);
  return depth > 0 ? 0.5 * depth * (1.0 + sine) / sine : depth;
}

/// A wedge of `angle` standing on its edge along x, tip at the origin.
FacetedSolid tip_bar(double angle, double flank) {
  const Pose edge_along_x(
      Eigen::Quaterniond(Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitY())) *
          Eigen::Quaterniond(Eigen::AngleAxisd(kPi - angle / 2, Eigen::Vector3d::UnitZ())),
      {-20, 0, 0});
  return testing::transformed(edge_along_x, testing::wedge(angle, flank, 40));
}

std::vector<Case> suite() {
  std::vector<Case> cases;
  const FacetedSolid block = testing::box({40, 30, 20}, {0, 0, 10});
  const FacetedSolid table = testing::box({100, 100, 20}, {0, 0, -10});
  cases.push_back({"flat on flat", block, table, [](double d) { return lifted(-d); }});
  cases.push_back({"flush boxes, side by side", block, block, [](double d) {
                     return Pose::from_translation({40 - d, 0, 0});
                   }});
  cases.push_back({"cylinder standing on a plane", testing::cylinder(6, 20, 26), table,
                   [](double d) { return lifted(-d); }});
  cases.push_back(
      {"cylinder lying on a plane", testing::cylinder(6, 20, 26, 0.05), table, [](double d) {
         return Pose(Eigen::Quaterniond(Eigen::AngleAxisd(kPi / 2, Eigen::Vector3d::UnitX())),
                     {0, 0, 6 - d});
       }});
  cases.push_back({"pin seated in a blind hole", testing::cylinder(5.994, 30, 26, 0.1),
                   testing::plate_with_holes({60, 60, 40}, {{0, 0, 6.0, 25.0}}, 30),
                   [](double d) { return lifted(15 - d); }});
  cases.push_back({"riser with holes on a plate with holes",
                   testing::plate_with_holes({78, 78, 20}, testing::hole_grid(2, 2, 40, 6.75), 24),
                   testing::transformed(lifted(-20),
                                        testing::plate_with_holes(
                                            {160, 160, 20}, testing::hole_grid(4, 4, 40, 6.0), 20)),
                   [](double d) { return lifted(-d); }});
  for (const double degrees : {5.0, 15.0, 30.0, 45.0, 90.0}) {
    const double angle = degrees * kPi / 180;
    cases.push_back({"wedge edge of " + std::to_string(degrees) + " degrees on a face",
                     tip_bar(angle, 30), table,
                     [angle](double d) { return lifted(-tip_height(d, angle / 2)); }});
    cases.push_back({"crossed edges of " + std::to_string(degrees) + " degrees", tip_bar(angle, 30),
                     testing::transformed(Pose(Eigen::Quaterniond(Eigen::AngleAxisd(
                                                   kPi, Eigen::Vector3d(1, 1, 0).normalized())),
                                               {0, 0, 0}),
                                          tip_bar(angle, 30)),
                     [angle](double d) { return lifted(d > 0 ? -d / std::sin(angle / 2) : -d); }});
  }
  const double cone_half = std::atan2(8.0, 20.0);
  cases.push_back(
      {"cone tip on a face",
       testing::transformed(
           Pose(Eigen::Quaterniond(Eigen::AngleAxisd(kPi, Eigen::Vector3d::UnitX())), {0, 0, 20}),
           testing::cone(8, 20, 32)),
       table, [cone_half](double d) { return lifted(-tip_height(d, cone_half)); }});
  const std::vector<Eigen::Vector2d> tail{
      {-10, 0}, {10, 0}, {15, 8.660254037844386}, {-15, 8.660254037844386}};
  const std::vector<Eigen::Vector2d> groove{
      {-40, -10}, {40, -10}, {40, 8.660254037844386},  {15, 8.660254037844386},
      {10, 0},    {-10, 0},  {-15, 8.660254037844386}, {-40, 8.660254037844386}};
  cases.push_back({"dovetail lifted out of its groove", testing::prism(tail, 60),
                   testing::prism(groove, 60), [](double d) {
                     return Pose::from_translation({0, d > 0 ? -d : -d, 0});
                   }});
  // A T-nut drawn up under the lips of its slot: both walls 0.2 mm off, the flanges flush.
  const std::vector<Eigen::Vector2d> nut{{-10.8, 0}, {10.8, 0},  {10.8, 7.8}, {6.8, 7.8},
                                         {6.8, 14},  {-6.8, 14}, {-6.8, 7.8}, {-10.8, 7.8}};
  const std::vector<Eigen::Vector2d> slot{{-30, -20}, {30, -20}, {30, 16}, {7, 16},
                                          {7, 8},     {11, 8},   {11, -2}, {-11, -2},
                                          {-11, 8},   {-7, 8},   {-7, 16}, {-30, 16}};
  cases.push_back({"T-nut drawn up in its slot", testing::prism(nut, 25), testing::prism(slot, 100),
                   [](double d) {
                     return Pose::from_translation({0, 0.2 + d, 40});
                   }});
  cases.push_back({"screw head on the edge of its clearance hole",
                   testing::stepped_pin({{5.0, 30}, {8.0, 8}}, 22),
                   testing::plate_with_holes({60, 60, 20}, {{0, 0, 6.6}}, 18), [](double d) {
                     return Pose::from_translation({1.0, 0.5, -10 - d});
                   }});
  return cases;
}

/// A case in a scene, to be asked at many poses. Nothing is remembered from one to the next: the
/// placed body is moved in between.
class PlacedCase {
 public:
  explicit PlacedCase(const Case& c)
      : b_(scene_.add(collision_element(c.b), Pose())),
        a_(scene_.add(collision_element(c.a), Pose::from_translation({1e4, 0, 0}))) {}

  Verdict at(const Pose& X_BA, const Pose& X_WB, double tolerance_mm) {
    scene_.move(b_, X_WB);
    const std::array<dowel::BodyId, 1> moving{a_};
    const std::array<Pose, 1> poses{X_WB * X_BA};
    return worst(scene_.check(moving, poses, QueryOptions{.tolerance_mm = tolerance_mm}));
  }

 private:
  CollisionScene scene_;
  dowel::BodyId b_;
  dowel::BodyId a_;
};

Verdict verdict_at(const Case& c, const Pose& X_BA, const Pose& X_WB, double tolerance_mm) {
  return PlacedCase(c).at(X_BA, X_WB, tolerance_mm);
}

}  // namespace

TEST_CASE("depth and gap decide the verdict within a tenth of the tolerance, in any pose",
          "[property]") {
  for (const Case& c : suite()) {
    PlacedCase placed(c);
    for (const double t : {0.01, 0.001}) {
      testing::RandomGeometry random(11);
      for (int i = 0; i < kWorldPoses / 2; ++i) {
        const Pose X_WB = random.pose(i == 0 ? 0.0 : 10'000.0);
        CAPTURE(c.name, t, i);
        REQUIRE(placed.at(c.X_BA(0.0), X_WB, t) == Verdict::Contact);
        REQUIRE(placed.at(c.X_BA(0.9 * t), X_WB, t) == Verdict::Contact);
        REQUIRE(placed.at(c.X_BA(1.1 * t), X_WB, t) == Verdict::Interference);
        REQUIRE(placed.at(c.X_BA(0.5), X_WB, t) == Verdict::Interference);
      }
    }
  }
}

TEST_CASE("a gap above the tolerance is clear and one below it is contact", "[property]") {
  for (const std::string name :
       {"flat on flat", "cylinder lying on a plane", "cone tip on a face"}) {
    const auto cases = suite();
    const Case& c =
        *std::find_if(cases.begin(), cases.end(), [&](const Case& x) { return x.name == name; });
    testing::RandomGeometry random(12);
    for (int i = 0; i < 10; ++i) {
      const Pose X_WB = random.pose(5000.0);
      CAPTURE(name, i);
      CHECK(verdict_at(c, c.X_BA(-0.009), X_WB, 0.01) == Verdict::Contact);
      CHECK(verdict_at(c, c.X_BA(-0.011), X_WB, 0.01) == Verdict::Clear);
    }
  }
}

TEST_CASE("a pin in its hole is judged by the exact cylinders, not by the facets", "[property]") {
  testing::RandomGeometry random(13);
  const double t = 0.001;
  int clear = 0;
  int interference = 0;
  for (int i = 0; i < 300; ++i) {
    // Diametral clearance from -30 um to +60 um, coarse facets at random phases, any offset.
    const double clearance = random.uniform(-0.03, 0.06);
    const double pin = 6.0 - clearance / 2;
    const double offset = clearance > 0 ? random.uniform(0.0, clearance) : 0.0;
    Case c{"",
           testing::cylinder(pin, 30, 20 + random.index(20), random.uniform(0, 1)),
           testing::plate_with_holes({60, 60, 20}, {{0, 0, 6.0}}, 20 + random.index(20)),
           {}};
    // Radial play left on the near side; negative: overlap, whose depth it is.
    const double play = clearance / 2 - offset;
    if (std::abs(play + t) < 0.1 * t || std::abs(play - t) < 0.1 * t) continue;
    const Pose X_BA = Pose::from_translation({offset, 0, random.uniform(-8, -2)});
    const Verdict expected = play < -t   ? Verdict::Interference
                             : play <= t ? Verdict::Contact
                                         : Verdict::Clear;
    CAPTURE(i, clearance, offset, play);
    CHECK(verdict_at(c, X_BA, random.pose(3000), t) == expected);
    clear += expected == Verdict::Clear ? 1 : 0;
    interference += expected == Verdict::Interference ? 1 : 0;
  }
  CHECK(clear > 30);
  CHECK(interference > 50);
}

TEST_CASE("solids inside one another and identical solids interfere") {
  const FacetedSolid big = testing::box({100, 100, 100});
  const FacetedSolid small = testing::box({10, 10, 10});
  testing::RandomGeometry random(14);
  for (int i = 0; i < 20; ++i) {
    const Pose X_WB = random.pose(5000);
    CHECK(verdict_at({"", small, big, {}}, Pose(), X_WB, 0.01) == Verdict::Interference);
    CHECK(verdict_at({"", big, small, {}}, Pose(), X_WB, 0.01) == Verdict::Interference);
    CHECK(verdict_at({"", big, big, {}}, Pose(), X_WB, 0.01) == Verdict::Interference);
    // In the cavity of a hollow part there is room.
    const FacetedSolid hollow = testing::hollowed(big, testing::box({50, 50, 50}));
    CHECK(verdict_at({"", small, hollow, {}}, Pose(), X_WB, 0.01) == Verdict::Clear);
    CHECK(verdict_at({"", testing::box({50, 50, 50}), hollow, {}}, Pose(), X_WB, 0.01) ==
          Verdict::Contact);
  }
}

TEST_CASE("parts that share an edge or a corner are in contact", "[degenerate]") {
  const FacetedSolid block = testing::box({10, 10, 10});
  testing::RandomGeometry random(15);
  for (int i = 0; i < 20; ++i) {
    const Pose X_WB = random.pose(5000);
    CHECK(verdict_at({"", block, block, {}}, Pose::from_translation({10, 10, 0}), X_WB, 0.01) ==
          Verdict::Contact);
    CHECK(verdict_at({"", block, block, {}}, Pose::from_translation({10, 10, 10}), X_WB, 0.01) ==
          Verdict::Contact);
    CHECK(verdict_at({"", block, block, {}}, Pose::from_translation({10.02, 10, 10}), X_WB, 0.01) ==
          Verdict::Clear);
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
