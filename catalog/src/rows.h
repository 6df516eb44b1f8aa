#pragma once

// Rows of SQLite tables, written and read column by column. Internal to the store.

#include <array>
#include <charconv>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <SQLiteCpp/SQLiteCpp.h>

#include "dowel/kernel/error.h"

namespace dowel {

/// Binds the parameters of a statement from the first on.
class RowWriter {
 public:
  explicit RowWriter(SQLite::Statement& statement) : statement_(statement) { statement_.reset(); }

  RowWriter& operator<<(std::int64_t value) { return bind(value); }
  RowWriter& operator<<(std::uint32_t value) { return bind(std::int64_t{value}); }
  RowWriter& operator<<(double value) { return bind(value); }
  RowWriter& operator<<(std::string_view value) { return bind(std::string(value)); }
  RowWriter& operator<<(const Eigen::Vector3d& value) {
    return bind(value.x()).bind(value.y()).bind(value.z());
  }
  RowWriter& null() {
    statement_.bind(next_++);
    return *this;
  }
  void execute() { statement_.exec(); }

 private:
  template <class Value>
  RowWriter& bind(const Value& value) {
    statement_.bind(next_++, value);
    return *this;
  }

  SQLite::Statement& statement_;
  int next_ = 1;
};

/// Reads the columns of a row from the first on and checks each: damage can put anything anywhere.
class RowReader {
 public:
  /// `place` begins every complaint.
  RowReader(SQLite::Statement& statement, const std::string& place)
      : statement_(statement), place_(place) {}

  std::string text() {
    const SQLite::Column column = next();
    if (!column.isText()) fail(column, "a text");
    return column.getString();
  }
  double real() {
    const SQLite::Column column = next();
    if (!column.isFloat()) fail(column, "a number");
    return column.getDouble();
  }
  std::optional<double> optional_real() {
    const SQLite::Column column = next();
    if (column.isNull()) return std::nullopt;
    if (!column.isFloat()) fail(column, "a number or nothing");
    return column.getDouble();
  }
  Eigen::Vector3d vector() {
    const double x = real();
    const double y = real();
    const double z = real();
    return {x, y, z};
  }
  std::int64_t integer() {
    const SQLite::Column column = next();
    if (!column.isInteger()) fail(column, "a whole number");
    return column.getInt64();
  }
  std::uint32_t count() {
    const SQLite::Column column = statement_.getColumn(next_);
    const std::int64_t value = integer();
    if (value < 0 || value > std::numeric_limits<std::uint32_t>::max()) fail(column, "a count");
    return static_cast<std::uint32_t>(value);
  }
  /// The one of `values` whose to_string the column holds.
  template <class Enum, std::size_t N>
  Enum one_of(const std::array<Enum, N>& values) {
    const SQLite::Column column = statement_.getColumn(next_);
    const std::string name = text();
    for (const Enum value : values) {
      if (to_string(value) == name) return value;
    }
    fail(column, "a known word");
  }
  /// A list of indices as "[1,2,3]".
  std::vector<std::uint32_t> indices() {
    const SQLite::Column column = statement_.getColumn(next_);
    const std::string list = text();
    std::vector<std::uint32_t> result;
    if (list == "[]") return result;
    const char* at = list.data();
    const char* const end = at + list.size();
    char expected = '[';
    while (at != end && *at == expected) {
      std::uint32_t value = 0;
      const auto [rest, problem] = std::from_chars(at + 1, end, value);
      if (problem != std::errc()) break;
      result.push_back(value);
      at = rest;
      expected = ',';
    }
    if (result.empty() || end - at != 1 || *at != ']') fail(column, "a list of face numbers");
    return result;
  }

 private:
  SQLite::Column next() { return statement_.getColumn(next_++); }

  [[noreturn]] void fail(const SQLite::Column& column, const char* expected) const {
    throw Error(ErrorCode::FileMalformed,
                place_ + ": column " + column.getName() + ": expected " + expected);
  }

  SQLite::Statement& statement_;
  const std::string& place_;
  int next_ = 0;
};

}  // namespace dowel
