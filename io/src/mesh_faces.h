#pragma once

#include <cstddef>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Edges of a triangle mesh by the number of triangles that use them.
struct MeshEdgeCounts {
  std::size_t all = 0;
  std::size_t open = 0;     ///< used by one triangle
  std::size_t crowded = 0;  ///< used by three or more
};

MeshEdgeCounts count_edges(const FacetedSolid& mesh);

/// Gives a closed, welded, outward mesh its faces and edges: neighbouring coplanar triangles become
/// one planar face, neighbours in different faces share an edge for each mesh edge between them.
/// Each outer shell is a solid; cavities belong to the smallest one around them.
void set_planar_faces(FacetedSolid& mesh);

}  // namespace dowel
