#pragma once

#include <vector>

#include "measure.h"
#include "table.h"

namespace dowel::bench {

/// Where verdicts hold and where they break: far from the origin, for small and large parts, in
/// exact contact, at gaps down to a millionth of a micrometre, on slivers, nearly parallel edges,
/// after long motions, for mates and locators that are nearly singular.
std::vector<Table> run_stability(const Plan& plan);

}  // namespace dowel::bench
