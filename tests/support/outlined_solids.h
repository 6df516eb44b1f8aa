#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "dowel/kernel/faceted_solid.h"
#include "outline.h"
#include "solid_builder.h"

/// Solids that an outline of lines and arcs makes, turned about an axis or drawn out along it.
namespace dowel::testing {

/// How fine facets are.
struct Facets {
  std::uint32_t per_turn = 24;  ///< chords of a full circle about z, at least 3
  std::uint32_t per_arc = 4;    ///< chords of an arc of a profile that is revolved
  double phase_rad = 0.0;       ///< of the first vertex of each circle about z
};

namespace detail {

/// Corners of the polygon into which an outline is cut, and the first of each piece.
struct Chords {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::size_t> first;  ///< by piece, and the number of all behind the last
};

inline Chords cut_into_chords(const Outline& outline, std::uint32_t per_turn) {
  Chords result;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    result.first.push_back(result.points.size());
    result.points.push_back(outline[i].point());
    const OutlinePiece piece(outline, i);
    const double turns = std::abs(piece.sweep_rad) / (2.0 * std::numbers::pi);
    const int chords = std::max(1, static_cast<int>(std::ceil(turns * per_turn)));
    for (int k = 1; k < chords; ++k) {
      result.points.push_back(piece.on_arc(static_cast<double>(k) / chords));
    }
  }
  result.first.push_back(result.points.size());
  return result;
}

/// A polygon whose corners know which vertex they are: a bridge to a hole passes two of them twice.
struct BridgedPolygon {
  std::vector<Eigen::Vector2d> points;
  std::vector<std::uint32_t> vertices;
};

inline bool crosses(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& p,
                    const Eigen::Vector2d& q) {
  if (a == p || a == q || b == p || b == q) return false;
  return cross(p, q, a) * cross(p, q, b) <= 0.0 && cross(a, b, p) * cross(a, b, q) <= 0.0;
}

inline bool crosses_any(const std::vector<Eigen::Vector2d>& polygon, const Eigen::Vector2d& p,
                        const Eigen::Vector2d& q) {
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    if (crosses(polygon[i], polygon[(i + 1) % polygon.size()], p, q)) return true;
  }
  return false;
}

/// Joins `holes[index]` to the polygon by the shortest bridge that crosses nothing.
inline void bridge(BridgedPolygon& polygon, const std::vector<BridgedPolygon>& holes,
                   std::size_t index) {
  const BridgedPolygon& hole = holes[index];
  double shortest = std::numeric_limits<double>::infinity();
  std::pair<std::size_t, std::size_t> ends;
  for (std::size_t i = 0; i < polygon.points.size(); ++i) {
    for (std::size_t j = 0; j < hole.points.size(); ++j) {
      const double length = (polygon.points[i] - hole.points[j]).norm();
      if (length >= shortest || crosses_any(polygon.points, polygon.points[i], hole.points[j])) {
        continue;
      }
      const bool is_free = std::none_of(holes.begin(), holes.end(), [&](const BridgedPolygon& h) {
        return crosses_any(h.points, polygon.points[i], hole.points[j]);
      });
      if (!is_free) continue;
      shortest = length;
      ends = {i, j};
    }
  }
  BridgedPolygon joined;
  const auto add = [&](const BridgedPolygon& from, std::size_t i) {
    joined.points.push_back(from.points[i]);
    joined.vertices.push_back(from.vertices[i]);
  };
  for (std::size_t i = 0; i <= ends.first; ++i) add(polygon, i);
  for (std::size_t j = 0; j <= hole.points.size(); ++j) {
    add(hole, (ends.second + j) % hole.points.size());
  }
  for (std::size_t i = ends.first; i < polygon.points.size(); ++i) add(polygon, i);
  polygon = std::move(joined);
}

