#include "dowel/collision/axis_profile.h"

#include <numbers>

#include <catch2/catch.hpp>

#include "collision_element.h"
#include "dowel/collision/model.h"
#include "dowel/kernel/mesh_defect.h"
#include "random_geometry.h"
#include "solids.h"

using dowel::AxisProfile;
using dowel::AxisProfiles;
using dowel::CollisionModel;
using dowel::Fit;
using dowel::Pose;
namespace testing = dowel::testing;

namespace {

#ifdef DOWEL_SANITIZED
constexpr int kTiltedShafts = 5'000;
#else
constexpr int kTiltedShafts = 100'000;
#endif

CollisionModel model_of(dowel::FacetedSolid solid) {
  return {std::make_shared<const dowel::FacetedSolid>(std::move(solid)), {}};
}

/// Heights of the profile's steps along z, whatever the direction of its axis, as from, to, radius.
std::vector<std::array<double, 3>> steps_along_z(const AxisProfile& profile) {
  std::vector<std::array<double, 3>> result;
  for (const dowel::ProfileStep& step : profile.steps) {
    const double z0 = (profile.origin + step.from_mm * profile.direction).z();
    const double z1 = (profile.origin + step.to_mm * profile.direction).z();
    result.push_back({std::min(z0, z1), std::max(z0, z1), step.most_radius_mm()});
  }
  std::ranges::sort(result);
  return result;
}

/// Of the profile's step at height `z`; 0 where there is none.
double radius_at(const AxisProfile& profile, double z) {
  double radius = 0.0;
  for (const auto& [from, to, most] : steps_along_z(profile)) {
    if (from < z && z < to) radius = std::max(radius, most);
  }
  return radius;
}

/// A cylinder whose top is a part of a sphere, `crown_mm` high, with no vertex but on its rim.
dowel::FacetedSolid crowned_pin(double radius_mm, double height_mm, double crown_mm) {
  dowel::FacetedSolid solid = testing::cylinder(radius_mm, height_mm, 16);
  constexpr std::uint32_t kTop = 2;
  const double ball_mm = 0.5 * (radius_mm * radius_mm / crown_mm + crown_mm);
  solid.faces[kTop].surface =
      dowel::SphereSurface{{0.0, 0.0, height_mm + crown_mm - ball_mm}, ball_mm};
  solid.faces[kTop].facet_error_mm = crown_mm;
  std::vector<std::uint32_t> rim;
  for (std::uint32_t v = 0; v < solid.vertices.size(); ++v) {
    const Eigen::Vector3d& p = solid.vertices[v];
    if (p.z() == height_mm && p.head<2>().norm() > 0.5 * radius_mm) rim.push_back(v);
  }
  dowel::FacetedSolid result = solid;
  result.triangles.clear();
  result.face_of.clear();
  for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
    if (solid.face_of[t] == kTop) continue;
    result.triangles.push_back(solid.triangles[t]);
    result.face_of.push_back(solid.face_of[t]);
  }
  for (std::size_t i = 1; i + 1 < rim.size(); ++i) {
    result.triangles.push_back({rim[0], rim[i], rim[i + 1]});
    result.face_of.push_back(kTop);
  }
  dowel::weld(result);
  return result;
}

}  // namespace

TEST_CASE("a screw-like pin has one shaft whose steps are its cylinders") {
  const CollisionModel model = model_of(testing::stepped_pin({{6.0, 30}, {9.0, 12}}, 20));
  const AxisProfiles& profiles = model.profiles();
  REQUIRE(profiles.shafts.size() == 1);
  CHECK(profiles.bores.empty());
  const auto steps = steps_along_z(profiles.shafts[0]);
  REQUIRE(steps.size() == 2);
  CHECK(steps[0][2] == Approx(6.0).epsilon(1e-12));
  CHECK(steps[1][2] == Approx(9.0).epsilon(1e-12));
  CHECK(steps[0][1] == Approx(30.0));
  for (const auto& step : profiles.shafts[0].steps) CHECK(step.is_round);
}

TEST_CASE("a bore knows its counterbore, its bottom and that nothing is before its mouth") {
  testing::DrilledHole hole{0, 0, 6.0, 25.0, 10.0, 8.0};
  const CollisionModel model = model_of(testing::plate_with_holes({60, 60, 40}, {hole}, 20));
  REQUIRE(model.profiles().bores.size() == 1);
  CHECK(model.profiles().shafts.empty());
  const auto steps = steps_along_z(model.profiles().bores[0]);
  REQUIRE(steps.size() == 3);
  CHECK(steps[0][2] == 0.0);  // under the bottom
  CHECK(steps[0][1] == Approx(15.0));
  CHECK(steps[1][2] == Approx(6.0).epsilon(1e-12));
  CHECK(steps[2][2] == Approx(10.0).epsilon(1e-12));
  CHECK(steps[2][1] == Approx(40.0));
}

