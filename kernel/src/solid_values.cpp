#include "solid_values.h"

#include <cmath>
#include <numbers>
#include <string_view>

#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

bool is_unit(const Eigen::Vector3d& v) {
  // Written so that NaN fails.
  return std::abs(v.squaredNorm() - 1.0) <= 2.0 * kUnitVectorSlack;
}

bool is_size(double value) {
  return std::isfinite(value) && value > 0.0;
}

bool is_measure(double value) {
  return std::isfinite(value) && value >= 0.0;
}

/// What is wrong with a surface's parameters; empty where nothing is.
struct SurfaceComplaint {
  std::string_view operator()(const OtherSurface&) const { return {}; }
  std::string_view operator()(const PlaneSurface& s) const {
    if (!s.origin.allFinite()) return "a plane without a finite origin";
    if (!is_unit(s.normal)) return "a plane whose normal is not of unit length";
    return {};
  }
  std::string_view operator()(const CylinderSurface& s) const {
    if (!s.origin.allFinite()) return "a cylinder without a finite origin";
    if (!is_unit(s.axis)) return "a cylinder whose axis is not of unit length";
    if (!is_size(s.radius_mm)) return "a cylinder without a positive radius";
    return {};
  }
  std::string_view operator()(const ConeSurface& s) const {
    if (!s.apex.allFinite()) return "a cone without a finite apex";
    if (!is_unit(s.axis)) return "a cone whose axis is not of unit length";
    if (!(s.half_angle_rad > 0.0 && s.half_angle_rad < 0.5 * std::numbers::pi)) {
      return "a cone whose half angle is not between 0 and 90 degrees";
    }
    return {};
  }
  std::string_view operator()(const SphereSurface& s) const {
    if (!s.center.allFinite()) return "a sphere without a finite centre";
    if (!is_size(s.radius_mm)) return "a sphere without a positive radius";
    return {};
  }
  std::string_view operator()(const TorusSurface& s) const {
    if (!s.center.allFinite()) return "a torus without a finite centre";
    if (!is_unit(s.axis)) return "a torus whose axis is not of unit length";
    if (!is_size(s.minor_radius_mm) || !is_size(s.major_radius_mm) ||
        s.minor_radius_mm >= s.major_radius_mm) {
      return "a torus whose radii are not 0 < minor < major";
    }
    return {};
  }
};

std::optional<std::string> find_bad_vertex(const FacetedSolid& solid) {
  for (std::size_t i = 0; i < solid.vertices.size(); ++i) {
    const Eigen::Vector3d& v = solid.vertices[i];
    if (!v.allFinite()) return "vertex " + std::to_string(i) + " is not finite";
    if (v.cwiseAbs().maxCoeff() > kMaxCoordinate_mm) {
      return "vertex " + std::to_string(i) + " is more than " +
             std::to_string(static_cast<int>(kMaxCoordinate_mm)) + " mm from the origin";
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_bad_triangle(const FacetedSolid& solid) {
  if (solid.face_of.size() != solid.triangles.size()) {
    return std::to_string(solid.triangles.size()) + " triangles have " +
           std::to_string(solid.face_of.size()) + " face indices, expected one each";
  }
  for (std::size_t i = 0; i < solid.triangles.size(); ++i) {
    const Triangle& t = solid.triangles[i];
    for (const std::uint32_t v : t) {
      if (v >= solid.vertices.size()) {
        return "triangle " + std::to_string(i) + " names vertex " + std::to_string(v) + " of " +
               std::to_string(solid.vertices.size());
      }
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      return "triangle " + std::to_string(i) + " has two equal vertices";
    }
    if (solid.face_of[i] >= solid.faces.size()) {
      return "triangle " + std::to_string(i) + " names face " + std::to_string(solid.face_of[i]) +
             " of " + std::to_string(solid.faces.size());
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_bad_face(const FacetedSolid& solid) {
  for (std::size_t i = 0; i < solid.faces.size(); ++i) {
    const Face& face = solid.faces[i];
    const std::string name = "face " + std::to_string(i);
    const std::string_view complaint = std::visit(SurfaceComplaint{}, face.surface);
    if (!complaint.empty()) return name + " lies on " + std::string(complaint);
    if (!is_measure(face.facet_error_mm)) return name + " has no finite facet error";
    if (!is_measure(face.area_mm2)) return name + " has no finite area";
    if (face.solid >= solid.solid_count) {
      return name + " names solid " + std::to_string(face.solid) + " of " +
             std::to_string(solid.solid_count);
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_bad_edge(const FacetedSolid& solid) {
  for (std::size_t i = 0; i < solid.edges.size(); ++i) {
    const Edge& edge = solid.edges[i];
    const std::string name = "face edge " + std::to_string(i);
    if (edge.faces[0] >= edge.faces[1] || edge.faces[1] >= solid.faces.size()) {
      return name + " is between faces " + std::to_string(edge.faces[0]) + " and " +
             std::to_string(edge.faces[1]) + ", expected first < second < " +
             std::to_string(solid.faces.size());
    }
    if (!is_measure(edge.length_mm) || !edge.start.allFinite() || !edge.end.allFinite() ||
        !edge.center.allFinite()) {
      return name + " is not finite";
    }
    if (edge.curve == CurveKind::Circle ? !is_unit(edge.axis) || !is_size(edge.radius_mm)
                                        : !edge.axis.allFinite() || !is_measure(edge.radius_mm)) {
      return name + " has no sound axis and radius";
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> find_bad_value(const FacetedSolid& solid) {
  if (auto defect = find_bad_vertex(solid)) return defect;
  if (auto defect = find_bad_triangle(solid)) return defect;
  if (auto defect = find_bad_face(solid)) return defect;
  return find_bad_edge(solid);
}

}  // namespace dowel
