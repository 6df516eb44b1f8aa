#pragma once

#include <variant>

#include <Eigen/Core>

#include "dowel/kernel/pose.h"

namespace dowel {

/// The exact, untrimmed surface that carries a face. Unit vectors are of unit length within 1e-9.
/// Each has a *natural side*: its signed distance is positive there. Plane: the side that `normal`
/// points to. Cylinder and cone: away from the axis. Sphere: away from the centre. Torus: outside
/// the tube. A face whose solid lies on the natural side has `Face::reversed` set (a bore).

struct PlaneSurface {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();
};

struct CylinderSurface {
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< any point of the axis
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double radius_mm = 0.0;  ///< > 0
};

/// One nappe: the points whose angle to `axis`, seen from `apex`, is `half_angle_rad`.
struct ConeSurface {
  Eigen::Vector3d apex = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< from the apex into the nappe
  double half_angle_rad = 0.0;                      ///< in (0, pi/2)
};

struct SphereSurface {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;  ///< > 0
};

/// Ring torus: `0 < minor_radius_mm < major_radius_mm`. Spindle tori are OtherSurface.
struct TorusSurface {
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double major_radius_mm = 0.0;
  double minor_radius_mm = 0.0;
};

/// Anything else (B-spline, extrusion, revolution, offset): known by its facets alone.
struct OtherSurface {};

using Surface = std::variant<OtherSurface, PlaneSurface, CylinderSurface, ConeSurface,
                             SphereSurface, TorusSurface>;

/// Distance of `point` from the surface, positive on its natural side. Construction: rounded,
/// error a few ulp of the coordinates. Expects: not OtherSurface.
double signed_distance_mm(const Surface& surface, const Eigen::Vector3d& point);

/// Unit gradient of `signed_distance_mm` at `point`; where it is not unique (on the axis, at the
/// centre) some unit vector that is one of the limits. Expects: not OtherSurface.
Eigen::Vector3d distance_gradient(const Surface& surface, const Eigen::Vector3d& point);

/// Closest point of the untrimmed surface; `point` itself for OtherSurface.
Eigen::Vector3d closest_point(const Surface& surface, const Eigen::Vector3d& point);

/// The same surface seen from frame W.
Surface transformed(const Pose& X_WB, const Surface& surface_B);

inline bool is_plane(const Surface& surface) {
  return std::holds_alternative<PlaneSurface>(surface);
}

}  // namespace dowel
