#pragma once

// Functions that rules can call beside the facts. Internal to the rule engine.

#include <span>
#include <vector>

#include "fact_table.h"

namespace dowel {

/// A quantity of what its arguments name, reckoned when a query calls it.
struct FactFunction {
  const char* name;
  const char* arguments;  ///< as they are written: "a, b"
  int argument_count;
  const char* meaning;  ///< of the value, with its unit
  unsigned inputs;      ///< of FactInput: it may be another after these changed
  /// Throws Error{InvalidInput} for an argument that names nothing.
  FactValue (*call)(FactSource& source, std::span<const FactValue> arguments);
};

/// All of them, by name.
const std::vector<FactFunction>& fact_functions();

}  // namespace dowel
