#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dowel/kernel/faceted_solid.h"

// What of a solid faces inward. Private to kernel. Both expect: indices in range.

namespace dowel {

/// First triangle of a closed component that encloses negative volume and is no cavity.
std::optional<std::uint32_t> find_inward_component(const FacetedSolid& solid);

/// For each face twice its area (mm2) where its facets have their outside on the exact face's; less
/// as they differ, negative where the face is inside out; 0 where only the facets are known.
std::vector<double> agreement_of_faces(const FacetedSolid& solid);

}  // namespace dowel
