#include "mate_rank.h"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>

#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::Vector3d;

/// Rows that are orthonormal and span those of the mates so far.
class RowSpace {
 public:
  explicit RowSpace(Index columns) : rows_(0, columns) {}

  const MatrixXd& rows() const { return rows_; }

  struct Added {
    int rank = 0;
    bool is_uncertain = false;  ///< a direction counts more than `none` but not `some`
  };

  Added add(MatrixXd more, double none, double some) {
    if (more.size() == 0) return {};  // nothing is asked, or nobody can move
    // Twice: the first leaves rounding of the size of the rows.
    for (int pass = 0; pass < 2; ++pass) more -= (more * rows_.transpose()) * rows_;
    const Eigen::JacobiSVD<MatrixXd> svd(more, Eigen::ComputeThinV);
    Added added;
    for (Index i = 0; i < svd.singularValues().size(); ++i) {
      const double value = svd.singularValues()[i];
      if (value <= none) break;
      if (value < some) {
        added.is_uncertain = true;
        break;
      }
      rows_.conservativeResize(rows_.rows() + 1, Eigen::NoChange);
      rows_.row(rows_.rows() - 1) = svd.matrixV().col(i).transpose();
      ++added.rank;
    }
    return added;
  }

 private:
  MatrixXd rows_;
};

/// Orthonormal columns that are square to all of `rows`, which are orthonormal.
MatrixXd null_space(const MatrixXd& rows) {
  const Index columns = rows.cols();
  if (rows.rows() == 0) return MatrixXd::Identity(columns, columns);
  const Eigen::HouseholderQR<MatrixXd> qr(rows.transpose());
  const MatrixXd q = qr.householderQ() * MatrixXd::Identity(columns, columns);
  return q.rightCols(columns - rows.rows());
}

}  // namespace

bool acts_on(const std::vector<Joint>& mate, std::size_t body) {
  return std::ranges::any_of(
      mate, [=](const Joint& joint) { return joint.a == body || joint.b == body; });
}

MateColumns::MateColumns(const MateProblem& problem,
                         const std::function<bool(std::size_t)>& is_free)
    : first_(problem.bodies.size()), center_(problem.bodies.size(), Vector3d::Zero()) {
  std::vector<double> joints(problem.bodies.size(), 0.0);
  for (const std::vector<Joint>& mate : problem.mates) {
    for (const Joint& joint : mate) {
      center_[joint.a] += joint.X_AF.translation();
      center_[joint.b] += joint.X_BG.translation();
      joints[joint.a] += 1.0;
      joints[joint.b] += 1.0;
    }
  }
  for (std::size_t body = 0; body < problem.bodies.size(); ++body) {
    center_[body] /= std::max(1.0, joints[body]);
    if (!is_free(body)) continue;
    first_[body] = count_;
    count_ += 6;
  }
}

MateEquations MateColumns::equations(const MateProblem& problem,
                                     const std::vector<std::size_t>& mates,
                                     const std::vector<Pose>& X_WB) const {
  Index rows = 0;
  for (const std::size_t mate : mates) {
    for (const Joint& joint : problem.mates[mate]) rows += joint.equations();
  }
  MateEquations all{Eigen::VectorXd::Zero(rows), MatrixXd::Zero(rows, count_)};
  Index row = 0;
  for (const std::size_t mate : mates) {
    for (const Joint& joint : problem.mates[mate]) {
      const Pose& X_WA = X_WB[joint.a];
      const Pose& X_WO = X_WB[joint.b];
      const JointEquations one =
          joint_equations(joint, X_WA, X_WO, center_W(joint.a, X_WA), center_W(joint.b, X_WO));
      const Index height = one.value.size();
      all.value.segment(row, height) = one.value;
      if (has(joint.a)) all.derivative.block(row, first(joint.a), height, 6) = one.motion_A;
      if (has(joint.b)) all.derivative.block(row, first(joint.b), height, 6) = one.motion_B;
      row += height;
    }
  }
  return all;
}

std::vector<Pose> MateColumns::moved(const MateProblem& problem, const std::vector<Pose>& X_WB,
                                     const Eigen::VectorXd& motion, double most_rad) const {
  double largest_rad = 0.0;
  for (std::size_t body = 0; body < problem.bodies.size(); ++body) {
    if (!has(body)) continue;
    largest_rad = std::max(largest_rad, motion.segment<3>(first(body)).norm() / kMateArm_mm);
  }
  const double share = largest_rad > most_rad ? most_rad / largest_rad : 1.0;
  std::vector<Pose> result = X_WB;
  for (std::size_t body = 0; body < problem.bodies.size(); ++body) {
    if (!has(body)) continue;
    const Vector3d turn_rad = share / kMateArm_mm * motion.segment<3>(first(body));
    const Vector3d slide = share * motion.segment<3>(first(body) + 3);
    const double angle_rad = turn_rad.norm();
    const Vector3d axis =
        angle_rad > 0.0 ? Vector3d(turn_rad / angle_rad) : Vector3d(Vector3d::UnitZ());
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle_rad, axis));
    const Vector3d center = center_W(body, X_WB[body]);
    result[body] = Pose((turn * X_WB[body].rotation()).normalized(),
                        center + slide + turn * (X_WB[body].translation() - center));
  }
  return result;
}

void judge_ranks(const MateProblem& problem, const std::vector<std::size_t>& accepted,
                 MateSolution& solution) {
  const MateColumns columns(problem, [&](std::size_t body) { return !problem.bodies[body].held; });
  RowSpace space(columns.count());
  // By as much as mates are off, rows that belong together are off each other.
  double slack = 0.0;
  for (const std::size_t mate : accepted) {
    const MateVerdict& verdict = solution.mates[mate];
    slack = std::max({slack, verdict.off_rad, verdict.off_mm / kMateArm_mm});
  }
  const double none = kMateDependent + 4.0 * slack;
  for (const std::size_t mate : accepted) {
    MateVerdict& verdict = solution.mates[mate];
    const RowSpace::Added added =
        space.add(columns.equations(problem, {mate}, solution.X_WB).derivative, none,
                  std::max(none, kMateIndependent));
    verdict.freedoms_taken = added.rank;
    if (added.is_uncertain) {
      verdict.status = MateStatus::NearlyRedundant;
    } else if (added.rank == 0) {
      verdict.status = MateStatus::Redundant;
    }
  }
  const MatrixXd left = null_space(space.rows());
  const auto bodies = static_cast<Index>(problem.bodies.size());
  solution.freedoms = MatrixXd::Zero(6 * bodies, left.cols());
  for (std::size_t body = 0; body < problem.bodies.size(); ++body) {
    solution.centers_W.push_back(columns.center_W(body, solution.X_WB[body]));
    if (columns.has(body)) {
      solution.freedoms.middleRows(6 * static_cast<Index>(body), 6) =
          left.middleRows(columns.first(body), 6);
    }
  }
}

}  // namespace dowel
