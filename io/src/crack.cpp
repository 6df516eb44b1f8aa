#include "crack.h"

#include <algorithm>
#include <cstdint>
#include <utility>

#include "dowel/kernel/mesh_defect.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// Vertices of edges that only one triangle uses, in ascending order.
std::vector<std::uint32_t> open_vertices(const FacetedSolid& solid) {
  std::vector<std::pair<std::uint32_t, std::uint32_t>> edges;
  edges.reserve(3 * solid.triangles.size());
  for (const Triangle& t : solid.triangles) {
    for (std::size_t k = 0; k < 3; ++k) edges.emplace_back(std::minmax(t[k], t[(k + 1) % 3]));
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::uint32_t> vertices;
  for (std::size_t first = 0; first < edges.size();) {
    std::size_t last = first + 1;
    while (last < edges.size() && edges[last] == edges[first]) ++last;
    if (last - first == 1) {
      vertices.push_back(edges[first].first);
      vertices.push_back(edges[first].second);
    }
    first = last;
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

}  // namespace

std::vector<double> close_cracks(FacetedSolid& solid, double tolerance_mm) {
  std::vector<std::uint32_t> open = open_vertices(solid);
  std::sort(open.begin(), open.end(), [&](std::uint32_t a, std::uint32_t b) {
    const double xa = solid.vertices[a].x();
    const double xb = solid.vertices[b].x();
    return xa != xb ? xa < xb : a < b;
  });
  // Each vertex moves to the first one near it that stays; none moves twice, so that a chain of
  // near vertices cannot carry one away.
  const std::vector<Vector3d> before = solid.vertices;
  std::vector<bool> is_settled(solid.vertices.size(), false);
  for (std::size_t i = 0; i < open.size(); ++i) {
    if (is_settled[open[i]]) continue;
    const Vector3d& anchor = before[open[i]];
    for (std::size_t j = i + 1; j < open.size(); ++j) {
      if (before[open[j]].x() - anchor.x() > tolerance_mm) break;
      if (is_settled[open[j]] || (before[open[j]] - anchor).norm() > tolerance_mm) continue;
      solid.vertices[open[j]] = anchor;
      is_settled[open[j]] = true;
    }
  }
  std::vector<double> moved_mm(solid.faces.size(), 0.0);
  for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
    for (const std::uint32_t v : solid.triangles[t]) {
      double& moved = moved_mm[solid.face_of[t]];
      moved = std::max(moved, (solid.vertices[v] - before[v]).norm());
    }
  }
  weld(solid);
  return moved_mm;
}

}  // namespace dowel
