#include "fact_database.h"

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <string_view>
#include <utility>

#include <sqlite3.h>

#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "fact_call.h"
#include "fact_module.h"

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
  std::vector<FactLookup>* lookups = nullptr;  ///< of the query that is run on a focus
  std::string refused;                         ///< what the authorizer did not let pass
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
    auto& module = impl_->modules.emplace_back(std::make_unique<FactModule>());
    module->rows = &impl_->rows;
    module->table = i;
    module->thrown = &impl_->thrown;
    module->lookups = &impl_->lookups;
    add_module(impl_->database, *module);
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

std::vector<std::string> FactDatabase::columns(const Query& query) const {
  std::vector<std::string> names;
  const int count = sqlite3_column_count(query.impl_->statement);
  names.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    names.emplace_back(sqlite3_column_name(query.impl_->statement, i));
  }
  return names;
}

FactAnswer FactDatabase::run(Query& query) {
  sqlite3_stmt* const statement = query.impl_->statement;
  FactAnswer answer;
  answer.columns = columns(query);
  const int width = static_cast<int>(answer.columns.size());
  impl_->looks = 0;
  impl_->thrown = nullptr;
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(statement)) == SQLITE_ROW && answer.rows.size() < kMaxRows) {
    FactRow& row = answer.rows.emplace_back();
    for (int i = 0; i < width; ++i) row.push_back(value_in(statement, i));
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

FactAnswer FactDatabase::run_on(Query& query, const FactColumns& columns, const std::string& text,
                                std::vector<FactLookup>& lookups) {
  std::string key;
  add_to_key(key, text);
  for (const auto& [table, column] : columns) {
    impl_->modules.at(table)->focus = FactLookup{table, 1U << column, key};
  }
  impl_->lookups = &lookups;
  const auto release = [&] {
    for (const auto& [table, column] : columns) impl_->modules.at(table)->focus.reset();
    impl_->lookups = nullptr;
  };
  try {
    FactAnswer answer = run(query);
    release();
    return answer;
  } catch (...) {
    release();
    throw;
  }
}

bool FactDatabase::has(const FactLookup& lookup) {
  return impl_->modules.at(lookup.table)->index(lookup.columns).contains(lookup.key);
}

void FactDatabase::forget(std::size_t table, const std::set<std::size_t>& columns) {
  unsigned bits = 0;
  for (const std::size_t column : columns) bits |= 1U << column;
  std::erase_if(impl_->modules.at(table)->indices,
                [&](const auto& index) { return (index.first & bits) != 0; });
}

}  // namespace dowel
