#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "dowel/kernel/surface.h"

namespace dowel {

/// Three vertex indices, counter-clockwise seen from outside the material.
using Triangle = std::array<std::uint32_t, 3>;

/// One face of the boundary, with the exact surface that it lies on.
struct Face {
  Surface surface;
  /// True where the solid lies on the natural side of the surface, as in a bore; then the outward
  /// normal is minus the gradient of the signed distance. Never set for planes (their normal is
  /// stored outward) and OtherSurface.
  bool reversed = false;
  /// Largest distance between the face's facets and its exact surface, measured; 0 for planes.
  double facet_error_mm = 0.0;
  double area_mm2 = 0.0;  ///< of the exact face where the source knows it, else of its facets
  /// Which of the solids (closed lumps) of the element the face belongs to, from 0.
  std::uint32_t solid = 0;
};

/// How the two faces at an edge meet. Smooth: tangent within about a degree.
enum class Convexity : std::uint8_t { Unknown, Convex, Concave, Smooth };

enum class CurveKind : std::uint8_t { Line, Circle, Other };

/// An edge between two faces (not the seam of one). For a Circle `center`, `axis`, `radius_mm`
/// describe it; for the others they are zero.
struct Edge {
  std::array<std::uint32_t, 2> faces{};  ///< indices into FacetedSolid::faces, first < second
  Convexity convexity = Convexity::Unknown;
  CurveKind curve = CurveKind::Other;
  bool closed = false;  ///< starts where it ends: a full circle
  double length_mm = 0.0;
  Eigen::Vector3d start = Eigen::Vector3d::Zero();
  Eigen::Vector3d end = Eigen::Vector3d::Zero();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  Eigen::Vector3d axis = Eigen::Vector3d::Zero();
  double radius_mm = 0.0;
};

/// An element's boundary as facets that know the exact face each came from. It passes from the
/// readers to the catalogue, which recognises features on it, and to collision, which decides by
/// the exact faces where facets cannot.
///
/// Invariants of a solid that was accepted (`find_defect` returns nothing): indices in range,
/// coordinates finite and within kMaxCoordinate_mm, no triangle with two equal vertices, welded
/// (no two vertices equal), closed (each directed edge used once and its reverse once), outward
/// (positive volume). Vertices that lie on a face's surface do so within a few ulp.
struct FacetedSolid {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<Triangle> triangles;
  std::vector<std::uint32_t> face_of;  ///< one face index per triangle
  std::vector<Face> faces;
  std::vector<Edge> edges;
  std::uint32_t solid_count = 0;

  std::array<Eigen::Vector3d, 3> corners(std::uint32_t triangle) const {
    const Triangle& t = triangles[triangle];
    return {vertices[t[0]], vertices[t[1]], vertices[t[2]]};
  }
};

}  // namespace dowel
