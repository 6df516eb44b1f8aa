#include "fact_call.h"

#include <string>
#include <variant>

#include <sqlite3.h>

namespace dowel {
namespace {

FactValue value_of(sqlite3_value* value) {
  switch (sqlite3_value_type(value)) {
    case SQLITE_INTEGER:
      return std::int64_t{sqlite3_value_int64(value)};
    case SQLITE_FLOAT:
      return sqlite3_value_double(value);
    case SQLITE_NULL:
      return FactValue();
    default: {
      const auto* const text = reinterpret_cast<const char*>(sqlite3_value_text(value));
      if (text == nullptr) return std::string();
      return std::string(text, static_cast<std::size_t>(sqlite3_value_bytes(value)));
    }
  }
}

void return_value(sqlite3_context* context, const FactValue& value) {
  if (const auto* const integer = std::get_if<std::int64_t>(&value)) {
    sqlite3_result_int64(context, *integer);
  } else if (const auto* const real = std::get_if<double>(&value)) {
    sqlite3_result_double(context, *real);
  } else if (const auto* const text = std::get_if<std::string>(&value)) {
    sqlite3_result_text(context, text->data(), static_cast<int>(text->size()), SQLITE_TRANSIENT);
  } else {
    sqlite3_result_null(context);
  }
}

}  // namespace

void call_function(sqlite3_context* context, int count, sqlite3_value** values) {
  const auto& entry = *static_cast<const FunctionEntry*>(sqlite3_user_data(context));
  try {
    FactRow arguments;
    for (int i = 0; i < count; ++i) arguments.push_back(value_of(values[i]));
    return_value(context, (*entry.call)(entry.function, arguments));
  } catch (...) {
    // No exception may pass through SQLite; it goes on where the query was started.
    *entry.thrown = std::current_exception();
    sqlite3_result_error_code(context, SQLITE_ABORT);
  }
}

}  // namespace dowel
