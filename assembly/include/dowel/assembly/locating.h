#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

namespace dowel {

/// Where something holds the workpiece, without friction.
struct LocatingPoint {
  std::string name;  ///< whose it is: an instance
  Eigen::Vector3d at = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< unit, into the workpiece
  double error_mm = 0.0;   ///< it may stand off along its normal by this, plus or minus
  bool two_sided = false;  ///< it pushes either way: a pin in a hole

  bool operator==(const LocatingPoint&) const = default;
};

/// What the workpiece is measured from and by: the centre and half the diagonal of its box.
struct LocatingFrame {
  Eigen::Vector3d reference = Eigen::Vector3d::Zero();
  double length_mm = 1.0;

  bool operator==(const LocatingFrame&) const = default;
};

/// A column for each point: [n; (r - o) x n / L]. The wrench (force, torque over L about o) that a
/// unit force at the point puts on the workpiece; its transpose takes a small motion (slide, L
/// times turn) to the way along each normal. All six rows are forces, or lengths. Source: Asada and
/// By, "Kinematic Analysis of Workpart Fixturing for Flexible Assembly with Automatically
/// Reconfigurable Fixtures", IEEE J. Robotics and Automation 1(2), 1985.
Eigen::Matrix<double, 6, Eigen::Dynamic> locator_matrix(std::span<const LocatingPoint> points,
                                                        const LocatingFrame& frame);

/// Singular values below this part of the largest are zero: far over the rounding of a 6 x n matrix
/// of entries near 1, far below what any two locators on a part differ by.
inline constexpr double kLocatingRank = 1.0e-9;

/// How well locators settle the workpiece.
struct Locating {
  int rank = 0;
  double condition = 0.0;  ///< largest over sixth singular value; infinity below rank 6
  std::vector<double> singular_values;
  std::vector<std::size_t> redundant;  ///< points that add no rank to those before them
  /// Motions that no point stops, columns (slide, L times turn), orthonormal; 6 - rank of them.
  Eigen::MatrixXd free_motions;

  bool is_deterministic() const { return rank == 6; }
};

Locating analyse_locating(std::span<const LocatingPoint> points, const LocatingFrame& frame);

/// How far a point of the workpiece may be off where the locators are by their errors.
struct PositionError {
  double worst_mm = 0.0;  ///< largest over all signs of the errors (or a bound, over 16 locators)
  // Errors evenly spread between plus and minus, independent of each other:
  double mean_mm = 0.0;
  double p95_mm = 0.0;
};

struct MonteCarloOptions {
  std::size_t samples = 10'000;
  std::uint64_t seed = 1;
};

/// By first order: motion = pinv(G^T) errors. Expects: rank 6.
PositionError position_error(std::span<const LocatingPoint> points, const LocatingFrame& frame,
                             const Eigen::Vector3d& at, const MonteCarloOptions& options = {});

}  // namespace dowel
