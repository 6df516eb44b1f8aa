// The distance from solids of revolution, against that from their profile in the plane of axis and
// radius.

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/collision/model.h"
#include "dowel/collision/scene.h"
#include "random_geometry.h"
#include "solids.h"

using dowel::CollisionModel;
using dowel::FacetedSolid;
using dowel::Pose;
namespace testing = dowel::testing;

namespace {

#ifdef DOWEL_SANITIZED
constexpr int kTurns = 2;
#else
constexpr int kTurns = 20;
#endif

using Profile = std::vector<Eigen::Vector2d>;  // radius and height, counter-clockwise

/// Signed distance from the solid that `profile` makes about the z axis, negative inside.
double distance_from(const Profile& profile, const Eigen::Vector3d& p) {
  const Eigen::Vector2d q(p.head<2>().norm(), p.z());
  double least = std::numeric_limits<double>::infinity();
  bool is_inside = false;
  for (std::size_t i = 0; i < profile.size(); ++i) {
    const Eigen::Vector2d& a = profile[i];
    const Eigen::Vector2d& b = profile[(i + 1) % profile.size()];
    if ((a.y() > q.y()) != (b.y() > q.y())) {
      const double at = a.x() + (q.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x());
      if (q.x() < at) is_inside = !is_inside;
    }
    if (a.x() == 0.0 && b.x() == 0.0) continue;  // the axis is no boundary
    const double share = std::clamp((q - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
    least = std::min(least, (q - a - share * (b - a)).norm());
  }
  return is_inside ? -least : least;
}

const Profile kConicalSeat{{4, 0}, {20, 0}, {20, 8}, {12, 8}};
const Profile kConicalHead{{0, 0}, {4, 0}, {12, 8}, {0, 8}};
const Profile kChamferedPin{{0, 0}, {5, 0}, {6, 1}, {6, 30}, {0, 30}};
const Profile kCollar{{0, 0}, {4, 0}, {4, 10}, {9, 10}, {9, 14}, {5, 14}, {5, 25}, {0, 25}};
const Profile kFlatCone{{0, 0}, {16, 0}, {0, 3}};
const Profile kCounterbore{{4, 0}, {20, 0}, {20, 12}, {8, 12}, {8, 7}, {4, 7}};

}  // namespace

TEST_CASE("the distance from coarse solids of revolution is that from their profile",
          "[property]") {
  const auto profile =
      GENERATE(kConicalSeat, kConicalHead, kChamferedPin, kCollar, kFlatCone, kCounterbore);
  const auto segments = GENERATE(8U, 11U, 12U, 16U, 24U);
  CAPTURE(profile.size(), profile[1].x(), segments);
  const CollisionModel model(
      std::make_shared<const FacetedSolid>(testing::revolved(profile, segments)), {});
  testing::RandomGeometry random(21);
  int inside = 0;
  int outside = 0;
  for (int i = 0; i < 3'000; ++i) {
    // About a place of the boundary, closer than the facets are to the exact faces.
    const std::size_t edge = random.index(static_cast<std::uint32_t>(profile.size()));
    const Eigen::Vector2d& a = profile[edge];
    const Eigen::Vector2d& b = profile[(edge + 1) % profile.size()];
    if (a.x() == 0.0 && b.x() == 0.0) continue;
    // Half of them by a rim, where facets fall short or overhang, and by an edge between facets.
    const bool is_by_rim = random.index(2) == 0;
    const double share = random.uniform(0.0, is_by_rim ? 0.05 : 1.0);
    const Eigen::Vector2d on = a + (random.index(2) == 0 ? share : 1.0 - share) * (b - a);
    const double seam = 2.0 * std::numbers::pi / segments * random.index(segments);
    const double angle = is_by_rim ? seam + random.uniform(-0.02, 0.02) : random.uniform(0.0, 6.3);
    const Eigen::Vector3d p =
        Eigen::Vector3d(on.x() * std::cos(angle), on.x() * std::sin(angle), on.y()) +
        random.point(is_by_rim ? 0.02 : 0.3);
    const double truth = distance_from(profile, p);
    const auto near = model.nearest(p);
    CAPTURE(p.transpose(), truth, near.distance_mm, near.inside);
    (truth < 0.0 ? inside : outside) += 1;
    if (std::abs(truth) > 1e-9) REQUIRE(near.inside == (truth < 0.0));
    REQUIRE(std::abs(near.distance_mm - std::abs(truth)) < 1e-6);
  }
  CHECK(inside > 300);
  CHECK(outside > 300);
}

TEST_CASE("the distance from a coarse solid with a fillet is that from its profile", "[property]") {
  // A right angle, convex or concave, whose fillet blends into plane and cylinder.
  struct Filleted {
    Profile profile;
    std::size_t corner;
    bool is_convex;
  };
  const auto filleted =
      GENERATE(Filleted{{{0, 0}, {10, 0}, {10, 30}, {0, 30}}, 1, true},
               Filleted{{{0, 0}, {10, 0}, {10, 30}, {0, 30}}, 2, true},
               Filleted{{{0, 0}, {14, 0}, {14, 6}, {6, 6}, {6, 25}, {0, 25}}, 3, false});
  const auto radius_mm = GENERATE(0.5, 2.0, 4.0);
  const auto segments = GENERATE(16U, 24U, 31U);
  const auto bands = GENERATE(2U, 5U);
  const auto& [profile, corner, is_convex] = filleted;
  CAPTURE(profile.size(), corner, radius_mm, segments, bands);
  const CollisionModel model(std::make_shared<const FacetedSolid>(testing::revolved_with_fillet(
                                 profile, corner, radius_mm, bands, segments)),
                             {});
  const Eigen::Vector2d in = radius_mm * (profile[corner - 1] - profile[corner]).normalized();
  const Eigen::Vector2d out = radius_mm * (profile[corner + 1] - profile[corner]).normalized();
  const Eigen::Vector2d center = profile[corner] + in + out;
  // Signed distance from the solid: the sharp profile, but for the square that the fillet is in.
  const auto truth_at = [&](const Eigen::Vector3d& p) {
    const Eigen::Vector2d q(p.head<2>().norm(), p.z());
    const Eigen::Vector2d d = q - center;
    const bool faces_fillet = d.dot(in) <= 0.0 && d.dot(out) <= 0.0;
    const double beyond_mm = d.norm() - radius_mm;
    double sharp = distance_from(profile, p);
    if (faces_fillet && d.dot(in) >= -in.squaredNorm() && d.dot(out) >= -out.squaredNorm()) {
      sharp = (beyond_mm > 0.0) == is_convex ? 1.0 : -1.0;  // its sign alone
    }
    Profile left = profile;  // the pieces that the fillet leaves
    double least = faces_fillet ? std::abs(beyond_mm) : std::numeric_limits<double>::infinity();
    left[corner] += in;
    left.insert(left.begin() + static_cast<std::ptrdiff_t>(corner) + 1, profile[corner] + out);
    for (std::size_t i = 0; i + 1 < left.size(); ++i) {
      if (i == corner) continue;
      const Eigen::Vector2d edge = left[i + 1] - left[i];
      const double share = std::clamp((q - left[i]).dot(edge) / edge.squaredNorm(), 0.0, 1.0);
      least = std::min(least, (q - left[i] - share * edge).norm());
    }
    return sharp < 0.0 ? -least : least;
  };
  testing::RandomGeometry random(23);
  for (int i = 0; i < 2'000; ++i) {
    // About the fillet and its rims; some far off.
    const double along = random.uniform(-0.2, 1.2) * 0.5 * std::numbers::pi;
    const Eigen::Vector2d on = center - std::sin(along) * in - std::cos(along) * out;
    const double angle = random.uniform(0.0, 6.3);
    const double reach_mm = std::pow(10.0, random.uniform(-4.0, 1.3));
    const Eigen::Vector3d p =
        Eigen::Vector3d(on.x() * std::cos(angle), on.x() * std::sin(angle), on.y()) +
        random.point(reach_mm);
    const double truth = truth_at(p);
    const auto near = model.nearest(p);
    CAPTURE(p.transpose(), truth, near.distance_mm, near.inside);
    if (std::abs(truth) > 1e-9) REQUIRE(near.inside == (truth < 0.0));
    REQUIRE(std::abs(near.distance_mm - std::abs(truth)) < 1e-6);
  }
}

TEST_CASE("a conical head over its seat is clear by its gap, however coarse the facets") {
  const auto segments = GENERATE(8U, 11U, 18U, 24U, 48U);
  const auto gap_mm = GENERATE(0.02, 0.03, 0.2);
  CAPTURE(segments, gap_mm);
  const auto element = [&](const Profile& profile) {
    auto solid = std::make_shared<const FacetedSolid>(testing::revolved(profile, segments));
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
