#pragma once

#include <optional>
#include <vector>

#include "dowel/catalog/feature.h"
#include "revolved_bands.h"

namespace dowel {

/// A hole without its name.
struct HoleFinding {
  Feature feature;
  std::optional<std::uint32_t> entry_face;  ///< planar face that it opens on
};

/// Holes of `solid`: chains of inner bands that open into each other about one axis. Unordered.
std::vector<HoleFinding> find_holes(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                                    const std::vector<AxisBands>& axes);

}  // namespace dowel
