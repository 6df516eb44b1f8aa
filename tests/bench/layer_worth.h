#pragma once

#include "measure.h"
#include "table.h"

namespace dowel::bench {

/// What each layer before the narrow phase is worth: the check with one of them left out.
Table layer_worth(const Plan& plan);

}  // namespace dowel::bench
