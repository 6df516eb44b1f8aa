// Sweeps of random solids against their exact signed distances. What fails names its seed, from
// which alone the case is made.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string>

#include <catch2/catch.hpp>

#include "dowel/collision/scene.h"
#include "random_geometry.h"
#include "random_shape.h"
#include "seed_range.h"
#include "separation.h"

using dowel::BodyId;
using dowel::CollisionScene;
using dowel::Pose;
using dowel::SweepResult;
using dowel::Verdict;
using dowel::testing::ExactShape;
using dowel::testing::RandomGeometry;
using dowel::testing::Separation;
using Eigen::Vector3d;
namespace testing = dowel::testing;

namespace {

#ifdef DOWEL_SANITIZED
constexpr std::uint64_t kSeeds = 8;
#else
constexpr std::uint64_t kSeeds = 45;
#endif
constexpr testing::SeedRange kLong{1'000, 2'000};
constexpr int kMotions = 4;  // of each pair

/// `a` moves, fixed in a unit; `b` stands.
struct Motion {
  ExactShape a;
  ExactShape b;
  double tolerance_mm = 0.0;
  Pose X_WB;
  Pose X_UA;
  Pose from;
  Pose to;

  Separation separation_at(const Pose& X_WU, int max_evaluations) const {
    return separation(a, b, X_WB.inverse() * X_WU * X_UA, {0.05 * tolerance_mm, max_evaluations});
  }
  double high_mm(double time) const {
    return separation_at(interpolate(from, to, time), 2'500).high_mm;
  }
  /// No point of `a` goes further from time 0 to 1.
  double way_mm() const {
    const Eigen::AngleAxisd turn(to.rotation() * from.rotation().conjugate());
    double reach_mm = 0.0;
    for (const Vector3d& p : a.solid.vertices) reach_mm = std::max(reach_mm, (X_UA * p).norm());
    return (to.translation() - from.translation()).norm() + 1.1 * turn.angle() * reach_mm;
  }
};

double diagonal_mm(const ExactShape& shape) {
  return shape.box.size().norm();
}

Motion random_pair(RandomGeometry& random) {
  const double size_mm = std::pow(10.0, random.uniform(0.0, 2.0));
  Motion motion;
  motion.a = testing::random_shape(random, size_mm);
  motion.b = testing::random_shape(random, size_mm * random.uniform(0.2, 2.0));
  motion.tolerance_mm = random.coin() ? 0.01 : std::max(1e-4 * size_mm, 1e-3);
  if (random.coin()) motion.X_WB = random.pose(5'000.0);
  return motion;
}

/// Starts apart and goes at, past or away from the other, turning about an axis of its own, about
/// one far off, or not at all. False where no such start was found.
bool set_random_way(RandomGeometry& random, Motion& motion) {
  const double reach_mm = 0.5 * (diagonal_mm(motion.a) + diagonal_mm(motion.b));
  motion.X_UA = random.coin() ? Pose() : random.pose(2.0 * reach_mm);
  bool is_apart = false;
  for (int i = 0; i < 10 && !is_apart; ++i) {
    const Pose X_BA(random.coin() ? Eigen::Quaterniond::Identity() : random.rotation(),
                    random.uniform(0.2, 1.5) * reach_mm * random.direction());
    motion.from = motion.X_WB * X_BA * motion.X_UA.inverse();
    is_apart = motion.high_mm(0.0) > 0.0;
  }
  const Vector3d between =
      motion.X_WB * motion.b.box.center() - motion.from * (motion.X_UA * motion.a.box.center());
  const Vector3d way = random.coin() ? Vector3d(random.uniform(0.5, 2.0) * between)
                       : random.index(4) != 0
                           ? Vector3d(random.uniform(0.0, 2.5) * reach_mm * random.direction())
                           : Vector3d::Zero();
  const double angle_rad = random.index(3) == 0   ? 0.0
                           : random.index(4) == 0 ? std::numbers::pi
                                                  : random.uniform(0.0, std::numbers::pi);
  const Vector3d axis =
      random.coin() ? random.direction() : Vector3d(Vector3d::Unit(random.index(3)));
  motion.to = {Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis)) * motion.from.rotation(),
               motion.from.translation() + way};
  return is_apart;
}

struct Deepest {
  double separation_mm = std::numeric_limits<double>::infinity();
  double time = 0.0;
};

/// Of samples on the way up to `end`, and closer and closer about the deepest of them.
Deepest deepest_before(const Motion& motion, double end) {
  constexpr int kSamples = 50;
  Deepest deepest;
  const auto look_at = [&](double time) {
    if (time < 0.0 || time >= end) return;
    const double separation_mm = motion.high_mm(time);
    if (separation_mm < deepest.separation_mm) deepest = {separation_mm, time};
  };
  for (int i = 0; i < kSamples; ++i) look_at(end * i / kSamples);
  for (double step = end / kSamples; step > 1e-4 * end; step *= 0.6) {
    const double about = deepest.time;
    look_at(about - step);
    look_at(about + step);
  }
  return deepest;
}

/// What is wrong with a sweep; empty where nothing is.
std::string fault_of(const SweepResult& swept, const Motion& motion) {
  constexpr int kEvaluations = 50'000;
  const double t = motion.tolerance_mm;
  const bool is_hit = swept.verdict == Verdict::Interference;
  const double end = is_hit ? swept.time_of_impact : 1.0;
  const Deepest deepest = deepest_before(motion, end);
  if (deepest.separation_mm < -1.1 * t) {
    if (!is_hit) return "an interference on the way is jumped over";
    if ((end - deepest.time) * motion.way_mm() > t) return "an earlier interference is missed";
  }
  if (!is_hit) return swept.time_of_impact == 1.0 ? "" : "the time of no impact";
  const Pose impact = interpolate(motion.from, motion.to, swept.time_of_impact);
  if (motion.separation_at(impact, kEvaluations).low_mm > -0.9 * t) return "no impact there";
  const Separation free = motion.separation_at(swept.free_pose, kEvaluations);
  if (swept.time_of_impact > 0.0 && free.high_mm < -1.1 * t) return "the free pose is not free";
  return "";
}

void check_sweeps(const testing::SeedRange& seeds) {
  int motions = 0;
  int hits = 0;
  for (std::uint64_t seed = seeds.first; seed < seeds.first + seeds.count; ++seed) {
    RandomGeometry random(seed);
    Motion motion = random_pair(random);
    CollisionScene scene;
    scene.add(testing::collision_element(motion.b), motion.X_WB);
    const std::array<BodyId, 1> moving{
        scene.add(testing::collision_element(motion.a), Pose::from_translation({0, 0, 2e4}))};
    for (int i = 0; i < kMotions; ++i) {
      if (!set_random_way(random, motion)) continue;
      const std::array<Pose, 1> X_UA{motion.X_UA};
      const SweepResult swept =
          scene.sweep(moving, X_UA, motion.from, motion.to, {.tolerance_mm = motion.tolerance_mm});
      CAPTURE(seed, i, motion.a.name, motion.b.name, motion.tolerance_mm, swept.time_of_impact,
              to_string(swept.verdict));
      CHECK(fault_of(swept, motion) == "");
      ++motions;
      hits += swept.verdict == Verdict::Interference ? 1 : 0;
    }
  }
  CHECK(motions > static_cast<int>(seeds.count * kMotions / 2));
  CHECK(hits > motions / 4);
  CHECK(motions - hits > motions / 4);
}

}  // namespace

TEST_CASE("a sweep of random solids stops where their exact distances say", "[property]") {
  check_sweeps({1, kSeeds});
}

TEST_CASE("thousands of sweeps of random solids stop where their exact distances say", "[.long]") {
  check_sweeps(testing::seeds_or(kLong));
}
