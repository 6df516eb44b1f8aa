#include "polygon.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "dowel/kernel/check.h"
#include "dowel/kernel/predicates.h"

namespace dowel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Corners in the coordinate plane that the polygon faces most, seen from its outside.
std::vector<Vector2d> projected(std::span<const std::uint32_t> corners, const FacetedSolid& mesh) {
  // Newell's normal: defined for concave and slightly uneven polygons too.
  Vector3d normal = Vector3d::Zero();
  const Vector3d& origin = mesh.vertices[corners[0]];
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vector3d a = mesh.vertices[corners[i]] - origin;
    const Vector3d b = mesh.vertices[corners[(i + 1) % corners.size()]] - origin;
    normal += a.cross(b);
  }
  Eigen::Index drop = 0;
  normal.cwiseAbs().maxCoeff(&drop);
  Eigen::Index first = (drop + 1) % 3;
  Eigen::Index second = (drop + 2) % 3;
  if (normal[drop] < 0.0) std::swap(first, second);
  std::vector<Vector2d> flat;
  for (const std::uint32_t corner : corners) {
    flat.emplace_back(mesh.vertices[corner][first], mesh.vertices[corner][second]);
  }
  return flat;
}

bool is_inside(const Vector2d& p, const Vector2d& a, const Vector2d& b, const Vector2d& c) {
  return orient2d(a, b, p) >= 0 && orient2d(b, c, p) >= 0 && orient2d(c, a, p) >= 0;
}

/// True where the corner at `at` of the remaining ring can be cut off.
bool is_ear(const std::vector<std::size_t>& ring, std::size_t at,
            const std::vector<Vector2d>& flat) {
  const std::size_t before = ring[(at + ring.size() - 1) % ring.size()];
  const std::size_t after = ring[(at + 1) % ring.size()];
  const Vector2d& a = flat[before];
  const Vector2d& b = flat[ring[at]];
  const Vector2d& c = flat[after];
  if (orient2d(a, b, c) <= 0) return false;
  for (const std::size_t other : ring) {
    const Vector2d& p = flat[other];
    // Corners at the same place, as where a slit joins a hole to the outline, do not block an ear.
    if (p == a || p == b || p == c) continue;
    if (is_inside(p, a, b, c)) return false;
  }
  return true;
}

}  // namespace

void append_polygon(std::span<const std::uint32_t> corners, FacetedSolid& mesh) {
  DOWEL_EXPECTS(corners.size() >= 3);
  if (corners.size() == 3) {
    mesh.triangles.push_back({corners[0], corners[1], corners[2]});
    return;
  }
  const std::vector<Vector2d> flat = projected(corners, mesh);
  std::vector<std::size_t> ring(corners.size());
  for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = i;
  while (ring.size() > 3) {
    std::size_t at = 1;  // no ear: a degenerate rest, cut as a fan
    for (std::size_t i = 0; i < ring.size(); ++i) {
      const std::size_t candidate = (i + 1) % ring.size();
      if (!is_ear(ring, candidate, flat)) continue;
      at = candidate;
      break;
    }
    const std::size_t before = ring[(at + ring.size() - 1) % ring.size()];
    const std::size_t after = ring[(at + 1) % ring.size()];
    mesh.triangles.push_back({corners[before], corners[ring[at]], corners[after]});
    ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(at));
  }
  mesh.triangles.push_back({corners[ring[0]], corners[ring[1]], corners[ring[2]]});
}

}  // namespace dowel
