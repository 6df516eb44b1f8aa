#pragma once

#include <vector>

#include "measure.h"
#include "table.h"

namespace dowel::bench {

/// Commands of a session on a project with many instances: checked, and journalled on disk.
std::vector<Table> run_project_study(const Plan& plan);

}  // namespace dowel::bench
