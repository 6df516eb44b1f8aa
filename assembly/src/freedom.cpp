#include "dowel/assembly/freedom.h"

#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// `v` with components that are rounding set to zero, of unit length, in the sense that has its
/// first component positive.
Vector3d tidy(Vector3d v) {
  v.normalize();
  for (double& component : v) {
    if (std::abs(component) < kParallel_rad) component = 0.0;
  }
  for (const double component : v) {
    if (component == 0.0) continue;
    if (component < 0.0) v = -v;
    break;
  }
  return v.normalized();
}

/// Directions that span the orthonormal columns of `span` (3 x n), square to each other, along the
/// world's axes where these lie in it.
std::vector<Vector3d> directions_of(MatrixXd span) {
  std::vector<Vector3d> directions;
  while (span.cols() > 0) {
    Index nearest = 0;
    const Eigen::Vector3d shares = span.rowwise().norm();
    // The first of several that lie in it as well, give or take rounding.
    for (Index i = 1; i < 3; ++i) {
      if (shares[i] > shares[nearest] + kParallel_rad) nearest = i;
    }
    const Vector3d along = span * span.row(nearest).transpose();
    directions.push_back(tidy(along));
    // What is left of the span, square to it.
    const MatrixXd rest = span - directions.back() * (directions.back().transpose() * span);
    const Eigen::JacobiSVD<MatrixXd> svd(rest, Eigen::ComputeThinU);
    span = MatrixXd(svd.matrixU().leftCols(span.cols() - 1));
  }
  return directions;
}

/// Number of singular values that count.
Index rank_of(const Eigen::VectorXd& singular_values) {
  Index rank = 0;
  while (rank < singular_values.size() && singular_values[rank] > kMateIndependent) ++rank;
  return rank;
}

}  // namespace

std::vector<Freedom> freedoms_of(const MatrixXd& motions, const Vector3d& center_W) {
  if (motions.cols() == 0) return {};
  const Eigen::JacobiSVD<MatrixXd> all(motions, Eigen::ComputeThinU);
  const MatrixXd basis = all.matrixU().leftCols(rank_of(all.singularValues()));
  if (basis.cols() == 0) return {};
  // Motions without a turn, and the rest.
  const MatrixXd turns = basis.topRows<3>();
  const Eigen::JacobiSVD<MatrixXd> split(turns, Eigen::ComputeThinU | Eigen::ComputeFullV);
  const Index turn_count = rank_of(split.singularValues());
  const MatrixXd slides =
      basis.bottomRows<3>() * split.matrixV().rightCols(basis.cols() - turn_count);

  std::vector<Freedom> freedoms;
  for (const Vector3d& axis : directions_of(slides)) {
    freedoms.push_back({Freedom::Kind::Slide, axis, Vector3d::Zero(), 0.0});
  }
  const MatrixXd turn_axes = split.matrixU().leftCols(turn_count);
  for (const Vector3d& axis : directions_of(turn_axes)) {
    // The motion that turns by one radian about the axis, less what it slides freely.
    const Eigen::VectorXd scaled =
        (turn_axes.transpose() * axis).array() / split.singularValues().head(turn_count).array();
    const Eigen::VectorXd shares = split.matrixV().leftCols(turn_count) * scaled;
    Vector3d slide = kMateArm_mm * (basis.bottomRows<3>() * shares);
    slide -= slides * (slides.transpose() * slide);
    freedoms.push_back({Freedom::Kind::Turn, axis, center_W + axis.cross(slide), axis.dot(slide)});
  }
  return freedoms;
}

std::vector<Freedom> freedoms_of(const MateSolution& solution, std::size_t body) {
  return freedoms_of(solution.freedoms.middleRows(6 * static_cast<Index>(body), 6),
                     solution.centers_W[body]);
}

}  // namespace dowel
