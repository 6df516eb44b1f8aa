#include "dowel/assembly/locating.h"

#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "dowel/assembly/restraint.h"
#include "random_geometry.h"

namespace {

using dowel::LocatingFrame;
using dowel::LocatingPoint;
using Eigen::Vector3d;

constexpr double kExact = 1e-9;

LocatingPoint point(const Vector3d& at, const Vector3d& normal, double error_mm = 0.0) {
  return {"P", at, normal.normalized(), error_mm, false};
}

/// Three points below, two in front, one at the left, all in the plane z = 0.
std::vector<LocatingPoint> three_two_one(double error_mm) {
  return {point({-50, -30, 0}, Vector3d::UnitZ(), error_mm),
          point({50, -30, 0}, Vector3d::UnitZ(), error_mm),
          point({0, 40, 0}, Vector3d::UnitZ(), error_mm),
          point({-40, -40, 0}, Vector3d::UnitY()),
          point({40, -40, 0}, Vector3d::UnitY()),
          point({-60, 0, 0}, Vector3d::UnitX())};
}

const LocatingFrame kFrame{Vector3d(3, -2, 5), 80.0};

}  // namespace

TEST_CASE("three pairs of points square to each other, L apart, have condition 1") {
  const double L = 70.0;
  const Vector3d o(10, 20, 30);
  std::vector<LocatingPoint> points;
  for (const double sense : {-1.0, 1.0}) {
    points.push_back(point(o + sense * L * Vector3d::UnitX(), Vector3d::UnitZ()));
    points.push_back(point(o + sense * L * Vector3d::UnitY(), Vector3d::UnitX()));
    points.push_back(point(o + sense * L * Vector3d::UnitZ(), Vector3d::UnitY()));
  }
  const auto locating = dowel::analyse_locating(points, {o, L});
  CHECK(locating.rank == 6);
  CHECK(locating.condition == Approx(1.0).margin(kExact));
  for (const double value : locating.singular_values) {
    CHECK(value == Approx(std::numbers::sqrt2).margin(kExact));
  }
  CHECK(locating.redundant.empty());
}

TEST_CASE("six points by 3-2-1 settle the workpiece, and without one of them one motion is free") {
  auto points = three_two_one(0.0);
  CHECK(dowel::analyse_locating(points, kFrame).rank == 6);
  points.pop_back();
  const auto locating = dowel::analyse_locating(points, kFrame);
  CHECK(locating.rank == 5);
  CHECK(std::isinf(locating.condition));
  REQUIRE(locating.free_motions.cols() == 1);
  // Along x, without a turn.
  CHECK(std::abs(locating.free_motions(0, 0)) == Approx(1.0).margin(kExact));
  CHECK(locating.free_motions.col(0).tail<5>().norm() == Approx(0.0).margin(kExact));
}

TEST_CASE("a fourth support and a third point in line are redundant, by name of the later one") {
  auto points = three_two_one(0.0);
  points.push_back(point({20, 10, 0}, Vector3d::UnitZ()));
  points.push_back(point({0, -40, 0}, Vector3d::UnitY()));
  const auto locating = dowel::analyse_locating(points, kFrame);
  CHECK(locating.rank == 6);
  CHECK(locating.redundant == std::vector<std::size_t>{6, 7});
}

TEST_CASE("three supports in a line leave the turn about it free", "[degenerate]") {
  auto points = three_two_one(0.0);
  points[2] = point({10, -30, 0}, Vector3d::UnitZ());
  const auto locating = dowel::analyse_locating(points, kFrame);
  CHECK(locating.rank == 5);
  CHECK(locating.redundant == std::vector<std::size_t>{2});
}

TEST_CASE("without points nothing is settled", "[degenerate]") {
  const auto locating = dowel::analyse_locating({}, kFrame);
  CHECK(locating.rank == 0);
  CHECK(locating.free_motions.cols() == 6);
}

TEST_CASE("rank and redundancy do not hang on where and how large the workpiece is", "[property]") {
  const auto seed = GENERATE(range(0U, 20U));
  CAPTURE(seed);
  dowel::testing::RandomGeometry random(seed);
  const Eigen::Quaterniond turn = random.rotation();
  const Vector3d far = random.point(10000.0);
  auto points = three_two_one(0.0);
  points.push_back(point({20, 10, 0}, Vector3d::UnitZ()));
  for (LocatingPoint& p : points) {
    p.at = turn * p.at + far;
    p.normal = turn * p.normal;
  }
  const auto locating = dowel::analyse_locating(points, {turn * kFrame.reference + far, 80.0});
  CHECK(locating.rank == 6);
  CHECK(locating.redundant == std::vector<std::size_t>{6});
  const auto still = dowel::analyse_locating(three_two_one(0.0), kFrame);
  points.pop_back();
  CHECK(dowel::analyse_locating(points, {turn * kFrame.reference + far, 80.0}).condition ==
        Approx(still.condition).epsilon(1e-8));
}

