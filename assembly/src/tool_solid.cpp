#include "tool_solid.h"

#include <cmath>
#include <numbers>

namespace dowel {
namespace {

constexpr std::uint32_t kSegments = 24;

/// Faces: bottom, top, wall.
FacetedSolid cylinder_solid(double radius_mm, double length_mm) {
  FacetedSolid solid;
  solid.solid_count = 1;
  for (const double z_mm : {0.0, length_mm}) {
    for (std::uint32_t i = 0; i < kSegments; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / kSegments;
      solid.vertices.emplace_back(radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad),
                                  z_mm);
    }
  }
  const auto add = [&](std::uint32_t face, const Triangle& triangle) {
    solid.triangles.push_back(triangle);
    solid.face_of.push_back(face);
  };
  for (std::uint32_t i = 0; i < kSegments; ++i) {
    const std::uint32_t next = (i + 1) % kSegments;
    if (i > 0 && i + 1 < kSegments) {
      add(0, {0, next, i});
      add(1, {kSegments, kSegments + i, kSegments + next});
    }
    add(2, {i, next, kSegments + next});
    add(2, {i, kSegments + next, kSegments + i});
  }
  const double area_mm2 = std::numbers::pi * radius_mm * radius_mm;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  solid.faces = {{PlaneSurface{Eigen::Vector3d::Zero(), -up}, false, 0.0, area_mm2, 0},
                 {PlaneSurface{length_mm * up, up}, false, 0.0, area_mm2, 0},
                 {CylinderSurface{Eigen::Vector3d::Zero(), up, radius_mm}, false,
                  radius_mm * (1.0 - std::cos(std::numbers::pi / kSegments)),
                  2.0 * std::numbers::pi * radius_mm * length_mm, 0}};
  for (const std::uint32_t end : {0U, 1U}) {
    const std::uint32_t first = end * kSegments;
    Edge rim;
    rim.faces = {end, 2};
    rim.convexity = Convexity::Convex;
    rim.curve = CurveKind::Circle;
    rim.closed = true;
    rim.length_mm = 2.0 * std::numbers::pi * radius_mm;
    rim.start = rim.end = solid.vertices[first];
    rim.center = end == 0 ? Eigen::Vector3d(0, 0, 0) : Eigen::Vector3d(length_mm * up);
    rim.axis = up;
    rim.radius_mm = radius_mm;
    solid.edges.push_back(rim);
  }
  return solid;
}

}  // namespace

std::shared_ptr<const CollisionElement> cylinder_model(double diameter_mm, double length_mm) {
  const double radius_mm = 0.5 * diameter_mm;
  Obb box;
  box.center = {0.0, 0.0, 0.5 * length_mm};
  box.half_extents_mm = {radius_mm, radius_mm, 0.5 * length_mm};
  return std::make_shared<const CollisionElement>(box, [radius_mm, length_mm] {
    return std::make_shared<const FacetedSolid>(cylinder_solid(radius_mm, length_mm));
  });
}

}  // namespace dowel
