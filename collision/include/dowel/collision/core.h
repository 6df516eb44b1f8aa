#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "dowel/kernel/box.h"
#include "dowel/kernel/pose.h"

namespace dowel {

class CollisionModel;

/// A convex piece of an element's material, in the element's frame: a block, or a round bar along
/// the third of its axes. No boundary of the exact solid is inside.
struct Core {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< columns, orthonormal
  Eigen::Vector3d half_mm = Eigen::Vector3d::Zero();   ///< of a bar: radius, radius, half length
  bool is_bar = false;

  /// Distance of `point` from the core's surface, positive inside.
  double depth_mm(const Eigen::Vector3d& point) const;

  /// The point nearest to `point` that lies `margin_mm` or deeper in the core, which must have such
  /// points.
  Eigen::Vector3d nearest(const Eigen::Vector3d& point, double margin_mm) const;

  double volume_mm3() const;
};

/// Cores of an element: what boxes are from outside, they are from inside. Boxes that are apart
/// keep bodies clear; cores that overlap make them interfere, without a look at any facet.
struct Cores {
  std::vector<Core> cores;          ///< the largest first
  Eigen::Matrix3d axes;             ///< that blocks are along
  std::vector<Aabb> boxes_in_axes;  ///< of each core, along these axes
  Aabb bounds_in_axes;              ///< of all of them

  std::size_t memory_bytes() const;
};

/// Blocks that start at the seats of the model's planes and at its inner points, and bars in its
/// outer cylinders, each grown until a facet (with what its exact face may stand off it) is met.
/// Deterministic.
Cores find_cores(const CollisionModel& model);

/// A point of two cores, of bodies A and B.
struct CoreOverlap {
  std::uint32_t core_a = 0;
  std::uint32_t core_b = 0;
  Eigen::Vector3d point_B = Eigen::Vector3d::Zero();
  double depth_a_mm = 0.0;
  double depth_b_mm = 0.0;
};

/// A point `margin_mm` or deeper in both a core of A and one of B, sought from `start_B` on by
/// projecting to and fro: nothing where that does not find one in a few steps, which happens only
/// where there is none or hardly any room.
std::optional<CoreOverlap> overlap_of(const Cores& a, std::uint32_t core_a, const Cores& b,
                                      std::uint32_t core_b, const Pose& X_BA, double margin_mm,
                                      const Eigen::Vector3d& start_B);

/// The same for the cores of two bodies: the first pair found, with the margin raised for as long
/// as that is easy.
std::optional<CoreOverlap> find_overlap(const Cores& a, const Cores& b, const Pose& X_BA,
                                        double margin_mm);

}  // namespace dowel
