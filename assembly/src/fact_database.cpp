#include "fact_database.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <exception>
#include <map>
#include <new>
#include <optional>
#include <string_view>
#include <unordered_map>
#include <utility>

#include <sqlite3.h>

#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "fact_call.h"

namespace dowel {
namespace {

/// Steps of SQLite's machine between two looks at the budget, and the budget: some seconds. In
/// steps rather than seconds, so that the same rule ends the same way on every machine.
constexpr int kStepsBetweenLooks = 10'000;
constexpr int kMaxLooks = 20'000;

/// Bytes of a text or blob, and rows of an answer, beyond any that a rule could mean.
constexpr int kMaxBytes = 1'000'000;
constexpr std::size_t kMaxRows = 200'000;

/// Functions that answer differently to the same question, or reach out of the database.
constexpr std::array<std::string_view, 16> kRefusedFunctions{
    "changes", "current_date",  "current_time",   "current_timestamp",
    "date",    "datetime",      "julianday",      "last_insert_rowid",
    "random",  "randomblob",    "load_extension", "strftime",
    "time",    "total_changes", "unixepoch",      "zeroblob"};

}  // namespace

/// One virtual table and its indices, made when a query first looks something up.
struct FactModule {
  /// Rows by the texts that they have in the index's columns.
  using Index = std::unordered_map<std::string, std::vector<std::size_t>>;

  FactDatabase::RowsOf* rows = nullptr;
  std::size_t table = 0;
  std::exception_ptr* thrown = nullptr;
  std::map<unsigned, Index> indices;  ///< by the bits of their columns

  const Index& index(unsigned columns) {
    const auto [entry, is_new] = indices.try_emplace(columns);
    if (is_new) {
      const FactRows& all = (*rows)(table);
      for (std::size_t i = 0; i < all.size(); ++i) {
        if (const auto key = key_of(all[i], columns)) entry->second[*key].push_back(i);
      }
    }
    return entry->second;
  }

  static void add_to_key(std::string& key, std::string_view text) {
    key += std::to_string(text.size());
    key += ':';
    key += text;
  }

