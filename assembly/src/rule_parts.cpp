#include "rule_parts.h"

#include <algorithm>
#include <sstream>
#include <utility>

namespace dowel {

FactColumns each_columns(const Rule& rule, const FactReads& reads) {
  FactColumns columns;
  std::istringstream names(rule.each);
  std::string name;
  const auto& tables = fact_tables();
  while (std::getline(names >> std::ws, name, ',')) {
    const FactQueryError wrong{
        "each: expected TABLE.COLUMN of a table that its query reads, not \"" + name + "\"",
        rule.sql.find("each:"), true};
    const std::size_t dot = name.find('.');
    const auto table = std::ranges::find(tables, name.substr(0, dot),
                                         [](const FactTable& t) { return std::string(t.name); });
    if (dot == std::string::npos || table == tables.end()) throw wrong;
    const auto column = std::ranges::find(table->columns, name.substr(dot + 1),
                                          [](const FactColumn& c) { return std::string(c.name); });
    const auto index = static_cast<std::size_t>(table - tables.begin());
    if (column == table->columns.end() || !reads.contains(index)) throw wrong;
    columns[index] = static_cast<std::size_t>(column - table->columns.begin());
  }
  return columns;
}

void RuleParts::put(const std::string& text, RulePart part) {
  drop(text);
  std::ranges::sort(part.lookups);
  part.lookups.erase(std::unique(part.lookups.begin(), part.lookups.end()), part.lookups.end());
  for (const FactLookup& lookup : part.lookups) {
    looked_up_[lookup.table][lookup.columns][lookup.key].insert(text);
  }
  parts_.emplace(text, std::move(part));
}

void RuleParts::drop(const std::string& text) {
  const auto part = parts_.find(text);
  if (part == parts_.end()) return;
  for (const FactLookup& lookup : part->second.lookups) {
    auto& by_key = looked_up_[lookup.table][lookup.columns];
    const auto found = by_key.find(lookup.key);
    found->second.erase(text);
    if (found->second.empty()) by_key.erase(found);
  }
  parts_.erase(part);
}

void RuleParts::clear() {
  parts_.clear();
  looked_up_.clear();
}

std::set<std::string> RuleParts::texts() const {
  std::set<std::string> all;
  for (const auto& [text, part] : parts_) all.insert(text);
  return all;
}

void RuleParts::add_touched(std::size_t table, const std::set<std::size_t>& columns,
                            const std::vector<RowChange>& changes,
                            std::set<std::string>& texts) const {
  const auto lookups = looked_up_.find(table);
  if (lookups == looked_up_.end()) return;
  for (const RowChange& change : changes) {
    const bool is_same = !change.before.empty() && !change.after.empty() &&
                         std::ranges::all_of(columns, [&](std::size_t column) {
                           return change.before[column] == change.after[column];
                         });
    if (is_same) continue;
    for (const FactRow* row : {&change.before, &change.after}) {
      if (row->empty()) continue;
      for (const auto& [bits, by_key] : lookups->second) {
        const auto key = lookup_key(*row, bits);
        const auto found = key ? by_key.find(*key) : by_key.end();
        if (found != by_key.end()) texts.insert(found->second.begin(), found->second.end());
      }
    }
  }
}

std::vector<RuleFinding> RuleParts::findings() const {
  std::vector<RuleFinding> all;
  for (const auto& [text, part] : parts_) {
    all.insert(all.end(), part.findings.begin(), part.findings.end());
  }
  return all;
}

}  // namespace dowel
