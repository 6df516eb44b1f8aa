#include "exact_surface.h"

#include <cmath>
#include <numbers>

#include <BRep_Tool.hxx>
#include <GeomAdaptor_Curve.hxx>
#include <GeomAdaptor_Surface.hxx>
#include <GeomLib_IsPlanarSurface.hxx>
#include <Geom_OffsetSurface.hxx>
#include <Geom_RectangularTrimmedSurface.hxx>
#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>
#include <gp_Circ.hxx>
#include <gp_Cone.hxx>
#include <gp_Cylinder.hxx>
#include <gp_Lin.hxx>
#include <gp_Pln.hxx>
#include <gp_Sphere.hxx>
#include <gp_Torus.hxx>

#include "dowel/kernel/tolerance.h"
#include "occt.h"

namespace dowel {
namespace {

using Eigen::Vector3d;
using SurfaceHandle = opencascade::handle<Geom_Surface>;

SurfaceHandle unwrapped(SurfaceHandle surface) {
  while (!surface.IsNull()) {
    const auto trimmed = opencascade::handle<Geom_RectangularTrimmedSurface>::DownCast(surface);
    const auto offset = opencascade::handle<Geom_OffsetSurface>::DownCast(surface);
    SurfaceHandle basis;
    if (!trimmed.IsNull()) basis = trimmed->BasisSurface();
    if (!offset.IsNull()) basis = offset->Surface();
    if (basis.IsNull()) break;
    surface = basis;
  }
  return surface;
}

Surface cylinder(const Vector3d& origin, const Vector3d& axis, double radius_mm) {
  if (!(radius_mm > kMinTolerance_mm) || !(radius_mm < kMaxCoordinate_mm)) return OtherSurface{};
  return CylinderSurface{origin, axis.normalized(), radius_mm};
}

Surface cone(const Vector3d& apex, const Vector3d& axis, double half_angle_rad,
             const Vector3d& inside) {
  const double angle = std::abs(half_angle_rad);
  const bool is_cone = angle > kParallel_rad && angle < std::numbers::pi / 2 - kParallel_rad;
  if (!is_cone || !apex.allFinite()) return OtherSurface{};
  const double side = (inside - apex).dot(axis) < 0.0 ? -1.0 : 1.0;
  return ConeSurface{apex, side * axis.normalized(), angle};
}

Surface sphere(const Vector3d& center, double radius_mm) {
  if (!(radius_mm > kMinTolerance_mm) || !(radius_mm < kMaxCoordinate_mm)) return OtherSurface{};
  return SphereSurface{center, radius_mm};
}

Surface torus(const Vector3d& center, const Vector3d& axis, double major_mm, double minor_mm) {
  if (!(minor_mm > kMinTolerance_mm) || !(major_mm > minor_mm)) return OtherSurface{};
  if (!(major_mm < kMaxCoordinate_mm)) return OtherSurface{};
  return TorusSurface{center, axis.normalized(), major_mm, minor_mm};
}

Surface extrusion(const GeomAdaptor_Curve& profile, const Vector3d& direction) {
  if (profile.GetType() == GeomAbs_Line) {
    const gp_Lin line = profile.Line();
    const Vector3d normal = to_eigen(line.Direction()).cross(direction);
    if (normal.norm() < kParallel_rad) return OtherSurface{};
    return PlaneSurface{to_eigen(line.Location()), normal.normalized()};
  }
  if (profile.GetType() == GeomAbs_Circle) {
    const gp_Circ circle = profile.Circle();
    const Vector3d axis = to_eigen(circle.Axis().Direction());
    if (axis.cross(direction).norm() < kParallel_rad) {
      return cylinder(to_eigen(circle.Location()), axis, circle.Radius());
    }
  }
  return OtherSurface{};
}

Surface revolved_line(const gp_Lin& line, const Vector3d& origin, const Vector3d& axis,
                      const Vector3d& inside) {
  const Vector3d direction = to_eigen(line.Direction());
  const Vector3d offset = to_eigen(line.Location()) - origin;
  const double cosine = direction.dot(axis);
  const double sine = direction.cross(axis).norm();
  if (sine < kParallel_rad)
    return cylinder(origin, axis, (offset - offset.dot(axis) * axis).norm());
  if (std::abs(cosine) < kParallel_rad) return PlaneSurface{to_eigen(line.Location()), axis};
  // Both lines in one plane: they meet in the apex. Skew lines make a hyperboloid.
  const Vector3d common = direction.cross(axis) / sine;
  if (std::abs(offset.dot(common)) > kMinTolerance_mm) return OtherSurface{};
  const double along_line = axis.cross(offset).dot(common) / sine;
  const Vector3d apex = to_eigen(line.Location()) + along_line * direction;
  return cone(apex, axis, std::atan2(sine, std::abs(cosine)), inside);
}

Surface revolved_circle(const gp_Circ& circle, const Vector3d& origin, const Vector3d& axis) {
  const Vector3d center = to_eigen(circle.Location());
  const Vector3d normal = to_eigen(circle.Axis().Direction());
  const Vector3d foot = origin + (center - origin).dot(axis) * axis;
  const double major_mm = (center - foot).norm();
  if (std::abs(normal.dot(axis)) > kParallel_rad) return OtherSurface{};
  if (std::abs((center - foot).dot(normal)) > kMinTolerance_mm) return OtherSurface{};
  if (major_mm < kMinTolerance_mm) return sphere(center, circle.Radius());
  return torus(foot, axis, major_mm, circle.Radius());
}

Surface revolution(const GeomAdaptor_Curve& profile, const gp_Ax1& axis, const Vector3d& inside) {
  const Vector3d origin = to_eigen(axis.Location());
  const Vector3d direction = to_eigen(axis.Direction());
  if (profile.GetType() == GeomAbs_Line) {
    return revolved_line(profile.Line(), origin, direction, inside);
  }
  if (profile.GetType() == GeomAbs_Circle) {
    return revolved_circle(profile.Circle(), origin, direction);
  }
  return OtherSurface{};
}

Surface flat_or_other(const SurfaceHandle& surface) {
  const GeomLib_IsPlanarSurface flatness(surface, kMinTolerance_mm);
  if (!flatness.IsPlanar()) return OtherSurface{};
  const gp_Pln plane = flatness.Plan();
  return PlaneSurface{to_eigen(plane.Location()), to_eigen(plane.Axis().Direction())};
}

Surface classify(const SurfaceHandle& surface, const Vector3d& inside) {
  const GeomAdaptor_Surface adaptor(surface);
  switch (adaptor.GetType()) {
    case GeomAbs_Plane: {
      const gp_Pln exact = adaptor.Plane();
      return PlaneSurface{to_eigen(exact.Location()), to_eigen(exact.Axis().Direction())};
    }
    case GeomAbs_Cylinder: {
      const gp_Cylinder exact = adaptor.Cylinder();
      return cylinder(to_eigen(exact.Location()), to_eigen(exact.Axis().Direction()),
                      exact.Radius());
    }
    case GeomAbs_Cone: {
      const gp_Cone exact = adaptor.Cone();
      return cone(to_eigen(exact.Apex()), to_eigen(exact.Axis().Direction()), exact.SemiAngle(),
                  inside);
    }
    case GeomAbs_Sphere: {
      const gp_Sphere exact = adaptor.Sphere();
      return sphere(to_eigen(exact.Location()), exact.Radius());
    }
    case GeomAbs_Torus: {
      const gp_Torus exact = adaptor.Torus();
      return torus(to_eigen(exact.Location()), to_eigen(exact.Axis().Direction()),
                   exact.MajorRadius(), exact.MinorRadius());
    }
    case GeomAbs_SurfaceOfExtrusion: {
      const auto swept = opencascade::handle<Geom_SurfaceOfLinearExtrusion>::DownCast(surface);
      return extrusion(GeomAdaptor_Curve(swept->BasisCurve()), to_eigen(swept->Direction()));
    }
    case GeomAbs_SurfaceOfRevolution: {
      const auto swept = opencascade::handle<Geom_SurfaceOfRevolution>::DownCast(surface);
      return revolution(GeomAdaptor_Curve(swept->BasisCurve()), swept->Axis(), inside);
    }
    case GeomAbs_BSplineSurface:
    case GeomAbs_BezierSurface:
      return flat_or_other(surface);
    default:
      return OtherSurface{};
  }
}

}  // namespace

Surface exact_surface(const TopoDS_Face& face, const Vector3d& inside) {
  const SurfaceHandle surface = unwrapped(BRep_Tool::Surface(face));
  if (surface.IsNull()) return OtherSurface{};
  return classify(surface, inside);
}

}  // namespace dowel
