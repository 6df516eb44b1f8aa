// Locating and form closure against closed forms and exact arithmetic.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/assembly/locating.h"
#include "dowel/assembly/restraint.h"

namespace {

using dowel::LocatingFrame;
using dowel::LocatingPoint;
using Eigen::Vector3d;

constexpr double kExact = 1e-9;

LocatingPoint point(const Vector3d& at, const Vector3d& normal) {
  return {"P", at, normal, 0.0, false};
}

/// 3-2-1 in one plane: supports at (-a, 0), (a, 0) and (0, off_line), two stops b beside the
/// middle, one stop on it.
std::vector<LocatingPoint> near_a_line(double a, double b, double off_line) {
  return {point({-a, 0, 0}, Vector3d::UnitZ()),       point({a, 0, 0}, Vector3d::UnitZ()),
          point({0, off_line, 0}, Vector3d::UnitZ()), point({-b, 0, 0}, Vector3d::UnitY()),
          point({b, 0, 0}, Vector3d::UnitY()),        point({0, 0, 0}, Vector3d::UnitX())};
}

/// Singular values of the locator matrix of `near_a_line`, worked out by hand: its product with its
/// transpose falls apart into [3 d; d d2], 2 (a/L)2, 2, 2 (b/L)2 and 1, with d = off_line / L.
std::vector<double> singular_values_near_a_line(double a, double b, double off_line, double L) {
  const double d = off_line / L;
  const double root = std::sqrt((3.0 + d * d) * (3.0 + d * d) - 8.0 * d * d);
  const double large = 0.5 * (3.0 + d * d + root);
  std::vector<double> values{std::sqrt(large),
                             std::sqrt(2.0 * d * d / large),  // their product is 2 d2
                             std::sqrt(2.0) * a / L,
                             std::sqrt(2.0),
                             std::sqrt(2.0) * b / L,
                             1.0};
  std::ranges::sort(values, std::greater{});
  return values;
}

using Wrench2 = std::array<std::int64_t, 3>;  // force and moment of a contact in the plane

std::int64_t determinant(const Wrench2& a, const Wrench2& b, const Wrench2& c) {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) +
         a[2] * (b[0] * c[1] - b[1] * c[0]);
}

/// Four contacts close a part in the plane where their wrenches add up to zero with positive
/// factors and span: the factors are the minors, by Cramer's rule, here exact.
bool is_closed_exactly(const std::array<Wrench2, 4>& w) {
  const std::array<std::int64_t, 4> factors{
      determinant(w[1], w[2], w[3]), -determinant(w[0], w[2], w[3]), determinant(w[0], w[1], w[3]),
      -determinant(w[0], w[1], w[2])};
  return std::ranges::all_of(factors, [](std::int64_t f) { return f > 0; }) ||
         std::ranges::all_of(factors, [](std::int64_t f) { return f < 0; });
}

struct Edge2 {
  std::array<std::int64_t, 2> from;
  std::array<std::int64_t, 2> to;
};

/// A convex part on a lattice of holes, corners counter-clockwise, and where contacts may be: at
/// lattice points of its edges, normals inwards.
std::vector<Wrench2> lattice_contacts(const std::vector<Edge2>& edges) {
  std::vector<Wrench2> contacts;
  for (const Edge2& edge : edges) {
    const std::int64_t x = edge.to[0] - edge.from[0];
    const std::int64_t y = edge.to[1] - edge.from[1];
    const std::int64_t steps = std::gcd(std::abs(x), std::abs(y));
    for (std::int64_t i = 1; i < steps; ++i) {
      const std::int64_t px = edge.from[0] + i * x / steps;
      const std::int64_t py = edge.from[1] + i * y / steps;
      // Inwards is to the left: (-y, x); moment about the origin.
      contacts.push_back({-y / steps, x / steps, px * (x / steps) + py * (y / steps)});
    }
  }
  return contacts;
}

}  // namespace

TEST_CASE("supports near to a line have the singular values of theory down to the bound of rank",
          "[degenerate]") {
  const double a = 50.0;
  const double b = 40.0;
  const double L = 80.0;
  for (const double off_line : {40.0, 1.0, 1e-2, 1e-4, 1e-6, 2e-7}) {
    CAPTURE(off_line);
    const auto locating =
        dowel::analyse_locating(near_a_line(a, b, off_line), LocatingFrame{Vector3d::Zero(), L});
    const auto expected = singular_values_near_a_line(a, b, off_line, L);
    CHECK(locating.rank == 6);
    REQUIRE(locating.singular_values.size() == 6);
    // Rounding of the matrix is of its largest entries.
    for (std::size_t i = 0; i < 6; ++i) {
      CHECK(locating.singular_values[i] == Approx(expected[i]).epsilon(kExact).margin(1e-15));
    }
    CHECK(locating.condition ==
          Approx(expected[0] / expected[5]).epsilon(std::max(kExact, 1e-15 / expected[5])));
  }
  // 5e-8 of 80 mm is 4e-10 of the largest: nothing any more.
  for (const double off_line : {5e-8, 0.0}) {
    const auto locating =
        dowel::analyse_locating(near_a_line(a, b, off_line), LocatingFrame{Vector3d::Zero(), L});
    CHECK(locating.rank == 5);
    CHECK(locating.free_motions.cols() == 1);
    CHECK(locating.redundant == std::vector<std::size_t>{2});
  }
}

