#include "dowel/collision/scene.h"

#include <algorithm>
#include <array>
#include <tuple>
#include <vector>

#include <catch2/catch.hpp>

#include "collision_element.h"
#include "dowel/kernel/error.h"
#include "random_geometry.h"
#include "solids.h"

using dowel::BodyId;
using dowel::BodyVerdict;
using dowel::CollisionElement;
using dowel::CollisionScene;
using dowel::FacetedSolid;
using dowel::Pose;
using dowel::Verdict;
namespace testing = dowel::testing;

namespace {

std::shared_ptr<const CollisionElement> box_element(const Eigen::Vector3d& size,
                                                    int* loads = nullptr) {
  return std::make_shared<const CollisionElement>(
      dowel::Obb{Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity(), 0.5 * size}, [size, loads] {
        if (loads != nullptr) ++*loads;
        return std::make_shared<const FacetedSolid>(testing::box(size));
      });
}

}  // namespace

TEST_CASE("no facets are loaded for a part that no move comes near, and each element's once") {
  int near_loads = 0;
  int far_loads = 0;
  CollisionScene scene;
  const auto near = box_element({10, 10, 10}, &near_loads);
  scene.add(near, Pose());
  scene.add(near, Pose::from_translation({0, 10, 0}));
  scene.add(box_element({10, 10, 10}, &far_loads), Pose::from_translation({500, 0, 0}));
  const BodyId tool = scene.add(box_element({5, 5, 5}), Pose::from_translation({0, 0, 100}));
  const std::array<BodyId, 1> moving{tool};
  for (const double z : {100.0, 50.0, 7.5, 7.0}) {
    const std::array<Pose, 1> poses{Pose::from_translation({0, 5, z})};
    const auto verdicts = scene.check(moving, poses, {});
    CHECK(worst(verdicts) == (z > 10     ? Verdict::Clear
                              : z == 7.5 ? Verdict::Contact
                                         : Verdict::Interference));
    if (z < 10) CHECK(verdicts.size() == 2);
  }
  CHECK(near_loads == 1);
  CHECK(far_loads == 0);
}

TEST_CASE("a unit is not checked against itself") {
  CollisionScene scene;
  const auto element = box_element({10, 10, 10});
  const std::array<BodyId, 2> unit{scene.add(element, Pose()),
                                   scene.add(element, Pose::from_translation({5, 0, 0}))};
  scene.add(element, Pose::from_translation({50, 0, 0}));
  const std::array<Pose, 2> apart{scene.pose(unit[0]), scene.pose(unit[1])};
  CHECK(scene.check(unit, apart, {}).empty());
  const std::array<Pose, 2> moved{Pose::from_translation({36, 0, 0}),
                                  Pose::from_translation({41, 0, 0})};
  const auto verdicts = scene.check(unit, moved, {});
  REQUIRE(verdicts.size() == 1);
  CHECK(verdicts[0].moving == unit[1]);
  CHECK(scene.check_all({}).size() == 1);  // the two of the unit overlap
}

namespace {

#ifdef DOWEL_SANITIZED
constexpr int kScenes = 3;
#else
constexpr int kScenes = 35;
#endif

/// Boxes, pins and wedges, some of them in each other.
struct Crowd {
  CollisionScene scene;
  std::vector<BodyId> bodies;

  explicit Crowd(testing::RandomGeometry& random) {
    const std::array elements{testing::collision_element(testing::box({10, 8, 6})),
                              testing::collision_element(testing::cylinder(3, 14, 12)),
                              testing::collision_element(testing::wedge(0.5, 12, 9))};
    for (int i = 0; i < 54; ++i) {
      bodies.push_back(scene.add(elements[random.index(elements.size())], random.pose(25)));
    }
  }

  std::vector<BodyVerdict> met_by(BodyId body, const Pose& pose, bool first_only = false) {
    const auto found = scene.check({&body, 1}, {&pose, 1}, {.first_only = first_only});
    return {found.begin(), found.end()};
  }
};

using Met = std::tuple<std::uint32_t, std::uint32_t, Verdict>;

/// Who meets whom and how.
std::vector<Met> summary(std::span<const BodyVerdict> verdicts) {
  std::vector<Met> result;
  for (const BodyVerdict& v : verdicts) {
    result.emplace_back(v.moving.value, v.with.value, v.pair.verdict);
  }
  return result;
}

}  // namespace

