// Whether cores of two bodies have a point in common.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dowel/collision/core.h"

namespace dowel {
namespace {

/// Projections to and fro before two cores are given up: blocks and bars along common directions
/// need one or two.
constexpr int kProjections = 12;

/// Cores are aimed at a little deeper than asked, so that the way there ends.
constexpr double kAim = 1.0e-3;

/// Pairs of cores whose boxes overlap that are tried, at most.
constexpr int kMaxTries = 12;

/// A point found is made deeper by this factor for as long as there is one.
constexpr double kGrowth = 4.0;

Core placed(const Core& core, const Pose& X_BA) {
  return {X_BA * core.center, X_BA.rotation() * core.axes, core.half_mm, core.is_bar};
}

bool has_points_at(const Core& core, double margin_mm) {
  return core.half_mm.minCoeff() > margin_mm;
}

/// A point at least `margin_mm` deep in both; nothing where a few projections find none.
std::optional<Eigen::Vector3d> common_point(const Core& a, const Core& b, double margin_mm,
                                            Eigen::Vector3d point) {
  const double aim_mm = (1.0 + kAim) * margin_mm;
  if (!has_points_at(a, aim_mm) || !has_points_at(b, aim_mm)) return std::nullopt;
  for (int step = 0; step < kProjections; ++step) {
    point = b.nearest(point, aim_mm);
    if (a.depth_mm(point) >= margin_mm) return point;
    point = a.nearest(point, aim_mm);
    if (b.depth_mm(point) >= margin_mm) return point;
  }
  return std::nullopt;
}

/// Boxes of cores of A against those of B, each along its body's core axes.
class CoreBoxSeparation {
 public:
  CoreBoxSeparation(const Cores& a, const Cores& b, const Pose& X_BA)
      : R_(b.axes.transpose() * X_BA.rotation_matrix() * a.axes),
        abs_R_(R_.cwiseAbs()),
        translation_(b.axes.transpose() * X_BA.translation()) {}

  /// Whether no plane along a face of either keeps them from having `depth_mm` in common.
  bool may_share(const Aabb& box_a, const Aabb& box_b, double depth_mm) const {
    const Eigen::Vector3d half_a = 0.5 * box_a.size();
    const Eigen::Vector3d half_b = 0.5 * box_b.size();
    const Eigen::Vector3d offset_B = R_ * box_a.center() + translation_ - box_b.center();
    if ((offset_B.cwiseAbs() - half_b - abs_R_ * half_a).maxCoeff() > -depth_mm) return false;
    const Eigen::Vector3d offset_A = R_.transpose() * offset_B;
    return (offset_A.cwiseAbs() - half_a - abs_R_.transpose() * half_b).maxCoeff() <= -depth_mm;
  }

 private:
  Eigen::Matrix3d R_;  // from the core axes of A to those of B
  Eigen::Matrix3d abs_R_;
  Eigen::Vector3d translation_;
};

}  // namespace

double Core::depth_mm(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d local = axes.transpose() * (point - center);
  if (!is_bar) return (half_mm - local.cwiseAbs()).minCoeff();
  return std::min(half_mm.x() - local.head<2>().norm(), half_mm.z() - std::abs(local.z()));
}

Eigen::Vector3d Core::nearest(const Eigen::Vector3d& point, double margin_mm) const {
  Eigen::Vector3d local = axes.transpose() * (point - center);
  const Eigen::Vector3d limit = half_mm.array() - margin_mm;
  if (is_bar) {
    const double radius = local.head<2>().norm();
    if (radius > limit.x()) local.head<2>() *= limit.x() / radius;
    local.z() = std::clamp(local.z(), -limit.z(), limit.z());
  } else {
    local = local.cwiseMax(-limit).cwiseMin(limit);
  }
  return center + axes * local;
}

double Core::volume_mm3() const {
  return 8.0 * half_mm.prod() * (is_bar ? 0.25 * std::numbers::pi : 1.0);
}

std::size_t Cores::memory_bytes() const {
  return cores.capacity() * sizeof(Core) + boxes_in_axes.capacity() * sizeof(Aabb);
}

std::optional<CoreOverlap> overlap_of(const Cores& a, std::uint32_t core_a, const Cores& b,
                                      std::uint32_t core_b, const Pose& X_BA, double margin_mm,
                                      const Eigen::Vector3d& start_B) {
  const Core a_B = placed(a.cores[core_a], X_BA);
  const Core& in_b = b.cores[core_b];
  const auto point = common_point(a_B, in_b, margin_mm, start_B);
  if (!point) return std::nullopt;
  return CoreOverlap{core_a, core_b, *point, a_B.depth_mm(*point), in_b.depth_mm(*point)};
}

std::optional<CoreOverlap> find_overlap(const Cores& a, const Cores& b, const Pose& X_BA,
                                        double margin_mm) {
  if (a.cores.empty() || b.cores.empty()) return std::nullopt;
  const CoreBoxSeparation boxes(a, b, X_BA);
  const double shared_mm = 2.0 * margin_mm;
  int tries = 0;
  for (std::uint32_t i = 0; i < a.cores.size(); ++i) {
    if (!boxes.may_share(a.boxes_in_axes[i], b.bounds_in_axes, shared_mm)) continue;
    const Core a_B = placed(a.cores[i], X_BA);
    for (std::uint32_t j = 0; j < b.cores.size(); ++j) {
      if (!boxes.may_share(a.boxes_in_axes[i], b.boxes_in_axes[j], shared_mm)) continue;
      auto point = common_point(a_B, b.cores[j], margin_mm, a_B.center);
      if (point) {
        for (double margin = kGrowth * margin_mm;; margin *= kGrowth) {
          const auto deeper = common_point(a_B, b.cores[j], margin, *point);
          if (!deeper) break;
          point = deeper;
        }
        return CoreOverlap{i, j, *point, a_B.depth_mm(*point), b.cores[j].depth_mm(*point)};
      }
      if (++tries == kMaxTries) return std::nullopt;
    }
  }
  return std::nullopt;
}

}  // namespace dowel
