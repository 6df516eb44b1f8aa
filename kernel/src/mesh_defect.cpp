#include "dowel/kernel/mesh_defect.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "dowel/kernel/box.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"
#include "inward.h"
#include "mesh_edges.h"
#include "solid_values.h"

namespace dowel {
namespace {

using PositionKey = std::array<std::uint64_t, 3>;

/// Bits of a position, in which 0 and -0 are the same: equal keys are equal positions, and NaN,
/// which has no order as a number, has one.
PositionKey position_key(const Eigen::Vector3d& p) {
  const auto bits = [](double value) { return std::bit_cast<std::uint64_t>(value + 0.0); };
  return {bits(p.x()), bits(p.y()), bits(p.z())};
}

/// Vertex indices, equal positions beside each other, the lower index first.
std::vector<std::uint32_t> sorted_by_position(const std::vector<Eigen::Vector3d>& vertices) {
  std::vector<PositionKey> keys;
  keys.reserve(vertices.size());
  for (const Eigen::Vector3d& v : vertices) keys.push_back(position_key(v));
  std::vector<std::uint32_t> order(vertices.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    return keys[a] != keys[b] ? keys[a] < keys[b] : a < b;
  });
  return order;
}

std::optional<std::string> find_double_vertex(const FacetedSolid& solid) {
  const std::vector<std::uint32_t> order = sorted_by_position(solid.vertices);
  for (std::size_t i = 1; i < order.size(); ++i) {
    if (solid.vertices[order[i - 1]] == solid.vertices[order[i]]) {
      return "vertices " + std::to_string(order[i - 1]) + " and " + std::to_string(order[i]) +
             " are at the same place: the mesh is not welded";
    }
  }
  return std::nullopt;
}

std::optional<std::string> find_bad_mesh_edge(const FacetedSolid& solid) {
  const std::vector<EdgeUse> uses = sorted_edge_uses(solid);
  std::optional<std::string> defect;
  for_each_edge(uses, [&](std::size_t first, std::size_t last) {
    if (defect) return;
    const EdgeUse& use = uses[first];
    const std::string name =
        "edge " + std::to_string(use.low) + "-" + std::to_string(use.high) + " is ";
    const std::size_t count = last - first;
    if (count == 1) {
      defect = name + "used by 1 triangle, expected 2: the mesh is open";
    } else if (count > 2) {
      defect = name + "used by " + std::to_string(count) +
               " triangles, expected 2: the solid touches itself there";
    } else if (use.upwards == uses[first + 1].upwards) {
      defect = name + "used twice in the same direction: triangles " +
               std::to_string(use.triangle) + " and " + std::to_string(uses[first + 1].triangle) +
               " disagree on which side is outside";
    } else if (solid.faces[solid.face_of[use.triangle]].solid !=
               solid.faces[solid.face_of[uses[first + 1].triangle]].solid) {
      defect = name + "shared by two solids, expected closed solids";
    }
  });
  return defect;
}

std::optional<std::string> find_inward_solid(const FacetedSolid& solid) {
  const Eigen::Vector3d center = bounds(solid.vertices).center();
  std::vector<double> volume_mm3(solid.solid_count, 0.0);
  for (std::uint32_t i = 0; i < solid.triangles.size(); ++i) {
    volume_mm3[solid.faces[solid.face_of[i]].solid] += signed_volume_mm3(solid.corners(i), center);
  }
  for (std::size_t i = 0; i < volume_mm3.size(); ++i) {
    if (volume_mm3[i] > 0.0) continue;
    return "solid " + std::to_string(i) + " encloses " + std::to_string(volume_mm3[i]) +
           " mm3, expected a positive volume: its triangles do not face outward";
  }
  return std::nullopt;
}

std::optional<std::string> find_inward_part(const FacetedSolid& solid) {
  if (const auto triangle = find_inward_component(solid)) {
    return "the component of triangle " + std::to_string(*triangle) +
           " encloses a negative volume and is no cavity: its triangles do not face outward";
  }
  const std::vector<double> agreement = agreement_of_faces(solid);
  for (std::size_t i = 0; i < agreement.size(); ++i) {
    if (agreement[i] >= 0.0) continue;
    return "face " + std::to_string(i) + " has its outside where its triangles have their inside";
  }
  return std::nullopt;
}

/// A triangle with a corner far off the face that it stands for.
std::optional<std::string> find_stray_triangle(const FacetedSolid& solid) {
  for (std::size_t i = 0; i < solid.triangles.size(); ++i) {
    const Face& face = solid.faces[solid.face_of[i]];
    if (std::holds_alternative<OtherSurface>(face.surface)) continue;
    for (const std::uint32_t v : solid.triangles[i]) {
      const double off_mm = std::abs(signed_distance_mm(face.surface, solid.vertices[v]));
      if (off_mm <= face.facet_error_mm + kStrayFacet_mm) continue;
      return "vertex " + std::to_string(v) + " of triangle " + std::to_string(i) + " is " +
             std::to_string(off_mm) + " mm off the surface of its face " +
             std::to_string(solid.face_of[i]);
    }
  }
  return std::nullopt;
}

}  // namespace

std::optional<std::string> find_defect(const FacetedSolid& solid) {
  if (solid.triangles.empty()) return "the mesh has no triangles";
  if (solid.solid_count > solid.faces.size()) {
    return std::to_string(solid.solid_count) + " solids have " +
           std::to_string(solid.faces.size()) + " faces, expected at least one each";
  }
  if (auto defect = find_bad_value(solid)) return defect;
  if (auto defect = find_double_vertex(solid)) return defect;
  if (auto defect = find_bad_mesh_edge(solid)) return defect;
  if (auto defect = find_inward_solid(solid)) return defect;
  if (auto defect = find_inward_part(solid)) return defect;
  return find_stray_triangle(solid);
}

void weld(FacetedSolid& solid) {
  DOWEL_EXPECTS(solid.face_of.size() == solid.triangles.size());
  const std::size_t count = solid.vertices.size();
  const std::vector<std::uint32_t> order = sorted_by_position(solid.vertices);
  std::vector<std::uint32_t> first_of(count);
  for (std::size_t i = 0; i < count; ++i) {
    const bool repeats = i > 0 && position_key(solid.vertices[order[i]]) ==
                                      position_key(solid.vertices[order[i - 1]]);
    first_of[order[i]] = repeats ? first_of[order[i - 1]] : order[i];
  }

  std::vector<bool> is_used(count, false);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < solid.triangles.size(); ++i) {
    Triangle t = solid.triangles[i];
    for (std::uint32_t& v : t) {
      DOWEL_EXPECTS(v < count);
      v = first_of[v];
    }
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
    for (const std::uint32_t v : t) is_used[v] = true;
    solid.triangles[kept] = t;
    solid.face_of[kept] = solid.face_of[i];
    ++kept;
  }
  solid.triangles.resize(kept);
  solid.face_of.resize(kept);

  std::vector<std::uint32_t> new_index(count, 0);
  std::uint32_t next = 0;
  for (std::size_t v = 0; v < count; ++v) {
    if (!is_used[v]) continue;
    new_index[v] = next;
    solid.vertices[next] = solid.vertices[v];
    ++next;
  }
  solid.vertices.resize(next);
  for (Triangle& t : solid.triangles) {
    for (std::uint32_t& v : t) v = new_index[v];
  }
}

}  // namespace dowel
