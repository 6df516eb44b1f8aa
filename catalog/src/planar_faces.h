#pragma once

#include <optional>
#include <vector>

#include "dowel/catalog/feature.h"
#include "face_graph.h"

namespace dowel {

/// Centre of the circle in which `wall` cuts a plane square to its axis; nothing where it cuts it
/// in no circle.
std::optional<Eigen::Vector3d> circle_center(const Surface& wall, const PlaneSurface& plane);

/// The largest of coplanar faces. Which of two that are equal does not matter to its normal.
std::uint32_t largest_face(const std::vector<FaceNode>& graph,
                           const std::vector<std::uint32_t>& faces);

/// Sets of coplanar neighbours, each sorted. Faces with `is_taken` set are left out, and so are the
/// facets of curved walls in a mesh file.
std::vector<std::vector<std::uint32_t>> coplanar_sets(const FacetedSolid& solid,
                                                      const std::vector<FaceNode>& graph,
                                                      const std::vector<bool>& is_taken);

/// Planar faces, coplanar neighbours as one feature without name. Faces with `is_taken` set (rings
/// and floors of holes) are left out, and so are the facets of curved walls in a mesh file. Area
/// and centroid are those of the exact face where circles and lines bound it. Unordered.
std::vector<Feature> find_planar_faces(const FacetedSolid& solid,
                                       const std::vector<FaceNode>& graph,
                                       const std::vector<bool>& is_taken);

}  // namespace dowel
