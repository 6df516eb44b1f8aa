#pragma once

#include "revolved_bands.h"

namespace dowel {

/// Finds the two rims of `band`, whose `faces` and `is_inner` are set, and fills `ends`.
void find_ends(const FacetedSolid& solid, const std::vector<FaceNode>& graph, const Axis& axis,
               Band& band);

}  // namespace dowel
