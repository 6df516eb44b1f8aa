// Models, verdicts and sweeps of random solids against their exact signed distances. What fails
// names its seed, from which alone the case is made.

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/collision/model.h"
#include "dowel/collision/scene.h"
#include "dowel/kernel/mesh_defect.h"
#include "random_geometry.h"
#include "random_shape.h"
#include "seed_range.h"
#include "separation.h"

using dowel::BodyId;
using dowel::CollisionElement;
using dowel::CollisionModel;
using dowel::CollisionScene;
using dowel::PairVerdict;
using dowel::Pose;
using dowel::Verdict;
using dowel::testing::ExactShape;
using dowel::testing::RandomGeometry;
using dowel::testing::Separation;
using Eigen::Vector3d;
namespace testing = dowel::testing;

namespace {

#ifdef DOWEL_SANITIZED
constexpr std::uint64_t kModels = 40;
constexpr std::uint64_t kPairs = 8;
constexpr std::uint64_t kSweeps = 8;
#else
constexpr std::uint64_t kModels = 120;
constexpr std::uint64_t kPairs = 120;
constexpr std::uint64_t kSweeps = 80;
#endif
constexpr testing::SeedRange kLong{1'000, 3'000};

/// Of random pairs from 0.3 mm to 1 m, mostly of like size.
double random_size_mm(RandomGeometry& random) {
  constexpr std::array kSizes_mm{0.3, 1.0, 5.0, 20.0, 100.0, 700.0};
  return kSizes_mm[random.index(kSizes_mm.size())];
}

double half_diagonal_mm(const ExactShape& shape) {
  return 0.5 * shape.box.size().norm();
}

// ---- models

/// Near a facet, an edge or a corner of it; mostly nearer to the exact boundary than the facet is.
Vector3d random_point_near(RandomGeometry& random, const ExactShape& shape, double size_mm) {
  const auto t = random.index(static_cast<std::uint32_t>(shape.solid.triangles.size()));
  const std::array<Vector3d, 3> corners = shape.solid.corners(t);
  double u = random.uniform(0.0, 1.0);
  double v = random.uniform(0.0, 1.0 - u);
  if (random.index(3) == 0) v = 0.0;
  if (random.index(6) == 0) u = v = 0.0;
  Vector3d p = corners[0] + u * (corners[1] - corners[0]) + v * (corners[2] - corners[0]);
  if (random.coin()) {  // onto the exact boundary, against the gradient
    const double step_mm = 1e-6 * size_mm;
    Vector3d gradient;
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const Vector3d step = step_mm * Vector3d::Unit(axis);
      gradient[axis] = (shape.signed_distance_mm(p + step) - shape.signed_distance_mm(p - step)) /
                       (2.0 * step_mm);
    }
    p -= shape.signed_distance_mm(p) * gradient;
  }
  return p + size_mm * std::pow(10.0, random.uniform(-6.0, -0.3)) * random.direction();
}

struct ModelTally {
  int inside = 0;
  int outside = 0;
  int near = 0;  ///< nearer than the facets
  std::set<std::size_t> surfaces;
};

/// What is wrong with what the model says of the place nearest to p; empty where nothing is.
std::string fault_of(const CollisionModel& model, const ExactShape& shape, const Vector3d& p,
                     double rounding_mm) {
  const double truth_mm = shape.signed_distance_mm(p);
  const dowel::NearestPoint nearest = model.nearest(p);
  if (std::abs(nearest.distance_mm - std::abs(truth_mm)) > rounding_mm) return "distance";
  if (std::abs(truth_mm) > rounding_mm && nearest.inside != (truth_mm < 0.0)) return "side";
  const double to_place_mm = (nearest.point - p).norm();
  if (std::abs(to_place_mm - nearest.distance_mm) > rounding_mm) return "distance of the place";
  if (std::abs(shape.signed_distance_mm(nearest.point)) > rounding_mm) return "place";
  const dowel::NearestPoint slow = model.nearest_brute_force(p);
  if (std::abs(slow.distance_mm - nearest.distance_mm) > rounding_mm) return "brute force";
  return "";
}

