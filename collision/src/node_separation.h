#pragma once

#include <array>
#include <cstddef>

#include <Eigen/Core>

#include "dowel/collision/model.h"
#include "dowel/kernel/pose.h"

// Boxes of nodes against each other, the commonest question of all. Private to collision.

namespace dowel {

/// Boxes of the tree of A against those of B, in single precision and four lanes at once.
class NodeSeparation {
 public:
  NodeSeparation(const CollisionModel& a, const CollisionModel& b, const Pose& X_BA) {
    const BvhNode& root_a = a.nodes()[0];
    const BvhNode& root_b = b.nodes()[0];
    const Eigen::Vector3d between =
        X_BA * Eigen::Vector3d(0.5 * (root_a.min + root_a.max)) - 0.5 * (root_b.min + root_b.max);
    const Eigen::Matrix3d R = X_BA.rotation_matrix();
    for (Eigen::Index i = 0; i < 3; ++i) {
      columns_[static_cast<std::size_t>(i)] = lanes(R.col(i));
      rows_[static_cast<std::size_t>(i)] = lanes(R.row(i));
    }
    translation_ = lanes(between);
    rounding_mm_ =
        kRounding * static_cast<float>(between.norm() + (root_a.max - root_a.min).norm() +
                                       (root_b.max - root_b.min).norm());
  }

  /// Lower bound of the boxes' distance, from the planes of types 1 and 2; negative: they may meet.
  float gap_mm(const NodeBox& a, const NodeBox& b) const {
    const Eigen::Array4f half_a = load(a.half);
    const Eigen::Array4f half_b = load(b.half);
    const Eigen::Array4f offset_B = mix(columns_, load(a.center)) + translation_ - load(b.center);
    const Eigen::Array4f along_b = offset_B.abs() - half_b - mix_abs(columns_, half_a);
    const Eigen::Array4f along_a = mix(rows_, offset_B).abs() - half_a - mix_abs(rows_, half_b);
    return along_a.max(along_b).maxCoeff() - rounding_mm_;
  }

 private:
  using Lanes = std::array<Eigen::Array4f, 3>;

  /// A gap is the end of some twenty roundings of numbers no larger than the distance of the roots'
  /// centres and the roots' diagonals together.
  static constexpr float kRounding = 20.0F * 0x1p-24F;

  static Eigen::Array4f load(const std::array<float, 4>& lanes) {
    return Eigen::Array4f::MapAligned(lanes.data());
  }
  static Eigen::Array4f lanes(const Eigen::Vector3d& v) {
    return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z()), 0.0F};
  }
  static Eigen::Array4f mix(const Lanes& m, const Eigen::Array4f& by) {
    return m[0] * by[0] + m[1] * by[1] + m[2] * by[2];
  }
  static Eigen::Array4f mix_abs(const Lanes& m, const Eigen::Array4f& by) {
    return m[0].abs() * by[0] + m[1].abs() * by[1] + m[2].abs() * by[2];
  }

  Lanes columns_;  // of the rotation from A to B
  Lanes rows_;
  Eigen::Array4f translation_;
  float rounding_mm_ = 0.0F;
};

inline float size_squared(const NodeBox& box) {
  return box.half[0] * box.half[0] + box.half[1] * box.half[1] + box.half[2] * box.half[2];
}

}  // namespace dowel
