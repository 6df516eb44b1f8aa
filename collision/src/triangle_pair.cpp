#include "triangle_pair.h"

#include <algorithm>
#include <limits>

#include "dowel/kernel/tolerance.h"
#include "exact_face.h"

namespace dowel {
namespace {

/// What rounding may put between the ends of a crossing and the two triangles: more than that of
/// coordinates, less than any tolerance.
constexpr double kSamePlace_mm = 1.0e-7;
static_assert(kSamePlace_mm * 10 <= kMinTolerance_mm);

/// Nearest points of segments p0-p1 and q0-q1.
/// Source: Ericson, "Real-Time Collision Detection", 2005, section 5.1.9.
ClosestPair closest_on_segments(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                const Eigen::Vector3d& q0, const Eigen::Vector3d& q1) {
  const Eigen::Vector3d u = p1 - p0;
  const Eigen::Vector3d v = q1 - q0;
  const Eigen::Vector3d w = p0 - q0;
  const double uu = u.squaredNorm();
  const double vv = v.squaredNorm();
  const double uv = u.dot(v);
  const double uw = u.dot(w);
  const double vw = v.dot(w);
  const double determinant = uu * vv - uv * uv;
  double s = determinant > 0.0 ? std::clamp((uv * vw - uw * vv) / determinant, 0.0, 1.0) : 0.0;
  double t = vv > 0.0 ? (uv * s + vw) / vv : 0.0;
  if (t < 0.0 || t > 1.0) {
    t = std::clamp(t, 0.0, 1.0);
    s = uu > 0.0 ? std::clamp((uv * t - uw) / uu, 0.0, 1.0) : 0.0;
  }
  const Eigen::Vector3d a = p0 + s * u;
  const Eigen::Vector3d b = q0 + t * v;
  return {a, b, (a - b).squaredNorm()};
}

/// Part of the line of intersection that lies in a triangle, from its corners' signed distances
/// from the other plane: the two points where its outline crosses that plane.
std::optional<Segment> section(const Corners& corners, const std::array<double, 3>& distances) {
  std::array<Eigen::Vector3d, 3> points;
  std::size_t count = 0;
  for (std::size_t i = 0; i < 3 && count < 2; ++i) {
    const std::size_t j = (i + 1) % 3;
    if ((distances[i] < 0.0) != (distances[j] < 0.0)) {
      const double s = distances[i] / (distances[i] - distances[j]);
      points[count++] = corners[i] + s * (corners[j] - corners[i]);
    }
  }
  if (count < 2) return std::nullopt;
  return Segment{points[0], points[1]};
}

}  // namespace

std::optional<Segment> crossing_segment(const Corners& a, const Eigen::Vector3d& normal_a,
                                        const Corners& b, const Eigen::Vector3d& normal_b) {
  std::array<double, 3> da{};
  std::array<double, 3> db{};
  for (std::size_t i = 0; i < 3; ++i) {
    da[i] = normal_b.dot(a[i] - b[0]);
    db[i] = normal_a.dot(b[i] - a[0]);
  }
  const auto section_a = section(a, da);
  if (!section_a) return std::nullopt;
  const auto section_b = section(b, db);
  if (!section_b) return std::nullopt;
  // Both lie on the line of intersection: compare them along it.
  Eigen::Vector3d along = section_a->end - section_a->start;
  const Eigen::Vector3d along_b = section_b->end - section_b->start;
  if (along_b.squaredNorm() > along.squaredNorm()) along = along_b;
  std::array<double, 4> at{along.dot(section_a->start), along.dot(section_a->end),
                           along.dot(section_b->start), along.dot(section_b->end)};
  const auto [a_low, a_high] = std::minmax(at[0], at[1]);
  const auto [b_low, b_high] = std::minmax(at[2], at[3]);
  const double low = std::max(a_low, b_low);
  const double high = std::min(a_high, b_high);
  if (!(low <= high)) return std::nullopt;
  const std::array<Eigen::Vector3d, 4> ends{section_a->start, section_a->end, section_b->start,
                                            section_b->end};
  const auto end_at = [&](double value) {
    return static_cast<std::size_t>(std::ranges::find(at, value) - at.begin());
  };
  // Where the planes are one but for rounding, or either section is a point, the sections lie on no
  // common line: an end of one is then anywhere beside the other triangle.
  const auto is_on_both = [&](std::size_t end) {
    const Eigen::Vector3d on_other = closest_on_triangle(end < 2 ? b : a, ends[end]).point;
    return (on_other - ends[end]).squaredNorm() <= kSamePlace_mm * kSamePlace_mm;
  };
  const std::size_t first = end_at(low);
  const std::size_t last = end_at(high);
  if (!is_on_both(first) || !is_on_both(last)) return std::nullopt;
  return Segment{ends[first], ends[last]};
}

ClosestPair closest_points(const Corners& a, const Eigen::Vector3d& normal_a, const Corners& b,
                           const Eigen::Vector3d& normal_b) {
  if (const auto crossing = crossing_segment(a, normal_a, b, normal_b)) {
    const Eigen::Vector3d middle = 0.5 * (crossing->start + crossing->end);
    return {middle, middle, 0.0};
  }
  ClosestPair best{a[0], b[0], std::numeric_limits<double>::infinity()};
  const auto keep = [&best](const ClosestPair& pair) {
    if (pair.distance_squared_mm2 < best.distance_squared_mm2) best = pair;
  };
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      keep(closest_on_segments(a[i], a[(i + 1) % 3], b[j], b[(j + 1) % 3]));
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d on_b = closest_on_triangle(b, a[i]).point;
    keep({a[i], on_b, (a[i] - on_b).squaredNorm()});
    const Eigen::Vector3d on_a = closest_on_triangle(a, b[i]).point;
    keep({on_a, b[i], (b[i] - on_a).squaredNorm()});
  }
  return best;
}

}  // namespace dowel
