#include "dowel/collision/box_separation.h"

#include <limits>

namespace dowel {
namespace {

/// Edges closer to parallel than this (squared sine) give no plane of their own.
constexpr double kParallelEdges = 1e-10;

constexpr int kPlanes = 15;

/// The two boxes as one sees the other: everything that the 15 planes need.
struct RelativeBoxes {
  Eigen::Matrix3d dot;       // axes of a against axes of b
  Eigen::Matrix3d abs_dot;   // its magnitudes
  Eigen::Vector3d offset_a;  // centre of b from centre of a, along the axes of a
  Eigen::Vector3d offset_b;  // the same along the axes of b
  Eigen::Vector3d half_a;
  Eigen::Vector3d half_b;

  RelativeBoxes(const Obb& a, const Obb& b)
      : dot(a.axes.transpose() * b.axes),
        abs_dot(dot.cwiseAbs()),
        offset_a(a.axes.transpose() * (b.center - a.center)),
        offset_b(b.axes.transpose() * (b.center - a.center)),
        half_a(a.half_extents_mm),
        half_b(b.half_extents_mm) {}

  double gap_of_face_of_a(int i) const {
    return std::abs(offset_a[i]) - half_a[i] - abs_dot.row(i).dot(half_b);
  }
  double gap_of_face_of_b(int j) const {
    return std::abs(offset_b[j]) - half_b[j] - abs_dot.col(j).dot(half_a);
  }
  /// Along the cross product of edge i of a and edge j of b, made a unit vector.
  double gap_of_edges(int i, int j) const {
    const double sine_squared = 1.0 - dot(i, j) * dot(i, j);
    if (!(sine_squared > kParallelEdges)) return -std::numeric_limits<double>::infinity();
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    const int j1 = (j + 1) % 3;
    const int j2 = (j + 2) % 3;
    const double distance = std::abs(offset_a[i2] * dot(i1, j) - offset_a[i1] * dot(i2, j));
    const double reach_a = half_a[i1] * abs_dot(i2, j) + half_a[i2] * abs_dot(i1, j);
    const double reach_b = half_b[j1] * abs_dot(i, j2) + half_b[j2] * abs_dot(i, j1);
    return (distance - reach_a - reach_b) / std::sqrt(sine_squared);
  }
  double gap(int plane) const {
    if (plane < 3) return gap_of_face_of_a(plane);
    if (plane < 6) return gap_of_face_of_b(plane - 3);
    return gap_of_edges((plane - 6) / 3, (plane - 6) % 3);
  }
};

}  // namespace

double gap_along_edges(const Obb& a, const Obb& b, int plane) {
  return RelativeBoxes(a, b).gap(plane);
}

BoxSeparation separate(const Obb& a, const Obb& b, double margin_mm, int hint) {
  if (hint >= 0) {
    const double gap = gap_along(a, b, hint);
    if (gap > margin_mm) return {hint, gap};
  }
  const RelativeBoxes boxes(a, b);
  for (int plane = 0; plane < kPlanes; ++plane) {
    const double gap = boxes.gap(plane);
    if (gap > margin_mm) return {plane, gap};
  }
  return {};
}

BoxSeparation separate_brute_force(const Obb& a, const Obb& b, double margin_mm) {
  const auto corners_a = a.corners();
  const auto corners_b = b.corners();
  BoxSeparation best{-1, -std::numeric_limits<double>::infinity()};
  for (int plane = 0; plane < kPlanes; ++plane) {
    Eigen::Vector3d normal =
        plane < 3 ? Eigen::Vector3d(a.axes.col(plane))
        : plane < 6
            ? Eigen::Vector3d(b.axes.col(plane - 3))
            : Eigen::Vector3d(a.axes.col((plane - 6) / 3).cross(b.axes.col((plane - 6) % 3)));
    if (!(normal.squaredNorm() > kParallelEdges)) continue;
    normal.normalize();
    double min_a = std::numeric_limits<double>::infinity();
    double max_a = -min_a;
    double min_b = min_a;
    double max_b = -min_a;
    for (std::size_t i = 0; i < 8; ++i) {
      min_a = std::min(min_a, normal.dot(corners_a[i]));
      max_a = std::max(max_a, normal.dot(corners_a[i]));
      min_b = std::min(min_b, normal.dot(corners_b[i]));
      max_b = std::max(max_b, normal.dot(corners_b[i]));
    }
    const double gap = std::max(min_b - max_a, min_a - max_b);
    if (gap > best.gap_mm) best = {plane, gap};
  }
  return best.gap_mm > margin_mm ? best : BoxSeparation{};
}

}  // namespace dowel
