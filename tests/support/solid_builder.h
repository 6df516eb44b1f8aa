#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

#include "dowel/kernel/faceted_solid.h"

namespace dowel::testing {

namespace detail {

inline constexpr double kSmoothAngle_rad = std::numbers::pi / 180.0;

/// How two faces meet whose outlines, with the material on the left, turn from `in` to `out`.
inline Convexity turn_convexity(const Eigen::Vector2d& in, const Eigen::Vector2d& out) {
  const double angle_rad = std::atan2(in.x() * out.y() - in.y() * out.x(), in.dot(out));
  if (std::abs(angle_rad) <= kSmoothAngle_rad) return Convexity::Smooth;
  return angle_rad > 0.0 ? Convexity::Convex : Convexity::Concave;
}

inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Appends vertices, triangles, faces and edges to a solid.
class Builder {
 public:
  Builder() { solid_.solid_count = 1; }

  std::uint32_t vertex(const Eigen::Vector3d& p) {
    solid_.vertices.push_back(p);
    return static_cast<std::uint32_t>(solid_.vertices.size() - 1);
  }

  /// One vertex for each corner of the regular polygon, counter-clockwise seen from +z.
  std::vector<std::uint32_t> ring(const Eigen::Vector2d& center, double z, double radius,
                                  std::uint32_t segments, double phase_rad) {
    std::vector<std::uint32_t> result(segments);
    for (std::uint32_t i = 0; i < segments; ++i) {
      const double angle = phase_rad + 2.0 * std::numbers::pi * i / segments;
      result[i] =
          vertex({center.x() + radius * std::cos(angle), center.y() + radius * std::sin(angle), z});
    }
    return result;
  }

  std::uint32_t face(const Surface& surface, double area_mm2, bool reversed = false) {
    solid_.faces.push_back({surface, reversed, 0.0, area_mm2, 0});
    return static_cast<std::uint32_t>(solid_.faces.size() - 1);
  }

  void triangle(std::uint32_t face_index, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    solid_.triangles.push_back({a, b, c});
    solid_.face_of.push_back(face_index);
  }

  /// Two triangles; a, b, c, d run counter-clockwise.
  void quad(std::uint32_t face_index, std::uint32_t a, std::uint32_t b, std::uint32_t c,
            std::uint32_t d) {
    triangle(face_index, a, b, c);
    triangle(face_index, a, c, d);
  }

  /// Facets between two loops that run the same way; a loop of one vertex is a tip.
  void band(std::uint32_t face_index, const std::vector<std::uint32_t>& from,
            const std::vector<std::uint32_t>& to) {
    const std::size_t n = std::max(from.size(), to.size());
    for (std::size_t i = 0; i < n; ++i) {
      const std::size_t j = (i + 1) % n;
      if (from.size() == 1) {
        triangle(face_index, from[0], to[j], to[i]);
      } else if (to.size() == 1) {
        triangle(face_index, from[i], from[j], to[0]);
      } else {
        quad(face_index, from[i], from[j], to[j], to[i]);
      }
    }
  }

  void line_edge(std::uint32_t f, std::uint32_t g, Convexity convexity, std::uint32_t start,
                 std::uint32_t end) {
    Edge edge;
    edge.faces = {std::min(f, g), std::max(f, g)};
    edge.convexity = convexity;
    edge.curve = CurveKind::Line;
    edge.start = solid_.vertices[start];
    edge.end = solid_.vertices[end];
    edge.length_mm = (edge.end - edge.start).norm();
    solid_.edges.push_back(edge);
  }

  void circle_edge(std::uint32_t f, std::uint32_t g, Convexity convexity,
                   const Eigen::Vector3d& center, double radius, std::uint32_t start) {
    arc_edge(f, g, convexity, center, radius, 2.0 * std::numbers::pi * radius, start, start);
  }

  /// About z; closed where it starts and ends at one vertex.
  void arc_edge(std::uint32_t f, std::uint32_t g, Convexity convexity,
                const Eigen::Vector3d& center, double radius, double length, std::uint32_t start,
                std::uint32_t end) {
    Edge edge;
    edge.faces = {std::min(f, g), std::max(f, g)};
    edge.convexity = convexity;
    edge.curve = CurveKind::Circle;
    edge.closed = start == end;
    edge.length_mm = length;
    edge.start = solid_.vertices[start];
    edge.end = solid_.vertices[end];
    edge.center = center;
    edge.axis = Eigen::Vector3d::UnitZ();
    edge.radius_mm = radius;
    solid_.edges.push_back(edge);
  }

  const Eigen::Vector3d& position(std::uint32_t index) const { return solid_.vertices[index]; }

  Eigen::Vector2d flat(std::uint32_t index) const { return position(index).head<2>(); }

  /// The solid, with the facet error of each face.
  FacetedSolid finish() {
    measure_facet_errors();
    return std::move(solid_);
  }

 private:
  void measure_facet_errors() {
    for (std::uint32_t t = 0; t < solid_.triangles.size(); ++t) {
      Face& face = solid_.faces[solid_.face_of[t]];
      if (is_plane(face.surface) || std::holds_alternative<OtherSurface>(face.surface)) continue;
      face.facet_error_mm =
          std::max(face.facet_error_mm, facet_error_mm(face.surface, solid_.corners(t)));
    }
  }

  /// On the sphere the facet's plane bounds it; elsewhere the worst point lies on a chord or
  /// inside, and a lattice that holds the midpoints of the edges finds it.
  static double facet_error_mm(const Surface& surface,
                               const std::array<Eigen::Vector3d, 3>& corners) {
    if (const auto* sphere = std::get_if<SphereSurface>(&surface)) {
      const Eigen::Vector3d normal =
          (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
      return sphere->radius_mm - std::abs(normal.dot(corners[0] - sphere->center));
    }
    constexpr int kSteps = 8;
    double error = 0.0;
    for (int i = 0; i <= kSteps; ++i) {
      for (int j = 0; i + j <= kSteps; ++j) {
        const Eigen::Vector3d p =
            (i * corners[0] + j * corners[1] + (kSteps - i - j) * corners[2]) / kSteps;
        error = std::max(error, std::abs(signed_distance_mm(surface, p)));
      }
    }
    return error;
  }

  FacetedSolid solid_;
};

}  // namespace detail

}  // namespace dowel::testing
