#include "dowel/catalog/catalog.h"

#include <new>
#include <utility>

#include <SQLiteCpp/SQLiteCpp.h>
#include <sqlite3.h>

#include "content_rows.h"
#include "dowel/catalog/search.h"
#include "dowel/kernel/blob.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "element_rows.h"
#include "instance_rows.h"
#include "schema.h"

namespace dowel {
namespace {

/// A writer holds the file for one put, which takes milliseconds; whoever is locked out this long
/// has met a program that hangs.
constexpr int kBusyTimeout_ms = 5000;

enum class Doing { Reading, Writing };

ErrorCode access_code(Doing doing) {
  return doing == Doing::Reading ? ErrorCode::FileUnreadable : ErrorCode::FileUnwritable;
}

/// Says in our words what SQLite ran into. Expects to be called while `error` is handled.
[[noreturn]] void rethrow(const SQLite::Exception& error, const std::string& file, Doing doing) {
  const std::string what = std::string(": ") + error.what();
  switch (error.getErrorCode() & 0xff) {
    case SQLITE_NOTADB:
      throw Error(ErrorCode::SchemaMismatch, file + ": is not an element catalogue");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw Error(access_code(doing), file + ": another program has been writing to it for " +
                                          std::to_string(kBusyTimeout_ms / 1000) +
                                          " s; try again when it is done");
    case SQLITE_FULL:
      throw Error(ErrorCode::FileUnwritable, file + ": no room left on the disk");
    case SQLITE_READONLY:
      throw Error(ErrorCode::FileUnwritable, file + ": may not be written" + what);
    case SQLITE_TOOBIG:
      throw Error(ErrorCode::FileUnwritable, file + ": an element is larger than 1 GB");
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      throw Error(
          access_code(doing),
          file + (doing == Doing::Reading ? ": cannot be read" : ": cannot be written") + what);
    case SQLITE_NOMEM:
      throw std::bad_alloc();
    default:
      // Our statements are right for the tables that were found on opening: what fails otherwise,
      // fails on damage.
      throw Error(ErrorCode::FileMalformed, file + ": is damaged" + what);
  }
}

/// Runs `body` and turns SQLite's exceptions into Error.
template <class Body>
auto guarded(const std::string& file, Doing doing, Body&& body) {
  try {
    return body();
  } catch (const SQLite::Exception& error) {
    rethrow(error, file, doing);
  }
}

std::int64_t pragma_number(SQLite::Database& database, const char* pragma) {
  return database.execAndGet(pragma).getInt64();
}

/// A file under the control of others can hold triggers and views that run when a table is
/// touched, and pages that point anywhere. No catalogue of ours has any of them.
void harden(SQLite::Database& database) {
  sqlite3_db_config(database.getHandle(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  database.exec("PRAGMA trusted_schema = OFF");
  database.exec("PRAGMA cell_size_check = ON");
  database.exec("PRAGMA mmap_size = 0");
  database.exec("PRAGMA temp_store = MEMORY");
  database.exec("PRAGMA foreign_keys = ON");
}

void expect_tables(SQLite::Database& database, const std::string& file, std::int64_t version) {
  SQLite::Statement triggers(database, "SELECT name FROM sqlite_schema WHERE type = 'trigger'");
  if (triggers.executeStep()) {
    throw Error(ErrorCode::SchemaMismatch, file + ": has a trigger, \"" +
                                               triggers.getColumn(0).getString() +
                                               "\", which no element catalogue has");
  }
  for (const SchemaTable& table : kCatalogTables) {
    if (table.since > version) continue;
    SQLite::Statement sql(database,
                          "SELECT sql FROM sqlite_schema WHERE type = 'table' AND name = ?");
    sql.bind(1, table.name);
    if (!sql.executeStep() || sql.getColumn(0).getString() != table.sql) {
      throw Error(ErrorCode::SchemaMismatch, file + ": its table \"" + table.name +
                                                 "\" is not the one of an element catalogue");
    }
  }
}

/// Throws where the database is not a catalogue that this version reads.
void expect_catalogue(SQLite::Database& database, const std::string& file) {
  const SQLite::Transaction snapshot(database);
  if (pragma_number(database, "PRAGMA application_id") != kCatalogApplicationId) {
    throw Error(ErrorCode::SchemaMismatch, file + ": is not an element catalogue");
  }
  const std::int64_t version = pragma_number(database, "PRAGMA user_version");
  if (version > kCatalogVersion) {
    throw Error(ErrorCode::SchemaMismatch,
                file + ": is a catalogue of version " + std::to_string(version) +
                    ", this program reads up to " + std::to_string(kCatalogVersion));
  }
  if (version < 1) {
    throw Error(ErrorCode::SchemaMismatch, file + ": is a catalogue of version " +
                                               std::to_string(version) + ", which there never was");
  }
  expect_tables(database, file, version);
}

/// Brings a catalogue of an older version up to this one, in one transaction: two programs may
/// start at once.
void upgrade_tables(SQLite::Database& database) {
  if (pragma_number(database, "PRAGMA user_version") == kCatalogVersion) return;
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  const std::int64_t version = pragma_number(database, "PRAGMA user_version");
  for (const SchemaTable& table : kCatalogTables) {
    if (table.since > version) database.exec(table.sql);
  }
  database.exec("PRAGMA user_version = " + std::to_string(kCatalogVersion));
  transaction.commit();
}

bool is_blank(SQLite::Database& database) {
  return pragma_number(database, "PRAGMA application_id") == 0 &&
         pragma_number(database, "PRAGMA user_version") == 0 &&
         pragma_number(database, "SELECT count(*) FROM sqlite_schema") == 0;
}

/// Makes a blank database a catalogue, in one transaction: two programs may start at once.
void create_tables(SQLite::Database& database) {
  SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
  if (!is_blank(database)) return;
  database.exec("PRAGMA application_id = " + std::to_string(kCatalogApplicationId));
  database.exec("PRAGMA user_version = " + std::to_string(kCatalogVersion));
  for (const SchemaTable& table : kCatalogTables) database.exec(table.sql);
  transaction.commit();
}

void expect_file(const std::filesystem::path& file, Catalog::Access access) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  const std::string name = file.string();
  if (std::filesystem::is_directory(status)) {
    throw Error(ErrorCode::FileUnreadable, name + ": is a folder, expected an element catalogue");
  }
  if (!std::filesystem::exists(status)) {
    if (access == Catalog::Access::ReadOnly) {
      throw Error(ErrorCode::FileUnreadable, name + ": no such file");
    }
    const auto folder = std::filesystem::absolute(file).parent_path();
    if (!std::filesystem::is_directory(folder, ignored)) {
      throw Error(ErrorCode::FileUnwritable,
                  name + ": cannot be created: there is no folder " + folder.string());
    }
  } else if (!std::filesystem::is_regular_file(status)) {
    // A pipe would be waited on for ever.
    throw Error(ErrorCode::FileUnreadable,
                name + ": is not a regular file, expected an element catalogue");
  }
}

/// A writer that was killed leaves a journal that must be played back before the file can be read;
/// who opens for reading alone may not do that.
void play_back_journal(const std::string& path) {
  SQLite::Database database(path, SQLite::OPEN_READWRITE, kBusyTimeout_ms);
  is_blank(database);
}

SQLite::Database open_read_only(const std::filesystem::path& file) {
  // An absolute path: SQLite gives some relative names, such as ":memory:", a meaning of their own.
  const std::string path = std::filesystem::absolute(file).string();
  const auto open = [&path] {
    SQLite::Database database(path, SQLite::OPEN_READONLY, kBusyTimeout_ms);
    harden(database);
    is_blank(database);
    return database;
  };
  try {
    return open();
  } catch (const SQLite::Exception& error) {
    if (error.getExtendedErrorCode() != SQLITE_READONLY_ROLLBACK) throw;
  }
  try {
    play_back_journal(path);
  } catch (const SQLite::Exception& error) {
    throw Error(ErrorCode::FileUnreadable,
                file.string() +
                    ": its last writer was killed, and undoing what it left needs the "
                    "right to write: " +
                    error.what());
  }
  return open();
}

SQLite::Database open_read_write(const std::filesystem::path& file) {
  const std::string path = std::filesystem::absolute(file).string();
  SQLite::Database database(path, SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE, kBusyTimeout_ms);
  // SQLite falls back to reading where it may not write.
  if (sqlite3_db_readonly(database.getHandle(), "main") != 0) {
    throw Error(ErrorCode::FileUnwritable, file.string() + ": may not be written");
  }
  harden(database);
  if (is_blank(database)) create_tables(database);
  return database;
}

SQLite::Database open(const std::filesystem::path& file, Catalog::Access access) {
  expect_file(file, access);
  const Doing doing = access == Catalog::Access::ReadOnly ? Doing::Reading : Doing::Writing;
  return guarded(file.string(), doing, [&] {
    SQLite::Database database =
        access == Catalog::Access::ReadOnly ? open_read_only(file) : open_read_write(file);
    expect_catalogue(database, file.string());
    if (access == Catalog::Access::ReadWrite) upgrade_tables(database);
    return database;
  });
}

/// `name`, or the first of `name~2`, `name~3`, … that no element carries.
std::string free_name(SQLite::Database& database, const std::string& name) {
  SQLite::Statement taken(database, "SELECT 1 FROM element WHERE name = ?");
  std::string candidate = name;
  for (int count = 2;; ++count) {
    taken.reset();
    taken.bind(1, candidate);
    if (!taken.executeStep()) return candidate;
    candidate = name + "~" + std::to_string(count);
  }
}

std::int64_t replace_source(SQLite::Database& database, const SourceRecord& source) {
  SQLite::Statement remove(database, "DELETE FROM source WHERE path = ?");
  remove.bind(1, source.path);
  remove.exec();
  SQLite::Statement insert(
      database,
      "INSERT INTO source (path, sha256, settings, status, reason) VALUES (?, ?, ?, ?, ?)");
  insert.bind(1, source.path);
  insert.bind(2, source.sha256);
  insert.bind(3, source.settings);
  insert.bind(4, source.status);
  insert.bind(5, source.reason);
  insert.exec();
  return database.getLastInsertRowid();
}

}  // namespace

struct Catalog::Impl {
  std::filesystem::path file;
  std::string name;  ///< of the file, for messages
  SQLite::Database database;

