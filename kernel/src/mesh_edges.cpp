#include "mesh_edges.h"

#include <algorithm>

#include <Eigen/Geometry>

namespace dowel {

std::vector<EdgeUse> sorted_edge_uses(const FacetedSolid& solid) {
  std::vector<EdgeUse> uses;
  uses.reserve(3 * solid.triangles.size());
  for (std::uint32_t i = 0; i < solid.triangles.size(); ++i) {
    const Triangle& t = solid.triangles[i];
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t from = t[k];
      const std::uint32_t to = t[(k + 1) % 3];
      uses.push_back({std::min(from, to), std::max(from, to), from < to, i});
    }
  }
  std::sort(uses.begin(), uses.end(), [](const EdgeUse& a, const EdgeUse& b) {
    if (a.low != b.low) return a.low < b.low;
    if (a.high != b.high) return a.high < b.high;
    return a.triangle < b.triangle;
  });
  return uses;
}

double signed_volume_mm3(const std::array<Eigen::Vector3d, 3>& corners,
                         const Eigen::Vector3d& apex) {
  return (corners[0] - apex).dot((corners[1] - apex).cross(corners[2] - apex)) / 6.0;
}

}  // namespace dowel
