#pragma once

#include <array>
#include <cstddef>
#include <optional>

#include <Eigen/Core>

#include "dowel/kernel/pose.h"

namespace dowel {

/// What a mate asks of two bodies A and B: that frame F of A stands in frame G of B. Each of the
/// six ways in which F can leave G is held or free; what is held is one scalar equation.
///
/// | held            | equations | asks                                              |
/// |-----------------|-----------|---------------------------------------------------|
/// | `holds_tilt`    | 2         | z axes of F and G are one direction, sense included |
/// | `holds_spin`    | 1         | x axes too. Only with tilt                        |
/// | `holds_slide`   | up to 3   | F's origin is G's, along x, y, z of G             |
/// | `angle_rad`     | 1         | angle between the z axes. Instead of tilt         |
struct Joint {
  std::size_t a = 0;  ///< index of body A in its MateProblem
  std::size_t b = 0;
  Pose X_AF;
  Pose X_BG;
  bool holds_tilt = false;
  bool holds_spin = false;
  std::array<bool, 3> holds_slide{};
  std::optional<double> angle_rad = std::nullopt;  ///< in (0, pi)

  /// Number of scalar equations, at most 6.
  int equations() const;
};

/// An angle counts in equations as the way of a point this far from the axis, so that all of them
/// are lengths: about the size of an element.
inline constexpr double kMateArm_mm = 100.0;

/// How far a joint is off, in the frame G.
struct JointOff {
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();  ///< rotation vector; 0 where free
  Eigen::Vector3d slide_mm = Eigen::Vector3d::Zero();  ///< 0 where free
};

/// `X_WA`, `X_WB`: poses of the two bodies.
JointOff joint_off(const Joint& joint, const Pose& X_WA, const Pose& X_WB);

/// At most six rows, kept without allocation.
using JointVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, 6, 1>;
using JointRows = Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::ColMajor, 6, 6>;

/// The equations of a joint, linear about the present poses.
///
/// A small motion of a body is (kMateArm_mm * turn, slide) in world axes: it turns about a point of
/// the body and slides. Values and derivatives are in mm.
struct JointEquations {
  JointVector value;   ///< 0 where the joint holds
  JointRows motion_A;  ///< derivative by the motion of A
  JointRows motion_B;
};

/// `c_W_A`, `c_W_B`: the points about which the bodies turn. Derivatives are analytic; where a z
/// axis points just against the other one (or, of an angle, along it), any way round is taken.
JointEquations joint_equations(const Joint& joint, const Pose& X_WA, const Pose& X_WB,
                               const Eigen::Vector3d& c_W_A, const Eigen::Vector3d& c_W_B);

/// The pose of A nearest to `X_WA` in which the joint holds: turned as little as can be, then slid
/// as little as can be. Construction: rounded, within a few ulp of the coordinates.
Pose place_by_joint(const Joint& joint, const Pose& X_WA, const Pose& X_WB);

/// The joint with A and B exchanged, as far as `place_by_joint` needs it: the pose of B nearest to
/// `X_WB` in which it holds.
Pose place_other_by_joint(const Joint& joint, const Pose& X_WA, const Pose& X_WB);

/// The rotation nearest to R_WA that gives direction `d_A` of A the direction `d_W`. Of the half
/// turns that reverse a direction: about that axis of A which is most nearly square to it.
Eigen::Quaterniond nearest_rotation(const Eigen::Quaterniond& R_WA, const Eigen::Vector3d& d_A,
                                    const Eigen::Vector3d& d_W);

/// A frame with its origin at `origin`, its z axis along unit vector `z` and its x axis as near to
/// `x` as can be; across `z` where `x` is along it.
Pose frame_on_axis(const Eigen::Vector3d& origin, const Eigen::Vector3d& z,
                   const Eigen::Vector3d& x);

}  // namespace dowel
