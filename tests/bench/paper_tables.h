#pragma once

#include <vector>

#include "report.h"

namespace dowel::bench {

/// The paper's Table 1 (triangles by class) and Table 2 (tests of colliding moves) beside ours,
/// from what `results` has of the scenarios; nothing where it has none.
std::vector<Table> paper_tables(const Results& results);

}  // namespace dowel::bench
