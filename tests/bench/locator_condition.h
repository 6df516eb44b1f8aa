#pragma once

#include "measure.h"
#include "table.h"

namespace dowel::bench {

/// Locators that hold the workpiece by next to nothing: condition against error.
Table locator_conditions(const Plan& plan);

}  // namespace dowel::bench