  /// Nothing where a column holds no text: it equals none.
  static std::optional<std::string> key_of(const FactRow& row, unsigned columns) {
    std::string key;
    for (std::size_t column = 0; column < row.size(); ++column) {
      if ((columns >> column & 1U) == 0) continue;
      const auto* const text = std::get_if<std::string>(&row[column]);
      if (text == nullptr) return std::nullopt;
      add_to_key(key, *text);
    }
    return key;
  }
};

/// Bits of an index that SQLite keeps as an int.
constexpr int kMaxIndexColumns = 31;

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
  std::array<int, kMaxIndexColumns> constraint_on{};
  constraint_on.fill(-1);
  for (int i = 0; i < info->nConstraint; ++i) {
    const auto& constraint = info->aConstraint[i];
    if (constraint.usable == 0 || constraint.op != SQLITE_INDEX_CONSTRAINT_EQ ||
        constraint.iColumn < 0 || constraint.iColumn >= kMaxIndexColumns) {
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
    FactModule::add_to_key(key.second,
                           {text, static_cast<std::size_t>(sqlite3_value_bytes(value))});
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
    const auto [text_columns, key] = key_of(static_cast<unsigned>(columns), values);
    if (text_columns != 0) {
      const auto& index = facts.index(text_columns);
      const auto entry = index.find(key);
      cursor->found = entry == index.end() ? &kNone : &entry->second;
    }
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

bool is_refused(std::string_view function) {
  return std::ranges::find(kRefusedFunctions, function) != kRefusedFunctions.end();
}

FactValue value_in(sqlite3_stmt* statement, int column_number) {
  switch (sqlite3_column_type(statement, column_number)) {
    case SQLITE_INTEGER:
      return std::int64_t{sqlite3_column_int64(statement, column_number)};
    case SQLITE_FLOAT:
      return sqlite3_column_double(statement, column_number);
    case SQLITE_NULL:
      return FactValue();
    default: {
      const auto* text = static_cast<const char*>(sqlite3_column_blob(statement, column_number));
      const int size = sqlite3_column_bytes(statement, column_number);
      return text == nullptr ? FactValue(std::string())
                             : FactValue(std::string(text, static_cast<std::size_t>(size)));
    }
  }
}

bool is_blank(const char* text) {
  return std::string_view(text).find_first_not_of(" \t\r\n;") == std::string_view::npos;
}

}  // namespace

struct FactDatabase::Impl {
  RowsOf rows;
  Call call;
  std::vector<std::unique_ptr<FunctionEntry>> functions;
  std::vector<std::unique_ptr<FactModule>> modules;
  std::exception_ptr thrown;
  sqlite3* database = nullptr;
  FactReads* reads = nullptr;  ///< of the query that is being prepared
  std::set<std::size_t>* calls = nullptr;
  std::string refused;  ///< what the authorizer did not let pass
  int looks = 0;

  int authorize(int action, const char* first, const char* second);
  void add_functions();
  void note_call(std::string_view name);
};

namespace {

/// SQLite names no column where a query counts rows alone.
void note_read(std::set<std::size_t>& columns, const FactTable& table, const char* column) {
  const auto found =
      std::ranges::find(table.columns, std::string_view(column ? column : ""),
                        [](const FactColumn& c) { return std::string_view(c.name); });
  if (found == table.columns.end()) return;
  columns.insert(static_cast<std::size_t>(found - table.columns.begin()));
}

}  // namespace

/// Called by SQLite for all that a statement would do.
int FactDatabase::Impl::authorize(int action, const char* first, const char* second) {
  const std::string_view name = first != nullptr ? first : "";
  if (action == SQLITE_SELECT || action == SQLITE_RECURSIVE) return SQLITE_OK;
  if (action == SQLITE_READ) {
    const auto& tables = fact_tables();
    for (std::size_t i = 0; i < tables.size(); ++i) {
      if (name != tables[i].name) continue;
      if (reads != nullptr) note_read((*reads)[i], tables[i], second);
      return SQLITE_OK;
    }
    if (name != "sqlite_master" && name != "sqlite_schema") return SQLITE_OK;  // WITH, subqueries
    refused = "the database's own tables are not to be read";
    return SQLITE_DENY;
  }
  refused = action == SQLITE_FUNCTION ? "function " + std::string(name) + "() is not for rules"
                                      : std::string("a rule may only read: expected one SELECT");
  return SQLITE_DENY;
}

struct FactDatabase::Query::Impl {
  sqlite3_stmt* statement = nullptr;
  FactReads reads;
  std::set<std::size_t> calls;
};

FactDatabase::Query::Query(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
FactDatabase::Query::~Query() {
  sqlite3_finalize(impl_->statement);
}
const FactReads& FactDatabase::Query::reads() const {
  return impl_->reads;
}

const std::set<std::size_t>& FactDatabase::Query::calls() const {
  return impl_->calls;
}

void FactDatabase::Impl::add_functions() {
  for (std::size_t i = 0; i < fact_functions().size(); ++i) {
    const FactFunction& function = fact_functions()[i];
    auto& entry = functions.emplace_back(std::make_unique<FunctionEntry>());
    *entry = {&call, i, &thrown};
    const int code = sqlite3_create_function_v2(database, function.name, function.argument_count,
                                                SQLITE_UTF8 | SQLITE_DETERMINISTIC, entry.get(),
                                                call_function, nullptr, nullptr, nullptr);
    DOWEL_EXPECTS(code == SQLITE_OK);
  }
}

/// Of the functions of one name that take other numbers of arguments (`rank`), all count.
void FactDatabase::Impl::note_call(std::string_view name) {
  for (std::size_t i = 0; i < fact_functions().size(); ++i) {
    if (calls != nullptr && name == fact_functions()[i].name) calls->insert(i);
  }
}

FactDatabase::FactDatabase(RowsOf rows, Call call) : impl_(std::make_unique<Impl>()) {
  impl_->rows = std::move(rows);
  impl_->call = std::move(call);
  if (sqlite3_open_v2(":memory:", &impl_->database, SQLITE_OPEN_READWRITE, nullptr) != SQLITE_OK) {
    sqlite3_close(impl_->database);
    throw std::bad_alloc();
  }
  for (std::size_t i = 0; i < fact_tables().size(); ++i) {
    DOWEL_EXPECTS(fact_tables()[i].columns.size() <= kMaxIndexColumns);
    auto& module = impl_->modules.emplace_back(std::make_unique<FactModule>());
    module->rows = &impl_->rows;
    module->table = i;
    module->thrown = &impl_->thrown;
    sqlite3_create_module_v2(impl_->database, fact_tables()[i].name, &kFactModule, module.get(),
                             nullptr);
  }
  impl_->add_functions();
  // A table is made when it is first named, which takes more than the authorizer lets a rule do.
  for (const FactTable& table : fact_tables()) {
    const std::string sql = std::string("SELECT 1 FROM \"") + table.name + "\"";
    sqlite3_stmt* statement = nullptr;
    const int code = sqlite3_prepare_v2(impl_->database, sql.c_str(), -1, &statement, nullptr);
    sqlite3_finalize(statement);
    DOWEL_EXPECTS(code == SQLITE_OK);
  }
  sqlite3_limit(impl_->database, SQLITE_LIMIT_LENGTH, kMaxBytes);
  sqlite3_limit(impl_->database, SQLITE_LIMIT_ATTACHED, 0);
  // "name" in double quotes is a name; were it a text where no column has it, a slip would pass.
  sqlite3_db_config(impl_->database, SQLITE_DBCONFIG_DQS_DML, 0, nullptr);
  sqlite3_db_config(impl_->database, SQLITE_DBCONFIG_DQS_DDL, 0, nullptr);
  sqlite3_set_authorizer(
      impl_->database,
      [](void* impl, int action, const char* first, const char* second, const char*, const char*) {
        auto* const self = static_cast<Impl*>(impl);
        if (action == SQLITE_FUNCTION) {
          if (second != nullptr) self->note_call(second);
          return second != nullptr && !is_refused(second)
                     ? SQLITE_OK
                     : self->authorize(action, second, nullptr);
        }
        return self->authorize(action, first, second);
      },
      impl_.get());
  sqlite3_progress_handler(
      impl_->database, kStepsBetweenLooks,
      [](void* impl) { return ++static_cast<Impl*>(impl)->looks > kMaxLooks ? 1 : 0; },
      impl_.get());
}

FactDatabase::~FactDatabase() {
  sqlite3_close_v2(impl_->database);
}

std::unique_ptr<FactDatabase::Query> FactDatabase::prepare(const std::string& sql) {
  auto made = std::make_unique<Query::Impl>();
  impl_->reads = &made->reads;
  impl_->calls = &made->calls;
  impl_->refused.clear();
  impl_->looks = 0;
  const char* tail = nullptr;
  const int code = sqlite3_prepare_v3(impl_->database, sql.c_str(), static_cast<int>(sql.size()),
                                      SQLITE_PREPARE_PERSISTENT, &made->statement, &tail);
  impl_->reads = nullptr;
  impl_->calls = nullptr;
  if (code != SQLITE_OK) {
    const int offset = sqlite3_error_offset(impl_->database);
    const std::string message =
        impl_->refused.empty() ? std::string(sqlite3_errmsg(impl_->database)) : impl_->refused;
    throw FactQueryError{message, offset < 0 ? 0 : static_cast<std::size_t>(offset), offset >= 0};
  }
  auto query = std::unique_ptr<Query>(new Query(std::move(made)));
  if (query->impl_->statement == nullptr) throw FactQueryError{"there is no query", 0, false};
  if (!is_blank(tail)) {
    throw FactQueryError{"expected one query, found more behind it",
                         static_cast<std::size_t>(tail - sql.c_str()), true};
  }
  return query;
}

FactAnswer FactDatabase::run(Query& query) {
  sqlite3_stmt* const statement = query.impl_->statement;
  FactAnswer answer;
  const int columns = sqlite3_column_count(statement);
  for (int i = 0; i < columns; ++i) answer.columns.emplace_back(sqlite3_column_name(statement, i));
  impl_->looks = 0;
  impl_->thrown = nullptr;
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(statement)) == SQLITE_ROW && answer.rows.size() < kMaxRows) {
    FactRow& row = answer.rows.emplace_back();
    for (int i = 0; i < columns; ++i) row.push_back(value_in(statement, i));
  }
  const std::string message = code == SQLITE_ROW ? "more than 200000 rows"
                              : code == SQLITE_INTERRUPT
                                  ? "broken off: it takes too long, as a query without an end does"
                                  : sqlite3_errmsg(impl_->database);
  sqlite3_reset(statement);
  if (impl_->thrown != nullptr) std::rethrow_exception(std::exchange(impl_->thrown, nullptr));
  if (code != SQLITE_DONE) throw FactQueryError{message, 0, false};
  return answer;
}

void FactDatabase::forget(std::size_t table, const std::set<std::size_t>& columns) {
  unsigned bits = 0;
  for (const std::size_t column : columns) bits |= 1U << column;
  std::erase_if(impl_->modules.at(table)->indices,
                [&](const auto& index) { return (index.first & bits) != 0; });
}

}  // namespace dowel
