#include "face_graph.h"

#include <algorithm>
#include <tuple>
#include <utility>

#include "dowel/kernel/check.h"
#include "surface_fit.h"

namespace dowel {
namespace {

template <class T>
void sort_unique(std::vector<T>& values) {
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
}

/// One side of one triangle, keyed so that the two sides of an edge sort next to each other.
struct Side {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  std::uint32_t solid = 0;
  bool runs_up = false;  ///< from `low` to `high`
  std::uint32_t triangle = 0;

  auto key() const { return std::tie(low, high, solid); }
};

std::vector<Side> sorted_sides(const FacetedSolid& solid) {
  std::vector<Side> sides;
  sides.reserve(3 * solid.triangles.size());
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const std::uint32_t lump = solid.faces[solid.face_of[t]].solid;
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = solid.triangles[t][i];
      const std::uint32_t b = solid.triangles[t][(i + 1) % 3];
      sides.push_back({std::min(a, b), std::max(a, b), lump, a < b, t});
    }
  }
  // By the lower vertex in one pass, for there are many sides; what is left to sort is short.
  std::vector<std::uint32_t> begin(solid.vertices.size() + 1, 0);
  for (const Side& side : sides) ++begin[side.low + 1];
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<Side> sorted(sides.size());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for (const Side& side : sides) sorted[next[side.low]++] = side;
  for (std::size_t v = 0; v + 1 < begin.size(); ++v) {
    std::sort(sorted.begin() + begin[v], sorted.begin() + begin[v + 1],
              [](const Side& a, const Side& b) {
                return std::tie(a.high, a.solid, a.runs_up, a.triangle) <
                       std::tie(b.high, b.solid, b.runs_up, b.triangle);
              });
  }
  return sorted;
}

std::uint32_t third_vertex(const Triangle& t, std::uint32_t a, std::uint32_t b) {
  for (const std::uint32_t v : t) {
    if (v != a && v != b) return v;
  }
  return t[0];
}

void add_rim(const FacetedSolid& solid, const Side& here, const Side& across,
             std::vector<FaceNode>& nodes) {
  const std::uint32_t face = solid.face_of[here.triangle];
  const std::uint32_t face_across = solid.face_of[across.triangle];
  if (face == face_across) return;
  nodes[face].rim.push_back(
      {here.runs_up ? here.low : here.high, here.runs_up ? here.high : here.low,
       third_vertex(solid.triangles[across.triangle], here.low, here.high), face_across});
  nodes[face].neighbours.push_back(face_across);
}

void add_rims(const FacetedSolid& solid, std::vector<FaceNode>& nodes) {
  const std::vector<Side> sides = sorted_sides(solid);
  for (std::size_t i = 0; i + 1 < sides.size(); ++i) {
    const Side& a = sides[i];
    const Side& b = sides[i + 1];
    if (a.key() != b.key() || a.runs_up == b.runs_up) continue;
    add_rim(solid, a, b, nodes);
    add_rim(solid, b, a, nodes);
    ++i;
  }
}

/// The vertices of each face, sorted by way of the faces of each vertex: large faces have many.
void add_vertices(const FacetedSolid& solid, std::vector<FaceNode>& nodes) {
  struct Use {
    std::uint32_t vertex = 0;
    std::uint32_t face = 0;
  };
  std::vector<Use> uses;  // each once, by face
  uses.reserve(2 * solid.vertices.size());
  std::vector<std::size_t> seen_by(solid.vertices.size(), nodes.size());  // the last face to do so
  std::vector<std::uint32_t> begin(solid.vertices.size() + 1, 0);
  for (std::uint32_t f = 0; f < nodes.size(); ++f) {
    for (const std::uint32_t t : nodes[f].triangles) {
      for (const std::uint32_t v : solid.triangles[t]) {
        if (std::exchange(seen_by[v], f) == f) continue;
        uses.push_back({v, f});
        ++begin[v + 1];
      }
    }
  }
  for (std::size_t v = 1; v < begin.size(); ++v) begin[v] += begin[v - 1];
  std::vector<Use> by_vertex(uses.size());
  for (const Use& use : uses) by_vertex[begin[use.vertex]++] = use;
  for (const Use& use : by_vertex) nodes[use.face].vertices.push_back(use.vertex);
}

}  // namespace

std::vector<FaceNode> face_graph(const FacetedSolid& solid) {
  DOWEL_EXPECTS(solid.face_of.size() == solid.triangles.size());
  std::vector<FaceNode> nodes(solid.faces.size());
  for (std::size_t f = 0; f < nodes.size(); ++f) {
    const Face& face = solid.faces[f];
    nodes[f].surface = face.surface;
    nodes[f].reversed = face.reversed;
    nodes[f].area_mm2 = face.area_mm2;
    nodes[f].solid = face.solid;
  }
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    DOWEL_EXPECTS(solid.face_of[t] < nodes.size());
    nodes[solid.face_of[t]].triangles.push_back(t);
  }
  add_rims(solid, nodes);
  add_vertices(solid, nodes);
  for (std::size_t f = 0; f < nodes.size(); ++f) {
    FaceNode& node = nodes[f];
    sort_unique(node.neighbours);
    if (!std::holds_alternative<OtherSurface>(node.surface)) continue;
    if (const auto fit = fit_surface(solid, solid.faces[f], node.triangles)) {
      node.surface = fit->surface;
      node.reversed = fit->reversed;
    }
  }
  return nodes;
}

}  // namespace dowel
