#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "collision_element.h"
#include "random_geometry.h"
#include "solids.h"

using dowel::BodyId;
using dowel::CollisionScene;
using dowel::FacetedSolid;
using dowel::Pose;
using dowel::QueryOptions;
using dowel::SweepResult;
using dowel::Verdict;
namespace testing = dowel::testing;

namespace {

using testing::collision_element;

SweepResult sweep(CollisionScene& scene, BodyId body, const Pose& from, const Pose& to) {
  const std::array<BodyId, 1> moving{body};
  const std::array<Pose, 1> X_UB{Pose()};
  return scene.sweep(moving, X_UB, from, to, {});
}

}  // namespace

TEST_CASE("a fast move does not jump through a thin plate, and stops where it meets it") {
  CollisionScene scene;
  scene.add(collision_element(testing::box({100, 100, 0.1})), Pose());
  const BodyId pin = scene.add(collision_element(testing::cylinder(6, 20, 24)),
                               Pose::from_translation({0, 0, 500}));
  const auto result =
      sweep(scene, pin, Pose::from_translation({0, 0, 500}), Pose::from_translation({0, 0, -500}));
  CHECK(result.verdict == Verdict::Interference);
  CHECK(result.time_of_impact == Approx(499.95 / 1000).margin(2e-5));
  CHECK(result.free_pose.translation().z() >= 0.05 - 0.01 - 1e-9);
  CHECK(result.free_pose.translation().z() <= 0.05 + 1e-9);
  REQUIRE(result.pairs.size() == 1);
}

TEST_CASE("a motion that starts in contact slides along and lifts off") {
  CollisionScene scene;
  scene.add(collision_element(testing::box({60, 60, 20}, {0, 0, -10})), Pose());
  const BodyId block = scene.add(collision_element(testing::box({10, 10, 10}, {0, 0, 5})), Pose());
  const auto slide = sweep(scene, block, Pose(), Pose::from_translation({2, 0, 0}));
  CHECK(slide.verdict == Verdict::Contact);
  CHECK(slide.time_of_impact == 1.0);
  const auto lift = sweep(scene, block, Pose(), Pose::from_translation({0, 0, 50}));
  CHECK(lift.time_of_impact == 1.0);
  const auto push = sweep(scene, block, Pose(), Pose::from_translation({0, 0, -5}));
  CHECK(push.verdict == Verdict::Interference);
  CHECK(push.free_pose.translation().z() > -0.02);
}

TEST_CASE("a turn meets what stands in its way") {
  CollisionScene scene;
  scene.add(collision_element(testing::box({10, 10, 10})), Pose::from_translation({0, 40, 0}));
  const BodyId bar = scene.add(collision_element(testing::box({100, 4, 4})), Pose());
  const Pose quarter(
      Eigen::Quaterniond(Eigen::AngleAxisd(1.5707963267948966, Eigen::Vector3d::UnitZ())),
      {0, 0, 0});
  const auto result = sweep(scene, bar, Pose(), quarter);
  CHECK(result.verdict == Verdict::Interference);
  // The bar's upper edge y = 2 meets the corner (5, 35): rotate by phi with 5 sin + ... solved
  // below.
  const double phi = std::atan2(35.0, 5.0) - std::asin(2.0 / std::hypot(5.0, 35.0));
  CHECK(result.time_of_impact == Approx(phi / 1.5707963267948966).margin(1e-3));
}

TEST_CASE("of several obstacles the first one met is told", "[property]") {
  testing::RandomGeometry random(31);
  for (int i = 0; i < 20; ++i) {
    CollisionScene scene;
    double nearest = 1e9;
    for (int k = 0; k < 5; ++k) {
      const double x = random.uniform(20, 300);
      scene.add(collision_element(testing::box({4, 50, 50})), Pose::from_translation({x, 0, 0}));
      nearest = std::min(nearest, x - 2 - 5);
    }
    const BodyId block = scene.add(collision_element(testing::box({10, 10, 10})), Pose());
    const auto result = sweep(scene, block, Pose(), Pose::from_translation({400, 0, 0}));
    CHECK(result.verdict == Verdict::Interference);
    CHECK(400 * result.time_of_impact == Approx(nearest).margin(0.02));
  }
}

