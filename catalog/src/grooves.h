#pragma once

#include <vector>

#include "slot_geometry.h"

namespace dowel {

/// Plain slots and T-slots: two walls that face each other over a floor. Unordered; those that
/// share both walls are all there (a groove with one closed end is one along it and one into it).
std::vector<SlotFinding> find_grooves(const SolidView& view);

}  // namespace dowel
