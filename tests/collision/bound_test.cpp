// How a verdict was reached, and how far what decided may be off the exact solids.

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
using dowel::Method;
using dowel::PairVerdict;
using dowel::Pose;
using dowel::Verdict;
namespace testing = dowel::testing;

namespace {

/// The solid with its curved faces known by their facets alone.
FacetedSolid by_facets(FacetedSolid solid) {
  for (dowel::Face& face : solid.faces) {
    if (!is_plane(face.surface)) face.surface = dowel::OtherSurface{};
  }
  return solid;
}

class Pair {
 public:
  Pair(const FacetedSolid& moving, const FacetedSolid& placed)
      : placed_(scene_.add(testing::collision_element(placed), Pose())),
        moving_(scene_.add(testing::collision_element(moving), Pose())) {}

  PairVerdict at(const Pose& X_WB) {
    scene_.move(placed_, Pose());  // nothing is remembered
    const auto found = scene_.check({&moving_, 1}, {&X_WB, 1}, {});
    return found.empty() ? PairVerdict() : found.front().pair;
  }

 private:
  CollisionScene scene_;
  BodyId placed_;
  BodyId moving_;
};

FacetedSolid table() {
  return testing::box({100, 100, 20}, {0, 0, -10});
}

}  // namespace

TEST_CASE("a verdict tells whether facets or exact faces decided") {
  Pair block(testing::box({10, 10, 10}, {0, 0, 5}), table());
  CHECK(block.at(Pose()).method == Method::Facets);
  CHECK(block.at(Pose()).bound_mm == 0.0);
  Pair pin(testing::cylinder(5.99, 30, 24),
           testing::plate_with_holes({60, 60, 20}, {{0, 0, 6}}, 20));
  const PairVerdict seated = pin.at(Pose::from_translation({0.005, 0, -5}));
  CHECK(seated.verdict == Verdict::Contact);
  CHECK(seated.method == Method::Exact);
  CHECK(seated.bound_mm == 0.0);
  CHECK(seated.gap_mm == Approx(0.005));
  const PairVerdict tight = pin.at(Pose::from_translation({0.05, 0, -5}));
  CHECK(tight.verdict == Verdict::Interference);
  CHECK(tight.method == Method::Exact);
  CHECK(tight.bound_mm == 0.0);
}

TEST_CASE("where faces are known by facets alone, verdict and gap are right within the bound",
          "[property]") {
  const double radius = 6.0;
  const double t = dowel::kDefaultTolerance_mm;
  const FacetedSolid bar = by_facets(testing::cylinder(radius, 20, 40));
  double error_mm = 0.0;
  for (const dowel::Face& face : bar.faces) error_mm = std::max(error_mm, face.facet_error_mm);
  REQUIRE(error_mm > t);
  Pair lying(bar, table());
  testing::RandomGeometry random(81);
  std::array<int, 3> seen{};
  int differ = 0;
  int by_facets_alone = 0;
  for (int i = 0; i < 20'000; ++i) {
    const double height = random.uniform(-4.0, 4.0) * error_mm;  // of the exact cylinder's bottom
    const Eigen::Quaterniond turn =
        Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX()) *
        Eigen::AngleAxisd(random.uniform(0, 7), Eigen::Vector3d::UnitZ());
    const PairVerdict said = lying.at(Pose(turn, {0, 0, radius + height}));
    const Verdict truth = height < -t  ? Verdict::Interference
                          : height > t ? Verdict::Clear
                                       : Verdict::Contact;
    CAPTURE(i, height, to_string(said.verdict), said.gap_mm, said.depth_mm, said.bound_mm);
    ++seen[static_cast<std::size_t>(said.verdict)];
    if (said.verdict != truth) {
      const double off_mm = std::min(std::abs(height - t), std::abs(height + t));
      REQUIRE(off_mm <= error_mm + 1e-9);
      ++differ;
    }
    if (said.verdict == Verdict::Clear) continue;
    // Exact: by what lies so deep in the facets that it is in the exact solids.
    REQUIRE(said.bound_mm >= (said.method == Method::Exact ? 0.0 : error_mm));
    by_facets_alone += said.method == Method::Facets ? 1 : 0;
    if (said.verdict == Verdict::Contact) {
      REQUIRE(said.gap_mm <= std::max(height, 0.0) + said.bound_mm);
      REQUIRE(said.gap_mm >= std::max(height, 0.0) - said.bound_mm);
    } else {
      REQUIRE(said.depth_mm <= -height + said.bound_mm);
    }
  }
  for (const int count : seen) CHECK(count > 1'000);
  CHECK(differ > 100);  // the bound is needed
  CHECK(by_facets_alone > 5'000);
}

TEST_CASE("an interference deep inside is told with the bound of what is known by facets") {
  Pair ball(by_facets(testing::sphere(8, 12)), testing::box({60, 60, 60}));
  const PairVerdict contained = ball.at(Pose::from_translation({1, 2, 3}));
  CHECK(contained.verdict == Verdict::Interference);
  CHECK(contained.depth_mm <= 16.0 + contained.bound_mm);
  Pair crossing(by_facets(testing::sphere(8, 12)), table());
  const PairVerdict pressed = crossing.at(Pose::from_translation({0, 0, 7}));
  CHECK(pressed.verdict == Verdict::Interference);
  CHECK(pressed.bound_mm > 0.01);
}
