#include "dowel/kernel/surface.h"

#include <cmath>
#include <limits>

#include "dowel/kernel/check.h"

namespace dowel {
namespace {

/// `v` at unit length, or `fallback` where `v` is too short to have a direction.
Eigen::Vector3d direction_or(const Eigen::Vector3d& v, const Eigen::Vector3d& fallback) {
  const double squared = v.squaredNorm();
  // Below the smallest normal number the square has lost digits and the quotient would not be of
  // unit length.
  if (squared < std::numeric_limits<double>::min()) return fallback;
  return v / std::sqrt(squared);
}

/// A point in the half-plane through a surface's axis: height along it and distance from it.
struct AxialPoint {
  double height = 0.0;
  double radius = 0.0;
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< from the axis to the point
};

AxialPoint axial(const Eigen::Vector3d& origin, const Eigen::Vector3d& axis,
                 const Eigen::Vector3d& point) {
  const Eigen::Vector3d v = point - origin;
  const double height = axis.dot(v);
  const Eigen::Vector3d offset = v - height * axis;
  return {height, offset.norm(), offset};
}

Eigen::Vector3d radial_direction(const AxialPoint& at, const Eigen::Vector3d& axis) {
  return direction_or(at.offset, axis.unitOrthogonal());
}

/// True where the apex, and no other point of the nappe, is closest.
bool is_behind_apex(const AxialPoint& at, double half_angle_rad) {
  return at.height * std::cos(half_angle_rad) + at.radius * std::sin(half_angle_rad) < 0.0;
}

struct SignedDistance {
  const Eigen::Vector3d& point;

  double operator()(const OtherSurface&) const {
    return std::numeric_limits<double>::quiet_NaN();  // refused by the caller
  }
  double operator()(const PlaneSurface& s) const { return s.normal.dot(point - s.origin); }
  double operator()(const CylinderSurface& s) const {
    return axial(s.origin, s.axis, point).radius - s.radius_mm;
  }
  double operator()(const ConeSurface& s) const {
    const AxialPoint at = axial(s.apex, s.axis, point);
    if (is_behind_apex(at, s.half_angle_rad)) return (point - s.apex).norm();
    return at.radius * std::cos(s.half_angle_rad) - at.height * std::sin(s.half_angle_rad);
  }
  double operator()(const SphereSurface& s) const {
    return (point - s.center).norm() - s.radius_mm;
  }
  double operator()(const TorusSurface& s) const {
    const AxialPoint at = axial(s.center, s.axis, point);
    return std::hypot(at.radius - s.major_radius_mm, at.height) - s.minor_radius_mm;
  }
};

struct Gradient {
  const Eigen::Vector3d& point;

  Eigen::Vector3d operator()(const OtherSurface&) const {
    return Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());  // as above
  }
  Eigen::Vector3d operator()(const PlaneSurface& s) const { return s.normal; }
  Eigen::Vector3d operator()(const CylinderSurface& s) const {
    return radial_direction(axial(s.origin, s.axis, point), s.axis);
  }
  Eigen::Vector3d operator()(const ConeSurface& s) const {
    const AxialPoint at = axial(s.apex, s.axis, point);
    const Eigen::Vector3d flank = std::cos(s.half_angle_rad) * radial_direction(at, s.axis) -
                                  std::sin(s.half_angle_rad) * s.axis;
    return is_behind_apex(at, s.half_angle_rad) ? direction_or(point - s.apex, flank) : flank;
  }
  Eigen::Vector3d operator()(const SphereSurface& s) const {
    return direction_or(point - s.center, Eigen::Vector3d::UnitZ());
  }
  Eigen::Vector3d operator()(const TorusSurface& s) const {
    const AxialPoint at = axial(s.center, s.axis, point);
    const Eigen::Vector3d outward = radial_direction(at, s.axis);
    return direction_or((at.radius - s.major_radius_mm) * outward + at.height * s.axis, outward);
  }
};

struct Transform {
  const Pose& X_WB;

  /// Turned and brought back to unit length, so that chains of poses do not let it drift.
  Eigen::Vector3d turned(const Eigen::Vector3d& unit_B) const {
    return (X_WB.rotation() * unit_B).normalized();
  }

  Surface operator()(const OtherSurface& s) const { return s; }
  Surface operator()(const PlaneSurface& s) const {
    return PlaneSurface{X_WB * s.origin, turned(s.normal)};
  }
  Surface operator()(const CylinderSurface& s) const {
    return CylinderSurface{X_WB * s.origin, turned(s.axis), s.radius_mm};
  }
  Surface operator()(const ConeSurface& s) const {
    return ConeSurface{X_WB * s.apex, turned(s.axis), s.half_angle_rad};
  }
  Surface operator()(const SphereSurface& s) const {
    return SphereSurface{X_WB * s.center, s.radius_mm};
  }
  Surface operator()(const TorusSurface& s) const {
    return TorusSurface{X_WB * s.center, turned(s.axis), s.major_radius_mm, s.minor_radius_mm};
  }
};

bool is_other(const Surface& surface) {
  return std::holds_alternative<OtherSurface>(surface);
}

}  // namespace

double signed_distance_mm(const Surface& surface, const Eigen::Vector3d& point) {
  DOWEL_EXPECTS(!is_other(surface));
  return std::visit(SignedDistance{point}, surface);
}

Eigen::Vector3d distance_gradient(const Surface& surface, const Eigen::Vector3d& point) {
  DOWEL_EXPECTS(!is_other(surface));
  return std::visit(Gradient{point}, surface);
}

Eigen::Vector3d closest_point(const Surface& surface, const Eigen::Vector3d& point) {
  if (is_other(surface)) return point;
  return point - signed_distance_mm(surface, point) * distance_gradient(surface, point);
}

Surface transformed(const Pose& X_WB, const Surface& surface_B) {
  return std::visit(Transform{X_WB}, surface_B);
}

}  // namespace dowel
