#pragma once

#include <vector>

#include "slot_geometry.h"

namespace dowel {

/// Oblong through holes: two half cylinders joined by two planes, no floor. Unordered.
std::vector<SlotFinding> find_slotted_holes(const SolidView& view);

}  // namespace dowel
