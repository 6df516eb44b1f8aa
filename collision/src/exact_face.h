#pragma once

#include <limits>

#include <Eigen/Core>

#include "dowel/collision/model.h"

// Distances from the exact faces behind the facets. Private to collision.

namespace dowel {

/// Where on a triangle: 0 inside, 1-3 on edge 0-2, 4-6 at corner 0-2.
struct TrianglePoint {
  Eigen::Vector3d point;
  int region = 0;
};

/// Point of the flat triangle that is nearest to `p`.
/// Source: Ericson, "Real-Time Collision Detection", 2005, section 5.1.5.
TrianglePoint closest_on_triangle(const std::array<Eigen::Vector3d, 3>& corners,
                                  const Eigen::Vector3d& p);

/// Distance of `p` from the material at an exact face: negative on the material's side.
double outward_distance_mm(const Face& face, const Eigen::Vector3d& p);

/// Unit normal of an exact face at (or nearest to) `p`, out of the material.
Eigen::Vector3d outward_normal(const Face& face, const Eigen::Vector3d& p);

inline bool is_exact(const Face& face) {
  return !std::holds_alternative<OtherSurface>(face.surface);
}

/// Whether a plane and a face of revolution that meet smoothly do so along a circle.
bool blend_in_circle(const Face& f, const Face& g);

/// From the middle of edge `i` of a facet of `face` to the exact rim with the face `beyond` it.
Eigen::Vector3d rim_offset(const Face& face, const Face& beyond, const ModelTriangle& t,
                           std::size_t i);

/// True where edge `i` is the chord of a curve in which two exact faces meet.
bool is_chord(const CollisionModel& model, const ModelTriangle& triangle, std::size_t i);

/// A place of the exact boundary behind one facet that is a candidate for the nearest to some
/// point.
struct FacePoint {
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double distance_squared_mm2 = 0.0;
  enum class Place : std::uint8_t { Face, ConvexRim, ConcaveRim, Corner } place = Place::Face;
};

/// Nearest place to `p` of the exact face patch behind triangle `index`; where only its overhang
/// over a rim comes near, the nearest place of that rim. Always a place of the boundary, up to
/// terms of second order in the facet error; the smallest over all triangles is the distance. Where
/// that is more than `within_squared_mm2`, any place beyond that distance: the caller has a nearer
/// one. `is_over`: `p` is known to be over the triangle, seen along its normal.
FacePoint nearest_on_patch(const CollisionModel& model, std::uint32_t index,
                           const Eigen::Vector3d& p,
                           double within_squared_mm2 = std::numeric_limits<double>::infinity(),
                           bool is_over = false);

}  // namespace dowel