TEST_CASE("the air about a bore ends at what stands beside it") {
  // A wall on the plate, 12 mm from the axis, reaches over the bore's mouth.
  const CollisionModel model = model_of(testing::merged(
      testing::plate_with_holes({60, 60, 20}, {{0, 0, 6.0}}, 20),
      testing::transformed(Pose::from_translation({22, 0, 25.5}), testing::box({20, 20, 10}))));
  REQUIRE(model.profiles().bores.size() == 1);
  const auto steps = steps_along_z(model.profiles().bores[0]);
  REQUIRE(steps.size() >= 2);
  CHECK(steps.front()[2] == Approx(6.0).epsilon(1e-12));
  CHECK(steps.back()[2] == Approx(12.0));
  CHECK(steps.back()[0] == Approx(20.5));
}

TEST_CASE("a shaft is as thick as the crowns of its torus, between all facets") {
  const auto tube_segments = GENERATE(7U, 10U, 14U);
  // Half a facet off: none has a corner on a crown.
  const double phase = std::numbers::pi * (0.5 + 1.0 / tube_segments);
  const CollisionModel model = model_of(
      testing::merged(testing::cylinder(5.0, 30.0, 24),
                      testing::transformed(Pose::from_translation({0, 0, 15}),
                                           testing::torus(10.0, 3.0, 24, tube_segments, phase))));
  REQUIRE(model.profiles().shafts.size() == 1);
  for (const double angle : {0.01, 0.1, 0.5, 1.0, 1.5}) {
    CAPTURE(tube_segments, angle);
    const double radius_mm = 10.0 + 3.0 * std::sin(angle);
    CHECK(radius_at(model.profiles().shafts[0], 15.0 + 3.0 * std::cos(angle)) >= radius_mm);
    CHECK(radius_at(model.profiles().shafts[0], 15.0 - 3.0 * std::cos(angle)) >= radius_mm);
  }
  // No thicker either, and nothing beyond the crowns.
  CHECK(radius_at(model.profiles().shafts[0], 15.0) <= 13.0 + 1e-9);
  CHECK(radius_at(model.profiles().shafts[0], 18.1) == Approx(5.0));
  CHECK(radius_at(model.profiles().shafts[0], 11.9) == Approx(5.0));
}

TEST_CASE("a shaft reaches as far as its crowned end, whose facets are level") {
  constexpr double kRadius_mm = 5.0;
  constexpr double kHeight_mm = 30.0;
  constexpr double kCrown_mm = 0.2;
  const CollisionModel model = model_of(crowned_pin(kRadius_mm, kHeight_mm, kCrown_mm));
  REQUIRE(model.profiles().shafts.size() == 1);
  const double ball_mm = 0.5 * (kRadius_mm * kRadius_mm / kCrown_mm + kCrown_mm);
  for (const double above_mm : {0.01, 0.1, 0.19}) {
    const double height_mm = ball_mm - kCrown_mm + above_mm;
    CHECK(radius_at(model.profiles().shafts[0], kHeight_mm + above_mm) >=
          std::sqrt(ball_mm * ball_mm - height_mm * height_mm));
  }
}

TEST_CASE("a ring that lies on a mouth, in it by less than the tolerance, meets no wall") {
  const CollisionModel plate = model_of(testing::plate_with_holes({60, 60, 20}, {{0, 0, 6.0}}, 16));
  AxisProfile ring;
  ring.steps = {{0.0, 5.0, 20.0, 20.0, true}};
  const AxisProfile& bore = plate.profiles().bores[0];
  const double top = bore.direction.z() > 0.0 ? bore.steps.back().to_mm : -bore.steps[0].from_mm;
  const Pose X_VS = Pose::from_translation({0, 0, bore.origin.z() + top - 0.04});
  const Fit fitted = fit(ring, bore, X_VS, 0.1, {});
  CHECK(fitted.is_free);
  CHECK(fitted.gap_mm < -1.0);
  CHECK_FALSE(fitted.gap_is_met);
}

