#pragma once

#include <vector>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// One use of an undirected edge by a triangle.
struct EdgeUse {
  std::uint32_t low = 0;
  std::uint32_t high = 0;
  bool upwards = false;  ///< runs from `low` to `high`
  std::uint32_t triangle = 0;

  bool same_edge(const EdgeUse& other) const { return low == other.low && high == other.high; }
};

/// All uses, those of one edge beside each other, by triangle. O(n log n).
std::vector<EdgeUse> sorted_edge_uses(const FacetedSolid& solid);

/// Calls `visit(first, last)` for the uses of each edge in turn.
template <class Visit>
void for_each_edge(const std::vector<EdgeUse>& uses, Visit visit) {
  for (std::size_t first = 0; first < uses.size();) {
    std::size_t last = first + 1;
    while (last < uses.size() && uses[last].same_edge(uses[first])) ++last;
    visit(first, last);
    first = last;
  }
}

/// Volume of the tetrahedron from `apex` to a triangle, positive where its front faces away from
/// it.
double signed_volume_mm3(const std::array<Eigen::Vector3d, 3>& corners,
                         const Eigen::Vector3d& apex);

}  // namespace dowel
