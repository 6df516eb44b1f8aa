#pragma once

#include "measure.h"
#include "table.h"

namespace dowel::bench {

/// Mates that hold by next to nothing: condition against error.
Table mate_conditions(const Plan& plan);

}  // namespace dowel::bench
