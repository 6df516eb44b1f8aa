#pragma once

#include <cstdint>
#include <vector>

#include <TopoDS_Face.hxx>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// A face of a solid as OpenCascade and as dowel know it.
struct PlacedFace {
  TopoDS_Face face;         ///< with the orientation that it has in its solid
  std::uint32_t index = 0;  ///< into FacetedSolid::faces
  bool turned = false;      ///< the solid's facets were turned inside out after meshing
};

/// The edges between two different faces of one solid, in the order in which `placed` meets them.
/// Convexity is decided at the middle of the edge. Seams, degenerated edges and edges of more than
/// two faces are left out. `faces` are those of the whole part, with surfaces set.
std::vector<Edge> exact_edges(const std::vector<PlacedFace>& placed,
                              const std::vector<Face>& faces);

}  // namespace dowel
