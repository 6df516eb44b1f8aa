// Tree against tree, and leaf against leaf, beside all pairs of facets.

#include "facet_pairs.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>

#include <catch2/catch.hpp>

#include "collision_element.h"
#include "kept_off.h"
#include "random_geometry.h"
#include "solids.h"

using dowel::CollisionModel;
using dowel::FacetedSolid;
using dowel::ModelPair;
using dowel::Pose;
namespace testing = dowel::testing;

namespace {

#ifdef DOWEL_SANITIZED
constexpr int kPoses = 1'000;
#else
constexpr int kPoses = 50'000;
#endif

struct Part {
  explicit Part(FacetedSolid solid)
      : obb(testing::box_of(solid)),
        model(std::make_shared<const FacetedSolid>(std::move(solid)), {}) {}
  dowel::Obb obb;
  CollisionModel model;
};

double distance_of_all_facets_mm(const CollisionModel& a, const CollisionModel& b,
                                 const Pose& X_BA) {
  const dowel::Placement placement(X_BA);
  double least = std::numeric_limits<double>::infinity();
  for (const dowel::ModelTriangle& of_a : a.triangles()) {
    const dowel::PlacedTriangle a_B = placement * of_a;
    for (const dowel::ModelTriangle& of_b : b.triangles()) {
      const auto closest =
          dowel::closest_points(a_B.corners_B, a_B.normal_B, of_b.corners, of_b.normal);
      least = std::min(least, closest.distance_squared_mm2);
    }
  }
  return std::sqrt(least);
}

}  // namespace

TEST_CASE("the trees lead to the distance that all pairs of facets have", "[property]") {
  // Of flat faces only: their facets are the exact solid.
  const std::vector<std::pair<double, double>> ell{{0, 0}, {30, 0}, {30, 8},
                                                   {8, 8}, {8, 25}, {0, 25}};
  std::vector<Eigen::Vector2d> outline;
  for (const auto& [x, y] : ell) outline.emplace_back(x, y);
  const Part angle(testing::prism(outline, 20));
  const Part wedge(testing::wedge(0.3, 20, 15));
  const auto [a, b] = GENERATE_REF(std::pair(&angle, &wedge), std::pair(&wedge, &wedge));
  testing::RandomGeometry random(63);
  dowel::NarrowScratch scratch;
  dowel::QueryCounters counters;
  int apart = 0;
  int meeting = 0;
  for (int i = 0; i < kPoses; ++i) {
    const Pose X_BA(i % 2 == 0 ? random.rotation() : Eigen::Quaterniond::Identity(),
                    random.point(40.0));
    const ModelPair pair{a->model, b->model, a->obb, b->obb, X_BA, {}};
    constexpr double kCap_mm = 1.0e3;
    const double said_mm =
        dowel::gap_lower_bound_mm(pair, dowel::HoleMode::Exact, kCap_mm, {}, {}, scratch, counters);
    const double truth_mm = distance_of_all_facets_mm(a->model, b->model, X_BA);
    CAPTURE(i, said_mm, truth_mm);
    REQUIRE(std::abs(said_mm - truth_mm) < 1e-12);
    (truth_mm > 0.0 ? apart : meeting) += 1;
  }
  CHECK(apart > kPoses / 5);
  CHECK(meeting > kPoses / 50);
}
