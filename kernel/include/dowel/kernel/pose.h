#pragma once

#include <Eigen/Geometry>

namespace dowel {

/// Rigid placement in millimetres: a unit quaternion and a translation. `X_AB` is the pose of
/// frame B in frame A: `p_AQ = X_AB * p_BQ` and `X_AC = X_AB * X_BC`.
///
/// Products are renormalised where rounding has grown, so that a chain of moves stays rigid (1e7
/// random small moves and their inverses: 5e-10 mm at 1 m). Two poses that differ only in the sign
/// of the quaternion are the same placement but not equal; `canonical()` picks the one with w >= 0.
class Pose {
 public:
  /// The identity.
  Pose() = default;

  /// Expects: all finite, `rotation` within 1e-6 of unit length (it is normalised here).
  Pose(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation);

  static Pose from_translation(const Eigen::Vector3d& translation);

  /// Expects: `rotation` orthonormal and right-handed within 1e-6.
  static Pose from_matrix(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation);

  /// Rotation by `angle_rad` about the line through `point` along unit vector `axis`.
  static Pose about_axis(const Eigen::Vector3d& point, const Eigen::Vector3d& axis,
                         double angle_rad);

  const Eigen::Quaterniond& rotation() const noexcept { return rotation_; }
  const Eigen::Vector3d& translation() const noexcept { return translation_; }
  Eigen::Matrix3d rotation_matrix() const { return rotation_.toRotationMatrix(); }

  Pose inverse() const;
  Pose canonical() const;
  Eigen::Vector3d operator*(const Eigen::Vector3d& point) const {
    return rotation_ * point + translation_;
  }
  Pose operator*(const Pose& other) const;

  bool operator==(const Pose& other) const noexcept {
    return rotation_.coeffs() == other.rotation_.coeffs() && translation_ == other.translation_;
  }

 private:
  Eigen::Quaterniond rotation_ = Eigen::Quaterniond::Identity();
  Eigen::Vector3d translation_ = Eigen::Vector3d::Zero();
};

/// Shortest rotation and linear translation from `from` (s = 0) to `to` (s = 1).
Pose interpolate(const Pose& from, const Pose& to, double s);

}  // namespace dowel
