#include "dowel/assembly/joint.h"

#include <cmath>

#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

using Eigen::Matrix3d;
using Eigen::Quaterniond;
using Eigen::Vector3d;

/// Below this angle (and this near to pi) quotients of sines give way to their series: its square
/// is the rounding of a double.
constexpr double kSmallAngle_rad = 1.0e-4;

/// Shortest rotation that takes unit vector `from` to unit vector `to`, which are not opposite.
Quaterniond shortest_arc(const Vector3d& from, const Vector3d& to) {
  Quaterniond arc;
  arc.w() = 1.0 + from.dot(to);
  arc.vec() = from.cross(to);
  return arc.normalized();
}

/// A half turn about that axis of `R_WA` which is most nearly square to unit vector `v_W` (made
/// square): of all half turns that reverse `v_W`, one that a person would pick.
Quaterniond half_turn(const Vector3d& v_W, const Quaterniond& R_WA) {
  const Matrix3d axes_W = R_WA.toRotationMatrix();
  Eigen::Index squarest = 0;
  (axes_W.transpose() * v_W).cwiseAbs().minCoeff(&squarest);
  Vector3d axis = axes_W.col(squarest);
  axis = (axis - axis.dot(v_W) * v_W).normalized();
  return {0.0, axis.x(), axis.y(), axis.z()};
}

