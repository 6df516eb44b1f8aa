#pragma once

#include <cstdint>
#include <vector>

#include "axis.h"
#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Stretch of a line outside the material; ends may be infinite.
struct VoidStretch {
  double low_mm = 0.0;
  double high_mm = 0.0;
};

/// Where the line along `axis`, moved sideways by about `offset_mm`, runs outside solid number
/// `lump`: heights, from the lowest up. The offset keeps it off the vertices and edges that bodies
/// of revolution have on their axes; should it meet one all the same, another is tried.
/// Predicate: exact for the facets up to the rounding of their projection. O(triangles).
std::vector<VoidStretch> void_along(const FacetedSolid& solid, std::uint32_t lump, const Axis& axis,
                                    double offset_mm);

}  // namespace dowel
