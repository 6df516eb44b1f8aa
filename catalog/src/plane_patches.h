#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "face_graph.h"

namespace dowel {

/// Coplanar neighbouring faces as one.
struct PlanePatch {
  PlaneSurface plane;                   ///< of its largest face
  std::vector<std::uint32_t> faces;     ///< sorted
  std::vector<std::uint32_t> vertices;  ///< sorted, without repetition
  double area_mm2 = 0.0;
  std::uint32_t solid = 0;
};

/// How two patches meet: at an edge, or over a cylinder that is tangent to both.
struct PatchLink {
  std::size_t patch = 0;
  bool is_concave = false;
  std::uint32_t fillet = kNoFillet;  ///< the cylinder's face

  static constexpr std::uint32_t kNoFillet = std::numeric_limits<std::uint32_t>::max();
  auto operator<=>(const PatchLink&) const = default;
};

/// The planar parts of a solid and how they meet.
struct PatchGraph {
  std::vector<PlanePatch> patches;
  std::vector<std::size_t> patch_of;          ///< of each face; kNone for those of no patch
  std::vector<std::vector<PatchLink>> links;  ///< of each patch, sorted, without repetition
  /// Of each face: the patches that a cylinder runs into without an edge; sorted.
  std::vector<std::vector<std::size_t>> tangent_patches;

  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();
};

PatchGraph patch_graph(const FacetedSolid& solid, const std::vector<FaceNode>& graph);

/// Whether both lie in one plane and look the same way.
bool are_coplanar(const FacetedSolid& solid, const PlanePatch& a, const PlanePatch& b);

/// Side on which the surface across an edge of a patch rises: sine of the turn, positive where the
/// edge is concave, negative where it is convex, about 0 where it is smooth.
double rise_across(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                   const PlanePatch& patch, const RimEdge& edge);

/// Outward normal of the face at a point of it. Expects: not OtherSurface.
Eigen::Vector3d outward_normal(const FaceNode& node, const Eigen::Vector3d& point);

}  // namespace dowel
