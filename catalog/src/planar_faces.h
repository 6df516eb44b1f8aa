#pragma once

#include <vector>

#include "dowel/catalog/feature.h"
#include "face_graph.h"

namespace dowel {

/// Planar faces, coplanar neighbours as one feature without name. Faces with `is_taken` set (rings
/// and floors of holes) are left out, and so are the facets of curved walls in a mesh file. Area
/// and centroid are those of the exact face where circles and lines bound it. Unordered.
std::vector<Feature> find_planar_faces(const FacetedSolid& solid,
                                       const std::vector<FaceNode>& graph,
                                       const std::vector<bool>& is_taken);

}  // namespace dowel
