#pragma once

// The facts as SQLite tables, and queries that can do nothing but read them. Internal to the rule
// engine.

#include <cstddef>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "fact_function.h"
#include "fact_lookup.h"
#include "fact_table.h"

namespace dowel {

/// An answer to a query.
struct FactAnswer {
  std::vector<std::string> columns;
  FactRows rows;
};

/// A query that cannot be prepared or breaks off.
struct FactQueryError {
  std::string message;     ///< in SQLite's words
  std::size_t offset = 0;  ///< in the text, where SQLite tells
  bool has_offset = false;
};

/// Columns by table, both as in `fact_tables()`. A table without columns has its rows counted.
using FactReads = std::map<std::size_t, std::set<std::size_t>>;

/// Columns, one a table.
using FactColumns = std::map<std::size_t, std::size_t>;

/// An in-memory database in which each fact table is a virtual table, filled by `rows` when a query
/// first reads it. Queries may read the tables, call the functions of `fact_functions()` and those
/// of SQLite that depend on their arguments alone; SQLite's authorizer refuses all else, and a
/// query that takes too many steps is broken off.
class FactDatabase {
 public:
  /// Index of the table in `fact_tables()`; the reference holds until the facts change.
  using RowsOf = std::function<const FactRows&(std::size_t table)>;

  /// Index of the function in `fact_functions()`.
  using Call = std::function<FactValue(std::size_t function, std::span<const FactValue>)>;

  FactDatabase(RowsOf rows, Call call);
  ~FactDatabase();
  FactDatabase(const FactDatabase&) = delete;
  FactDatabase& operator=(const FactDatabase&) = delete;

  /// A prepared query, kept for another run.
  class Query {
   public:
    ~Query();
    Query(const Query&) = delete;
    Query& operator=(const Query&) = delete;
    /// What it reads, by the authorizer.
    const FactReads& reads() const;
    /// What it calls of `fact_functions()`.
    const std::set<std::size_t>& calls() const;

   private:
    friend class FactDatabase;
    struct Impl;
    explicit Query(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
  };

  /// Throws FactQueryError: bad SQL, unknown names, more than one statement, anything but reading.
  std::unique_ptr<Query> prepare(const std::string& sql);
  /// Throws FactQueryError, and what the making of facts throws.
  FactAnswer run(Query& query);
  /// The same where of each table of `columns` only those rows are seen that hold the text in its
  /// column. Adds to `lookups` what the answer hangs on: it stays while their rows do.
  FactAnswer run_on(Query& query, const FactColumns& columns, const std::string& text,
                    std::vector<FactLookup>& lookups);
  /// Names of the columns of its answer.
  std::vector<std::string> columns(const Query& query) const;
  /// Whether there is such a row.
  bool has(const FactLookup& lookup);
  /// These columns of a table are not what they were.
  void forget(std::size_t table, const std::set<std::size_t>& columns);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dowel
