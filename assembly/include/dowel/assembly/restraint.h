#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "dowel/assembly/locating.h"

namespace dowel {

using Wrench = Eigen::Matrix<double, 6, 1>;

/// A force at a point, as (force, torque over L about o), all in N.
Wrench wrench_of(const Eigen::Vector3d& force_N, const Eigen::Vector3d& at,
                 const LocatingFrame& frame);

/// Non-negative least squares: x >= 0 with the smallest |a x - b|.
struct NonNegative {
  Eigen::VectorXd x;
  double residual = 0.0;  ///< |a x - b|
  bool has_converged = true;
};

/// Source: Lawson and Hanson, "Solving Least Squares Problems", 1974, algorithm NNLS (23.10).
/// Expects: finite entries.
NonNegative non_negative_least_squares(const Eigen::MatrixXd& a, const Eigen::VectorXd& b);

/// Forces that the points take, without friction, when `wrench` acts on the workpiece.
struct Seating {
  /// One for each point; two-sided ones have either sign. Of others, below 0: it would have to
  /// pull, so the workpiece lifts off. Six points of rank 6: the only solution. Otherwise the one
  /// without pull where there is one (then of smallest error), else that of least squares.
  std::vector<double> forces_N;
  double residual_N = 0.0;  ///< what is left unbalanced: the workpiece slides away
  double least_N = 0.0;     ///< smallest force of a point that is not two-sided
};

/// Columns as in locator_matrix, and of two-sided points the opposite one, too, behind all others.
Eigen::Matrix<double, 6, Eigen::Dynamic> pushing_matrix(std::span<const LocatingPoint> points,
                                                        const LocatingFrame& frame);

/// Expects: at least one point.
Seating seating_forces(std::span<const LocatingPoint> points, const LocatingFrame& frame,
                       const Wrench& wrench);

/// A contact with friction.
struct FrictionContact {
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, into the workpiece
  double friction = 0.0;
  /// Clamps: the force along the normal, neither more nor less. Locators: whatever is needed.
  std::optional<double> preload_N;
};

/// Edges of the pyramid that stands for a friction cone, inside of it.
inline constexpr int kConeEdges = 8;

/// Whether contacts can balance a wrench within their friction cones.
struct ForceClosure {
  bool holds = false;
  double residual_N = 0.0;                ///< what stays unbalanced
  std::vector<Eigen::Vector3d> forces_N;  ///< one solution, a force for each contact
};

/// The workpiece holds where min |F lambda + w| over lambda >= 0 is zero (1e-6 of the forces), F
/// having the edges of all cones as columns; of a clamp the edges' shares sum up to its preload.
/// Static friction with pyramids inside the cones: what holds here, holds; by up to 8 % more might.
/// Source: Wang, "Characterization of Fixture Kinematics", IEEE Trans. Robotics and Automation
/// 16(4), 2000; non-negative solution by Lawson and Hanson.
ForceClosure force_closure(std::span<const FrictionContact> contacts, const LocatingFrame& frame,
                           const Wrench& wrench);

/// The largest factor on `load` up to `most` at which the contacts hold it beside `dead` (weight);
/// 0 where they do not hold even without load. Within 1 part in 1000.
double load_factor(std::span<const FrictionContact> contacts, const LocatingFrame& frame,
                   const Wrench& dead, const Wrench& load, double most = 100.0);

/// True where the contacts whose wrenches are the columns hold the body without friction against
/// anything: full row rank, and positive forces that add up to zero. Rows: 6 in space, 3 in a
/// plane. Source: Brost and Goldberg, "A Complete Algorithm for Designing Planar Fixtures Using
/// Modular Components", IEEE Trans. Robotics and Automation 12(1), 1996.
bool has_form_closure(const Eigen::MatrixXd& wrenches);

/// Signed distance of a point from the border of the convex hull of `supports`, positive inside.
/// All in one plane. Fewer than three supports, or all on a line: minus the distance.
double support_margin_mm(std::span<const Eigen::Vector2d> supports, const Eigen::Vector2d& point);

/// Convex hull in the plane, counter-clockwise, without points on its edges.
std::vector<Eigen::Vector2d> convex_polygon(std::span<const Eigen::Vector2d> points);

double polygon_area_mm2(std::span<const Eigen::Vector2d> polygon);

}  // namespace dowel
