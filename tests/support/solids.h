#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "dowel/kernel/faceted_solid.h"
#include "dowel/kernel/pose.h"
#include "outlined_solids.h"
#include "plate_with_holes.h"
#include "random_geometry.h"
#include "solid_builder.h"

/// Solids for tests: welded, closed, outward, with exact faces, edges and measured facet errors.
/// Every vertex lies on the exact surfaces of its faces within a few ulp. Prisms and plates stand
/// on z = 0; bodies of revolution have the z axis as theirs.
namespace dowel::testing {

/// Stands on z = 0 and rises to `height_mm`. `polygon`: simple, counter-clockwise, no straight
/// angles; T-slots and dovetails are such polygons. Faces: bottom, top, then one for each side.
inline FacetedSolid prism(const std::vector<Eigen::Vector2d>& polygon, double height_mm) {
  return extruded({straight_outline(polygon)}, height_mm);
}

/// Body of revolution about z. `profile`: points (r, z) with the material on the left; from the
/// axis to the axis, or closed (a tube) where it does not touch it. One face for each piece of it,
/// pieces along the axis excepted, in order.
inline FacetedSolid revolved(const std::vector<Eigen::Vector2d>& profile, std::uint32_t segments,
                             double phase_rad = 0.0) {
  return revolved_outline(straight_outline(profile),
                          {.per_turn = segments, .phase_rad = phase_rad});
}

inline FacetedSolid transformed(const Pose& X_WB, FacetedSolid solid) {
  const Eigen::Quaterniond& turn = X_WB.rotation();
  for (Eigen::Vector3d& p : solid.vertices) p = X_WB * p;
  for (Face& face : solid.faces) face.surface = dowel::transformed(X_WB, face.surface);
  for (Edge& edge : solid.edges) {
    edge.start = X_WB * edge.start;
    edge.end = X_WB * edge.end;
    if (edge.curve != CurveKind::Circle) continue;
    edge.center = X_WB * edge.center;
    edge.axis = turn * edge.axis;
  }
  return solid;
}

/// Both in one element. `b` keeps solids of its own, numbered after those of `a`.
inline FacetedSolid merged(FacetedSolid a, const FacetedSolid& b) {
  const auto vertex_offset = static_cast<std::uint32_t>(a.vertices.size());
  const auto face_offset = static_cast<std::uint32_t>(a.faces.size());
  a.vertices.insert(a.vertices.end(), b.vertices.begin(), b.vertices.end());
  for (const Triangle& t : b.triangles) {
    a.triangles.push_back({t[0] + vertex_offset, t[1] + vertex_offset, t[2] + vertex_offset});
  }
  for (const std::uint32_t face : b.face_of) a.face_of.push_back(face + face_offset);
  a.faces.insert(a.faces.end(), b.faces.begin(), b.faces.end());
  for (std::size_t f = face_offset; f < a.faces.size(); ++f) a.faces[f].solid += a.solid_count;
  for (Edge edge : b.edges) {
    edge.faces = {edge.faces[0] + face_offset, edge.faces[1] + face_offset};
    a.edges.push_back(edge);
  }
  a.solid_count += b.solid_count;
  return a;
}

/// Inside out: material where there was none.
inline FacetedSolid inverted(FacetedSolid solid) {
  for (Triangle& t : solid.triangles) std::swap(t[1], t[2]);
  for (Face& face : solid.faces) {
    if (auto* plane = std::get_if<PlaneSurface>(&face.surface)) {
      plane->normal = -plane->normal;
    } else if (!std::holds_alternative<OtherSurface>(face.surface)) {
      face.reversed = !face.reversed;
    }
  }
  for (Edge& edge : solid.edges) {
    if (edge.convexity == Convexity::Convex) {
      edge.convexity = Convexity::Concave;
    } else if (edge.convexity == Convexity::Concave) {
      edge.convexity = Convexity::Convex;
    }
  }
  return solid;
}

/// `outer` with a closed cavity of the shape of `inner`, which must lie inside it: one solid.
inline FacetedSolid hollowed(const FacetedSolid& outer, const FacetedSolid& inner) {
  FacetedSolid result = merged(outer, inverted(inner));
  for (Face& face : result.faces) face.solid = 0;
  result.solid_count = 1;
  return result;
}

/// 12 triangles. Faces: -z, +z, -y, +x, +y, -x.
inline FacetedSolid box(const Eigen::Vector3d& size,
                        const Eigen::Vector3d& center = Eigen::Vector3d::Zero()) {
  const double x = 0.5 * size.x();
  const double y = 0.5 * size.y();
  return transformed(Pose::from_translation(center - Eigen::Vector3d(0.0, 0.0, 0.5 * size.z())),
                     prism({{-x, -y}, {x, -y}, {x, y}, {-x, y}}, size.z()));
}

/// Stands on z = 0. Faces: bottom, wall, top.
inline FacetedSolid cylinder(double radius_mm, double height_mm, std::uint32_t segments,
                             double phase_rad = 0.0) {
  return revolved({{0.0, 0.0}, {radius_mm, 0.0}, {radius_mm, height_mm}, {0.0, height_mm}},
                  segments, phase_rad);
}

/// Stands on z = 0. Faces: bottom, outer wall, top, inner wall.
inline FacetedSolid tube(double inner_radius_mm, double outer_radius_mm, double height_mm,
                         std::uint32_t segments, double phase_rad = 0.0) {
  return revolved({{inner_radius_mm, 0.0},
                   {outer_radius_mm, 0.0},
                   {outer_radius_mm, height_mm},
                   {inner_radius_mm, height_mm}},
                  segments, phase_rad);
}

/// Stands on z = 0, tip at the top. Faces: bottom, flank.
inline FacetedSolid cone(double radius_mm, double height_mm, std::uint32_t segments,
                         double phase_rad = 0.0) {
  return revolved({{0.0, 0.0}, {radius_mm, 0.0}, {0.0, height_mm}}, segments, phase_rad);
}

/// Cylinders {radius, length} stacked along z from z = 0. Neighbours must differ in radius.
inline FacetedSolid stepped_pin(const std::vector<std::pair<double, double>>& steps,
                                std::uint32_t segments, double phase_rad = 0.0) {
  std::vector<Eigen::Vector2d> profile{{0.0, 0.0}};
  double z = 0.0;
  for (const auto& [radius_mm, length_mm] : steps) {
    profile.emplace_back(radius_mm, z);
    z += length_mm;
    profile.emplace_back(radius_mm, z);
  }
  profile.emplace_back(0.0, z);
  return revolved(profile, segments, phase_rad);
}

/// A bar along z of triangular section: the edge of `angle_rad` (below pi) is the z axis, its two
/// flanks are `flank_mm` wide, one of them in the plane y = 0.
inline FacetedSolid wedge(double angle_rad, double flank_mm, double height_mm) {
  return prism({{0.0, 0.0},
                {flank_mm, 0.0},
                {flank_mm * std::cos(angle_rad), flank_mm * std::sin(angle_rad)}},
               height_mm);
}

/// Around the origin: `segments` meridians, half as many parallels. One face, no edges.
inline FacetedSolid sphere(double radius_mm, std::uint32_t segments) {
  return revolved_outline({{0.0, -radius_mm, std::numbers::pi}, {0.0, radius_mm}},
                          {.per_turn = segments, .per_arc = std::max(2U, segments / 2)});
}

/// A ring about the z axis: `segments` about it, `tube_segments` about the tube, from `phase_rad`
/// on (0: from the outmost circle). One face, no edges.
inline FacetedSolid torus(double major_radius_mm, double minor_radius_mm, std::uint32_t segments,
                          std::uint32_t tube_segments, double phase_rad = 0.0) {
  detail::Builder builder;
  std::vector<std::vector<std::uint32_t>> rings;
  for (std::uint32_t i = 0; i < tube_segments; ++i) {
    const double angle = phase_rad + 2.0 * std::numbers::pi * i / tube_segments;
    rings.push_back(builder.ring(Eigen::Vector2d::Zero(), minor_radius_mm * std::sin(angle),
                                 major_radius_mm + minor_radius_mm * std::cos(angle), segments,
                                 0.0));
  }
  const std::uint32_t face =
      builder.face(TorusSurface{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), major_radius_mm,
                                minor_radius_mm},
                   4.0 * std::numbers::pi * std::numbers::pi * major_radius_mm * minor_radius_mm);
  for (std::size_t i = 0; i < rings.size(); ++i) {
    builder.band(face, rings[i], rings[(i + 1) % rings.size()]);
  }
  return builder.finish();
}

}  // namespace dowel::testing
