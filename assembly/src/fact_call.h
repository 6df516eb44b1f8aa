#pragma once

// A function of rules as SQLite calls it. Internal to the rule engine.

#include <cstddef>
#include <exception>

#include "fact_database.h"

struct sqlite3_context;
struct sqlite3_value;

namespace dowel {

/// What SQLite is given of a function.
struct FunctionEntry {
  const FactDatabase::Call* call = nullptr;
  std::size_t function = 0;
  std::exception_ptr* thrown = nullptr;
};

/// The user data of `context` is a FunctionEntry.
void call_function(sqlite3_context* context, int count, sqlite3_value** values);

}  // namespace dowel
