// The distance from solids of revolution, against that from their profile in the plane of axis and
// radius.

#include <cmath>
#include <memory>
#include <numbers>

#include <catch2/catch.hpp>

#include "dowel/collision/model.h"
#include "dowel/collision/scene.h"
#include "exact_shape.h"
#include "random_geometry.h"

using dowel::CollisionModel;
using dowel::FacetedSolid;
using dowel::Pose;
using dowel::testing::Outline;
namespace testing = dowel::testing;

namespace {

#ifdef DOWEL_SANITIZED
constexpr int kTurns = 2;
#else
constexpr int kTurns = 20;
#endif

constexpr double kQuarterTurn = 0.5 * std::numbers::pi;

const Outline kConicalSeat{{4, 0}, {20, 0}, {20, 8}, {12, 8}};
const Outline kConicalHead{{0, 0}, {4, 0}, {12, 8}, {0, 8}};
const Outline kChamferedPin{{0, 0}, {5, 0}, {6, 1}, {6, 30}, {0, 30}};
const Outline kCollar{{0, 0}, {4, 0}, {4, 10}, {9, 10}, {9, 14}, {5, 14}, {5, 25}, {0, 25}};
const Outline kFlatCone{{0, 0}, {16, 0}, {0, 3}};
const Outline kCounterbore{{4, 0}, {20, 0}, {20, 12}, {8, 12}, {8, 7}, {4, 7}};
const Outline kRoundedFoot{{0, 0}, {6, 0, kQuarterTurn}, {10, 4}, {10, 30}, {0, 30}};
const Outline kRoundedHead{{0, 0}, {10, 0}, {10, 28, kQuarterTurn}, {8, 30}, {0, 30}};
const Outline kFillet{{0, 0}, {14, 0}, {14, 6}, {8, 6, -kQuarterTurn}, {6, 8}, {6, 25}, {0, 25}};

// Smaller than the chords of their rims are off.
const Outline kBrokenEdge{{0, 0}, {9.7, 0, kQuarterTurn}, {10, 0.3}, {10, 20}, {0, 20}};
const Outline kTinyFillet{{0, 0},   {14, 0}, {14, 6}, {6.2, 6, -kQuarterTurn},
                          {6, 6.2}, {6, 25}, {0, 25}};

/// By a place of `piece` at the angle `angle_rad` about the axis, as near as `reach_mm`.
Eigen::Vector3d point_by(testing::RandomGeometry& random, const testing::OutlinePiece& piece,
                         double share, double angle_rad, double reach_mm) {
  const Eigen::Vector2d on =
      piece.is_arc() ? piece.on_arc(share) : piece.start + share * (piece.end - piece.start);
  return Eigen::Vector3d(on.x() * std::cos(angle_rad), on.x() * std::sin(angle_rad), on.y()) +
         random.point(reach_mm);
}

}  // namespace

TEST_CASE("the distance from coarse solids of revolution is that from their profile",
          "[property]") {
  const auto profile =
      GENERATE(kConicalSeat, kConicalHead, kChamferedPin, kCollar, kFlatCone, kCounterbore,
               kRoundedFoot, kRoundedHead, kFillet, kBrokenEdge, kTinyFillet);
  const auto segments = GENERATE(8U, 11U, 12U, 16U, 24U, 31U);
  const auto per_arc = GENERATE(2U, 5U);
  CAPTURE(profile.size(), profile[1].x, segments, per_arc);
  const testing::ExactShape shape =
      testing::revolved_shape("of revolution", profile, {.per_turn = segments, .per_arc = per_arc});
  const CollisionModel model(std::make_shared<const FacetedSolid>(shape.solid), {});
  testing::RandomGeometry random(21);
  int inside = 0;
  int outside = 0;
  for (int i = 0; i < 3'000; ++i) {
    // About a place of the boundary, closer than the facets are to the exact faces.
    const testing::OutlinePiece piece(profile,
                                      random.index(static_cast<std::uint32_t>(profile.size())));
    if (piece.start.x() == 0.0 && piece.end.x() == 0.0) continue;
    // Half of them by a rim, where facets fall short or overhang, and by an edge between facets.
    const bool is_by_rim = random.index(2) == 0;
    const double share = random.uniform(0.0, is_by_rim ? 0.05 : 1.0);
    const double seam = 2.0 * std::numbers::pi / segments * random.index(segments);
    const double angle = is_by_rim ? seam + random.uniform(-0.02, 0.02) : random.uniform(0.0, 6.3);
    const double reach_mm = is_by_rim ? 0.02 : std::pow(10.0, random.uniform(-4.0, 1.0));
    const Eigen::Vector3d p =
        point_by(random, piece, random.index(2) == 0 ? share : 1.0 - share, angle, reach_mm);
    const double truth = shape.signed_distance_mm(p);
    const auto near = model.nearest(p);
    CAPTURE(p.transpose(), truth, near.distance_mm, near.inside);
    (truth < 0.0 ? inside : outside) += 1;
    if (std::abs(truth) > 1e-9) REQUIRE(near.inside == (truth < 0.0));
    REQUIRE(std::abs(near.distance_mm - std::abs(truth)) < 1e-6);
  }
  CHECK(inside > 300);
  CHECK(outside > 300);
}

TEST_CASE("a conical head over its seat is clear by its gap, however coarse the facets") {
  const auto segments = GENERATE(8U, 11U, 18U, 24U, 48U);
  const auto gap_mm = GENERATE(0.02, 0.03, 0.2);
  CAPTURE(segments, gap_mm);
  const auto element = [&](const Outline& profile) {
    auto solid = std::make_shared<const FacetedSolid>(
        testing::revolved_outline(profile, {.per_turn = segments}));
    const dowel::Aabb box = dowel::bounds(solid->vertices);
    const dowel::Obb obb{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()};
    return std::make_shared<const dowel::CollisionElement>(
        obb, [solid] { return solid; }, std::vector<std::uint32_t>{});
  };
  dowel::CollisionScene scene;
  scene.add(element(kConicalSeat), Pose());
  const dowel::BodyId head = scene.add(element(kConicalHead), Pose());
  testing::RandomGeometry random(22);
  for (int i = 0; i < kTurns; ++i) {
    const Pose turned =
        Pose::about_axis({0, 0, 0}, Eigen::Vector3d::UnitZ(), random.uniform(0.0, 6.3));
    const Pose X_WH(turned.rotation(), {0.0, 0.0, gap_mm * std::sqrt(2.0)});
    const auto verdicts = scene.check(std::array{head}, std::array{X_WH}, {});
    REQUIRE(dowel::worst(verdicts) == dowel::Verdict::Clear);
    // Pressed in, or seated, it is not.
    const Pose seated(turned.rotation(), Eigen::Vector3d::Zero());
    REQUIRE(dowel::worst(scene.check(std::array{head}, std::array{seated}, {})) ==
            dowel::Verdict::Contact);
    for (const double depth_mm : {0.006, 0.009, 0.011, 0.05}) {
      const Pose pressed(turned.rotation(), {0.0, 0.0, -depth_mm * std::sqrt(2.0)});
      CAPTURE(depth_mm);
      REQUIRE(dowel::worst(scene.check(std::array{head}, std::array{pressed}, {})) ==
              (depth_mm < 0.01 ? dowel::Verdict::Contact : dowel::Verdict::Interference));
    }
  }
}