void check_model(std::uint64_t seed, ModelTally& tally) {
  constexpr int kPoints = 1'000;
  RandomGeometry random(seed);
  const double size_mm = random_size_mm(random);
  const ExactShape shape = testing::random_shape(random, size_mm);
  CAPTURE(seed, shape.name, size_mm);
  REQUIRE(find_defect(shape.solid).value_or("").empty());
  const CollisionModel model(std::make_shared<const dowel::FacetedSolid>(shape.solid), {});
  const double rounding_mm = 1e-7 * (1.0 + size_mm);
  std::string fault;
  for (int i = 0; i < kPoints && fault.empty(); ++i) {
    const Vector3d p = random_point_near(random, shape, size_mm);
    fault = fault_of(model, shape, p, rounding_mm);
    const double truth_mm = shape.signed_distance_mm(p);
    const dowel::NearestPoint nearest = model.nearest(p);
    CAPTURE(i, p.transpose(), truth_mm, nearest.distance_mm, nearest.inside);
    CHECK(fault == "");
    (truth_mm < 0.0 ? tally.inside : tally.outside) += 1;
    tally.near += std::abs(truth_mm) < model.max_slack_mm() ? 1 : 0;
    tally.surfaces.insert(model.face(model.triangles()[nearest.triangle].face).surface.index());
  }
}

void check_models(const testing::SeedRange& seeds) {
  ModelTally tally;
  for (std::uint64_t seed = seeds.first; seed < seeds.first + seeds.count; ++seed) {
    check_model(seed, tally);
  }
  const auto points = tally.inside + tally.outside;
  CHECK(tally.inside > points / 5);
  CHECK(tally.outside > points / 5);
  CHECK(tally.near > points / 5);
  CHECK(tally.surfaces.size() == 5);  // plane, cylinder, cone, sphere, torus
}

// ---- verdicts

/// A pair of which `a` moves along a line, seen from `b`.
struct Approach {
  ExactShape a;
  ExactShape b;
  std::shared_ptr<const CollisionElement> element_a;
  std::shared_ptr<const CollisionElement> element_b;
  double tolerance_mm = 0.0;
  Eigen::Quaterniond turn;
  Vector3d start;
  Vector3d direction;

  Pose X_BA(double way_mm) const { return {turn, start + way_mm * direction}; }
  double size_mm() const { return half_diagonal_mm(a) + half_diagonal_mm(b); }
};

/// Any, none, by right angles, or almost none.
Eigen::Quaterniond random_turn(RandomGeometry& random) {
  const auto about = [](double angle_rad, const Vector3d& axis) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis));
  };
  constexpr double kRightAngle_rad = 0.5 * std::numbers::pi;
  switch (random.index(5)) {
    case 0:
      return Eigen::Quaterniond::Identity();
    case 1:
      return about(kRightAngle_rad * random.index(4), Vector3d::UnitX()) *
             about(kRightAngle_rad * random.index(4), Vector3d::UnitZ());
    case 2:
      return about(std::pow(10.0, random.uniform(-5.0, -1.0)), random.direction());
    case 3:
      return about(random.uniform(0.0, 6.3), Vector3d::UnitZ());
    default:
      return random.rotation();
  }
}

Approach random_approach(RandomGeometry& random) {
  const double size_a_mm = random_size_mm(random);
  double size_b_mm =
      random.index(3) == 0 ? random_size_mm(random) : size_a_mm * random.uniform(0.3, 3.0);
  if (std::max(size_a_mm, size_b_mm) > 200.0 * std::min(size_a_mm, size_b_mm)) {
    size_b_mm = size_a_mm;
  }
  Approach pair;
  pair.a = testing::random_shape(random, size_a_mm);
  pair.b = testing::random_shape(random, size_b_mm);
  pair.element_a = testing::collision_element(pair.a);
  pair.element_b = testing::collision_element(pair.b);
  constexpr std::array kTolerances_mm{0.001, 0.01, 0.1};
  pair.tolerance_mm =
      std::clamp(kTolerances_mm[random.index(3)], 2e-5 * std::max(size_a_mm, size_b_mm),
                 0.05 * std::min(size_a_mm, size_b_mm));
  pair.turn = random_turn(random);
  const bool is_along_axis = random.coin();
  pair.direction = is_along_axis ? Vector3d::Unit(random.index(3)).eval() : random.direction();
  if (random.coin()) pair.direction = -pair.direction;
  const bool is_concentric = random.coin();
  pair.start =
      is_concentric ? Vector3d::Zero().eval() : random.point(0.7 * half_diagonal_mm(pair.b));
  return pair;
}

