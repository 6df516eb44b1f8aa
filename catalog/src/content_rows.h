#pragma once

// The heavy parts of elements (facets, boundary representation) as rows. Internal to the store.

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

namespace dowel {

/// Gives the element its content of that kind, "facets" or "brep". Equal bytes are kept once,
/// however many elements have them. Throws SQLite::Exception.
void insert_content(SQLite::Database& database, std::int64_t element_id, const char* kind,
                    std::span<const std::byte> bytes);

/// Content of the element called `name`. Throws Error{NotFound} where there is none of that name,
/// Error{FileMalformed} where the bytes do not match their checksum; both begin with `file`.
std::vector<std::byte> select_content(SQLite::Database& database, std::string_view name,
                                      const char* kind, const std::string& file);

/// Blobs that the elements of the source at `path` have.
std::vector<std::int64_t> blobs_of_source(SQLite::Database& database, const std::string& path);

/// Takes away those of `blobs` that no element has any more.
void remove_unused_blobs(SQLite::Database& database, const std::vector<std::int64_t>& blobs);

}  // namespace dowel
