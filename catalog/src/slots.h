#pragma once

#include <vector>

#include "slot_geometry.h"

namespace dowel {

/// Plain slots, T-slots and slotted holes of `solid`. Unordered.
std::vector<SlotFinding> find_slots(const FacetedSolid& solid, const std::vector<FaceNode>& graph);

}  // namespace dowel