/// How well shaped an ear is, from 0 to 1; below 0 where the corner is none.
inline double ear_quality(const std::vector<Eigen::Vector2d>& points,
                          const std::vector<std::uint32_t>& left, const Triangle& ear) {
  const Eigen::Vector2d& a = points[ear[0]];
  const Eigen::Vector2d& b = points[ear[1]];
  const Eigen::Vector2d& c = points[ear[2]];
  const double area = cross(a, b, c);
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  if (area <= 1e-12 * longest) return -1.0;
  for (const std::uint32_t v : left) {
    const Eigen::Vector2d& p = points[v];
    if (p == a || p == b || p == c) continue;
    if (cross(a, b, p) >= 0.0 && cross(b, c, p) >= 0.0 && cross(c, a, p) >= 0.0) return -1.0;
  }
  return area / longest;
}

/// Triangles of a polygon, counter-clockwise, as indices into it: the best ear is cut off first.
/// O(n^3), for small ones.
inline std::vector<Triangle> ear_clip(const std::vector<Eigen::Vector2d>& points) {
  std::vector<std::uint32_t> left(points.size());
  for (std::uint32_t i = 0; i < left.size(); ++i) left[i] = i;
  std::vector<Triangle> result;
  while (left.size() >= 3) {
    const std::size_t n = left.size();
    double best = 0.0;
    std::size_t tip = n;
    const auto ear_at = [&](std::size_t i) {
      return Triangle{left[(i + n - 1) % n], left[i], left[(i + 1) % n]};
    };
    for (std::size_t i = 0; i < n; ++i) {
      const double quality = ear_quality(points, left, ear_at(i));
      if (quality <= best) continue;
      best = quality;
      tip = i;
    }
    if (tip == n) throw std::logic_error("the polygon is not simple and counter-clockwise");
    result.push_back(ear_at(tip));
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(tip));
  }
  return result;
}

inline Surface surface_of_wall(const OutlinePiece& piece) {
  const Eigen::Vector3d origin(piece.start.x(), piece.start.y(), 0.0);
  if (piece.is_arc()) {
    return CylinderSurface{
        {piece.center.x(), piece.center.y(), 0.0}, Eigen::Vector3d::UnitZ(), piece.radius_mm};
  }
  const Eigen::Vector2d along = piece.end - piece.start;
  return PlaneSurface{origin, Eigen::Vector3d(along.y(), -along.x(), 0.0).normalized()};
}

inline Surface revolved_surface(const OutlinePiece& piece) {
  const Eigen::Vector2d& a = piece.start;
  const Eigen::Vector2d& b = piece.end;
  if (piece.is_arc()) {
    const Eigen::Vector3d center(0.0, 0.0, piece.center.y());
    if (std::abs(piece.center.x()) < 1e-9 * piece.radius_mm) {
      return SphereSurface{center, piece.radius_mm};
    }
    return TorusSurface{center, Eigen::Vector3d::UnitZ(), piece.center.x(), piece.radius_mm};
  }
  if (a.y() == b.y()) {
    return PlaneSurface{{0.0, 0.0, a.y()}, {0.0, 0.0, b.x() > a.x() ? -1.0 : 1.0}};
  }
  if (a.x() == b.x()) {
    return CylinderSurface{{0.0, 0.0, a.y()}, Eigen::Vector3d::UnitZ(), a.x()};
  }
  const double slope = (b.x() - a.x()) / (b.y() - a.y());
  return ConeSurface{{0.0, 0.0, a.y() - a.x() / slope},
                     {0.0, 0.0, slope > 0.0 ? 1.0 : -1.0},
                     std::atan(std::abs(slope))};
}

inline double length_mm(const OutlinePiece& piece) {
  return piece.is_arc() ? piece.radius_mm * std::abs(piece.sweep_rad)
                        : (piece.end - piece.start).norm();
}

