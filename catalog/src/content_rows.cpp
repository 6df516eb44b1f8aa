#include "content_rows.h"

#include <algorithm>
#include <limits>
#include <optional>

#include <sqlite3.h>

#include "checksum.h"
#include "dowel/kernel/error.h"
#include "schema.h"

namespace dowel {
namespace {

constexpr const char* kSelectContent = R"(
  SELECT bytes, checksum FROM element LEFT JOIN content
    ON element_id = element.id AND kind = ?2
  WHERE name = ?1)";

/// What was put before blobs were shared is still where it was.
constexpr const char* kSelectSharedContent = R"(
  SELECT coalesce(blob.bytes, content.bytes), coalesce(blob.checksum, content.checksum)
  FROM element
    LEFT JOIN element_blob ON element_blob.element_id = element.id AND element_blob.kind = ?2
    LEFT JOIN blob ON blob.id = blob_id
    LEFT JOIN content ON content.element_id = element.id AND content.kind = ?2
  WHERE name = ?1)";

/// As SQLite's signed number.
std::int64_t stored_checksum(std::span<const std::byte> bytes) {
  return static_cast<std::int64_t>(checksum(bytes));
}

std::span<const std::byte> bytes_of(const SQLite::Column& column) {
  return {static_cast<const std::byte*>(column.getBlob()),
          static_cast<std::size_t>(column.getBytes())};
}

/// The blob that holds `bytes`; makes it where there is none. Checksums only narrow the search.
std::int64_t blob_of(SQLite::Database& database, std::span<const std::byte> bytes) {
  const std::int64_t sum = stored_checksum(bytes);
  SQLite::Statement known(database,
                          "SELECT id, bytes FROM blob WHERE checksum = ? ORDER BY repeat");
  known.bind(1, sum);
  int repeat = 0;
  for (; known.executeStep(); ++repeat) {
    if (std::ranges::equal(bytes_of(known.getColumn(1)), bytes)) {
      return known.getColumn(0).getInt64();
    }
  }
  SQLite::Statement insert(database, "INSERT INTO blob (checksum, repeat, bytes) VALUES (?, ?, ?)");
  insert.bind(1, sum);
  insert.bind(2, repeat);
  // A null pointer would be stored as NULL, not as a blob without bytes.
  const void* const data = bytes.empty() ? static_cast<const void*>("") : bytes.data();
  insert.bindNoCopy(3, data, static_cast<int>(bytes.size()));
  insert.exec();
  return database.getLastInsertRowid();
}

}  // namespace

void insert_content(SQLite::Database& database, std::int64_t element_id, const char* kind,
                    std::span<const std::byte> bytes) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw SQLite::Exception("content too large", SQLITE_TOOBIG);
  }
  const std::int64_t blob_id = blob_of(database, bytes);
  SQLite::Statement statement(
      database, "INSERT INTO element_blob (element_id, kind, blob_id) VALUES (?, ?, ?)");
  statement.bind(1, element_id);
  statement.bind(2, kind);
  statement.bind(3, blob_id);
  statement.exec();
}

std::vector<std::byte> select_content(SQLite::Database& database, std::string_view name,
                                      const char* kind, const std::string& file) {
  const std::int64_t version = database.execAndGet("PRAGMA user_version").getInt64();
  SQLite::Statement statement(
      database, version >= kSharedContentVersion ? kSelectSharedContent : kSelectContent);
  statement.bind(1, std::string(name));
  statement.bind(2, kind);
  if (!statement.executeStep()) {
    throw Error(ErrorCode::NotFound, file + ": has no element \"" + std::string(name) + "\"");
  }
  const SQLite::Column column = statement.getColumn(0);
  const std::span<const std::byte> bytes = bytes_of(column);
  if (!column.isBlob() || stored_checksum(bytes) != statement.getColumn(1).getInt64()) {
    throw Error(ErrorCode::FileMalformed, file + ": is damaged: the " + kind + " of element \"" +
                                              std::string(name) + "\" do not match their checksum");
  }
  return {bytes.begin(), bytes.end()};
}

std::vector<std::int64_t> blobs_of_source(SQLite::Database& database, const std::string& path) {
  SQLite::Statement statement(database,
                              "SELECT DISTINCT blob_id FROM source"
                              " JOIN element ON source_id = source.id"
                              " JOIN element_blob ON element_id = element.id"
                              " WHERE path = ? ORDER BY blob_id");
  statement.bind(1, path);
  std::vector<std::int64_t> blobs;
  while (statement.executeStep()) blobs.push_back(statement.getColumn(0).getInt64());
  return blobs;
}

void remove_unused_blobs(SQLite::Database& database, const std::vector<std::int64_t>& blobs) {
  SQLite::Statement statement(database,
                              "DELETE FROM blob WHERE id = ?1 AND NOT EXISTS"
                              " (SELECT 1 FROM element_blob WHERE blob_id = ?1)");
  for (const std::int64_t blob : blobs) {
    statement.reset();
    statement.bind(1, blob);
    statement.exec();
  }
}

}  // namespace dowel
