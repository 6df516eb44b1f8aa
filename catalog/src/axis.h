#pragma once

#include <cmath>

#include "dowel/kernel/surface.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {

/// Line shared by coaxial faces. Heights are measured from `origin` along `direction`.
struct Axis {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d direction = Eigen::Vector3d::UnitZ();

  double height_mm(const Eigen::Vector3d& p) const { return direction.dot(p - origin); }
  double distance_mm(const Eigen::Vector3d& p) const {
    const Eigen::Vector3d q = p - origin;
    return (q - direction.dot(q) * direction).norm();
  }
  Eigen::Vector3d at(double height_mm) const { return origin + height_mm * direction; }
  bool is_parallel(const Eigen::Vector3d& unit) const {
    return direction.cross(unit).norm() <= kCoaxial_rad;
  }
  /// Height where `plane` meets the axis. Expects: it does.
  double height_mm(const PlaneSurface& plane) const {
    return plane.normal.dot(plane.origin - origin) / plane.normal.dot(direction);
  }
};

}  // namespace dowel