double highest_separation_mm(const Approach& pair, double way_mm, double resolution_mm) {
  return separation(pair.a, pair.b, pair.X_BA(way_mm), {resolution_mm, 2'000}).high_mm;
}

/// A way at which the pair is about to touch, from outside or from inside of a bore, and deep by
/// up to some tolerances; nothing where there is none.
std::optional<double> random_touch(RandomGeometry& random, const Approach& pair) {
  constexpr int kSteps = 24;
  const double reach_mm = 2.2 * pair.size_mm() + pair.start.norm();
  const double step_mm = 2.0 * reach_mm / kSteps;
  const double wanted_mm = pair.tolerance_mm * random.uniform(-2.0, 2.0);
  std::vector<double> changes;
  bool was_apart = true;
  for (int i = 0; i <= kSteps; ++i) {
    const double way_mm = i * step_mm - reach_mm;
    const bool is_apart =
        highest_separation_mm(pair, way_mm, std::max(pair.tolerance_mm, 0.01 * pair.size_mm())) >
        wanted_mm;
    if (is_apart != was_apart) changes.push_back(way_mm);
    was_apart = is_apart;
  }
  if (changes.empty()) return std::nullopt;
  double high_mm = changes[random.index(static_cast<std::uint32_t>(changes.size()))];
  double low_mm = high_mm - step_mm;
  const bool is_low_apart =
      highest_separation_mm(pair, low_mm, 0.1 * pair.tolerance_mm) > wanted_mm;
  while (high_mm - low_mm > 0.05 * pair.tolerance_mm) {
    const double middle_mm = 0.5 * (low_mm + high_mm);
    const double resolution_mm = std::max(0.1 * pair.tolerance_mm, 0.1 * (high_mm - low_mm));
    const bool is_apart = highest_separation_mm(pair, middle_mm, resolution_mm) > wanted_mm;
    (is_apart == is_low_apart ? low_mm : high_mm) = middle_mm;
  }
  return 0.5 * (low_mm + high_mm);
}

/// What is wrong with a verdict; empty where nothing is.
std::string fault_of(const PairVerdict& told, const Approach& pair, const Pose& X_BA,
                     const Pose& X_WB, const Separation& truth) {
  const double t = pair.tolerance_mm;
  const double rounding_mm = 1e-9 + 1e-12 * X_WB.translation().norm();
  const Vector3d witness_B = X_WB.inverse() * told.witness_W;
  const double from_a_mm = pair.a.signed_distance_mm(X_BA.inverse() * witness_B);
  const double from_b_mm = pair.b.signed_distance_mm(witness_B);
  const double witnessed_mm = -2.0 * std::max(from_a_mm, from_b_mm);
  if (told.verdict == Verdict::Interference) {
    if (witnessed_mm < 0.9 * t) return "interference, and its witness is not that deep";
    if (witnessed_mm < told.depth_mm - 2.0 * rounding_mm) return "the depth is not what it says";
    return "";
  }
  if (truth.high_mm < -1.1 * t) return "interference missed";
  if (told.verdict == Verdict::Clear) {
    return truth.high_mm < 0.9 * t ? "contact missed" : "";
  }
  if (truth.low_mm > 1.1 * t) return "contact, and they are apart";
  if (std::max(0.0, from_a_mm) + std::max(0.0, from_b_mm) > 1.1 * t) {
    return "contact, and its witness is not near both";
  }
  return "";
}

/// Whether the bounds leave one verdict only, or contact beside one of the others.
bool is_conclusive(const Separation& truth, double tolerance_mm) {
  return truth.low_mm > 0.9 * tolerance_mm || truth.high_mm < -0.9 * tolerance_mm ||
         (truth.low_mm > -1.1 * tolerance_mm && truth.high_mm < 1.1 * tolerance_mm);
}

struct VerdictTally {
  std::array<int, 3> verdicts{};
  int poses = 0;
  int conclusive = 0;
};

PairVerdict first_of(std::span<const dowel::BodyVerdict> verdicts) {
  return verdicts.empty() ? PairVerdict{} : verdicts.front().pair;
}

/// The ways to ask about one pose of a pair; one of them, with memory, along all of its poses.
class Inquiry {
 public:
  Inquiry(const Approach& pair, const Pose& X_WB) : pair_(pair), X_WB_(X_WB) {
    kept_.add(pair.element_b, X_WB);
    body_ =
        kept_.add(pair.element_a, X_WB * Pose::from_translation({4.0 * pair.size_mm(), 0.0, 0.0}));
  }

  struct Answer {
    const char* way;
    PairVerdict told;
  };

  std::vector<Answer> ask(const Pose& X_BA) {
    const Pose X_WA = X_WB_ * X_BA;
    const dowel::QueryOptions options{.tolerance_mm = pair_.tolerance_mm};
    const std::array<Pose, 1> at_a{X_WA};
    const std::array<Pose, 1> at_b{X_WB_};
    CollisionScene scene;
    const std::array<BodyId, 1> b{scene.add(pair_.element_b, X_WB_)};
    const std::array<BodyId, 1> a{scene.add(pair_.element_a, X_WA)};
    std::vector<Answer> answers{{"check", first_of(scene.check(a, at_a, options))},
                                {"swapped", first_of(scene.check(b, at_b, options))},
                                {"all", first_of(scene.check_all(options))},
                                {"remembered", first_of(kept_.check({&body_, 1}, at_a, options))}};
    if (pair_.a.solid.triangles.size() * pair_.b.solid.triangles.size() < 200'000) {
      answers.push_back({"brute force", first_of(scene.check_brute_force(a, at_a, options))});
    }
    return answers;
  }

 private:
  const Approach& pair_;
  Pose X_WB_;
  CollisionScene kept_;
  BodyId body_;
};

void check_pair(std::uint64_t seed, VerdictTally& tally) {
  RandomGeometry random(seed);
  const Approach pair = random_approach(random);
  CAPTURE(seed, pair.a.name, pair.b.name, pair.tolerance_mm);
  const std::optional<double> touch_mm = random_touch(random, pair);
  if (!touch_mm) return;
  const Pose X_WB = random.coin() ? Pose() : random.pose(10'000.0);
  Inquiry inquiry(pair, X_WB);
  for (const double way : {0.0, 0.2, -0.2, 0.5, -0.5, 1.0, -1.0, 2.0, -2.0, 20.0, -20.0}) {
    const Pose X_BA = pair.X_BA(*touch_mm + way * pair.tolerance_mm);
    const Separation truth = separation(pair.a, pair.b, X_BA, {0.02 * pair.tolerance_mm, 20'000});
    ++tally.poses;
    tally.conclusive += is_conclusive(truth, pair.tolerance_mm) ? 1 : 0;
    for (const auto& [asked, told] : inquiry.ask(X_BA)) {
      CAPTURE(way, asked, to_string(told.verdict), told.depth_mm, told.gap_mm, truth.low_mm,
              truth.high_mm);
      CHECK(fault_of(told, pair, X_BA, X_WB, truth) == "");
      ++tally.verdicts[static_cast<std::size_t>(told.verdict)];
    }
  }
}

void check_pairs(const testing::SeedRange& seeds) {
  VerdictTally tally;
  for (std::uint64_t seed = seeds.first; seed < seeds.first + seeds.count; ++seed) {
    check_pair(seed, tally);
  }
  const int verdicts = tally.verdicts[0] + tally.verdicts[1] + tally.verdicts[2];
  for (const int told : tally.verdicts) CHECK(told > verdicts / 10);
  CHECK(tally.poses > static_cast<int>(5 * seeds.count));
  CHECK(tally.conclusive > tally.poses / 2);
}

}  // namespace

TEST_CASE("the separation of balls and of bores is what their sizes say") {
  const auto ball = [](double r) {
    return testing::revolved_shape("ball", {{0, -r, std::numbers::pi}, {0, r}}, {});
  };
  const auto separation_mm = [](const ExactShape& a, const ExactShape& b, const Vector3d& at) {
    const Separation found = separation(a, b, Pose::from_translation(at), {1e-4, 1'000'000});
    CHECK(found.high_mm - found.low_mm < 1e-3);
    return found.high_mm;
  };
  const Vector3d direction = Vector3d(1.0, 2.0, -0.5).normalized();
  CHECK(separation_mm(ball(3), ball(2), 5.1 * direction) == Approx(0.1).margin(2e-4));
  CHECK(separation_mm(ball(3), ball(2), 4.8 * direction) == Approx(-0.2).margin(2e-4));
  CHECK(separation_mm(ball(3), ball(2), 0.5 * direction) == Approx(-4.0).margin(2e-4));
  // A ball in a ball socket, held off its floor by 0.25; the floor is at z = 1.
  const ExactShape socket = testing::revolved_shape(
      "socket", {{0, 0}, {4, 0}, {4, 4}, {3, 4, -0.5 * std::numbers::pi}, {0, 1}}, {});
  CHECK(separation_mm(ball(2), socket, {0, 0, 3.25}) == Approx(0.25).margin(2e-4));
  CHECK(separation_mm(ball(2), socket, {0, 0, 2.75}) == Approx(-0.25).margin(2e-4));
}

TEST_CASE("the distance from a random solid is that from its outlines", "[property]") {
  check_models({1, kModels});
}

TEST_CASE("verdicts on random solids near touch are those of their exact distances", "[property]") {
  check_pairs({1, kPairs});
}

TEST_CASE("distances from thousands of random solids are those from their outlines", "[.long]") {
  check_models(testing::seeds_or(kLong));
}

TEST_CASE("verdicts on thousands of random solids are those of their exact distances", "[.long]") {
  check_pairs(testing::seeds_or(kLong));
}