Vector3d rotation_vector(const Quaterniond& rotation) {
  Quaterniond q = rotation;
  if (q.w() < 0.0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  const double angle_rad = 2.0 * std::atan2(sine, q.w());
  return (sine < kSmallAngle_rad ? 2.0 : angle_rad / sine) * q.vec();
}

Matrix3d cross_matrix(const Vector3d& v) {
  Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

/// Derivative of `rotation_vector(exp(w) R)` by w at w = 0: the inverse of the left Jacobian.
Matrix3d rotation_vector_derivative(const Vector3d& vector) {
  const double angle_rad = vector.norm();
  const Matrix3d cross = cross_matrix(vector);
  double quadratic = 1.0 / 12.0;
  if (angle_rad > kSmallAngle_rad) {
    const double half = 0.5 * angle_rad;
    quadratic = (1.0 - half * std::cos(half) / std::sin(half)) / (angle_rad * angle_rad);
  }
  return Matrix3d::Identity() - 0.5 * cross + quadratic * cross * cross;
}

/// The shortest turn, as a rotation vector, that takes z to unit vector `d`, with its derivative by
/// the turn of d. It has no z.
struct Tilt {
  Vector3d turn_rad;
  Matrix3d derivative;
};

Tilt tilt_of(const Vector3d& d) {
  const double sine = d.head<2>().norm();
  const double angle_rad = std::atan2(sine, d.z());
  double per_sine = 1.0;      // angle / sine
  double growth = 1.0 / 3.0;  // its derivative by the angle, by the sine once more
  const Vector3d across(-d.y(), d.x(), 0.0);
  if (d.z() < 0.0 && sine < kSmallAngle_rad) {
    // Just against z any axis will do, and the derivative is that of a turn about it.
    const Vector3d axis = sine > 0.0 ? Vector3d(across / sine) : Vector3d(Vector3d::UnitX());
    return {angle_rad * axis, Vector3d(1.0, 1.0, 0.0).asDiagonal()};
  }
  if (angle_rad > kSmallAngle_rad) {
    per_sine = angle_rad / sine;
    growth = (sine - angle_rad * d.z()) / (sine * sine * sine);
  }
  // d moves by w x d.
  const Matrix3d motion = -cross_matrix(d);
  Tilt tilt{per_sine * across, Matrix3d::Zero()};
  tilt.derivative.row(0) = -per_sine * motion.row(1) + growth * d.y() * motion.row(2);
  tilt.derivative.row(1) = per_sine * motion.row(0) - growth * d.x() * motion.row(2);
  return tilt;
}

/// F in G.
struct Relative {
  Matrix3d R_WG;
  Quaterniond R_GF;
  Vector3d p_W_F;
  Vector3d p_GF;
};

Relative relative_pose(const Joint& joint, const Pose& X_WA, const Pose& X_WB) {
  const Quaterniond R_WG = X_WB.rotation() * joint.X_BG.rotation();
  const Vector3d p_W_F = X_WA * joint.X_AF.translation();
  const Vector3d p_W_G = X_WB * joint.X_BG.translation();
  return {R_WG.toRotationMatrix(),
          (R_WG.conjugate() * (X_WA.rotation() * joint.X_AF.rotation())).normalized(), p_W_F,
          R_WG.conjugate() * (p_W_F - p_W_G)};
}

/// Angle between z and unit vector `d`, less `wanted_rad`.
double angle_off(const Vector3d& d, double wanted_rad) {
  return std::atan2(d.head<2>().norm(), d.z()) - wanted_rad;
}

}  // namespace

int Joint::equations() const {
  return (holds_tilt ? 2 : 0) + (holds_spin ? 1 : 0) + (angle_rad ? 1 : 0) +
         static_cast<int>(holds_slide[0]) + static_cast<int>(holds_slide[1]) +
         static_cast<int>(holds_slide[2]);
}

JointOff joint_off(const Joint& joint, const Pose& X_WA, const Pose& X_WB) {
  const Relative at = relative_pose(joint, X_WA, X_WB);
  const Vector3d z_G_F = at.R_GF * Vector3d::UnitZ();
  JointOff off;
  if (joint.holds_spin) {
    off.turn_rad = rotation_vector(at.R_GF);
  } else if (joint.holds_tilt) {
    off.turn_rad = tilt_of(z_G_F).turn_rad;
  } else if (joint.angle_rad) {
    off.turn_rad.x() = angle_off(z_G_F, *joint.angle_rad);
  }
  for (int i = 0; i < 3; ++i) {
    if (joint.holds_slide[static_cast<std::size_t>(i)]) off.slide_mm[i] = at.p_GF[i];
  }
  return off;
}

JointEquations joint_equations(const Joint& joint, const Pose& X_WA, const Pose& X_WB,
                               const Vector3d& c_W_A, const Vector3d& c_W_B) {
  DOWEL_EXPECTS(!joint.holds_spin || joint.holds_tilt);
  DOWEL_EXPECTS(!(joint.angle_rad && joint.holds_tilt));
  const Relative at = relative_pose(joint, X_WA, X_WB);
  const Vector3d z_G_F = at.R_GF * Vector3d::UnitZ();
  JointEquations result;
  const int count = joint.equations();
  result.value = JointVector::Zero(count);
  result.motion_A = JointRows::Zero(count, 6);
  result.motion_B = JointRows::Zero(count, 6);
  int row = 0;
  // `value` in rad, `by_turn` its derivative by the turn of A against B, in G.
  const auto add_turn = [&](double value_rad, const Eigen::RowVector3d& by_turn) {
    const Eigen::RowVector3d by_turn_W = by_turn * at.R_WG.transpose();
    result.value[row] = kMateArm_mm * value_rad;
    result.motion_A.row(row).head<3>() = by_turn_W;
    result.motion_B.row(row).head<3>() = -by_turn_W;
    ++row;
  };
  if (joint.holds_spin) {
    const Vector3d turn_rad = rotation_vector(at.R_GF);
    const Matrix3d derivative = rotation_vector_derivative(turn_rad);
    for (int i = 0; i < 3; ++i) add_turn(turn_rad[i], derivative.row(i));
  } else if (joint.holds_tilt) {
    const Tilt tilt = tilt_of(z_G_F);
    for (int i = 0; i < 2; ++i) add_turn(tilt.turn_rad[i], tilt.derivative.row(i));
  } else if (joint.angle_rad) {
    // Along z any axis opens the angle.
    const double sine = z_G_F.head<2>().norm();
    const Vector3d opening = sine < kRounding ? Vector3d(Vector3d::UnitX())
                                              : Vector3d(-z_G_F.y() / sine, z_G_F.x() / sine, 0.0);
    add_turn(angle_off(z_G_F, *joint.angle_rad), opening.transpose());
  }
  for (int i = 0; i < 3; ++i) {
    if (!joint.holds_slide[static_cast<std::size_t>(i)]) continue;
    const Vector3d axis_W = at.R_WG.col(i);
    result.value[row] = at.p_GF[i];
    // Where F moves by v + w x (p - c), and what B turns takes G along.
    result.motion_A.row(row) << (at.p_W_F - c_W_A).cross(axis_W).transpose() / kMateArm_mm,
        axis_W.transpose();
    result.motion_B.row(row) << -(at.p_W_F - c_W_B).cross(axis_W).transpose() / kMateArm_mm,
        -axis_W.transpose();
    ++row;
  }
  return result;
}

Quaterniond nearest_rotation(const Quaterniond& R_WA, const Vector3d& d_A, const Vector3d& d_W) {
  Quaterniond rotation = R_WA;
  const Vector3d present = (rotation * d_A).normalized();
  const bool opposite = present.dot(d_W) < 0.0 && present.cross(d_W).norm() < kParallel_rad;
  if (opposite) rotation = half_turn(present, R_WA) * rotation;
  // Twice: what the first leaves near the opposite direction, the second takes away.
  for (int pass = 0; pass < 2; ++pass) {
    rotation = (shortest_arc((rotation * d_A).normalized(), d_W) * rotation).normalized();
  }
  return rotation;
}

namespace {

/// R_WA turned as little as can be so that the turns that `joint` holds are as R_WG asks.
Quaterniond placed_rotation(const Joint& joint, const Quaterniond& R_WA, const Quaterniond& R_WG) {
  const Quaterniond& R_AF = joint.X_AF.rotation();
  if (joint.holds_spin) return (R_WG * R_AF.conjugate()).normalized();
  const Vector3d z_A = R_AF * Vector3d::UnitZ();
  const Vector3d z_W_G = (R_WG * Vector3d::UnitZ()).normalized();
  if (joint.holds_tilt) return nearest_rotation(R_WA, z_A, z_W_G);
  if (!joint.angle_rad) return R_WA;
  const Vector3d z_W_F = (R_WA * z_A).normalized();
  Vector3d axis_W = z_W_G.cross(z_W_F);
  if (axis_W.norm() < kRounding) axis_W = z_W_G.unitOrthogonal();
  axis_W.normalize();
  const Quaterniond opened(Eigen::AngleAxisd(*joint.angle_rad, axis_W));
  return nearest_rotation(R_WA, z_A, opened * z_W_G);
}

}  // namespace

Pose place_by_joint(const Joint& joint, const Pose& X_WA, const Pose& X_WB) {
  const Quaterniond R_WG = (X_WB.rotation() * joint.X_BG.rotation()).normalized();
  const Quaterniond R_WA = placed_rotation(joint, X_WA.rotation(), R_WG);
  Vector3d off_G = R_WG.conjugate() * (R_WA * joint.X_AF.translation() + X_WA.translation() -
                                       X_WB * joint.X_BG.translation());
  for (int i = 0; i < 3; ++i) {
    if (!joint.holds_slide[static_cast<std::size_t>(i)]) off_G[i] = 0.0;
  }
  return {R_WA, X_WA.translation() - R_WG * off_G};
}

Pose place_other_by_joint(const Joint& joint, const Pose& X_WA, const Pose& X_WB) {
  const Quaterniond R_WF = (X_WA.rotation() * joint.X_AF.rotation()).normalized();
  Joint turned;
  turned.X_AF = joint.X_BG;
  turned.X_BG = joint.X_AF;
  turned.holds_tilt = joint.holds_tilt;
  turned.holds_spin = joint.holds_spin;
  turned.angle_rad = joint.angle_rad;
  const Quaterniond R_WB = placed_rotation(turned, X_WB.rotation(), R_WF);
  // What is held along G's axes is held along them, wherever G has come to.
  const Quaterniond R_WG = (R_WB * joint.X_BG.rotation()).normalized();
  Vector3d off_G = R_WG.conjugate() * (X_WA * joint.X_AF.translation() -
                                       R_WB * joint.X_BG.translation() - X_WB.translation());
  for (int i = 0; i < 3; ++i) {
    if (!joint.holds_slide[static_cast<std::size_t>(i)]) off_G[i] = 0.0;
  }
  return {R_WB, X_WB.translation() + R_WG * off_G};
}

Pose frame_on_axis(const Vector3d& origin, const Vector3d& z, const Vector3d& x) {
  Vector3d across = x - x.dot(z) * z;
  if (across.norm() < kParallel_rad) across = z.unitOrthogonal();
  across.normalize();
  Matrix3d axes;
  axes << across, z.cross(across), z;
  return Pose::from_matrix(axes, origin);
}

}  // namespace dowel
