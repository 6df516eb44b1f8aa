#pragma once

#include <cstdint>
#include <vector>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// A side of a triangle beyond which another face begins.
struct RimEdge {
  std::uint32_t from = 0;  ///< vertices, in the direction in which the triangle on this side runs
  std::uint32_t to = 0;
  std::uint32_t apex_across = 0;  ///< third vertex of the triangle on the other side
  std::uint32_t face_across = 0;
};

/// A face as recognition sees it.
struct FaceNode {
  Surface surface;        ///< the exact one, or the plane or cylinder that fits a free-form face
  bool reversed = false;  ///< as Face::reversed, for `surface`
  double area_mm2 = 0.0;
  std::uint32_t solid = 0;
  std::vector<std::uint32_t> triangles;
  std::vector<std::uint32_t> vertices;  ///< sorted, without repetition
  std::vector<RimEdge> rim;
  std::vector<std::uint32_t> neighbours;  ///< sorted, without repetition
};

/// The faces of a solid and how they meet, taken from the facets alone: exporters differ in how
/// they cut edges, and a mesh file has none. Solids that touch are not neighbours.
/// O(n log n). Expects: one face index in range per triangle.
std::vector<FaceNode> face_graph(const FacetedSolid& solid);

}  // namespace dowel
