#pragma once

// An element as rows of the catalogue's tables. Internal to the store.

#include <cstdint>
#include <optional>
#include <string_view>

#include <SQLiteCpp/SQLiteCpp.h>

#include "dowel/catalog/element.h"

namespace dowel {

/// Writes the element's rows, without its content. Returns the element's row id. Throws
/// SQLite::Exception.
std::int64_t insert_element(SQLite::Database& database, std::int64_t source_id,
                            std::int64_t position, const Element& element);

/// The element called `name`. The rows are untrusted: throws Error{FileMalformed} beginning with
/// `file` where they make no sound element, SQLite::Exception where they cannot be read.
std::optional<Element> select_element(SQLite::Database& database, std::string_view name,
                                      std::string_view file);

}  // namespace dowel
