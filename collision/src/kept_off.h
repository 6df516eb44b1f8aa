#pragma once

#include <array>

#include "narrow_phase.h"

// What cannot take part in an interference. Private to collision.

namespace dowel {

/// Planes of one body's faces that have all of another body before them, but for less than the
/// tolerance: no ball of that diameter that fits into the other body is behind them, and so nothing
/// behind them can take part in an interference of the two.
class KeptOff {
 public:
  KeptOff() = default;

  /// `least_height_mm(plane)`: lower bound of the other body's height before a plane of `body`.
  template <class LeastHeight>
  KeptOff(const CollisionModel& body, double tolerance_mm, const LeastHeight& least_height_mm) {
    for (const SeatPlane& seat : body.seat_planes()) {
      if (count_ == planes_.size()) break;
      if (least_height_mm(seat.plane) > -tolerance_mm * (1.0 - kSafety)) {
        planes_[count_++] = &seat.plane;
      }
    }
  }

  /// Whether the node lies behind one of the planes.
  bool contains(const BvhNode& node) const {
    for (std::size_t i = 0; i < count_; ++i) {
      const Eigen::Vector3d center = 0.5 * (node.min + node.max) - planes_[i]->origin;
      const double reach = planes_[i]->normal.cwiseAbs().dot(0.5 * (node.max - node.min));
      if (planes_[i]->normal.dot(center) + reach <= kPlaneSlack_mm) return true;
    }
    return false;
  }

  bool is_empty() const { return count_ == 0; }

 private:
  /// Facets end at a plane where they pass it by no more than this: rounding of placed coordinates.
  static constexpr double kPlaneSlack_mm = 1.0e-9;

  std::array<const PlaneSurface*, 8> planes_{};
  std::size_t count_ = 0;
};

}  // namespace dowel
