#pragma once

// A fact table as SQLite sees it. Internal to the rule engine.

#include <exception>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "fact_database.h"

struct sqlite3;

namespace dowel {

/// One virtual table and its indices, made when a query first looks something up.
struct FactModule {
  /// Rows by the texts that they have in the index's columns.
  using Index = std::unordered_map<std::string, std::vector<std::size_t>>;

  FactDatabase::RowsOf* rows = nullptr;
  std::size_t table = 0;
  std::exception_ptr* thrown = nullptr;
  std::vector<FactLookup>** lookups = nullptr;  ///< noted there while a query runs that asks for it
  std::optional<FactLookup> focus;              ///< while it is set, no other rows are seen
  std::map<unsigned, Index> indices;            ///< by the bits of their columns

  const Index& index(unsigned columns);
};

/// Makes the table known to the database, by its name. `module` outlives the database.
void add_module(sqlite3* database, FactModule& module);

}  // namespace dowel
