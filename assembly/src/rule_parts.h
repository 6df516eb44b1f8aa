#pragma once

// A rule that is evaluated text by text of a column. Internal to the rule engine.

#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "dowel/assembly/rules.h"
#include "fact_database.h"
#include "kept_facts.h"

namespace dowel {

/// The columns that a rule's header names behind `each:`; none where it does not. Throws
/// FactQueryError for what is no column of a table that the query reads.
FactColumns each_columns(const Rule& rule, const FactReads& reads);

/// What a rule says for one text of its column.
struct RulePart {
  std::vector<RuleFinding> findings;
  std::vector<FactLookup> lookups;  ///< what it hangs on; sorted, each once
};

/// A rule's parts by their texts, and which of them an edit may change.
class RuleParts {
 public:
  void put(const std::string& text, RulePart part);
  void drop(const std::string& text);
  void clear();

  bool contains(const std::string& text) const { return parts_.contains(text); }
  /// All that there are.
  std::set<std::string> texts() const;
  /// Adds those whose lookups find one of the changed rows, before or after; rows that differ in
  /// other columns than `columns` alone are as they were to the rule.
  void add_touched(std::size_t table, const std::set<std::size_t>& columns,
                   const std::vector<RowChange>& changes, std::set<std::string>& texts) const;
  /// In the order of the texts.
  std::vector<RuleFinding> findings() const;

 private:
  using Texts = std::set<std::string>;
  std::map<std::string, RulePart> parts_;
  /// Texts by table, columns and key of what they looked up.
  std::map<std::size_t, std::map<unsigned, std::unordered_map<std::string, Texts>>> looked_up_;
};

}  // namespace dowel
