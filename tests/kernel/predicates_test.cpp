#include "dowel/kernel/predicates.h"

#include <array>
#include <cmath>
#include <cstdint>

#include <catch2/catch.hpp>

#include "random_geometry.h"

namespace {

using namespace dowel;
using dowel::testing::RandomGeometry;

__extension__ using Int128 = __int128;
using IntPoint = std::array<std::int64_t, 3>;

int sign(Int128 value) {
  return value > 0 ? 1 : (value < 0 ? -1 : 0);
}

/// Exact for coordinates below 2^39.
int exact_sign(const IntPoint& a, const IntPoint& b, const IntPoint& c, const IntPoint& d) {
  const auto component = [&](const IntPoint& p, std::size_t k) {
    return static_cast<Int128>(p[k]) - a[k];
  };
  Int128 determinant = 0;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t i = (k + 1) % 3;
    const std::size_t j = (k + 2) % 3;
    determinant +=
        (component(b, i) * component(c, j) - component(b, j) * component(c, i)) * component(d, k);
  }
  return sign(determinant);
}

Eigen::Vector3d scaled(const IntPoint& p, double unit) {
  return unit * Eigen::Vector3d(static_cast<double>(p[0]), static_cast<double>(p[1]),
                                static_cast<double>(p[2]));
}

IntPoint random_int_point(RandomGeometry& random, std::uint32_t range) {
  IntPoint p{};
  for (std::int64_t& x : p) x = static_cast<std::int64_t>(random.index(2 * range + 1)) - range;
  return p;
}

}  // namespace

TEST_CASE("orient3d is +1 on the side from which a, b, c turn counter-clockwise") {
  const Eigen::Vector3d a(0, 0, 0);
  const Eigen::Vector3d b(1, 0, 0);
  const Eigen::Vector3d c(0, 1, 0);
  CHECK(orient3d(a, b, c, {0.2, 0.2, 1e-9}) == 1);
  CHECK(orient3d(a, b, c, {0.2, 0.2, -1e-9}) == -1);
  CHECK(orient3d(a, b, c, {7, -8, 0}) == 0);
  CHECK(orient3d(a, b, b, {7, -8, 3}) == 0);
  CHECK(orient2d({0, 0}, {1, 0}, {0, 1}) == 1);
  CHECK(orient2d({0, 0}, {0, 1}, {1, 0}) == -1);
  CHECK(orient2d({0, 0}, {1, 1}, {-3, -3}) == 0);
}

TEST_CASE("orient3d agrees with integer arithmetic on nearly coplanar points", "[property]") {
  RandomGeometry random(GENERATE(range(1U, 6U)));
  std::array<std::size_t, 3> counts{};
  for (int round = 0; round < 4000; ++round) {
    const IntPoint a = random_int_point(random, 1U << 20U);
    const IntPoint b = random_int_point(random, 1U << 20U);
    const IntPoint c = random_int_point(random, 1U << 20U);
    // A point of the plane, far outside the triangle, moved by at most one unit.
    const auto s = static_cast<std::int64_t>(random.index(1U << 16U)) - (1 << 15);
    const auto t = static_cast<std::int64_t>(random.index(1U << 16U)) - (1 << 15);
    IntPoint d{};
    for (std::size_t k = 0; k < 3; ++k) d[k] = a[k] + s * (b[k] - a[k]) + t * (c[k] - a[k]);
    d[random.index(3)] += static_cast<std::int64_t>(random.index(3)) - 1;
    const int expected = exact_sign(a, b, c, d);
    ++counts[static_cast<std::size_t>(expected + 1)];
    const double unit = std::ldexp(1.0, static_cast<int>(random.index(80)) - 40);
    REQUIRE(orient3d(scaled(a, unit), scaled(b, unit), scaled(c, unit), scaled(d, unit)) ==
            expected);
  }
  for (const std::size_t count : counts) CHECK(count > 800);
}

TEST_CASE("orient3d changes sign with every exchange", "[property]") {
  RandomGeometry random(3);
  for (int round = 0; round < 2000; ++round) {
    // Coordinates whose differences round, and small grids where points coincide.
    std::array<Eigen::Vector3d, 4> p;
    for (Eigen::Vector3d& q : p) {
      q = round % 2 == 0
              ? Eigen::Vector3d(random.index(3), random.index(3), random.index(3))
              : Eigen::Vector3d(random.point(1.0).cwiseProduct(Eigen::Vector3d(1e-17, 1.0, 1e12)));
    }
    const int expected = orient3d(p[0], p[1], p[2], p[3]);
    REQUIRE(orient3d(p[1], p[0], p[2], p[3]) == -expected);
    REQUIRE(orient3d(p[0], p[2], p[1], p[3]) == -expected);
    REQUIRE(orient3d(p[0], p[1], p[3], p[2]) == -expected);
    REQUIRE(orient3d(p[3], p[1], p[2], p[0]) == -expected);
  }
}

TEST_CASE("orient2d agrees with integer arithmetic where doubles cannot tell", "[property]") {
  RandomGeometry random(9);
  std::array<std::size_t, 3> counts{};
  for (int round = 0; round < 20000; ++round) {
    // Coordinates of 53 bits with differences of more: the classical trap.
    const std::int64_t big = std::int64_t{1} << 52U;
    const std::array<std::int64_t, 2> a{random.index(8), random.index(8)};
    const std::array<std::int64_t, 2> b{big + random.index(8), big + random.index(8)};
    const std::array<std::int64_t, 2> c{-2 * static_cast<std::int64_t>(random.index(1000)),
                                        -2 * static_cast<std::int64_t>(random.index(1000))};
    const auto pick = [&](const std::array<std::int64_t, 2>& p) {
      return Eigen::Vector2d(static_cast<double>(p[0]), static_cast<double>(p[1]));
    };
    const std::array<std::int64_t, 2> d =
        round % 2 == 0 ? c : std::array<std::int64_t, 2>{-b[0], -b[1]};
    const int expected = sign(static_cast<Int128>(b[0] - a[0]) * (d[1] - a[1]) -
                              static_cast<Int128>(b[1] - a[1]) * (d[0] - a[0]));
    ++counts[static_cast<std::size_t>(expected + 1)];
    REQUIRE(orient2d(pick(a), pick(b), pick(d)) == expected);
  }
  for (const std::size_t count : counts) CHECK(count > 200);
}

TEST_CASE("predicates hold at the ends of their range", "[degenerate]") {
  for (const double unit : {1e-59, 1e59}) {
    CAPTURE(unit);
    const Eigen::Vector3d a(0, 0, 0);
    const Eigen::Vector3d b(unit, 0, unit);
    const Eigen::Vector3d c(0, unit, unit);
    const Eigen::Vector3d d(unit, unit, 2 * unit);
    CHECK(orient3d(a, b, c, d) == 0);
    Eigen::Vector3d above = d;
    above.z() = std::nextafter(above.z(), 4 * unit);
    CHECK(orient3d(a, b, c, above) == 1);
    CHECK(orient3d(a, c, b, above) == -1);
  }
}
