#pragma once

#include <vector>

#include "measure.h"
#include "table.h"

namespace dowel::bench {

/// The shipped design rules on a fixture: a full check, and one after each move of a part.
std::vector<Table> run_rule_study(const Plan& plan);

}  // namespace dowel::bench