TEST_CASE("locators near to one plane hold the turn out of it by their distance from it",
          "[degenerate]") {
  // Six stops of a flat part: three of them push along x in a plane, one is `off` above it. Without
  // it the turn about y is free.
  for (const double off : {10.0, 1e-3, 1e-6}) {
    CAPTURE(off);
    const std::vector<LocatingPoint> points{
        point({0, 0, off}, Vector3d::UnitX()), point({0, -30, 0}, Vector3d::UnitX()),
        point({0, 30, 0}, Vector3d::UnitX()),  point({-30, 0, 0}, Vector3d::UnitY()),
        point({0, -30, 0}, Vector3d::UnitZ()), point({0, 30, 0}, Vector3d::UnitZ())};
    const auto locating = dowel::analyse_locating(points, LocatingFrame{Vector3d::Zero(), 50.0});
    CHECK(locating.rank == 6);
    // The pushes along x alone see that turn: [3 d; d d2] as for supports near to a line.
    const double d = off / 50.0;
    const double large =
        0.5 * (3.0 + d * d + std::sqrt((3.0 + d * d) * (3.0 + d * d) - 8.0 * d * d));
    CHECK(locating.singular_values.back() ==
          Approx(std::sqrt(2.0 * d * d / large)).epsilon(1e-9).margin(1e-15));
  }
}

TEST_CASE("form closure of modular parts in the plane is that of exact arithmetic", "[property]") {
  // Parts of the kinds that Brost and Goldberg 1996 fixture: corners and contacts on a lattice. All
  // sets of four contacts.
  const std::vector<std::vector<Edge2>> parts{
      {{{0, 0}, {6, 0}}, {{6, 0}, {6, 4}}, {{6, 4}, {0, 4}}, {{0, 4}, {0, 0}}},
      {{{0, 0}, {8, 0}}, {{8, 0}, {4, 4}}, {{4, 4}, {0, 0}}},
      {{{0, 0}, {6, 0}}, {{6, 0}, {9, 3}}, {{9, 3}, {3, 6}}, {{3, 6}, {0, 3}}, {{0, 3}, {0, 0}}}};
  std::size_t closed = 0;
  std::size_t open = 0;
  for (const auto& part : parts) {
    const std::vector<Wrench2> contacts = lattice_contacts(part);
    const std::size_t n = contacts.size();
    for (std::size_t code = 0; code < n * n * n * n; ++code) {
      const std::array<std::size_t, 4> set{code / (n * n * n), code / (n * n) % n, code / n % n,
                                           code % n};
      if (!(set[0] < set[1] && set[1] < set[2] && set[2] < set[3])) continue;
      std::array<Wrench2, 4> wrenches{};
      Eigen::MatrixXd matrix(3, 4);
      for (std::size_t i = 0; i < 4; ++i) {
        wrenches[i] = contacts[set[i]];
        const double normal =
            std::hypot(static_cast<double>(wrenches[i][0]), static_cast<double>(wrenches[i][1]));
        for (std::size_t row = 0; row < 3; ++row) {
          // Unit normals, moments by a length of 5.
          matrix(static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(i)) =
              static_cast<double>(wrenches[i][row]) / (normal * (row == 2 ? 5.0 : 1.0));
        }
      }
      const bool exact = is_closed_exactly(wrenches);
      (exact ? closed : open) += 1;
      if (dowel::has_form_closure(matrix) != exact) {
        FAIL_CHECK("contacts " << set[0] << ' ' << set[1] << ' ' << set[2] << ' ' << set[3]
                               << " of " << n << " are closed: " << exact);
      }
    }
  }
  CHECK(closed > 50);
  CHECK(open > 50);
}

TEST_CASE("a triangle whose contacts' normals meet in a point is not closed by three") {
  // Reuleaux: the middles of the sides of an equilateral triangle let it turn about its centre; a
  // fourth contact beside a middle and one on the other side of it close it.
  const auto contact = [](double angle_rad, double aside) {
    const Eigen::Vector2d normal(-std::cos(angle_rad), -std::sin(angle_rad));
    const Eigen::Vector2d at =
        -normal + aside * Eigen::Vector2d(-std::sin(angle_rad), std::cos(angle_rad));
    return Vector3d(normal.x(), normal.y(), at.x() * normal.y() - at.y() * normal.x());
  };
  const double third_rad = 2.0 * std::acos(-1.0) / 3.0;
  Eigen::MatrixXd three(3, 3);
  three << contact(0, 0), contact(third_rad, 0), contact(2 * third_rad, 0);
  CHECK_FALSE(dowel::has_form_closure(three));
  Eigen::MatrixXd four(3, 4);
  four << contact(0, 0.5), contact(0, -0.5), contact(third_rad, 0), contact(2 * third_rad, 0);
  CHECK(dowel::has_form_closure(four));
  Eigen::MatrixXd aside(3, 4);
  aside << contact(0, 0.5), contact(0, 0.25), contact(third_rad, 0), contact(2 * third_rad, 0);
  CHECK_FALSE(dowel::has_form_closure(aside));
}
