#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

struct SurfaceFit {
  Surface surface;        ///< PlaneSurface (outward), CylinderSurface or ConeSurface
  bool reversed = false;  ///< as Face::reversed
};

/// Plane, cylinder or cone that a free-form face really is: some exporters write B-splines and
/// nothing else. Nothing where the vertices miss every such surface by more than kSameFeature_mm,
/// or where area or facet error say that the face leaves the surface between its vertices.
/// A direction that rounds to a coordinate axis within that tolerance becomes that axis.
/// `triangles` are those of `face`. The result does not depend on their order.
std::optional<SurfaceFit> fit_surface(const FacetedSolid& solid, const Face& face,
                                      const std::vector<std::uint32_t>& triangles);

}  // namespace dowel
