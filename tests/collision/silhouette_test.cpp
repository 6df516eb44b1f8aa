#include "dowel/collision/silhouette.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <catch2/catch.hpp>

#include "random_geometry.h"

using dowel::Obb;
using dowel::Silhouette;

namespace {

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The hull of the eight corners seen along z, counter-clockwise (Andrew's monotone chain).
std::vector<Eigen::Vector2d> outline(const Obb& box) {
  std::vector<Eigen::Vector2d> points;
  for (const Eigen::Vector3d& corner : box.corners()) points.emplace_back(corner.head<2>());
  std::ranges::sort(points, [](const auto& p, const auto& q) {
    return p.x() != q.x() ? p.x() < q.x() : p.y() < q.y();
  });
  std::vector<Eigen::Vector2d> hull;
  for (int pass = 0; pass < 2; ++pass) {
    const std::size_t begin = hull.size();
    for (const Eigen::Vector2d& p : points) {
      while (hull.size() >= begin + 2 &&
             cross(hull.back() - hull[hull.size() - 2], p - hull.back()) <= 1e-12) {
        hull.pop_back();
      }
      hull.push_back(p);
    }
    hull.pop_back();
    std::ranges::reverse(points);
  }
  return hull;
}

/// The widest strip between two convex outlines along a side of either; negative: they overlap.
double strip_between(const std::vector<Eigen::Vector2d>& a, const std::vector<Eigen::Vector2d>& b) {
  double widest = -std::numeric_limits<double>::infinity();
  for (const auto& [own, other] : {std::pair(&a, &b), std::pair(&b, &a)}) {
    for (std::size_t i = 0; i < own->size(); ++i) {
      const Eigen::Vector2d side = (*own)[(i + 1) % own->size()] - (*own)[i];
      const Eigen::Vector2d outward = Eigen::Vector2d(side.y(), -side.x()).normalized();
      double least = std::numeric_limits<double>::infinity();
      for (const Eigen::Vector2d& p : *other) least = std::min(least, outward.dot(p - (*own)[i]));
      widest = std::max(widest, least);
    }
  }
  return widest;
}

Obb random_box(dowel::testing::RandomGeometry& random) {
  Eigen::Quaterniond turn = random.rotation();
  const std::uint32_t kind = random.index(4);
  if (kind == 0) turn = Eigen::Quaterniond::Identity();
  if (kind == 1) turn = Eigen::AngleAxisd(random.uniform(0.0, 6.0), Eigen::Vector3d::UnitZ());
  return {random.point(40.0),
          turn.toRotationMatrix(),
          {random.uniform(0.1, 30.0), random.uniform(0.1, 30.0), random.uniform(0.1, 30.0)}};
}

}  // namespace

TEST_CASE("silhouettes are apart where the hulls of the corners are", "[property]") {
  dowel::testing::RandomGeometry random(1);
  int apart = 0;
  int only_silhouettes = 0;
  for (int i = 0; i < 100'000; ++i) {
    const Obb a = random_box(random);
    const Obb b = random_box(random);
    const double margin_mm = random.coin() ? 0.0 : random.uniform(0.0, 10.0);
    const double strip_mm = strip_between(outline(a), outline(b));
    if (std::abs(strip_mm - margin_mm) < 1e-9) continue;
    const bool told = are_apart(silhouette(a), silhouette(b), margin_mm);
    REQUIRE(told == (strip_mm > margin_mm));
    if (!told) continue;
    ++apart;
    const dowel::Aabb around_a = bounds(a).padded(margin_mm);
    const bool intervals_overlap =
        (around_a.min.head<2>().array() <= bounds(b).max.head<2>().array()).all() &&
        (bounds(b).min.head<2>().array() <= around_a.max.head<2>().array()).all();
    if (intervals_overlap) ++only_silhouettes;
  }
  CHECK(apart > 10'000);
  CHECK(apart < 90'000);
  CHECK(only_silhouettes > 3'000);  // the paper's situation (c)
}

TEST_CASE("a silhouette has a rectangle's or a hexagon's sides") {
  const Obb upright{{1, 2, 3}, Eigen::Matrix3d::Identity(), {4, 5, 6}};
  CHECK(outline(upright).size() == 4);
  const Obb on_a_corner{
      {0, 0, 0},
      Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::Ones(), Eigen::Vector3d::UnitZ())
          .toRotationMatrix(),
      {1, 1, 1}};
  const auto hexagon = outline(on_a_corner);
  CHECK(hexagon.size() == 6);
  const Silhouette seen = silhouette(on_a_corner);
  for (const Eigen::Vector2d& corner : hexagon) {  // corners are sums of whole arms
    double nearest = std::numeric_limits<double>::infinity();
    for (int signs = 0; signs < 8; ++signs) {
      Eigen::Vector2d p = seen.center;
      for (std::size_t i = 0; i < 3; ++i) p += ((signs >> i) & 1 ? 1.0 : -1.0) * seen.arms[i];
      nearest = std::min(nearest, (p - corner).norm());
    }
    CHECK(nearest < 1e-12);
  }
}