TEST_CASE("a fit is free exactly where the cylinders leave room", "[property]") {
  // The seat, the counterbore and the tilt are analytic: clearance less offset less tilt.
  const CollisionModel plate = model_of(testing::plate_with_holes({60, 60, 20}, {{0, 0, 6.0}}, 16));
  const AxisProfile& bore = plate.profiles().bores[0];
  testing::RandomGeometry random(41);
  const double t = 0.001;
  int free = 0;
  int blocked = 0;
  for (int i = 0; i < 100'000; ++i) {
    const double clearance = std::pow(10.0, random.uniform(-3.0, 0.0));
    const double offset = random.uniform(0.0, 1.5) * clearance;
    const double radius = 6.0 - clearance;
    AxisProfile shaft;
    shaft.steps = {{0.0, 30.0, radius, radius, true}, {30.0, 36.0, 9.0, 9.0, true}};
    const double direction = random.uniform(0.0, 7.0);
    const double turn = random.uniform(0.0, 7.0);
    // The head is seated on the plate or above it.
    const double above = i % 2 == 0 ? 0.0 : random.uniform(0.0, 5.0);
    const Pose X_VS(Eigen::Quaterniond(Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitZ())),
                    {offset * std::cos(direction), offset * std::sin(direction), -10.0 + above});
    const double gap = clearance - offset;
    if (std::abs(gap + t) < 1e-3 * t || std::abs(gap) < 1e-9) continue;
    const Fit fitted = fit(shaft, bore, X_VS, t, {});
    CAPTURE(i, clearance, offset, above);
    REQUIRE(fitted.is_free == (gap > -t));
    if (fitted.is_free) REQUIRE(fitted.gap_mm == Approx(std::min(gap, above)).margin(1e-9));
    if (fitted.gap_is_met) REQUIRE(fitted.gap_mm == Approx(gap).margin(1e-9));
    free += fitted.is_free ? 1 : 0;
    blocked += fitted.is_free ? 0 : 1;
  }
  CHECK(free > 5000);
  CHECK(blocked > 2000);
}

TEST_CASE("of a tilted shaft a fit says no more room than there is, nor a contact that is none",
          "[property]") {
  const CollisionModel plate = model_of(testing::plate_with_holes({60, 60, 20}, {{0, 0, 6.0}}, 16));
  const AxisProfile& bore = plate.profiles().bores[0];
  testing::RandomGeometry random(43);
  const double t = 0.01;
  const double length = 12.0;
  constexpr int kRulings = 1000;
  constexpr double kSampling_mm = 6.0 * 1.3e-6;  // of a circle by its rulings
  // The shaft's side is made of straight lines, each of which is furthest from the bore's axis
  // where it ends or passes an end of the bore.
  std::vector<Eigen::Vector2d> around;
  for (int k = 0; k < kRulings; ++k) {
    const double angle = 2.0 * 3.14159265358979 * k / kRulings;
    around.emplace_back(std::cos(angle), std::sin(angle));
  }
  const auto room_mm = [&](const Pose& X_WS, double radius) {
    const Eigen::Matrix3d rotation = X_WS.rotation_matrix();
    const Eigen::Vector3d along = rotation.col(2);
    double least = std::numeric_limits<double>::infinity();
    for (const Eigen::Vector2d& direction : around) {
      const Eigen::Vector3d foot =
          radius * (rotation.leftCols<2>() * direction) + X_WS.translation();
      const double from = std::max(0.0, -foot.z() / along.z());
      const double to = std::min(length, (20.0 - foot.z()) / along.z());
      if (from > to) continue;
      for (const double s : {from, to}) {
        least = std::min(least, 6.0 - (foot + s * along).head<2>().norm());
      }
    }
    return least;
  };
  int met = 0;
  int apart = 0;
  for (int i = 0; i < kTiltedShafts; ++i) {
    const double radius = 6.0 - std::pow(10.0, random.uniform(-2.0, 0.0));
    const double tilt = std::pow(10.0, random.uniform(-4.0, -1.05));
    AxisProfile shaft;
    shaft.steps = {{0.0, length, radius, radius, true}};
    const double turn = random.uniform(0.0, 7.0);
    const Eigen::Vector3d about(std::cos(turn), std::sin(turn), 0.0);
    const double off = random.uniform(0.0, 6.0 - radius);
    const Pose X_WS(Eigen::Quaterniond(Eigen::AngleAxisd(tilt, about)),
                    {off, 0.0, random.uniform(-length, 20.0)});
    const Fit fitted = fit(shaft, bore, X_WS, t, {});
    const double room = room_mm(X_WS, radius);
    CAPTURE(i, radius, tilt, off, room);
    REQUIRE(fitted.gap_mm <= room + 1e-9);
    if (fitted.gap_is_met) REQUIRE(room <= t + kSampling_mm);
    met += fitted.gap_is_met ? 1 : 0;
    apart += fitted.gap_mm > t ? 1 : 0;
  }
  CHECK(met > kTiltedShafts / 40);
  CHECK(apart > kTiltedShafts / 40);
}
