#include "hull_facets.h"

#include <algorithm>
#include <numeric>

#include "disjoint_sets.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/predicates.h"

namespace dowel {
namespace {

/// A directed edge of a triangle, sortable so that it stands beside its reverse.
struct HalfEdge {
  std::uint32_t from = 0;
  std::uint32_t to = 0;
  std::uint32_t triangle = 0;

  std::uint64_t key() const {
    return (static_cast<std::uint64_t>(std::min(from, to)) << 32U) | std::max(from, to);
  }
};

std::uint32_t opposite_corner(const Triangle& t, const HalfEdge& edge) {
  for (const std::uint32_t v : t) {
    if (v != edge.from && v != edge.to) return v;
  }
  return t[0];
}

/// Half edges in pairs: 2i and 2i + 1 are the two sides of an edge.
std::vector<HalfEdge> paired_half_edges(std::span<const Triangle> triangles) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (std::uint32_t i = 0; i < triangles.size(); ++i) {
    const Triangle& t = triangles[i];
    for (std::size_t k = 0; k < 3; ++k) edges.push_back({t[k], t[(k + 1) % 3], i});
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.key() != b.key() ? a.key() < b.key() : a.from < b.from;
  });
  return edges;
}

}  // namespace

std::vector<HullFacet> hull_facets(std::span<const Eigen::Vector3d> points,
                                   std::span<const Triangle> triangles) {
  std::vector<HalfEdge> edges = paired_half_edges(triangles);
  std::vector<std::uint32_t> parent(triangles.size());
  std::iota(parent.begin(), parent.end(), 0U);
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    const Triangle& t = triangles[edges[i].triangle];
    const std::uint32_t across = opposite_corner(triangles[edges[i + 1].triangle], edges[i + 1]);
    if (orient3d(points[t[0]], points[t[1]], points[t[2]], points[across]) != 0) continue;
    parent[root_of(parent, edges[i].triangle)] = root_of(parent, edges[i + 1].triangle);
  }

  // What is left of the edges bounds the facets; a vertex is extreme where three or more of them
  // meet.
  std::vector<HalfEdge> outline;
  std::vector<std::uint32_t> facets_at(points.size(), 0);
  for (std::size_t i = 0; i + 1 < edges.size(); i += 2) {
    edges[i].triangle = root_of(parent, edges[i].triangle);
    edges[i + 1].triangle = root_of(parent, edges[i + 1].triangle);
    if (edges[i].triangle == edges[i + 1].triangle) continue;
    for (const HalfEdge& edge : {edges[i], edges[i + 1]}) {
      outline.push_back(edge);
      ++facets_at[edge.from];
    }
  }
  std::sort(outline.begin(), outline.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return a.triangle != b.triangle ? a.triangle < b.triangle : a.from < b.from;
  });

  std::vector<HullFacet> facets;
  for (std::size_t first = 0; first < outline.size();) {
    std::size_t last = first;
    while (last < outline.size() && outline[last].triangle == outline[first].triangle) ++last;
    HullFacet facet;
    std::size_t at = first;
    for (std::size_t steps = first; steps < last; ++steps) {
      if (facets_at[outline[at].from] >= 3) facet.push_back(outline[at].from);
      const auto next = std::lower_bound(
          outline.begin() + static_cast<std::ptrdiff_t>(first),
          outline.begin() + static_cast<std::ptrdiff_t>(last), outline[at].to,
          [](const HalfEdge& edge, std::uint32_t vertex) { return edge.from < vertex; });
      at = static_cast<std::size_t>(next - outline.begin());
    }
    std::rotate(facet.begin(), std::min_element(facet.begin(), facet.end()), facet.end());
    facets.push_back(std::move(facet));
    first = last;
  }
  std::sort(facets.begin(), facets.end());
  return facets;
}

std::vector<Triangle> fan_triangles(const std::vector<HullFacet>& facets) {
  std::vector<Triangle> triangles;
  for (const HullFacet& facet : facets) {
    for (std::size_t i = 1; i + 1 < facet.size(); ++i) {
      triangles.push_back({facet[0], facet[i], facet[i + 1]});
    }
  }
  return triangles;
}

}  // namespace dowel
