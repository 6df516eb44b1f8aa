#include "fact_module.h"

#include <array>
#include <cstring>
#include <memory>
#include <string_view>
#include <tuple>
#include <utility>

#include <sqlite3.h>

#include "dowel/kernel/check.h"

namespace dowel {

const FactModule::Index& FactModule::index(unsigned columns) {
  const auto [entry, is_new] = indices.try_emplace(columns);
  if (is_new) {
    const FactRows& all = (*rows)(table);
    for (std::size_t i = 0; i < all.size(); ++i) {
      if (const auto key = lookup_key(all[i], columns)) entry->second[*key].push_back(i);
    }
  }
  return entry->second;
}

namespace {

struct VirtualTable : sqlite3_vtab {
  FactModule* module = nullptr;
};

struct Cursor : sqlite3_vtab_cursor {
  const FactRows* rows = nullptr;
  const std::vector<std::size_t>* found = nullptr;  // those of an index; all where none was asked
  std::size_t next = 0;

  std::size_t size() const { return found != nullptr ? found->size() : rows->size(); }
  std::size_t row() const { return found != nullptr ? (*found)[next] : next; }
};

FactModule& module_of(sqlite3_vtab_cursor* cursor) {
  return *static_cast<VirtualTable*>(cursor->pVtab)->module;
}

int connect(sqlite3* database, void* module, int, const char* const*, sqlite3_vtab** table,
            char**) {
  auto* const facts = static_cast<FactModule*>(module);
  std::string sql = "CREATE TABLE x(";
  for (const FactColumn& column : fact_tables()[facts->table].columns) {
    sql += (sql.back() == '(' ? "\"" : ", \"") + std::string(column.name) + "\"";
  }
  if (const int code = sqlite3_declare_vtab(database, (sql + ")").c_str()); code != SQLITE_OK) {
    return code;
  }
  auto made = std::make_unique<VirtualTable>();
  made->module = facts;
  *table = made.release();
  return SQLITE_OK;
}

int disconnect(sqlite3_vtab* table) {
  const std::unique_ptr<VirtualTable> owned(static_cast<VirtualTable*>(table));
  return SQLITE_OK;
}

/// Equalities are looked up in an index of their columns; SQLite tests them all again.
int best_index(sqlite3_vtab*, sqlite3_index_info* info) {
  constexpr double kRows = 1000.0;
  constexpr double kShare = 0.02;  // of the rows that have one text in a column
  std::array<int, kMaxLookupColumns> constraint_on{};
  constraint_on.fill(-1);
  for (int i = 0; i < info->nConstraint; ++i) {
    const auto& constraint = info->aConstraint[i];
    if (constraint.usable == 0 || constraint.op != SQLITE_INDEX_CONSTRAINT_EQ ||
        constraint.iColumn < 0 || constraint.iColumn >= static_cast<int>(kMaxLookupColumns)) {
      continue;
    }
    // A value that compares equal in another type or collation has another place in the index.
    if (std::strcmp(sqlite3_vtab_collation(info, i), "BINARY") != 0) continue;
    constraint_on[static_cast<std::size_t>(constraint.iColumn)] = i;
  }
  double rows = kRows;
  int values = 0;
  unsigned columns = 0;
  for (std::size_t column = 0; column < constraint_on.size(); ++column) {
    if (constraint_on[column] < 0) continue;
    info->aConstraintUsage[constraint_on[column]].argvIndex = ++values;
    columns |= 1U << column;
    rows *= kShare;
  }
  info->idxNum = static_cast<int>(columns);
  info->estimatedCost = rows + 1.0;
  info->estimatedRows = static_cast<sqlite3_int64>(rows + 1.0);
  return SQLITE_OK;
}

int open_cursor(sqlite3_vtab*, sqlite3_vtab_cursor** cursor) {
  *cursor = std::make_unique<Cursor>().release();
  return SQLITE_OK;
}

int close_cursor(sqlite3_vtab_cursor* cursor) {
  const std::unique_ptr<Cursor> owned(static_cast<Cursor*>(cursor));
  return SQLITE_OK;
}

/// The columns whose value is a text, and what to look up: 1 and 1.0 are equal to SQLite, so that
/// numbers are left to it.
std::pair<unsigned, std::string> key_of(unsigned columns, sqlite3_value** values) {
  std::pair<unsigned, std::string> key;
  for (unsigned column = 0; columns >> column != 0; ++column) {
    if ((columns >> column & 1U) == 0) continue;
    sqlite3_value* const value = *values++;
    if (sqlite3_value_type(value) != SQLITE_TEXT) continue;
    key.first |= 1U << column;
    const auto* text = reinterpret_cast<const char*>(sqlite3_value_text(value));
    add_to_key(key.second, {text, static_cast<std::size_t>(sqlite3_value_bytes(value))});
  }
  return key;
}

int filter(sqlite3_vtab_cursor* base, int columns, const char*, int, sqlite3_value** values) {
  static const std::vector<std::size_t> kNone;
  auto* const cursor = static_cast<Cursor*>(base);
  FactModule& facts = module_of(base);
  try {
    cursor->rows = &(*facts.rows)(facts.table);
    cursor->next = 0;
    cursor->found = nullptr;
    FactLookup lookup = facts.focus ? *facts.focus : FactLookup{facts.table, 0, {}};
    if (!facts.focus) {
      std::tie(lookup.columns, lookup.key) = key_of(static_cast<unsigned>(columns), values);
    }
    if (lookup.columns != 0) {
      const auto& index = facts.index(lookup.columns);
      const auto entry = index.find(lookup.key);
      cursor->found = entry == index.end() ? &kNone : &entry->second;
    }
    if (*facts.lookups != nullptr) (*facts.lookups)->push_back(std::move(lookup));
    return SQLITE_OK;
  } catch (...) {
    // No exception may pass through SQLite; it goes on where the query was started.
    *facts.thrown = std::current_exception();
    return SQLITE_ABORT;
  }
}

int advance(sqlite3_vtab_cursor* base) {
  ++static_cast<Cursor*>(base)->next;
  return SQLITE_OK;
}

int at_end(sqlite3_vtab_cursor* base) {
  const auto* const cursor = static_cast<Cursor*>(base);
  return cursor->next >= cursor->size() ? 1 : 0;
}

int column(sqlite3_vtab_cursor* base, sqlite3_context* context, int number) {
  const auto* const cursor = static_cast<Cursor*>(base);
  const FactValue& value = (*cursor->rows)[cursor->row()][static_cast<std::size_t>(number)];
  if (const auto* const integer = std::get_if<std::int64_t>(&value)) {
    sqlite3_result_int64(context, *integer);
  } else if (const auto* const real = std::get_if<double>(&value)) {
    sqlite3_result_double(context, *real);
  } else if (const auto* const text = std::get_if<std::string>(&value)) {
    // The rows stay while a query runs.
    sqlite3_result_text(context, text->data(), static_cast<int>(text->size()), SQLITE_STATIC);
  } else {
    sqlite3_result_null(context);
  }
  return SQLITE_OK;
}

int row_id(sqlite3_vtab_cursor* base, sqlite3_int64* id) {
  *id = static_cast<sqlite3_int64>(static_cast<Cursor*>(base)->row());
  return SQLITE_OK;
}

/// Without xCreate: the tables are there, by their names, in every database.
sqlite3_module fact_module() {
  sqlite3_module module{};
  module.xConnect = connect;
  module.xDisconnect = disconnect;
  module.xBestIndex = best_index;
  module.xOpen = open_cursor;
  module.xClose = close_cursor;
  module.xFilter = filter;
  module.xNext = advance;
  module.xEof = at_end;
  module.xColumn = column;
  module.xRowid = row_id;
  return module;
}

const sqlite3_module kFactModule = fact_module();

}  // namespace

void add_module(sqlite3* database, FactModule& module) {
  const FactTable& table = fact_tables()[module.table];
  DOWEL_EXPECTS(table.columns.size() <= kMaxLookupColumns);
  sqlite3_create_module_v2(database, table.name, &kFactModule, &module, nullptr);
}

}  // namespace dowel