TEST_CASE("errors of three supports go to a point of their plane by its barycentric coordinates") {
  // With all points in one plane, a tilt moves that plane's points along z alone.
  const double e = 0.01;
  const auto points = three_two_one(e);
  // Barycentric coordinates of (x, y) in the triangle (-50,-30), (50,-30), (0,40), by hand.
  const double x = 70.0;
  const double y = 55.0;
  const double third = (y + 30.0) / 70.0;
  const double second = 0.5 * (1.0 - third + x / 50.0);
  const double first = 1.0 - second - third;
  const auto error = dowel::position_error(points, kFrame, {x, y, 0.0});
  CHECK(error.worst_mm ==
        Approx(e * (std::abs(first) + std::abs(second) + std::abs(third))).margin(1e-12));
  // At a support itself: its own error.
  CHECK(dowel::position_error(points, kFrame, {0, 40, 0}).worst_mm == Approx(e).margin(1e-12));
}

TEST_CASE("plane, round pin and diamond pin: the pins' play turns the workpiece about each other") {
  // Play c1 and c2 (diameters) of pins B apart: a point on their line beyond the diamond by s is
  // off by c2/2 and by s times the turn (c1 + c2) / (2 B).
  const double B = 120.0;
  const double c1 = 0.03;
  const double c2 = 0.05;
  std::vector<LocatingPoint> points{
      point({-50, -30, 0}, Vector3d::UnitZ()),       point({50, -30, 0}, Vector3d::UnitZ()),
      point({0, 40, 0}, Vector3d::UnitZ()),          point({0, 0, 0}, Vector3d::UnitX()),
      point({0, 0, 0}, Vector3d::UnitY(), c1 / 2.0), point({B, 0, 0}, Vector3d::UnitY(), c2 / 2.0)};
  const double s = 40.0;
  const auto error = dowel::position_error(points, kFrame, {B + s, 0, 0});
  CHECK(error.worst_mm == Approx(c2 / 2.0 + s * (c1 + c2) / (2.0 * B)).margin(1e-12));
  // The angle itself, off the line of centres: two points one mm apart across it.
  const auto above = dowel::position_error(points, kFrame, {0, 1000.0, 0});
  CHECK(above.worst_mm ==
        Approx(std::hypot(1000.0 * (c1 + c2) / (2.0 * B), c1 / 2.0)).margin(1e-9));
}

TEST_CASE("locators far apart place a part better than locators close to each other") {
  const auto spread = three_two_one(0.01);
  auto close = spread;
  close[0].at = {-5, -3, 0};
  close[1].at = {5, -3, 0};
  close[2].at = {0, 4, 0};
  const Vector3d corner(60, 40, 0);
  CHECK(dowel::analyse_locating(close, kFrame).condition >
        5.0 * dowel::analyse_locating(spread, kFrame).condition);
  CHECK(dowel::position_error(close, kFrame, corner).worst_mm >
        5.0 * dowel::position_error(spread, kFrame, corner).worst_mm);
}

TEST_CASE("drawn errors stay below the worst case, and their mean is that of theory") {
  // One support alone is off, evenly within e: the mean of |error| at it is e / 2.
  auto points = three_two_one(0.0);
  points[2].error_mm = 0.02;
  const auto error = dowel::position_error(points, kFrame, {0, 40, 0}, {40'000, 7});
  CHECK(error.worst_mm == Approx(0.02).margin(1e-12));
  CHECK(error.mean_mm == Approx(0.01).margin(0.0002));  // 4 standard errors: 0.00012
  CHECK(error.p95_mm == Approx(0.019).margin(0.0002));
  const auto again = dowel::position_error(points, kFrame, {0, 40, 0}, {40'000, 7});
  CHECK(again.mean_mm == error.mean_mm);
  CHECK(dowel::position_error(points, kFrame, {0, 40, 0}, {40'000, 8}).mean_mm != error.mean_mm);
}
