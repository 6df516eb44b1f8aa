#pragma once

// What queries look up in fact tables. Internal to the rule engine.

#include <compare>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

#include "fact_table.h"

namespace dowel {

/// Rows of a table that hold certain texts in some of its columns; all rows where there is no
/// column.
struct FactLookup {
  std::size_t table = 0;  ///< in `fact_tables()`
  unsigned columns = 0;   ///< bits
  std::string key;        ///< of `lookup_key`

  auto operator<=>(const FactLookup&) const = default;
};

/// Bits of columns that SQLite keeps as an int.
inline constexpr std::size_t kMaxLookupColumns = 31;

/// No two lists of texts make one key.
inline void add_to_key(std::string& key, std::string_view text) {
  key += std::to_string(text.size());
  key += ':';
  key += text;
}

/// Of a row's texts in the columns. Nothing where one holds no text: it equals none.
inline std::optional<std::string> lookup_key(const FactRow& row, unsigned columns) {
  std::string key;
  for (std::size_t column = 0; columns >> column != 0; ++column) {
    if ((columns >> column & 1U) == 0) continue;
    const auto* const text = std::get_if<std::string>(&row[column]);
    if (text == nullptr) return std::nullopt;
    add_to_key(key, *text);
  }
  return key;
}

}  // namespace dowel
