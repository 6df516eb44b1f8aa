#include "kept_facts.h"

#include <algorithm>
#include <numeric>
#include <optional>
#include <span>

#include "dowel/kernel/check.h"

namespace dowel {
namespace {

using Rows = std::span<const FactRow>;

/// For each row of `after` the row of `before` that equals it, each taken once.
std::vector<std::optional<std::size_t>> matches(Rows before, Rows after) {
  std::vector<std::size_t> order(before.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::ranges::stable_sort(order,
                           [&](std::size_t a, std::size_t b) { return before[a] < before[b]; });
  std::vector<bool> is_taken(before.size(), false);
  std::vector<std::optional<std::size_t>> found(after.size());
  for (std::size_t j = 0; j < after.size(); ++j) {
    auto next =
        std::lower_bound(order.begin(), order.end(), after[j],
                         [&](std::size_t i, const FactRow& row) { return before[i] < row; });
    while (next != order.end() && before[*next] == after[j] && is_taken[*next]) ++next;
    if (next == order.end() || before[*next] != after[j]) continue;
    is_taken[*next] = true;
    found[j] = *next;
  }
  return found;
}

/// Answers to queries may hang on the order of rows, so that rows that changed places count as
/// others.
bool is_in_order(const std::vector<std::optional<std::size_t>>& found) {
  std::size_t next = 0;
  for (const auto& match : found) {
    if (!match) continue;
    if (*match < next) return false;
    next = *match + 1;
  }
  return true;
}

}  // namespace

std::vector<RowChange> row_changes(const FactRows& before, const FactRows& after) {
  const std::size_t shorter = std::min(before.size(), after.size());
  std::size_t first = 0;
  while (first < shorter && before[first] == after[first]) ++first;
  std::size_t last = 0;
  while (last < shorter - first &&
         before[before.size() - 1 - last] == after[after.size() - 1 - last]) {
    ++last;
  }
  const Rows old = Rows(before).subspan(first, before.size() - last - first);
  const Rows now = Rows(after).subspan(first, after.size() - last - first);
  std::vector<RowChange> changes;
  if (old.size() == now.size()) {
    for (std::size_t i = 0; i < old.size(); ++i) {
      if (old[i] != now[i]) changes.push_back({old[i], now[i]});
    }
    return changes;
  }
  auto found = matches(old, now);
  if (!is_in_order(found)) std::ranges::fill(found, std::nullopt);
  std::vector<bool> stays(old.size(), false);
  for (std::size_t j = 0; j < now.size(); ++j) {
    if (found[j]) {
      stays[*found[j]] = true;
    } else {
      changes.push_back({{}, now[j]});
    }
  }
  for (std::size_t i = 0; i < old.size(); ++i) {
    if (!stays[i]) changes.push_back({old[i], {}});
  }
  return changes;
}

KeptFacts::KeptFacts(FactSource& source, Changed changed)
    : source_(source), changed_(std::move(changed)), tables_(fact_tables().size()) {}

void KeptFacts::expire(unsigned inputs) {
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    tables_[i].changes.clear();
    if ((fact_tables()[i].inputs & inputs) != 0) tables_[i].is_stale = true;
  }
}

const FactRows& KeptFacts::rows(std::size_t table) {
  Table& known = tables_.at(table);
  if (!known.is_stale) return known.rows;
  FactRows now = fact_tables()[table].rows(source_);
  known.is_stale = false;
  const std::size_t columns = fact_tables()[table].columns.size();
  DOWEL_EXPECTS(
      std::ranges::all_of(now, [&](const FactRow& row) { return row.size() == columns; }));
  known.changes = row_changes(known.rows, now);
  const bool is_first = known.versions.empty();
  const bool is_resized = is_first || now.size() != known.rows.size();
  std::set<std::size_t> changed;
  for (std::size_t column = 0; column < columns; ++column) {
    if (is_resized || std::ranges::any_of(known.changes, [&](const RowChange& change) {
          return change.before[column] != change.after[column];
        })) {
      changed.insert(column);
    }
  }
  if (changed.empty()) return known.rows;
  ++known.times_changed;
  known.versions.resize(columns);
  for (const std::size_t column : changed) known.versions[column] = known.times_changed;
  if (is_resized) known.count_version = known.times_changed;
  known.rows = std::move(now);
  changed_(table, changed);
  return known.rows;
}

std::uint64_t KeptFacts::version(std::size_t table, const std::set<std::size_t>& columns) {
  rows(table);
  std::uint64_t last = tables_[table].count_version;
  for (const std::size_t column : columns) last = std::max(last, tables_[table].versions[column]);
  return last;
}

const std::vector<RowChange>& KeptFacts::changes(std::size_t table) {
  rows(table);
  return tables_[table].changes;
}

}  // namespace dowel
