#pragma once

// Fact tables as they are kept from one check to the next. Internal to the rule engine.

#include <cstdint>
#include <functional>
#include <set>
#include <vector>

#include "fact_table.h"

namespace dowel {

/// A row before and after an edit; the one that is not there is empty.
struct RowChange {
  FactRow before;
  FactRow after;
};

/// What turns one into the other. Rows that are in neither end keep their order.
std::vector<RowChange> row_changes(const FactRows& before, const FactRows& after);

/// Tables made when they are first read, and what the last edit changed in them.
class KeptFacts {
 public:
  /// Told of columns that are not what they were.
  using Changed = std::function<void(std::size_t table, const std::set<std::size_t>& columns)>;

  /// `source` outlives it.
  KeptFacts(FactSource& source, Changed changed);

  /// Tables with one of these inputs (FactInput) are made anew when they are next read; changes
  /// count from here.
  void expire(unsigned inputs);

  /// The reference holds until the facts expire.
  const FactRows& rows(std::size_t table);
  /// Grows when one of the columns changes, or how many rows there are.
  std::uint64_t version(std::size_t table, const std::set<std::size_t>& columns);
  /// Since the facts expired.
  const std::vector<RowChange>& changes(std::size_t table);

 private:
  struct Table {
    FactRows rows;
    std::vector<RowChange> changes;
    bool is_stale = true;
    std::uint64_t times_changed = 0;
    std::vector<std::uint64_t> versions;  ///< by column: the last of these that changed it
    std::uint64_t count_version = 0;      ///< the last that changed the number of rows
  };

  FactSource& source_;
  Changed changed_;
  std::vector<Table> tables_;
};

}  // namespace dowel