/// Walls of one outline of an extruded solid, with all edges at them. Vertices run along the
/// outline on the floor from `low`, on the ceiling from `high`.
inline void add_walls(Builder& builder, const Outline& outline, const Chords& chords,
                      std::uint32_t low, std::uint32_t high, double height_mm) {
  const std::size_t n = outline.size();
  const auto vertex_count = static_cast<std::uint32_t>(chords.points.size());
  std::vector<OutlinePiece> pieces;
  std::vector<std::uint32_t> walls;
  for (std::size_t i = 0; i < n; ++i) {
    const OutlinePiece& piece = pieces.emplace_back(outline, i);
    const std::uint32_t wall = walls.emplace_back(
        builder.face(surface_of_wall(piece), length_mm(piece) * height_mm, piece.sweep_rad < 0.0));
    for (auto v = static_cast<std::uint32_t>(chords.first[i]); v < chords.first[i + 1]; ++v) {
      const std::uint32_t w = (v + 1) % vertex_count;
      builder.quad(wall, low + v, low + w, high + w, high + v);
    }
    const auto from = static_cast<std::uint32_t>(chords.first[i]);
    const auto to = static_cast<std::uint32_t>(chords.first[i + 1]) % vertex_count;
    for (const std::uint32_t end : {0U, 1U}) {  // floor and ceiling are the first two faces
      const std::uint32_t base = end == 0 ? low : high;
      if (piece.is_arc()) {
        builder.arc_edge(end, wall, Convexity::Convex,
                         {piece.center.x(), piece.center.y(), end == 0 ? 0.0 : height_mm},
                         piece.radius_mm, length_mm(piece), base + from, base + to);
      } else {
        builder.line_edge(end, wall, Convexity::Convex, base + from, base + to);
      }
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    const Eigen::Vector2d corner = outline[i].point();
    const auto v = static_cast<std::uint32_t>(chords.first[i]);
    builder.line_edge(
        walls[before], walls[i],
        turn_convexity(pieces[before].tangent_at(corner), pieces[i].tangent_at(corner)), low + v,
        high + v);
  }
}

}  // namespace detail

/// Stands on z = 0 and rises to `height_mm`. `outlines`: first the outer one, counter-clockwise,
/// then holes in it, clockwise. Faces: bottom, top, then one for each piece of each outline.
inline FacetedSolid extruded(const std::vector<Outline>& outlines, double height_mm,
                             std::uint32_t facets_per_turn = 24) {
  detail::Builder builder;
  std::vector<detail::Chords> chords;
  std::vector<std::uint32_t> low;
  std::vector<std::uint32_t> high;
  std::vector<detail::BridgedPolygon> floors;
  for (const Outline& outline : outlines) {
    const std::vector<Eigen::Vector2d>& points =
        chords.emplace_back(detail::cut_into_chords(outline, facets_per_turn)).points;
    detail::BridgedPolygon& floor = floors.emplace_back();
    floor.points = points;
    for (const Eigen::Vector2d& p : points) {
      floor.vertices.push_back(builder.vertex({p.x(), p.y(), 0.0}));
    }
    low.push_back(floor.vertices.front());
    for (const Eigen::Vector2d& p : points) builder.vertex({p.x(), p.y(), height_mm});
    high.push_back(low.back() + static_cast<std::uint32_t>(points.size()));
  }

  detail::BridgedPolygon polygon = floors.front();
  std::vector<std::uint32_t> rise;  // by vertex of the floor, to the one above it
  for (std::size_t i = 1; i < floors.size(); ++i) detail::bridge(polygon, floors, i);
  const std::vector<Triangle> triangles = detail::ear_clip(polygon.points);
  double area_mm2 = 0.0;
  for (const Triangle& t : triangles) {
    area_mm2 +=
        0.5 * detail::cross(polygon.points[t[0]], polygon.points[t[1]], polygon.points[t[2]]);
  }
  const std::uint32_t bottom =
      builder.face(PlaneSurface{builder.position(low[0]), -Eigen::Vector3d::UnitZ()}, area_mm2);
  const std::uint32_t top =
      builder.face(PlaneSurface{builder.position(high[0]), Eigen::Vector3d::UnitZ()}, area_mm2);
  rise.resize(high.back());
  for (std::size_t i = 0; i < floors.size(); ++i) {
    for (const std::uint32_t v : floors[i].vertices) rise[v] = v - low[i] + high[i];
  }
  for (const Triangle& t : triangles) {
    const std::uint32_t a = polygon.vertices[t[0]];
    const std::uint32_t b = polygon.vertices[t[1]];
    const std::uint32_t c = polygon.vertices[t[2]];
    builder.triangle(bottom, a, c, b);
    builder.triangle(top, rise[a], rise[b], rise[c]);
  }
  for (std::size_t i = 0; i < outlines.size(); ++i) {
    detail::add_walls(builder, outlines[i], chords[i], low[i], high[i], height_mm);
  }
  return builder.finish();
}

