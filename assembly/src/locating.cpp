#include "dowel/assembly/locating.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "dowel/kernel/check.h"

namespace dowel {
namespace {

constexpr int kFreedoms = 6;

/// All signs of so many errors are tried; beyond, their sum is the bound.
constexpr Eigen::Index kMostSigns = 16;

/// From the errors of the points to the displacement of `at`.
Eigen::Matrix<double, 3, Eigen::Dynamic> displacement_by_error(
    std::span<const LocatingPoint> points, const LocatingFrame& frame, const Eigen::Vector3d& at) {
  const auto G = locator_matrix(points, frame);
  const Eigen::MatrixXd motion_by_error =
      Eigen::MatrixXd(G.transpose()).completeOrthogonalDecomposition().pseudoInverse();
  // slide + turn x (at - o), the turn being the lower half over L
  const Eigen::Vector3d arm = (at - frame.reference) / frame.length_mm;
  Eigen::Matrix<double, 3, kFreedoms> by_motion;
  by_motion.leftCols<3>().setIdentity();
  by_motion.rightCols<3>() << 0.0, arm.z(), -arm.y(), -arm.z(), 0.0, arm.x(), arm.y(), -arm.x(),
      0.0;
  return by_motion * motion_by_error;
}

/// Evenly spread in [-1, 1), the same on every platform.
double signed_unit(std::mt19937_64& random) {
  constexpr double kSteps = 9007199254740992.0;  // 2^53
  return 2.0 * static_cast<double>(random() >> 11U) / kSteps - 1.0;
}

}  // namespace

Eigen::Matrix<double, 6, Eigen::Dynamic> locator_matrix(std::span<const LocatingPoint> points,
                                                        const LocatingFrame& frame) {
  DOWEL_EXPECTS(frame.length_mm > 0.0);
  Eigen::Matrix<double, kFreedoms, Eigen::Dynamic> G(kFreedoms, points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const LocatingPoint& point = points[i];
    G.col(static_cast<Eigen::Index>(i)) << point.normal,
        (point.at - frame.reference).cross(point.normal) / frame.length_mm;
  }
  return G;
}

Locating analyse_locating(std::span<const LocatingPoint> points, const LocatingFrame& frame) {
  Locating result;
  result.condition = std::numeric_limits<double>::infinity();
  result.free_motions = Eigen::MatrixXd::Identity(kFreedoms, kFreedoms);
  if (points.empty()) return result;
  const auto G = locator_matrix(points, frame);
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(G, Eigen::ComputeFullU);
  const Eigen::VectorXd& values = svd.singularValues();
  result.singular_values.assign(values.data(), values.data() + values.size());
  const double zero = kLocatingRank * values[0];
  result.rank = static_cast<int>((values.array() > zero).count());
  result.free_motions = svd.matrixU().rightCols(kFreedoms - result.rank);
  if (result.rank == kFreedoms) result.condition = values[0] / values[kFreedoms - 1];

  // What a column adds to those before it, by Gram and Schmidt (twice, against rounding).
  std::vector<Eigen::Matrix<double, kFreedoms, 1>> basis;
  for (Eigen::Index i = 0; i < G.cols(); ++i) {
    Eigen::Matrix<double, kFreedoms, 1> rest = G.col(i);
    for (int pass = 0; pass < 2; ++pass) {
      for (const auto& direction : basis) rest -= direction.dot(rest) * direction;
    }
    if (rest.norm() > zero) {
      basis.push_back(rest.normalized());
    } else {
      result.redundant.push_back(static_cast<std::size_t>(i));
    }
  }
  return result;
}

PositionError position_error(std::span<const LocatingPoint> points, const LocatingFrame& frame,
                             const Eigen::Vector3d& at, const MonteCarloOptions& options) {
  DOWEL_EXPECTS(analyse_locating(points, frame).is_deterministic());
  Eigen::Matrix<double, 3, Eigen::Dynamic> by_error = displacement_by_error(points, frame, at);
  for (std::size_t i = 0; i < points.size(); ++i) {
    by_error.col(static_cast<Eigen::Index>(i)) *= points[i].error_mm;
  }
  PositionError result;
  const Eigen::Index n = by_error.cols();
  if (n <= kMostSigns) {
    // The norm is convex, so its largest value is at a corner. Opposite corners are alike.
    for (std::uint32_t signs = 0; signs < (1U << static_cast<unsigned>(n - 1)); ++signs) {
      Eigen::Vector3d sum = by_error.col(n - 1);
      for (Eigen::Index i = 0; i + 1 < n; ++i) {
        const bool is_plus = ((signs >> static_cast<unsigned>(i)) & 1U) != 0U;
        sum += (is_plus ? 1.0 : -1.0) * by_error.col(i);
      }
      result.worst_mm = std::max(result.worst_mm, sum.norm());
    }
  } else {
    result.worst_mm = by_error.colwise().norm().sum();
  }
  if (options.samples == 0) return result;
  std::mt19937_64 random(options.seed);
  std::vector<double> lengths_mm(options.samples);
  Eigen::VectorXd errors(n);
  for (double& length_mm : lengths_mm) {
    for (double& error : errors) error = signed_unit(random);
    length_mm = (by_error * errors).norm();
  }
  result.mean_mm = std::accumulate(lengths_mm.begin(), lengths_mm.end(), 0.0) /
                   static_cast<double>(options.samples);
  constexpr double kShare = 0.95;
  const auto rank = static_cast<std::ptrdiff_t>(kShare * static_cast<double>(options.samples - 1));
  std::nth_element(lengths_mm.begin(), lengths_mm.begin() + rank, lengths_mm.end());
  result.p95_mm = lengths_mm[static_cast<std::size_t>(rank)];
  return result;
}

}  // namespace dowel
