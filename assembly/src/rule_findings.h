#pragma once

// A rule's answer as findings. Internal to the rule engine.

#include <vector>

#include "dowel/assembly/rules.h"
#include "fact_database.h"

namespace dowel {

/// One a row. Throws FactQueryError where the answer is not what the rule's form asks for.
std::vector<RuleFinding> findings_of(const Rule& rule, const FactAnswer& answer);

}  // namespace dowel
