#pragma once

// Where assemblies have their elements, as rows. Internal to the store.

#include <cstdint>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "dowel/catalog/catalog.h"

namespace dowel {

/// Throws SQLite::Exception.
void insert_instances(SQLite::Database& database, std::int64_t source_id,
                      const std::vector<SourceInstance>& instances);

/// Of a source with `element_count` elements. The rows are untrusted: throws Error{FileMalformed}
/// beginning with `place` where they make no sound instances.
std::vector<SourceInstance> select_instances(SQLite::Database& database, std::int64_t source_id,
                                             std::size_t element_count, const std::string& place);

}  // namespace dowel
