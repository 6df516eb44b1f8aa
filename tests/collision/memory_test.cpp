// What a scene remembers from move to move: it may save time, and nothing else.

#include <atomic>
#include <cstdlib>
#include <new>
#include <thread>

#include <catch2/catch.hpp>
#include <malloc.h>

#include "surroundings.h"

using dowel::BodyId;
using dowel::BodyVerdict;
using dowel::CollisionElement;
using dowel::CollisionScene;
using dowel::Pose;
using dowel::Verdict;
using dowel::testing::anchor;
using dowel::testing::mover;
using dowel::testing::next;
using dowel::testing::Surroundings;
using dowel::testing::told;
namespace testing = dowel::testing;

#ifndef DOWEL_SANITIZED  // sanitizers have these operators of their own
namespace {

/// Of this process, by the heap's count.
std::size_t in_use_bytes() {
  return mallinfo2().uordblks;
}

/// Allocations of this thread since it began to count.
thread_local bool is_counting = false;
thread_local std::size_t allocations = 0;

void* counted_allocation(std::size_t size) {
  if (is_counting) ++allocations;
  if (void* memory = std::malloc(size == 0 ? 1 : size)) return memory;
  throw std::bad_alloc();
}

}  // namespace

void* operator new(std::size_t size) {
  return counted_allocation(size);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
#endif

namespace {

#ifdef DOWEL_SANITIZED
constexpr int kMoves = 1'000;
constexpr int kMovesWithoutSkip = 150;
constexpr int kMovesInThreads = 1'000;
#else
constexpr int kMoves = 20'000;             // each past six bodies
constexpr int kMovesWithoutSkip = 20'000;  // the same, of each skip
constexpr int kMovesInThreads = 100'000;
#endif

constexpr double kTolerance_mm = dowel::kDefaultTolerance_mm;
}  // namespace

TEST_CASE("a scene that remembers gives the verdicts of one that looks at all facets",
          "[property]") {
  const int kind = GENERATE(0, 1, 2);
  CAPTURE(kind);
  testing::RandomGeometry random(31);
  Surroundings world;
  const BodyId moving = world.scene.add(testing::collision_element(mover(kind)), Pose());
  const std::array<BodyId, 1> bodies{moving};
  std::array<int, 3> seen{};
  int borderline = 0;
  Pose pose = anchor(random);
  for (int i = 0; i < kMoves / 3; ++i) {
    pose = next(random, pose);
    const std::array<Pose, 1> poses{pose};
    const auto slow_at = [&](double tolerance_mm) {
      return told(world.scene.check_brute_force(bodies, poses, {.tolerance_mm = tolerance_mm}));
    };
    const std::string fast = told(world.scene.check(bodies, poses, {}));
    const std::string slow = slow_at(kTolerance_mm);
    CAPTURE(i, pose.translation().transpose(), pose.rotation().coeffs().transpose(), slow);
    if (fast != slow) {
      // Within a twentieth of the tolerance a witness may be found from one start and not another.
      const bool is_borderline =
          fast == slow_at(0.95 * kTolerance_mm) || fast == slow_at(1.05 * kTolerance_mm);
      REQUIRE((is_borderline ? slow : fast) == slow);
      ++borderline;
    }
    seen[0] += slow.empty() ? 1 : 0;
    seen[1] += slow.find("contact") != std::string::npos ? 1 : 0;
    seen[2] += slow.find("interference") != std::string::npos ? 1 : 0;
    // The scene changes, too: the mover is put where it is, or another body a little aside.
    if (random.index(50) == 0) world.scene.move(moving, pose);
    if (random.index(100) == 0) {
      const BodyId other = world.bodies[1 + random.index(4)];
      world.scene.move(other, Pose::from_translation(random.point(0.01)) * world.scene.pose(other));
    }
  }
  for (const int count : seen) CHECK(count > kMoves / 100);
  CHECK(borderline < kMoves / 1000);
}

namespace {

using Uses = std::array<std::uint64_t, dowel::kSkipCount>;

/// Asks two scenes about the same moves of one kind of mover, one of them without some skips, and
/// adds how often the other one used each. Returns how many verdicts differ near the threshold.
int compare_without(dowel::SkipSet without, int kind, std::uint64_t seed, int moves, Uses& uses) {
  testing::RandomGeometry random(seed);
  Surroundings world;
  Surroundings plain;  // has a memory of its own
  const BodyId moving = world.scene.add(testing::collision_element(mover(kind)), Pose());
  const BodyId plainly = plain.scene.add(testing::collision_element(mover(kind)), Pose());
  int borderline = 0;
  Pose pose = anchor(random);
  for (int i = 0; i < moves; ++i) {
    pose = next(random, pose);
    const auto plain_at = [&](double tolerance_mm) {
      return told(plain.scene.check({&plainly, 1}, {&pose, 1},
                                    {.tolerance_mm = tolerance_mm, .without = without}));
    };
    const std::string fast = told(world.scene.check({&moving, 1}, {&pose, 1}, {}));
    const std::string slow = plain_at(kTolerance_mm);
    if (fast == slow) continue;
    CAPTURE(i, pose.translation().transpose(), pose.rotation().coeffs().transpose(), slow);
    // Within a twentieth of the tolerance a witness may be found from one start and not another.
    const bool is_borderline =
        fast == plain_at(0.95 * kTolerance_mm) || fast == plain_at(1.05 * kTolerance_mm);
    REQUIRE((is_borderline ? slow : fast) == slow);
    ++borderline;
  }
  for (std::size_t s = 0; s < dowel::kSkipCount; ++s) {
    uses[s] += world.scene.counters().uses[s];
    if (without.contains(static_cast<dowel::Skip>(s))) CHECK(plain.scene.counters().uses[s] == 0);
  }
  return borderline;
}

}  // namespace

TEST_CASE("no verdict depends on a skip", "[property]") {
  const int moves = kMovesWithoutSkip / 3;
  int borderline = 0;
  Uses uses{};
  for (std::size_t left_out = 0; left_out <= dowel::kSkipCount; ++left_out) {
    const dowel::SkipSet without = left_out == dowel::kSkipCount
                                       ? dowel::SkipSet::all()
                                       : dowel::SkipSet(static_cast<dowel::Skip>(left_out));
    for (const int kind : {0, 1, 2}) {
      CAPTURE(left_out, kind);
      borderline += compare_without(without, kind, 77 + left_out, moves, uses);
    }
  }
  CHECK(borderline <= moves / 20);
  for (std::size_t s = 0; s < dowel::kSkipCount; ++s) {
    CAPTURE(to_string(static_cast<dowel::Skip>(s)));
    CHECK(uses[s] > 0);
  }
}

#ifndef DOWEL_SANITIZED
TEST_CASE("moves allocate nothing once a scene has seen their like") {
  testing::RandomGeometry random(32);
  Surroundings world;
  const std::array<BodyId, 2> unit{
      world.scene.add(testing::collision_element(mover(2)), Pose()),
      world.scene.add(testing::collision_element(mover(1)), Pose::from_translation({0, 0, 30}))};
  const Pose X_UB = Pose::from_translation({0, 0, 30});
  std::vector<Pose> path{anchor(random)};
  for (int i = 0; i < 500; ++i) path.push_back(next(random, path.back()));
  const auto as_one = [&] {
    for (const Pose& pose : path) world.scene.check({unit.data(), 1}, {&pose, 1}, {});
  };
  const auto as_unit = [&] {
    for (const Pose& pose : path) world.scene.check(unit, std::array{pose, pose * X_UB}, {});
  };
  const auto and_stay = [&] {
    for (const Pose& pose : path) {
      world.scene.check({unit.data(), 1}, {&pose, 1}, {});
      world.scene.move(unit[0], pose);
    }
  };
  const auto allocations_of = [](const auto& follow) {
    follow();
    follow();  // from the end to the start is a move, too
    allocations = 0;
    is_counting = true;
    follow();
    is_counting = false;
    return allocations;
  };
  CHECK(allocations_of(as_one) == 0);
  CHECK(allocations_of(as_unit) == 0);
  CHECK(allocations_of(and_stay) == 0);
  CHECK(allocations_of([] { std::make_unique<int>(1); }) == 1);
}

TEST_CASE("an instance in a scene of ten thousand takes less than 256 bytes") {
  constexpr std::size_t kCount = 10'000;
  const auto element = testing::collision_element(testing::box({20, 20, 20}));
  testing::RandomGeometry random(34);
  CollisionScene scene;
  const std::size_t before = in_use_bytes();
  for (std::size_t i = 0; i < kCount; ++i) {
    scene.add(element, Pose::from_translation({30.0 * random.index(60), 30.0 * random.index(60),
                                               20.0 * random.index(5)}));
  }
  CHECK(in_use_bytes() - before < 256 * kCount);
  CHECK(in_use_bytes() - before > 100 * kCount);  // poses alone take 56
  CHECK(scene.memory_bytes() < 256 * kCount);
}
#endif

TEST_CASE("many scenes in many threads share elements and give the same verdicts") {
  const auto plate = testing::collision_element(testing::plate_with_holes(
      {120, 80, Surroundings::kTop_mm}, {{-40, 0, 6.0}, {40, 20, 6.0, 12.0}}, 12));
  const auto pin = testing::collision_element(mover(2));
  const auto run = [&](std::string& verdicts) {
    testing::RandomGeometry random(33);
    CollisionScene scene;
    scene.add(plate, Pose());
    const std::array<BodyId, 1> bodies{scene.add(pin, Pose())};
    Pose pose = anchor(random);
    for (int i = 0; i < kMovesInThreads / 4; ++i) {
      pose = next(random, pose);
      verdicts += told(scene.check(bodies, std::span(&pose, 1), {}));
    }
  };
  std::array<std::string, 4> results;
  std::vector<std::thread> threads;
  threads.reserve(results.size());
  for (auto& result : results) threads.emplace_back([&] { run(result); });
  for (std::thread& thread : threads) thread.join();
  CHECK(results[0].size() > kMovesInThreads / 4);
  for (const auto& result : results) CHECK(result == results[0]);
}

TEST_CASE("a move that is shorter than the known gap costs no test") {
  Surroundings world;
  const BodyId moving = world.scene.add(testing::collision_element(mover(1)), Pose());
  const std::array<BodyId, 1> bodies{moving};
  const auto check_at = [&](double x) {
    const std::array<Pose, 1> poses{Pose::from_translation({x, 0, Surroundings::kTop_mm + 2})};
    return worst(world.scene.check(bodies, poses, {}));
  };
  CHECK(check_at(-20) == Verdict::Clear);
  CHECK(check_at(-19.9) == Verdict::Clear);
  world.scene.reset_counters();
  CHECK(check_at(-19.8) == Verdict::Clear);
  CHECK(check_at(-19.7) == Verdict::Clear);
  CHECK(world.scene.counters().box_tests == 0);
  // Something put in the way is seen, however small the move.
  world.scene.add(testing::collision_element(testing::box({5, 5, 5})),
                  Pose::from_translation({-19.6, 0, Surroundings::kTop_mm + 5}));
  CHECK(check_at(-19.6999) == Verdict::Interference);
}
