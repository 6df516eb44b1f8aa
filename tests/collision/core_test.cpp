#include "dowel/collision/core.h"

#include <cmath>
#include <memory>

#include <catch2/catch.hpp>

#include "dowel/collision/box_separation.h"
#include "dowel/collision/model.h"
#include "plate_with_holes.h"
#include "random_geometry.h"
#include "solids.h"

using dowel::CollisionModel;
using dowel::Core;
using dowel::Cores;
using dowel::FacetedSolid;
using dowel::Pose;
namespace testing = dowel::testing;

namespace {

constexpr double kMargin_mm = 0.005;

CollisionModel model_of(FacetedSolid solid) {
  return {std::make_shared<const FacetedSolid>(std::move(solid)), {}};
}

/// Any point of the core.
Eigen::Vector3d point_of(const Core& core, testing::RandomGeometry& random) {
  Eigen::Vector3d local;
  do {
    local = {random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0)};
  } while (core.is_bar && local.head<2>().norm() > 1.0);
  return core.center + core.axes * local.cwiseProduct(core.half_mm);
}

Cores block(const Eigen::Vector3d& size) {
  return model_of(testing::box(size)).cores();
}

}  // namespace

TEST_CASE("cores lie in the exact material of a plate with holes and reach its faces",
          "[property]") {
  const Eigen::Vector3d size(120.0, 80.0, 20.0);
  auto holes = testing::hole_grid(3, 2, 40.0, 6.0);
  holes[1].counterbore_radius_mm = 9.0;
  holes[1].counterbore_depth_mm = 5.0;
  const CollisionModel model = model_of(testing::plate_with_holes(size, holes, 32));
  const Cores& cores = model.cores();
  REQUIRE(cores.cores.size() >= 6);
  testing::RandomGeometry random(11);
  dowel::Aabb reached;
  for (const Core& core : cores.cores) {
    CAPTURE(core.center.transpose(), core.half_mm.transpose());
    for (int i = 0; i < 2'000; ++i) {
      const Eigen::Vector3d p = point_of(core, random);
      reached.extend(p);
      REQUIRE((p.head<2>().cwiseAbs() - 0.5 * size.head<2>()).maxCoeff() <= 0.0);
      REQUIRE(std::abs(p.z() - 10.0) <= 10.0);
      for (const testing::DrilledHole& hole : holes) {
        const bool is_in_counterbore = p.z() > size.z() - hole.counterbore_depth_mm;
        const double radius = is_in_counterbore ? hole.counterbore_radius_mm : hole.radius_mm;
        REQUIRE(std::hypot(p.x() - hole.x, p.y() - hole.y) >= std::max(radius, hole.radius_mm));
      }
    }
  }
  CHECK((reached.size() - size).cwiseAbs().maxCoeff() < 0.5);
}

TEST_CASE("a chamfered pin has bars as thick as the pin and as long as the pin", "[property]") {
  const CollisionModel model = model_of(
      testing::revolved({{0.0, 0.0}, {5.0, 0.0}, {6.0, 1.0}, {6.0, 30.0}, {0.0, 30.0}}, 24));
  bool is_thick = false;
  bool is_long = false;
  testing::RandomGeometry random(12);
  for (const Core& core : model.cores().cores) {
    is_thick = is_thick || (core.is_bar && std::abs(core.half_mm.x() - 6.0) < 1e-6);
    is_long = is_long || (core.is_bar && std::abs(core.half_mm.z() - 15.0) < 1e-6);
    for (int i = 0; i < 2'000; ++i) {
      const Eigen::Vector3d p = point_of(core, random);
      REQUIRE(std::abs(p.z() - 15.0) <= 15.0);
      REQUIRE(std::hypot(p.x(), p.y()) <= std::min(6.0, 5.0 + p.z()));
    }
  }
  CHECK(is_thick);
  CHECK(is_long);
}

TEST_CASE("a tube has no bar along its bore") {
  const CollisionModel model = model_of(testing::tube(4.0, 6.0, 20.0, 24));
  REQUIRE_FALSE(model.cores().cores.empty());
  for (const Core& core : model.cores().cores) CHECK_FALSE(core.is_bar);
}

TEST_CASE("blocks that overlap have a point in common, others have none", "[property]") {
  const Eigen::Vector3d size_a(20.0, 10.0, 6.0);
  const Eigen::Vector3d size_b(30.0, 8.0, 8.0);
  const Cores a = block(size_a);
  const Cores b = block(size_b);
  REQUIRE(a.cores.size() == 1);
  REQUIRE(b.cores.size() == 1);
  const auto box_of = [](const Core& core) {
    return dowel::Obb{core.center, core.axes, core.half_mm};
  };
  testing::RandomGeometry random(13);
  int found = 0;
  int overlapping = 0;
  int apart = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Pose X_BA(i % 3 == 0 ? Eigen::Quaterniond::Identity() : random.rotation(),
                    random.point(20.0));
    const auto overlap = find_overlap(a, b, X_BA, kMargin_mm);
    const auto separation = dowel::separate_brute_force(transformed(X_BA, box_of(a.cores[0])),
                                                        box_of(b.cores[0]), -2.0 * kMargin_mm);
    if (separation.plane >= 0) {
      ++apart;
      REQUIRE_FALSE(overlap);
      continue;
    }
    ++overlapping;
    if (!overlap) continue;  // allowed where there is hardly any room
    ++found;
    const Eigen::Vector3d p_A = X_BA.inverse() * overlap->point_B;
    REQUIRE(overlap->depth_a_mm >= kMargin_mm);
    REQUIRE(overlap->depth_b_mm >= kMargin_mm);
    REQUIRE(std::abs(overlap->depth_a_mm - a.cores[0].depth_mm(p_A)) < 1e-9);
    REQUIRE(std::abs(overlap->depth_b_mm - b.cores[0].depth_mm(overlap->point_B)) < 1e-9);
  }
  CHECK(apart > 10'000);
  CHECK(overlapping > 10'000);
  CHECK(found > 0.75 * overlapping);
}
