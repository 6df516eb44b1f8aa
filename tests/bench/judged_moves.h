#pragma once

#include <vector>

#include "measure.h"
#include "table.h"

namespace dowel::bench {

/// Verdicts of many moves against their truth, untimed.
struct JudgedMoves {
  Table table;
  std::size_t dowel_wrong = 0;
};

/// `plan.poses` of each motion in five variants of each scenario: 140,000 moves at the default, of
/// which more than 100,000 are known.
JudgedMoves run_judged_moves(const std::vector<Method>& methods, const Plan& plan);

}  // namespace dowel::bench
