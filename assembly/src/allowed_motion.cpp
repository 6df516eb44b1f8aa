#include "allowed_motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// A turn is swept in legs of at most this angle, each well under the half turn at which the
/// shortest rotation changes its sense.
constexpr double kLargestLeg_rad = std::numbers::pi / 2.0;

}  // namespace

Vector3d allowed_slide(const std::vector<Freedom>& freedoms, const Vector3d& by_mm_W) {
  Vector3d allowed = Vector3d::Zero();
  for (const Freedom& freedom : freedoms) {
    if (freedom.kind != Freedom::Kind::Slide) continue;
    allowed += freedom.axis_W.dot(by_mm_W) * freedom.axis_W;
  }
  // Of a part that is free every way, to the bit.
  return (allowed - by_mm_W).norm() <= kRounding * by_mm_W.norm() ? by_mm_W : allowed;
}

std::optional<ScrewMotion> allowed_turn(const std::vector<Freedom>& freedoms,
                                        const Vector3d& axis_W, const Vector3d& point_W) {
  Vector3d turn = Vector3d::Zero();
  Vector3d velocity = Vector3d::Zero();  // of the body's point at `point_W`, for a radian
  for (const Freedom& freedom : freedoms) {
    if (freedom.kind != Freedom::Kind::Turn) continue;
    const double share = freedom.axis_W.dot(axis_W);
    turn += share * freedom.axis_W;
    velocity += share * (freedom.axis_W.cross(point_W - freedom.point_W) +
                         freedom.slide_mm_per_rad * freedom.axis_W);
  }
  if ((turn - axis_W).norm() > kParallel_rad) return std::nullopt;
  // What the part may slide it need not: that brings the axis nearer.
  velocity -= allowed_slide(freedoms, velocity);
  const double along = axis_W.dot(velocity);
  ScrewMotion screw{point_W + axis_W.cross(velocity), axis_W, along};
  if (std::abs(along) <= kRounding * kMateArm_mm) screw.slide_mm_per_rad = 0.0;
  return screw;
}

std::vector<Pose> screw_path(const ScrewMotion& screw, double angle_rad, const Vector3d& center_W) {
  const int legs = std::max(1, static_cast<int>(std::ceil(std::abs(angle_rad) / kLargestLeg_rad)));
  // A frame on the axis turns and slides along it, so that its straight path makes the part's path
  // the arc or helix. The nearer it is to the part, the better the bound that a sweep has for the
  // way of its points.
  const Vector3d pivot_W =
      screw.point_W + screw.axis_W.dot(center_W - screw.point_W) * screw.axis_W;
  std::vector<Pose> X_WU;
  for (int leg = 0; leg <= legs; ++leg) {
    const double turn_rad = angle_rad * leg / legs;
    X_WU.emplace_back(Eigen::Quaterniond(Eigen::AngleAxisd(turn_rad, screw.axis_W)),
                      pivot_W + turn_rad * screw.slide_mm_per_rad * screw.axis_W);
  }
  return X_WU;
}

}  // namespace dowel
