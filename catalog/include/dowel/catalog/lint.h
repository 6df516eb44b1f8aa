#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "dowel/catalog/catalog.h"
#include "dowel/catalog/element.h"
#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Something wrong with the data of one element.
struct LintFinding {
  enum class Severity { Warning, Error };
  std::string rule;  ///< "CAT-01" … "CAT-10", see catalog/README.md
  Severity severity = Severity::Error;
  std::string element;  ///< its name
  std::string message;  ///< one sentence with the numbers

  bool operator==(const LintFinding&) const = default;
};

/// "warning" or "error".
std::string_view to_string(LintFinding::Severity severity);

/// What is wrong with one element by itself (CAT-01 to CAT-06, CAT-09, CAT-10), by rule.
/// Expects: `solid` as from_blob returns it (its indices are in range).
std::vector<LintFinding> lint(const Element& element, const FacetedSolid& solid);

/// What is wrong with the catalogue, by name of the element and rule: each element by itself, equal
/// ones among them (CAT-07), fasteners beside the next smaller size (CAT-01), and those that cannot
/// be read (CAT-08). Goes on past damage where the list of names can be read; throws Error where it
/// cannot.
std::vector<LintFinding> lint(const Catalog& catalog);

}  // namespace dowel