namespace detail {

/// Of the face that a piece of a profile makes. Source: Pappus's centroid theorem.
inline double revolved_area_mm2(const OutlinePiece& piece) {
  double centroid_x = 0.5 * (piece.start.x() + piece.end.x());
  if (piece.is_arc()) {
    const double half = 0.5 * std::abs(piece.sweep_rad);
    centroid_x =
        piece.center.x() + piece.radius_mm * std::sin(half) / half * piece.middle_direction.x();
  }
  return 2.0 * std::numbers::pi * centroid_x * length_mm(piece);
}

/// Vertices of the circle that a point of a profile makes about z: one on the axis.
inline std::vector<std::uint32_t> circle_of(Builder& builder, const Eigen::Vector2d& p,
                                            const Facets& facets) {
  if (p.x() == 0.0) return {builder.vertex({0.0, 0.0, p.y()})};
  return builder.ring(Eigen::Vector2d::Zero(), p.y(), p.x(), facets.per_turn, facets.phase_rad);
}

}  // namespace detail

/// Body of revolution about z. `profile`: radius and height, x >= 0, counter-clockwise; a sphere is
/// an arc from the axis to the axis. One face for each piece of it, pieces along the axis excepted,
/// in order.
inline FacetedSolid revolved_outline(const Outline& profile, const Facets& facets = {}) {
  detail::Builder builder;
  const std::size_t n = profile.size();
  std::vector<std::vector<std::uint32_t>> circles;
  std::vector<OutlinePiece> pieces;
  for (std::size_t i = 0; i < n; ++i) {
    circles.push_back(detail::circle_of(builder, profile[i].point(), facets));
    pieces.emplace_back(profile, i);
  }
  constexpr std::uint32_t kNoFace = ~std::uint32_t{0};
  std::vector<std::uint32_t> faces(n, kNoFace);
  for (std::size_t i = 0; i < n; ++i) {
    const OutlinePiece& piece = pieces[i];
    if (!piece.is_arc() && piece.start.x() == 0.0 && piece.end.x() == 0.0) continue;
    const Surface surface = detail::revolved_surface(piece);
    const bool is_reversed = piece.is_arc() ? piece.sweep_rad < 0.0
                                            : !is_plane(surface) && piece.end.y() < piece.start.y();
    faces[i] = builder.face(surface, detail::revolved_area_mm2(piece), is_reversed);
    std::vector<std::uint32_t> from = circles[i];
    for (std::uint32_t k = 1; piece.is_arc() && k < facets.per_arc; ++k) {
      std::vector<std::uint32_t> to =
          detail::circle_of(builder, piece.on_arc(static_cast<double>(k) / facets.per_arc), facets);
      builder.band(faces[i], from, to);
      from = std::move(to);
    }
    builder.band(faces[i], from, circles[(i + 1) % n]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t before = (i + n - 1) % n;
    if (profile[i].x == 0.0 || faces[before] == kNoFace || faces[i] == kNoFace) continue;
    const Eigen::Vector2d p = profile[i].point();
    const Convexity convexity =
        detail::turn_convexity(pieces[before].tangent_at(p), pieces[i].tangent_at(p));
    builder.circle_edge(faces[before], faces[i], convexity, {0.0, 0.0, profile[i].y}, profile[i].x,
                        circles[i][0]);
  }
  return builder.finish();
}

}  // namespace dowel::testing
