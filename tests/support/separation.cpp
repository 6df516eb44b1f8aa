#include "separation.h"

#include <algorithm>
#include <limits>
#include <queue>
#include <vector>

namespace dowel::testing {

namespace {

struct Cell {
  double low_mm = 0.0;  ///< of f in it
  Eigen::Vector3d center;
  Eigen::Vector3d half;

  bool operator<(const Cell& other) const { return low_mm > other.low_mm; }  // lowest on top
};

class Search {
 public:
  Search(const ExactShape& a, const ExactShape& b, const Pose& X_BA, const SeparationEffort& effort)
      : a_(a), b_(b), X_AB_(X_BA.inverse()), effort_(effort) {
    const Aabb box_a_B = bounds(dowel::transformed(X_BA, a.obb()));
    const Eigen::Vector3d min = box_a_B.min.cwiseMin(b.box.min);
    const Eigen::Vector3d max = box_a_B.max.cwiseMax(b.box.max);
    look_into(0.5 * (min + max), 0.5 * (max - min));
  }

  Separation result() {
    while (!cells_.empty() && cells_.top().low_mm < needed_mm() &&
           evaluations_ < effort_.max_evaluations) {
      const Cell cell = cells_.top();
      cells_.pop();
      Eigen::Index axis = 0;
      cell.half.maxCoeff(&axis);
      Eigen::Vector3d half = cell.half;
      half[axis] *= 0.5;
      Eigen::Vector3d step = Eigen::Vector3d::Zero();
      step[axis] = half[axis];
      look_into(cell.center - step, half);
      look_into(cell.center + step, half);
    }
    const double low_mm = cells_.empty() ? needed_mm() : std::min(cells_.top().low_mm, needed_mm());
    return {2.0 * low_mm, 2.0 * least_mm_, place_};
  }

 private:
  /// A cell that has nothing below this is of no interest.
  double needed_mm() const { return least_mm_ - 0.5 * effort_.resolution_mm; }

  void look_into(const Eigen::Vector3d& center, const Eigen::Vector3d& half) {
    ++evaluations_;
    const double reach_mm = half.norm();
    double f_mm = b_.signed_distance_mm(center);
    if (f_mm - reach_mm >= needed_mm()) return;
    f_mm = std::max(f_mm, a_.signed_distance_mm(X_AB_ * center));
    if (f_mm < least_mm_) {
      least_mm_ = f_mm;
      place_ = center;
    }
    if (f_mm - reach_mm < needed_mm()) cells_.push({f_mm - reach_mm, center, half});
  }

  const ExactShape& a_;
  const ExactShape& b_;
  Pose X_AB_;
  SeparationEffort effort_;
  std::priority_queue<Cell> cells_;
  double least_mm_ = std::numeric_limits<double>::infinity();
  Eigen::Vector3d place_ = Eigen::Vector3d::Zero();
  int evaluations_ = 0;
};

}  // namespace

Separation separation(const ExactShape& a, const ExactShape& b, const Pose& X_BA,
                      const SeparationEffort& effort) {
  return Search(a, b, X_BA, effort).result();
}

}  // namespace dowel::testing
