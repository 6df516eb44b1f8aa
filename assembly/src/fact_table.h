#pragma once

// Facts: what rules can read of a project. Internal to the rule engine.

#include <cstdint>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace dowel {

class FactSource;

using FactValue = std::variant<std::monostate, std::int64_t, double, std::string>;
using FactRow = std::vector<FactValue>;
using FactRows = std::vector<FactRow>;

struct FactColumn {
  const char* name;  ///< ends in its unit
  const char* meaning;
};

/// Parts of a project's state that a fact can be made of.
enum FactInput : unsigned { FromParts = 1U, FromMates = 2U, FromDesign = 4U, FromTolerance = 8U };

/// A table of facts: computed when a rule first reads it, and again after its inputs changed.
struct FactTable {
  const char* name;
  const char* meaning;
  std::vector<FactColumn> columns;
  unsigned inputs;  ///< of FactInput
  FactRows (*rows)(FactSource& source);
};

/// All of them, by name.
const std::vector<FactTable>& fact_tables();

// By file.
std::vector<FactTable> part_facts();
std::vector<FactTable> mate_facts();
std::vector<FactTable> pair_facts();
std::vector<FactTable> axis_facts();
std::vector<FactTable> locating_facts();
std::vector<FactTable> design_facts();
std::vector<FactTable> stated_facts();
std::vector<FactTable> slot_facts();
std::vector<FactTable> access_facts();
std::vector<FactTable> washer_facts();
std::vector<FactTable> order_facts();

/// Truth as SQL has it.
inline FactValue truth(bool value) {
  return std::int64_t{value ? 1 : 0};
}

/// NULL where nobody says.
inline FactValue text_or_null(const std::string& text) {
  return text.empty() ? FactValue() : FactValue(text);
}

}  // namespace dowel
