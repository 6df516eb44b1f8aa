#pragma once

#include <vector>

#include "measure.h"
#include "table.h"

namespace dowel::bench {

/// What each layer before the narrow phase is worth: the check with one of them left out. What the
/// narrow phase remembers of pairs, and what decides in it.
std::vector<Table> layer_worth(const Plan& plan);

}  // namespace dowel::bench