  Impl(const std::filesystem::path& path, Access access)
      : file(path), name(path.string()), database(open(path, access)) {}

  /// Prepared when it is first wanted: a catalogue is to open at once.
  ElementReader& reader() {
    if (!reader_) reader_.emplace(database, name);
    return *reader_;
  }

  std::vector<std::byte> content(std::string_view element, const char* kind);

 private:
  std::optional<ElementReader> reader_;
};

std::vector<std::byte> Catalog::Impl::content(std::string_view element, const char* kind) {
  return guarded(name, Doing::Reading, [&] {
    const SQLite::Transaction snapshot(database);
    return select_content(database, element, kind, name);
  });
}

Catalog::Catalog(const std::filesystem::path& file, Access access)
    : impl_(std::make_unique<Impl>(file, access)) {}
Catalog::~Catalog() = default;
Catalog::Catalog(Catalog&&) noexcept = default;
Catalog& Catalog::operator=(Catalog&&) noexcept = default;

const std::filesystem::path& Catalog::file() const {
  return impl_->file;
}

std::vector<std::string> Catalog::names() const {
  return guarded(impl_->name, Doing::Reading, [this] {
    SQLite::Statement statement(impl_->database, "SELECT name FROM element ORDER BY name");
    std::vector<std::string> names;
    while (statement.executeStep()) names.push_back(statement.getColumn(0).getString());
    return names;
  });
}

std::optional<Element> Catalog::find(std::string_view name) const {
  return guarded(impl_->name, Doing::Reading, [this, name] {
    // One snapshot for all tables, though another program may be writing.
    const SQLite::Transaction snapshot(impl_->database);
    return impl_->reader().read(name);
  });
}

std::vector<std::string> Catalog::similar_names(std::string_view name, std::size_t count) const {
  return closest_names(name, names(), count);
}

std::shared_ptr<const FacetedSolid> Catalog::solid(std::string_view name) const {
  const std::vector<std::byte> blob = impl_->content(name, "facets");
  const std::string place = impl_->name + ": element \"" + std::string(name) + "\"";
  return std::make_shared<const FacetedSolid>(from_blob(blob, place.c_str()));
}

std::vector<std::byte> Catalog::brep(std::string_view name) const {
  return impl_->content(name, "brep");
}

std::optional<SourceRecord> Catalog::source(std::string_view path) const {
  return guarded(impl_->name, Doing::Reading, [this, path]() -> std::optional<SourceRecord> {
    const SQLite::Transaction snapshot(impl_->database);
    SQLite::Statement source(
        impl_->database, "SELECT id, sha256, settings, status, reason FROM source WHERE path = ?");
    source.bind(1, std::string(path));
    if (!source.executeStep()) return std::nullopt;
    SourceRecord record;
    record.path = path;
    record.sha256 = source.getColumn(1).getString();
    record.settings = source.getColumn(2).getString();
    record.status = source.getColumn(3).getString();
    record.reason = source.getColumn(4).getString();
    SQLite::Statement elements(impl_->database,
                               "SELECT name FROM element WHERE source_id = ? ORDER BY position");
    elements.bind(1, source.getColumn(0).getInt64());
    while (elements.executeStep()) record.elements.push_back(elements.getColumn(0).getString());
    record.instances =
        select_instances(impl_->database, source.getColumn(0).getInt64(), record.elements.size(),
                         impl_->name + ": is damaged: source \"" + record.path + "\"");
    return record;
  });
}

std::vector<std::string> Catalog::put(const SourceRecord& source,
                                      std::span<const ElementRecord> elements) {
  DOWEL_EXPECTS(source.status == "ok" || source.status == "empty" || source.status == "failed");
  for (const ElementRecord& record : elements) DOWEL_EXPECTS(!find_defect(record.element));
  for (const SourceInstance& instance : source.instances) {
    DOWEL_EXPECTS(instance.element < elements.size());
  }

  return guarded(impl_->name, Doing::Writing, [&] {
    SQLite::Database& database = impl_->database;
    SQLite::Transaction transaction(database, SQLite::TransactionBehavior::IMMEDIATE);
    const std::vector<std::int64_t> former_blobs = blobs_of_source(database, source.path);
    const std::int64_t source_id = replace_source(database, source);
    std::vector<std::string> names;
    for (const ElementRecord& record : elements) {
      Element element = record.element;
      element.name = free_name(database, element.name);
      const auto position = static_cast<std::int64_t>(names.size());
      const std::int64_t id = insert_element(database, source_id, position, element);
      insert_content(database, id, "facets", to_blob(record.solid));
      insert_content(database, id, "brep", record.brep);
      names.push_back(element.name);
    }
    insert_instances(database, source_id, source.instances);
    remove_unused_blobs(database, former_blobs);
    transaction.commit();
    return names;
  });
}

}  // namespace dowel