namespace {

#ifdef DOWEL_SANITIZED
constexpr int kShifts = 1'000;
constexpr int kTurns = 100;
#else
constexpr int kShifts = 100'000;
constexpr int kTurns = 1'000;
#endif

/// When a box at the origin's place, shifted along `way`, overlaps another one by more than
/// `overlap_mm` on all three axes; 2: never. `reach_mm`: sum of their half sizes.
double first_overlap(const Eigen::Vector3d& from, const Eigen::Vector3d& way,
                     const Eigen::Vector3d& reach_mm, double overlap_mm) {
  double enter = 0.0;
  double leave = 1.0;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double limit = reach_mm[i] - overlap_mm;
    if (way[i] == 0.0) {
      if (std::abs(from[i]) >= limit) return 2.0;
      continue;
    }
    const double t0 = (-limit - from[i]) / way[i];
    const double t1 = (limit - from[i]) / way[i];
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  return enter < leave ? enter : 2.0;
}

}  // namespace

TEST_CASE("the time of impact of boxes is that of their intervals, however thin or fast",
          "[property]") {
  testing::RandomGeometry random(52);
  constexpr double t = dowel::kDefaultTolerance_mm;
  int hits = 0;
  int grazes = 0;
  int from_contact = 0;
  for (int k = 0; k < kShifts / 100; ++k) {
    // Sheets, bars and blocks from twice the tolerance on.
    const auto size = [&] { return 2.5 * t * std::pow(10.0, random.uniform(0.0, 3.3)); };
    const Eigen::Vector3d a(size(), size(), size());
    const Eigen::Vector3d b(size(), size(), size());
    const Pose X_WB = random.pose(5'000);
    CollisionScene scene;
    scene.add(collision_element(testing::box(b)), X_WB);
    const BodyId body = scene.add(collision_element(testing::box(a)), X_WB);
    const Eigen::Vector3d reach = 0.5 * (a + b);
    for (int i = 0; i < 100; ++i) {
      // Past each other, or nearly; a third begins where they touch on a face.
      Eigen::Vector3d from = random.direction() * random.uniform(1.0, 1'000.0);
      Eigen::Vector3d to = -from + random.point(1.0).cwiseProduct(reach);
      const bool is_from_contact = i % 3 == 0;
      if (is_from_contact) {
        from = random.point(1.0).cwiseProduct(reach);
        const auto axis = static_cast<Eigen::Index>(random.index(3));
        from[axis] = reach[axis];
        to = from + random.direction() * random.uniform(1.0, 1'000.0);
        if (random.coin()) to[axis] = from[axis];
      }
      const Eigen::Vector3d way = to - from;
      // Not later than when they overlap by a tenth more than the tolerance, nor earlier than by
      // a tenth less.
      const double late = first_overlap(from, way, reach, 1.1 * t);
      const double early = first_overlap(from, way, reach, 0.9 * t);
      const auto result = sweep(scene, body, X_WB * Pose::from_translation(from),
                                X_WB * Pose::from_translation(to));
      const double accuracy = 0.25 * t / way.norm();
      CAPTURE(k, i, a.transpose(), b.transpose(), from.transpose(), to.transpose(), early, late);
      if (early > 1.0) REQUIRE(result.verdict != Verdict::Interference);
      if (late <= 1.0) {
        REQUIRE(result.verdict == Verdict::Interference);
        REQUIRE(result.time_of_impact <= late + accuracy);
      }
      if (result.verdict == Verdict::Interference) {
        REQUIRE(result.time_of_impact >= early - accuracy);
        const double free = (X_WB.inverse() * result.free_pose).translation().x();
        const double hit = from.x() + result.time_of_impact * way.x();
        REQUIRE(std::abs(free - hit) <= 2.0 * t);
        ++hits;
      }
      grazes += early <= 1.0 && late > 1.0 ? 1 : 0;
      from_contact += is_from_contact && result.verdict != Verdict::Interference ? 1 : 0;
    }
  }
  CHECK(hits > kShifts / 10);
  CHECK(from_contact > kShifts / 20);
  CHECK(grazes < kShifts / 20);
}

TEST_CASE("a bar that turns meets a pin when its side is as near as the pin is thick",
          "[property]") {
  testing::RandomGeometry random(53);
  constexpr double t = dowel::kDefaultTolerance_mm;
  constexpr double kHalfWidth_mm = 2.0;
  const auto bar_element = collision_element(testing::box({200, 2 * kHalfWidth_mm, 4}));
  int hits = 0;
  for (int i = 0; i < kTurns; ++i) {
    const double radius = std::pow(10.0, random.uniform(-1.0, 0.7));
    const double distance = random.uniform(10.0, 90.0);
    // Of the pin from the bar, which touches it at neither end yet.
    const double touching = std::asin((radius + kHalfWidth_mm) / distance);
    const double angle = random.uniform(touching + 0.05, std::numbers::pi - touching - 0.05);
    const Pose X_WO = random.pose(5'000);
    CollisionScene scene;
    scene.add(
        collision_element(testing::transformed(Pose::from_translation({0, 0, -10}),
                                               testing::cylinder(radius, 20, 16))),
        X_WO * Pose::from_translation({distance * std::cos(angle), distance * std::sin(angle), 0}));
    const BodyId bar = scene.add(bar_element, X_WO);
    const double to_turn = random.uniform(0.2, 3.0);
    const Pose end = X_WO * Pose::about_axis({0, 0, 0}, Eigen::Vector3d::UnitZ(), to_turn);
    // The pin is as deep in the bar's side as its axis is nearer than radius and half width.
    const auto angle_at = [&](double depth_mm) {
      return angle - std::asin((radius + kHalfWidth_mm - depth_mm) / distance);
    };
    const auto result = sweep(scene, bar, X_WO, end);
    CAPTURE(i, radius, distance, angle, to_turn);
    const double accuracy_rad = 0.25 * t / distance;
    if (to_turn < angle_at(0.9 * t)) REQUIRE(result.verdict != Verdict::Interference);
    if (to_turn > angle_at(1.1 * t)) {
      REQUIRE(result.verdict == Verdict::Interference);
      REQUIRE(to_turn * result.time_of_impact >= angle_at(0.9 * t) - accuracy_rad);
      REQUIRE(to_turn * result.time_of_impact <= angle_at(1.1 * t) + accuracy_rad);
      ++hits;
    }
  }
  CHECK(hits > kTurns / 3);
  CHECK(hits < kTurns * 9 / 10);
}

TEST_CASE("a motion of no length is a check where the body stands") {
  CollisionScene scene;
  scene.add(collision_element(testing::box({10, 10, 10})), Pose());
  const BodyId block = scene.add(collision_element(testing::box({10, 10, 10})), Pose());
  const auto inside = sweep(scene, block, Pose(), Pose());
  CHECK(inside.verdict == Verdict::Interference);
  CHECK(inside.time_of_impact == 0.0);
  const Pose away = Pose::from_translation({0, 0, 10});
  CHECK(sweep(scene, block, away, away).verdict == Verdict::Contact);
}

TEST_CASE("a long slide in contact or close by takes few tests, whatever its length") {
  CollisionScene scene;
  scene.add(collision_element(
                testing::plate_with_holes({400, 200, 20}, testing::hole_grid(9, 4, 40, 6.0), 16)),
            Pose());
  const BodyId riser = scene.add(collision_element(testing::plate_with_holes(
                                     {60, 60, 30}, testing::hole_grid(1, 1, 40, 6.75), 16)),
                                 Pose::from_translation({-150, 0, 20}));
  const Pose from = scene.pose(riser);
  const auto slide = sweep(scene, riser, from, Pose::from_translation({150, 10, 20}));
  CHECK(slide.verdict == Verdict::Contact);
  CHECK(slide.time_of_impact == 1.0);
  CHECK(scene.counters().triangle_tests < 2000);
  // Hardly off the plate, with a part below it: the boxes overlap and say nothing.
  scene.reset_counters();
  const BodyId bar = scene.add(
      collision_element(testing::merged(
          testing::box({10, 60, 10}),
          testing::transformed(Pose::from_translation({0, 0, -40}), testing::box({10, 60, 10})))),
      Pose());
  const double low_mm = 25.0 + 1.5 * QueryOptions().tolerance_mm;
  const auto close_by = sweep(scene, bar, Pose::from_translation({-150, -95, low_mm}),
                              Pose::from_translation({100, -95, low_mm}));
  CHECK(close_by.verdict == Verdict::Clear);
  CHECK(scene.counters().box_tests < 10'000);
  scene.remove(bar);
  scene.reset_counters();
  const Pose turned = Pose::about_axis({-150, 0, 0}, Eigen::Vector3d::UnitZ(), 1.5) * from;
  CHECK(sweep(scene, riser, from, turned).time_of_impact == 1.0);
  CHECK(scene.counters().triangle_tests < 2000);
  // A pin let down its bore, turning: by the cylinders alone.
  scene.reset_counters();
  const BodyId pin =
      scene.add(collision_element(testing::stepped_pin({{5.99, 20}, {9, 8}}, 16)), Pose());
  scene.remove(riser);
  const Pose above = Pose::from_translation({-160, -60, 40});
  const Pose seated(Eigen::Quaterniond(Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitZ())),
                    {-160, -60, 0});
  const auto insert = sweep(scene, pin, above, seated);
  CHECK(insert.verdict == Verdict::Contact);
  CHECK(insert.time_of_impact == 1.0);
  CHECK(scene.counters().triangle_tests < 2000);
}

TEST_CASE("no pose before the impact interferes, and the one at it does", "[property]") {
#ifdef DOWEL_SANITIZED
  constexpr int kMotions = 20;
#else
  constexpr int kMotions = 200;
#endif
  constexpr int kSamples = 60;
  constexpr double kTolerance_mm = dowel::kDefaultTolerance_mm;
  testing::RandomGeometry random(51);
  CollisionScene scene;
  scene.add(collision_element(testing::plate_with_holes({120, 80, 20}, {{-40, 0, 6.0}}, 12)),
            Pose());
  scene.add(collision_element(testing::box({20, 20, 20}, {0, 0, 10})),
            Pose::from_translation({0, 25, 20}));
  scene.add(collision_element(testing::cylinder(8, 25, 14)),
            Pose::from_translation({-10, -25, 20}));
  const std::array<BodyId, 2> bodies{
      scene.add(collision_element(testing::stepped_pin({{5.99, 12}, {9.0, 6}}, 12)), Pose()),
      scene.add(collision_element(testing::box({15, 15, 15}, {0, 0, 7.5})), Pose())};
  int hits = 0;
  int passes = 0;
  for (int i = 0; i < kMotions; ++i) {
    // Starts on the plate, over the bore or in the air; goes anywhere, turning or not.
    const std::array<BodyId, 1> moving{bodies[random.index(2)]};
    const bool over_bore = random.index(3) == 0;
    const Pose from = Pose::from_translation({over_bore ? -40.0 : random.uniform(-60, 60),
                                              over_bore ? 0.0 : random.uniform(-40, 40),
                                              random.coin() ? 20.0 : random.uniform(20, 60)});
    const Eigen::Vector3d way =
        random.coin() ? Eigen::Vector3d(0, 0, random.uniform(-60, 20)) : random.point(60);
    const Eigen::Quaterniond turn =
        random.coin() ? Eigen::Quaterniond::Identity()
                      : Eigen::Quaterniond(Eigen::AngleAxisd(
                            random.uniform(0, 3),
                            random.coin() ? Eigen::Vector3d::UnitZ() : random.direction()));
    const Pose to(turn, from.translation() + way);
    const auto verdict_at = [&](double time) {
      const std::array<Pose, 1> poses{interpolate(from, to, time)};
      return worst(scene.check_brute_force(moving, poses, {.tolerance_mm = 1.05 * kTolerance_mm}));
    };
    const std::array<Pose, 1> X_UB{Pose()};
    scene.move(moving[0], Pose::from_translation({500, 0, 0}));
    scene.move(bodies[moving[0] == bodies[0] ? 1 : 0], Pose::from_translation({900, 0, 0}));
    const SweepResult result = scene.sweep(moving, X_UB, from, to, {});
    CAPTURE(i, from.translation().transpose(), way.transpose(), turn.coeffs().transpose(),
            result.time_of_impact);
    for (int k = 0; k < kSamples; ++k) {
      const double time = (k + 0.5) / kSamples;
      if (time < result.time_of_impact) REQUIRE(verdict_at(time) != Verdict::Interference);
    }
    if (result.verdict == Verdict::Interference) {
      const std::array<Pose, 1> hit{interpolate(from, to, result.time_of_impact)};
      REQUIRE(worst(scene.check(moving, hit, {.tolerance_mm = 0.95 * kTolerance_mm})) ==
              Verdict::Interference);
      const std::array<Pose, 1> free{result.free_pose};
      if (result.time_of_impact > 0.0) {
        REQUIRE(worst(scene.check(moving, free, {})) != Verdict::Interference);
      }
    }
    hits += result.verdict == Verdict::Interference ? 1 : 0;
    passes += result.verdict == Verdict::Interference ? 0 : 1;
  }
  CHECK(hits > kMotions / 5);
  CHECK(passes > kMotions / 10);
}
