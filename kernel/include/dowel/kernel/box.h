#pragma once

#include <array>
#include <limits>
#include <span>

#include <Eigen/Core>

#include "dowel/kernel/pose.h"

namespace dowel {

/// Axis-aligned bounding box, closed on all sides: boxes that touch overlap. Default: empty.
struct Aabb {
  Eigen::Vector3d min = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d max = Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity());

  bool is_empty() const noexcept { return !(min.array() <= max.array()).all(); }
  bool overlaps(const Aabb& other) const noexcept {
    return (min.array() <= other.max.array()).all() && (other.min.array() <= max.array()).all();
  }
  bool contains(const Aabb& other) const noexcept {
    return (min.array() <= other.min.array()).all() && (other.max.array() <= max.array()).all();
  }
  Eigen::Vector3d center() const { return 0.5 * (min + max); }
  Eigen::Vector3d size() const { return max - min; }
  void extend(const Eigen::Vector3d& point) {
    min = min.cwiseMin(point);
    max = max.cwiseMax(point);
  }
  void extend(const Aabb& other) {
    min = min.cwiseMin(other.min);
    max = max.cwiseMax(other.max);
  }
  /// Grown by `margin_mm` on every side.
  Aabb padded(double margin_mm) const { return {min.array() - margin_mm, max.array() + margin_mm}; }
};

/// Oriented bounding box: `center`, right-handed orthonormal `axes` (one per column) and half the
/// edge lengths along them, all in the frame of the points it bounds.
struct Obb {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  Eigen::Vector3d half_extents_mm = Eigen::Vector3d::Zero();

  double volume_mm3() const { return 8.0 * half_extents_mm.prod(); }
  /// Grown by `margin_mm` on every side.
  Obb padded(double margin_mm) const { return {center, axes, half_extents_mm.array() + margin_mm}; }
  /// Signed distance from the box: the largest of the six face distances, negative inside.
  double face_distance_mm(const Eigen::Vector3d& point) const {
    return ((axes.transpose() * (point - center)).cwiseAbs() - half_extents_mm).maxCoeff();
  }
  std::array<Eigen::Vector3d, 8> corners() const;
};

/// The same box seen from frame W.
Obb transformed(const Pose& X_WB, const Obb& box_B);

/// Smallest axis-aligned box around `box`.
Aabb bounds(const Obb& box);

/// Smallest axis-aligned box around `points`; empty where there is none.
Aabb bounds(std::span<const Eigen::Vector3d> points);

}  // namespace dowel
