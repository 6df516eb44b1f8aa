#include "plane_patches.h"

#include <algorithm>
#include <cmath>

#include "dowel/kernel/tolerance.h"
#include "facet_geometry.h"
#include "planar_faces.h"

namespace dowel {
namespace {

template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

PlanePatch make_patch(const std::vector<FaceNode>& graph, std::vector<std::uint32_t> faces) {
  PlanePatch patch;
  patch.plane = std::get<PlaneSurface>(graph[largest_face(graph, faces)].surface);
  patch.solid = graph[faces.front()].solid;
  std::vector<double> areas_mm2;
  for (const std::uint32_t face : faces) {
    const FaceNode& node = graph[face];
    areas_mm2.push_back(node.area_mm2);
    patch.vertices.insert(patch.vertices.end(), node.vertices.begin(), node.vertices.end());
  }
  patch.area_mm2 = ordered_sum(areas_mm2);
  sort_unique(patch.vertices);
  patch.faces = std::move(faces);
  return patch;
}

bool is_tangent(const FacetedSolid& solid, const FaceNode& cylinder, const RimEdge& edge,
                const Eigen::Vector3d& normal) {
  const double least_cosine = std::cos(kTangent_rad);
  return outward_normal(cylinder, solid.vertices[edge.from]).dot(normal) >= least_cosine &&
         outward_normal(cylinder, solid.vertices[edge.to]).dot(normal) >= least_cosine;
}

std::vector<std::size_t> tangent_patches(const FacetedSolid& solid, const PatchGraph& patches,
                                         const FaceNode& node) {
  std::vector<std::size_t> result;
  if (!std::holds_alternative<CylinderSurface>(node.surface)) return result;
  for (const RimEdge& edge : node.rim) {
    const std::size_t patch = patches.patch_of[edge.face_across];
    if (patch == PatchGraph::kNone) continue;
    if (is_tangent(solid, node, edge, patches.patches[patch].plane.normal)) result.push_back(patch);
  }
  sort_unique(result);
  return result;
}

void link_over_edges(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                     PatchGraph& result) {
  for (std::size_t p = 0; p < result.patches.size(); ++p) {
    const PlanePatch& patch = result.patches[p];
    for (const std::uint32_t face : patch.faces) {
      for (const RimEdge& edge : graph[face].rim) {
        const std::size_t across = result.patch_of[edge.face_across];
        if (across == PatchGraph::kNone || across == p) continue;
        const double rise = rise_across(solid, graph, patch, edge);
        if (std::abs(rise) <= kTangent_rad) continue;
        result.links[p].push_back({across, rise > 0.0});
      }
    }
  }
}

void link_over_fillets(const std::vector<FaceNode>& graph, PatchGraph& result) {
  for (std::uint32_t face = 0; face < graph.size(); ++face) {
    for (const std::size_t p : result.tangent_patches[face]) {
      for (const std::size_t q : result.tangent_patches[face]) {
        if (p != q) result.links[p].push_back({q, graph[face].reversed, face});
      }
    }
  }
}

}  // namespace

Eigen::Vector3d outward_normal(const FaceNode& node, const Eigen::Vector3d& point) {
  if (const auto* plane = std::get_if<PlaneSurface>(&node.surface)) return plane->normal;
  const Eigen::Vector3d gradient = distance_gradient(node.surface, point);
  return node.reversed ? Eigen::Vector3d(-gradient) : gradient;
}

double rise_across(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                   const PlanePatch& patch, const RimEdge& edge) {
  const Eigen::Vector3d along = solid.vertices[edge.to] - solid.vertices[edge.from];
  if (along.norm() <= kCoincident_mm) return 0.0;
  const FaceNode& across = graph[edge.face_across];
  const Eigen::Vector3d inward = patch.plane.normal.cross(along).normalized();
  if (std::holds_alternative<OtherSurface>(across.surface)) {
    const Eigen::Vector3d to_apex = solid.vertices[edge.apex_across] - solid.vertices[edge.from];
    const double reach_mm = to_apex.norm();
    return reach_mm > kCoincident_mm ? patch.plane.normal.dot(to_apex) / reach_mm : 0.0;
  }
  const Eigen::Vector3d middle = 0.5 * (solid.vertices[edge.to] + solid.vertices[edge.from]);
  return outward_normal(across, middle).dot(inward);
}

bool are_coplanar(const FacetedSolid& solid, const PlanePatch& a, const PlanePatch& b) {
  if (a.plane.normal.dot(b.plane.normal) < std::cos(kCoaxial_rad)) return false;
  const auto lies_in = [&solid](const PlanePatch& patch, const PlaneSurface& plane) {
    return std::ranges::all_of(patch.vertices, [&](std::uint32_t v) {
      return std::abs(plane.normal.dot(solid.vertices[v] - plane.origin)) <= kSameFeature_mm;
    });
  };
  return lies_in(b, a.plane) || lies_in(a, b.plane);
}

PatchGraph patch_graph(const FacetedSolid& solid, const std::vector<FaceNode>& graph) {
  PatchGraph result;
  result.patch_of.assign(graph.size(), PatchGraph::kNone);
  const std::vector<bool> none_taken(graph.size(), false);
  for (std::vector<std::uint32_t>& faces : coplanar_sets(solid, graph, none_taken)) {
    for (const std::uint32_t face : faces) result.patch_of[face] = result.patches.size();
    result.patches.push_back(make_patch(graph, std::move(faces)));
  }
  result.links.resize(result.patches.size());
  result.tangent_patches.reserve(graph.size());
  for (const FaceNode& node : graph) {
    result.tangent_patches.push_back(tangent_patches(solid, result, node));
  }
  link_over_edges(solid, graph, result);
  link_over_fillets(graph, result);
  for (std::vector<PatchLink>& links : result.links) sort_unique(links);
  return result;
}

}  // namespace dowel