TEST_CASE("all pairs of a scene are those that each body alone finds, and that facets tell",
          "[property]") {
  testing::RandomGeometry random(21);
  std::size_t pairs = 0;
  std::size_t met = 0;
  for (int k = 0; k < kScenes; ++k) {
    CAPTURE(k);
    Crowd crowd(random);
    std::vector<Met> found;
    for (const BodyId body : crowd.bodies) {
      const Pose pose = crowd.scene.pose(body);
      const std::vector<Met> fast = summary(crowd.met_by(body, pose));
      REQUIRE(fast == summary(crowd.scene.check_brute_force({&body, 1}, {&pose, 1}, {})));
      for (const Met& m : fast) {
        if (std::get<0>(m) < std::get<1>(m)) found.push_back(m);
      }
    }
    const std::vector<Met> all = summary(crowd.scene.check_all({}));
    REQUIRE(found == all);
    pairs += crowd.bodies.size() * (crowd.bodies.size() - 1);  // asked from either side
    met += all.size();
  }
  CHECK(pairs > 2'800U * kScenes);
  CHECK(met > 20U * kScenes);
}

TEST_CASE("a unit meets what each of its bodies meets, but for its own", "[property]") {
  testing::RandomGeometry random(23);
  std::size_t met = 0;
  std::size_t own = 0;
  for (int k = 0; k < kScenes; ++k) {
    Crowd crowd(random);
    const std::array<BodyId, 3> unit{crowd.bodies[4], crowd.bodies[20], crowd.bodies[37]};
    for (int i = 0; i < 100; ++i) {
      const Pose X_WU = Pose::about_axis({0, 0, 0}, random.direction(), random.uniform(0, 0.05)) *
                        Pose::from_translation(random.point(0.5));
      std::array<Pose, 3> poses;
      std::vector<Met> alone;
      for (std::size_t j = 0; j < unit.size(); ++j) {
        poses[j] = X_WU * crowd.scene.pose(unit[j]);
        for (const Met& m : summary(crowd.met_by(unit[j], poses[j]))) {
          const bool is_own =
              std::ranges::any_of(unit, [&](BodyId id) { return id.value == std::get<1>(m); });
          if (is_own) ++own;
          if (!is_own) alone.push_back(m);
        }
      }
      CAPTURE(k, i);
      REQUIRE(summary(crowd.scene.check(unit, poses, {})) == alone);
      met += alone.size();
    }
  }
  CHECK(met > 100U * kScenes);
  CHECK(own > 0);
}

TEST_CASE("the first hit is told where there is one, and it is one of all", "[property]") {
  testing::RandomGeometry random(24);
  int hits = 0;
  int others = 0;
  for (int k = 0; k < kScenes; ++k) {
    Crowd crowd(random);
    for (int i = 0; i < 300; ++i) {
      const BodyId body = crowd.bodies[random.index(54)];
      const Pose pose = random.pose(30);
      const auto all = crowd.met_by(body, pose);
      const auto first = crowd.met_by(body, pose, true);
      CAPTURE(k, i);
      REQUIRE(worst(first) == worst(all));
      if (worst(all) == Verdict::Interference) {
        ++hits;
        REQUIRE(first.size() == 1);
        REQUIRE(std::ranges::count(summary(all), summary(first)[0]) == 1);
      } else {
        ++others;
        REQUIRE(summary(first) == summary(all));
      }
    }
  }
  CHECK(hits > 50 * kScenes);
  CHECK(others > 20 * kScenes);
}

TEST_CASE("a removed body is no longer met and its id may come back") {
  CollisionScene scene;
  const auto element = box_element({10, 10, 10});
  const BodyId first = scene.add(element, Pose());
  const BodyId second = scene.add(element, Pose::from_translation({1, 0, 0}));
  CHECK(scene.check_all({}).size() == 1);
  scene.remove(first);
  CHECK(scene.check_all({}).empty());
  CHECK(scene.size() == 1);
  CHECK_THROWS_AS(scene.remove(first), std::logic_error);
  scene.add(element, Pose::from_translation({2, 0, 0}));
  CHECK(scene.check_all({}).size() == 1);
  scene.move(second, Pose::from_translation({100, 0, 0}));
  CHECK(scene.check_all({}).empty());
}

TEST_CASE("a screw may overlap the thread it is declared for and nothing else") {
  CollisionScene scene;
  const auto plate_solid = std::make_shared<const FacetedSolid>(
      testing::plate_with_holes({60, 60, 20}, {{0, 0, 5.053}}, 24));
  const auto screw_solid = std::make_shared<const FacetedSolid>(testing::cylinder(6.0, 30, 24));
  const auto element = [](const std::shared_ptr<const FacetedSolid>& solid) {
    const dowel::Aabb box = dowel::bounds(solid->vertices).padded(0.2);
    return std::make_shared<const CollisionElement>(
        dowel::Obb{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()},
        [solid] { return solid; });
  };
  const BodyId plate = scene.add(element(plate_solid), Pose());
  const BodyId screw = scene.add(element(screw_solid), Pose::from_translation({0, 0, -5}));
  CHECK(worst(scene.check_all({})) == Verdict::Interference);
  scene.set_reliefs(screw, plate, {{{0, 0, 5}, Eigen::Vector3d::UnitZ(), 20, 6.0}});
  CHECK(worst(scene.check_all({})) == Verdict::Contact);
  scene.set_reliefs(plate, screw, {{{0, 0, 0}, Eigen::Vector3d::UnitZ(), 20, 6.0}});
  CHECK(worst(scene.check_all({})) == Verdict::Contact);
  // Whichever moves.
  const Pose X_WS = Pose::from_translation({0, 0, -5});
  CHECK(worst(scene.check(std::span(&screw, 1), std::span(&X_WS, 1), {})) == Verdict::Contact);
  const Pose X_WP;
  CHECK(worst(scene.check(std::span(&plate, 1), std::span(&X_WP, 1), {})) == Verdict::Contact);
  // Tilted or off its axis it is no longer in its thread.
  scene.move(screw, Pose::from_translation({0.5, 0, -5}));
  CHECK(worst(scene.check_all({})) == Verdict::Interference);
  scene.set_reliefs(plate, screw, {});
  scene.move(screw, Pose::from_translation({0, 0, -5}));
  CHECK(worst(scene.check_all({})) == Verdict::Interference);
}

TEST_CASE("the same queries give the same verdicts and counters again", "[determinism]") {
  const auto run = [] {
    testing::RandomGeometry random(22);
    CollisionScene scene;
    const auto element = std::make_shared<const CollisionElement>(
        dowel::Obb{{0, 0, 10}, Eigen::Matrix3d::Identity(), {6.2, 6.2, 10}},
        [] { return std::make_shared<const FacetedSolid>(testing::cylinder(6, 20, 26)); });
    for (int i = 0; i < 40; ++i) scene.add(element, random.pose(40));
    const auto verdicts = scene.check_all({});
    std::vector<double> numbers{static_cast<double>(scene.counters().triangle_tests)};
    for (const auto& v : verdicts) {
      numbers.insert(numbers.end(), {v.pair.depth_mm, v.pair.gap_mm, v.pair.witness_W.x()});
    }
    return numbers;
  };
  CHECK(run() == run());
  CHECK(run().size() > 10);
}

TEST_CASE("what would lead to a wrong verdict is refused") {
  const auto block = testing::collision_element(testing::box({10, 10, 10}));
  CollisionScene scene;
  scene.add(block, Pose());
  const BodyId body = scene.add(block, Pose::from_translation({0, 0, 30}));
  const Pose in_unit;
  const auto sweep_from = [&](double x, double tolerance_mm) {
    return scene.sweep(std::span(&body, 1), std::span(&in_unit, 1),
                       Pose::from_translation({x, 0, 0}), Pose::from_translation({-50, 0, 0}),
                       {.tolerance_mm = tolerance_mm});
  };
  CHECK(sweep_from(50.0, 0.01).verdict == Verdict::Interference);
  for (const double tolerance_mm : {-1.0, 0.0, 1e-7, 11.0, std::nan(""), HUGE_VAL}) {
    CAPTURE(tolerance_mm);
    CHECK_THROWS_AS(sweep_from(50.0, tolerance_mm), std::logic_error);
    CHECK_THROWS_AS(scene.check_all({.tolerance_mm = tolerance_mm}), std::logic_error);
    const Pose X_WB;
    CHECK_THROWS_AS(
        scene.check(std::span(&body, 1), std::span(&X_WB, 1), {.tolerance_mm = tolerance_mm}),
        std::logic_error);
  }
  // So far off that a place is not known to the tolerance.
  CHECK_THROWS_AS(sweep_from(1e16, 0.01), std::logic_error);
  CHECK_THROWS_AS(scene.add(block, Pose::from_translation({0, 1e16, 0})), std::logic_error);
  CHECK_THROWS_AS(scene.move(body, Pose::from_translation({0, 0, -1e16})), std::logic_error);
  const double nan = std::nan("");
  CHECK_THROWS_AS(scene.set_reliefs(body, body, {}), std::logic_error);
  CHECK_THROWS_AS(scene.set_reliefs(BodyId{0}, body, {{{nan, 0, 0}, {0, 0, 1}, 5, 5}}),
                  std::logic_error);
  CHECK_THROWS_AS(scene.set_reliefs(BodyId{0}, body, {{{0, 0, 0}, {0, 0, 0}, 5, 5}}),
                  std::logic_error);
  // Elements: one without a solid, one that sticks out of its box.
  const dowel::Obb small{{0, 0, 0}, Eigen::Matrix3d::Identity(), {5, 5, 4}};
  const CollisionElement empty(small, [] { return std::shared_ptr<const FacetedSolid>(); });
  CHECK_THROWS_AS(empty.model(), std::logic_error);
  const auto solid = std::make_shared<const FacetedSolid>(testing::box({10, 10, 10}));
  const CollisionElement outside(small, [solid] { return solid; });
  CHECK_THROWS_WITH(outside.model(), Catch::Contains("1.000000 mm outside the box of its element"));
  CHECK_FALSE(outside.is_loaded());
}
