#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "dowel/kernel/faceted_solid.h"
#include "dowel/kernel/pose.h"
#include "plate_with_holes.h"
#include "random_geometry.h"
#include "solid_builder.h"

/// Solids for tests: welded, closed, outward, with exact faces, edges and measured facet errors.
/// Every vertex lies on the exact surfaces of its faces within a few ulp. Prisms and plates stand
/// on z = 0; bodies of revolution have the z axis as theirs.
namespace dowel::testing {

namespace detail {

/// Triangles of a simple polygon, counter-clockwise, as indices into it. O(n^3), for small ones.
inline std::vector<Triangle> ear_clip(const std::vector<Eigen::Vector2d>& polygon) {
  std::vector<std::uint32_t> left(polygon.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<Triangle> result;
  while (left.size() >= 3) {
    const std::size_t n = left.size();
    std::size_t ear = n;
    for (std::size_t i = 0; i < n && ear == n; ++i) {
      const Triangle t{left[(i + n - 1) % n], left[i], left[(i + 1) % n]};
      if (cross(polygon[t[0]], polygon[t[1]], polygon[t[2]]) <= 0.0) continue;
      const bool is_empty = std::none_of(left.begin(), left.end(), [&](std::uint32_t v) {
        if (v == t[0] || v == t[1] || v == t[2]) return false;
        return cross(polygon[t[0]], polygon[t[1]], polygon[v]) >= 0.0 &&
               cross(polygon[t[1]], polygon[t[2]], polygon[v]) >= 0.0 &&
               cross(polygon[t[2]], polygon[t[0]], polygon[v]) >= 0.0;
      });
      if (is_empty) ear = i;
    }
    if (ear == n) throw std::logic_error("the polygon is not simple and counter-clockwise");
    result.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  return result;
}

}  // namespace detail

/// Stands on z = 0 and rises to `height_mm`. `polygon`: simple, counter-clockwise, no straight
/// angles; T-slots and dovetails are such polygons. Faces: bottom, top, then one for each side.
inline FacetedSolid prism(const std::vector<Eigen::Vector2d>& polygon, double height_mm) {
  detail::Builder builder;
  std::vector<std::uint32_t> low;
  std::vector<std::uint32_t> high;
  low.reserve(polygon.size());
  high.reserve(polygon.size());
  for (const Eigen::Vector2d& p : polygon) low.push_back(builder.vertex({p.x(), p.y(), 0.0}));
  for (const Eigen::Vector2d& p : polygon) {
    high.push_back(builder.vertex({p.x(), p.y(), height_mm}));
  }

  const std::vector<Triangle> triangles = detail::ear_clip(polygon);
  double area_mm2 = 0.0;
  for (const Triangle& t : triangles) {
    area_mm2 += 0.5 * detail::cross(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
  }
  const std::uint32_t bottom =
      builder.face(PlaneSurface{builder.position(low[0]), -Eigen::Vector3d::UnitZ()}, area_mm2);
  const std::uint32_t top =
      builder.face(PlaneSurface{builder.position(high[0]), Eigen::Vector3d::UnitZ()}, area_mm2);
  for (const Triangle& t : triangles) {
    builder.triangle(bottom, low[t[0]], low[t[2]], low[t[1]]);
    builder.triangle(top, high[t[0]], high[t[1]], high[t[2]]);
  }

  const std::size_t n = polygon.size();
  std::vector<std::uint32_t> sides(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    const Eigen::Vector2d along = polygon[j] - polygon[i];
    const Eigen::Vector3d normal = Eigen::Vector3d(along.y(), -along.x(), 0.0).normalized();
    sides[i] =
        builder.face(PlaneSurface{builder.position(low[i]), normal}, along.norm() * height_mm);
    builder.quad(sides[i], low[i], low[j], high[j], high[i]);
    builder.line_edge(bottom, sides[i], Convexity::Convex, low[i], low[j]);
    builder.line_edge(top, sides[i], Convexity::Convex, high[i], high[j]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    const Convexity convexity =
        detail::turn_convexity(polygon[i] - polygon[before], polygon[(i + 1) % n] - polygon[i]);
    builder.line_edge(sides[before], sides[i], convexity, low[i], high[i]);
  }
  return builder.finish();
}

namespace detail {

/// What the piece of a profile from `a` to `b`, points (r, z), makes about the z axis.
inline Surface surface_of_piece(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  if (a.y() == b.y())
    return PlaneSurface{{0.0, 0.0, a.y()}, {0.0, 0.0, b.x() > a.x() ? -1.0 : 1.0}};
  if (a.x() == b.x()) return CylinderSurface{{0.0, 0.0, a.y()}, Eigen::Vector3d::UnitZ(), a.x()};
  const double slope = (b.x() - a.x()) / (b.y() - a.y());
  return ConeSurface{{0.0, 0.0, a.y() - a.x() / slope},
                     {0.0, 0.0, slope > 0.0 ? 1.0 : -1.0},
                     std::atan(std::abs(slope))};
}

}  // namespace detail

/// The half-plane outline of a body of revolution, turned about z. `profile`: points (r, z) with
/// the material on the left; from the axis to the axis, or closed (a tube) where it does not touch
/// it. One face for each piece of it, pieces along the axis excepted, in order.
inline FacetedSolid revolved(const std::vector<Eigen::Vector2d>& profile, std::uint32_t segments,
                             double phase_rad = 0.0) {
  detail::Builder builder;
  const std::size_t n = profile.size();
  std::vector<std::vector<std::uint32_t>> rings(n);
  for (std::size_t i = 0; i < n; ++i) {
    const double r = profile[i].x();
    const double z = profile[i].y();
    if (r > 0.0) {
      rings[i] = builder.ring(Eigen::Vector2d::Zero(), z, r, segments, phase_rad);
    } else {
      rings[i] = {builder.vertex({0.0, 0.0, z})};
    }
  }

  constexpr std::uint32_t kNoFace = ~std::uint32_t{0};
  std::vector<std::uint32_t> faces(n, kNoFace);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    const Eigen::Vector2d& a = profile[i];
    const Eigen::Vector2d& b = profile[j];
    if (a.x() == 0.0 && b.x() == 0.0) continue;
    const double area_mm2 = std::numbers::pi * (a.x() + b.x()) * (b - a).norm();
    const Surface surface = detail::surface_of_piece(a, b);
    faces[i] = builder.face(surface, area_mm2, !is_plane(surface) && b.y() < a.y());
    builder.band(faces[i], rings[i], rings[j]);
  }

  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    if (profile[i].x() == 0.0 || faces[before] == kNoFace || faces[i] == kNoFace) continue;
    const Convexity convexity =
        detail::turn_convexity(profile[i] - profile[before], profile[(i + 1) % n] - profile[i]);
    builder.circle_edge(faces[before], faces[i], convexity, {0.0, 0.0, profile[i].y()},
                        profile[i].x(), rings[i][0]);
  }
  return builder.finish();
}

/// The same, from the axis to the axis, with the right angle at point `corner` rounded by a torus
/// of `bands` rows of facets. Without edges.
inline FacetedSolid revolved_with_fillet(const std::vector<Eigen::Vector2d>& profile,
                                         std::size_t corner, double radius_mm, std::uint32_t bands,
                                         std::uint32_t segments) {
  detail::Builder builder;
  const auto ring = [&](const Eigen::Vector2d& p) {
    return p.x() > 0.0 ? builder.ring(Eigen::Vector2d::Zero(), p.y(), p.x(), segments, 0.0)
                       : std::vector<std::uint32_t>{builder.vertex({0.0, 0.0, p.y()})};
  };
  const Eigen::Vector2d in = radius_mm * (profile[corner - 1] - profile[corner]).normalized();
  const Eigen::Vector2d out = radius_mm * (profile[corner + 1] - profile[corner]).normalized();
  const Eigen::Vector2d center = profile[corner] + in + out;
  const TorusSurface torus{{0.0, 0.0, center.y()}, Eigen::Vector3d::UnitZ(), center.x(), radius_mm};
  std::vector<std::uint32_t> last = ring(profile.front());
  Eigen::Vector2d from = profile.front();
  const auto go_to = [&](const Eigen::Vector2d& p) {
    const Surface surface = detail::surface_of_piece(from, p);
    const std::vector<std::uint32_t> next = ring(p);
    builder.band(builder.face(surface, std::numbers::pi * (from + p).x() * (p - from).norm(),
                              !is_plane(surface) && p.y() < from.y()),
                 last, next);
    last = next;
    from = p;
  };
  for (std::size_t i = 1; i < profile.size(); ++i) {
    if (i != corner) {
      go_to(profile[i]);
      continue;
    }
    go_to(profile[corner] + in);
    const bool is_reversed = in.x() * out.y() - in.y() * out.x() > 0.0;
    const double area_mm2 = std::numbers::pi * std::numbers::pi * center.x() * radius_mm;
    const std::uint32_t face = builder.face(torus, area_mm2, is_reversed);
    for (std::uint32_t k = 1; k <= bands; ++k) {
      const double angle = 0.5 * std::numbers::pi * k / bands;
      from = k < bands ? Eigen::Vector2d(center - std::sin(angle) * in - std::cos(angle) * out)
                       : Eigen::Vector2d(profile[corner] + out);
      const std::vector<std::uint32_t> next = ring(from);
      builder.band(face, last, next);
      last = next;
    }
  }
  return builder.finish();
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
  detail::Builder builder;
  const std::uint32_t parallels = std::max(2U, segments / 2);
  std::vector<std::vector<std::uint32_t>> rings{{builder.vertex({0.0, 0.0, -radius_mm})}};
  for (std::uint32_t i = 1; i < parallels; ++i) {
    const double latitude = std::numbers::pi * (static_cast<double>(i) / parallels - 0.5);
    rings.push_back(builder.ring(Eigen::Vector2d::Zero(), radius_mm * std::sin(latitude),
                                 radius_mm * std::cos(latitude), segments, 0.0));
  }
  rings.push_back({builder.vertex({0.0, 0.0, radius_mm})});
  const std::uint32_t face = builder.face(SphereSurface{Eigen::Vector3d::Zero(), radius_mm},
                                          4.0 * std::numbers::pi * radius_mm * radius_mm);
  for (std::size_t i = 0; i + 1 < rings.size(); ++i) builder.band(face, rings[i], rings[i + 1]);
  return builder.finish();
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
