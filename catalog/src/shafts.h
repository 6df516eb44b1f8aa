#pragma once

#include <vector>

#include "dowel/catalog/feature.h"
#include "revolved_bands.h"

namespace dowel {

/// Outside cylinders, one feature without name for each. Unordered.
std::vector<Feature> find_shafts(const std::vector<AxisBands>& axes);

}  // namespace dowel
