#pragma once

#include <vector>

#include "measure.h"
#include "methods.h"
#include "table.h"

namespace dowel::bench {

/// What each method builds before the first move in the scenes of the paper: time and memory.
Table preparation(const std::vector<Method>& methods, const Plan& plan);

}  // namespace dowel::bench
