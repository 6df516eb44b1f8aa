#include "dowel/kernel/pose.h"

#include <cmath>

#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// A quaternion whose square misses 1 by no more is kept to the bit: a pose survives being written
/// and read, and a chain of products does not drift. Dividing by a length of 1 - 1e-16 moves the
/// components in [1/2, 1) by a whole ulp and the others by none: it turns, the same way each time.
/// Some tens of ulp stay below 4e-10 mm at kMaxCoordinate_mm, and dividing is rare.
constexpr double kRoundedOff = 4.0e-15;

}  // namespace

Pose::Pose(const Eigen::Quaterniond& rotation, const Eigen::Vector3d& translation)
    : rotation_(rotation), translation_(translation) {
  DOWEL_EXPECTS(rotation.coeffs().allFinite() && translation.allFinite());
  DOWEL_EXPECTS(std::abs(rotation.norm() - 1.0) <= kUnitQuaternionSlack);
  if (std::abs(rotation.squaredNorm() - 1.0) > kRoundedOff) rotation_.normalize();
}

Pose Pose::from_translation(const Eigen::Vector3d& translation) {
  return {Eigen::Quaterniond::Identity(), translation};
}

Pose Pose::from_matrix(const Eigen::Matrix3d& rotation, const Eigen::Vector3d& translation) {
  const Eigen::Matrix3d residual = rotation * rotation.transpose() - Eigen::Matrix3d::Identity();
  DOWEL_EXPECTS(residual.cwiseAbs().maxCoeff() <= kUnitQuaternionSlack);
  DOWEL_EXPECTS(rotation.determinant() > 0.0);
  return {Eigen::Quaterniond(rotation).normalized(), translation};
}

Pose Pose::about_axis(const Eigen::Vector3d& point, const Eigen::Vector3d& axis, double angle_rad) {
  const Eigen::Quaterniond rotation(Eigen::AngleAxisd(angle_rad, axis));
  return {rotation, point - rotation * point};
}

Pose Pose::inverse() const {
  Pose result;
  result.rotation_ = rotation_.conjugate();
  result.translation_ = -(result.rotation_ * translation_);
  return result;
}

Pose Pose::canonical() const {
  Pose result = *this;
  if (rotation_.w() < 0.0) result.rotation_.coeffs() = -rotation_.coeffs();
  return result;
}

Pose Pose::operator*(const Pose& other) const {
  Pose result;
  result.rotation_ = rotation_ * other.rotation_;
  result.translation_ = *this * other.translation_;
  if (std::abs(result.rotation_.squaredNorm() - 1.0) > kRoundedOff) result.rotation_.normalize();
  return result;
}

Pose interpolate(const Pose& from, const Pose& to, double s) {
  return {from.rotation().slerp(s, to.rotation()).normalized(),
          from.translation() + s * (to.translation() - from.translation())};
}

}  // namespace dowel
