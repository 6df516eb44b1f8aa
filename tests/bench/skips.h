#pragma once

#include <vector>

#include "measure.h"
#include "table.h"

namespace dowel::bench {

/// What each layer of dowel's pipeline rejects on the motions of the paper's scenarios, how often
/// each skip is used there, and what a check takes without it, without any, and by brute force.
std::vector<Table> run_skip_study(const Plan& plan);

}  // namespace dowel::bench
