#include "project_file.h"

#include <array>
#include <fstream>
#include <new>
#include <utility>

#include <sqlite3.h>

#include "dowel/assembly/project.h"
#include "dowel/kernel/error.h"
#include "mate_target_table.h"
#include "project_rows.h"

namespace dowel {
namespace {

/// A verb holds the file for milliseconds, a prompt for hours: wait for the one, not the other.
constexpr int kBusyTimeout_ms = 3000;

struct SchemaTable {
  const char* name;
  const char* sql;  ///< as sqlite_schema keeps it, to the letter
};

/// Instances and mates are columns rather than documents so that rules can be written over them.
const std::array<SchemaTable, 6> kTables{{
    {"setting", R"(CREATE TABLE setting (
  name TEXT PRIMARY KEY,
  value TEXT NOT NULL
) STRICT)"},
    {"element", R"(CREATE TABLE element (
  name TEXT PRIMARY KEY,
  description TEXT NOT NULL,
  facets BLOB NOT NULL,
  brep BLOB NOT NULL
) STRICT)"},
    {"instance", R"(CREATE TABLE instance (
  number INTEGER PRIMARY KEY,
  name TEXT NOT NULL UNIQUE,
  element TEXT NOT NULL REFERENCES element (name),
  qw REAL NOT NULL,
  qx REAL NOT NULL,
  qy REAL NOT NULL,
  qz REAL NOT NULL,
  x_mm REAL NOT NULL,
  y_mm REAL NOT NULL,
  z_mm REAL NOT NULL,
  grounded INTEGER NOT NULL CHECK (grounded IN (0, 1))
) STRICT)"},
    {"mate", R"(CREATE TABLE mate (
  number INTEGER PRIMARY KEY,
  kind TEXT NOT NULL,
  moving TEXT NOT NULL REFERENCES instance (name) DEFERRABLE INITIALLY DEFERRED,
  moving_feature TEXT NOT NULL,
  fixed TEXT NOT NULL REFERENCES instance (name) DEFERRABLE INITIALLY DEFERRED,
  fixed_feature TEXT NOT NULL,
  seat TEXT REFERENCES instance (name) DEFERRABLE INITIALLY DEFERRED,
  moving_face TEXT,
  fixed_face TEXT,
  offset_mm REAL NOT NULL,
  flip INTEGER NOT NULL CHECK (flip IN (0, 1)),
  thread INTEGER NOT NULL CHECK (thread IN (0, 1))
) STRICT)"},
    {"journal", R"(CREATE TABLE journal (
  number INTEGER PRIMARY KEY,
  command TEXT NOT NULL,
  before TEXT NOT NULL,
  after TEXT NOT NULL,
  undone INTEGER NOT NULL CHECK (undone IN (0, 1))
) STRICT)"},
    {kMateTargetTable, kMateTargetSql},
}};

std::int64_t number_of(SQLite::Database& database, const char* query) {
  return database.execAndGet(query).getInt64();
}

/// A file of others can hold triggers and views that run when a table is touched, and pages that
/// point anywhere.
void harden(SQLite::Database& database) {
  sqlite3_db_config(database.getHandle(), SQLITE_DBCONFIG_DEFENSIVE, 1, nullptr);
  database.exec("PRAGMA trusted_schema = OFF");
  database.exec("PRAGMA cell_size_check = ON");
  database.exec("PRAGMA mmap_size = 0");
  database.exec("PRAGMA temp_store = MEMORY");
  database.exec("PRAGMA foreign_keys = ON");
  database.exec("PRAGMA synchronous = FULL");
}

void expect_project(SQLite::Database& database, const std::string& title) {
  if (number_of(database, "PRAGMA application_id") != kProjectApplicationId) {
    throw Error(ErrorCode::SchemaMismatch, title + ": is not a dowel project");
  }
  const std::int64_t version = number_of(database, "PRAGMA user_version");
  if (version != kProjectVersion && version != kProjectVersionWithoutTargets) {
    throw Error(ErrorCode::SchemaMismatch,
                title + ": is a project of version " + std::to_string(version) +
                    ", this program reads version " + std::to_string(kProjectVersion));
  }
  const std::string verdict = database.execAndGet("PRAGMA quick_check(1)").getString();
  if (verdict != "ok") throw Error(ErrorCode::FileMalformed, title + ": is damaged: " + verdict);
  if (number_of(database, "SELECT count(*) FROM sqlite_schema WHERE type IN ('trigger', 'view')") !=
      0) {
    throw Error(ErrorCode::SchemaMismatch, title + ": has triggers or views, which no project has");
  }
  for (const SchemaTable& table : kTables) {
    if (version == kProjectVersionWithoutTargets && table.name == kMateTargetTable) continue;
    SQLite::Statement sql(database,
                          "SELECT sql FROM sqlite_schema WHERE type = 'table' AND name = ?");
    sql.bind(1, table.name);
    if (!sql.executeStep() || sql.getColumn(0).getString() != table.sql) {
      throw Error(ErrorCode::SchemaMismatch,
                  title + ": its table \"" + table.name + "\" is not the one of a project");
    }
  }
}

/// Makes a project of an older version one of this, but for one that is write-protected.
void upgrade(SQLite::Database& database) {
  if (number_of(database, "PRAGMA user_version") == kProjectVersion) return;
  if (sqlite3_db_readonly(database.getHandle(), "main") == 1) return;
  SQLite::Transaction transaction(database);
  database.exec(kMateTargetSql);
  database.exec("PRAGMA user_version = " + std::to_string(kProjectVersion));
  transaction.commit();
}

void create_tables(SQLite::Database& database) {
  SQLite::Transaction transaction(database);
  database.exec("PRAGMA application_id = " + std::to_string(kProjectApplicationId));
  database.exec("PRAGMA user_version = " + std::to_string(kProjectVersion));
  for (const SchemaTable& table : kTables) database.exec(table.sql);
  SQLite::Statement insert(database, "INSERT INTO setting VALUES (?, ?)");
  for (const SettingRow& row : settings_of(ProjectState{})) {
    insert.bind(1, row.name);
    insert.bind(2, row.value);
    insert.exec();
    insert.reset();
  }
  transaction.commit();
}

std::filesystem::path existing_file(const std::filesystem::path& file) {
  std::error_code ignored;
  const auto status = std::filesystem::status(file, ignored);
  if (!std::filesystem::exists(status)) {
    throw Error(ErrorCode::FileUnreadable, file.string() + ": no such file");
  }
  if (!std::filesystem::is_regular_file(status)) {
    throw Error(ErrorCode::FileUnreadable, file.string() + ": is not a file, expected a project");
  }
  return std::filesystem::absolute(file);
}

/// Takes the file for this program until it is closed. Plays back what a killed writer left.
void lock(SQLite::Database& database) {
  if (sqlite3_db_readonly(database.getHandle(), "main") == 1) return;
  database.exec("PRAGMA journal_mode = DELETE");
  database.exec("BEGIN EXCLUSIVE");
  database.exec("COMMIT");
}

}  // namespace

/// Says in our words what SQLite ran into.
[[noreturn]] void rethrow_as_project_error(const SQLite::Exception& error,
                                           const std::string& title) {
  const std::string what = std::string(": ") + error.what();
  switch (error.getErrorCode() & 0xff) {
    case SQLITE_NOTADB:
      throw Error(ErrorCode::SchemaMismatch, title + ": is not a dowel project");
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw Error(ErrorCode::FileUnwritable,
                  title + ": is in use by another program; close it there first");
    case SQLITE_FULL:
      throw Error(ErrorCode::FileUnwritable, title + ": no room left on the disk");
    case SQLITE_TOOBIG:
      throw Error(ErrorCode::FileUnwritable, title + ": an element is larger than 1 GB");
    case SQLITE_READONLY:
    case SQLITE_IOERR:
    case SQLITE_CANTOPEN:
    case SQLITE_PERM:
    case SQLITE_AUTH:
      throw Error(ErrorCode::FileUnwritable, title + ": cannot be written" + what);
    case SQLITE_NOMEM:
      throw std::bad_alloc();
    default:
      // The statements are right for the tables that were found on opening: what fails otherwise,
      // fails on damage.
      throw Error(ErrorCode::FileMalformed, title + ": is damaged" + what);
  }
}

ProjectFile::ProjectFile()
    : title_("the project in memory"),
      database_(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE) {
  guarded(title_, [&] {
    harden(database_);
    create_tables(database_);
  });
}

ProjectFile::ProjectFile(const std::filesystem::path& file, ProjectAccess access)
    : path_(file), title_(file.string()), database_(guarded(title_, [&] {
        // The absolute path, so that no name is taken for a URI. For reading, too: what a killed
        // writer left can only be played back by who may write.
        return SQLite::Database(existing_file(file).string(), SQLite::OPEN_READWRITE,
                                kBusyTimeout_ms);
      })) {
  // Before anything is locked: that would write a header into an empty file.
  if (!looks_like_project(path_)) {
    throw Error(ErrorCode::SchemaMismatch, title_ + ": is not a dowel project");
  }
  guarded(title_, [&] {
    const bool is_for_writing = access == ProjectAccess::ReadWrite;
    // Before anything is read: a write-ahead log then needs no file of shared memory.
    if (is_for_writing) database_.exec("PRAGMA locking_mode = EXCLUSIVE");
    harden(database_);
    if (is_for_writing) lock(database_);
    expect_project(database_, title_);
    if (is_for_writing) upgrade(database_);
    if (!is_for_writing) database_.exec("PRAGMA query_only = ON");
  });
}

ProjectFile::ProjectFile(ProjectFile&& other) noexcept
    : path_(std::move(other.path_)),
      title_(std::move(other.title_)),
      database_(std::move(other.database_)),
      transactions_(other.transactions_),
      has_log_(std::exchange(other.has_log_, false)) {}

ProjectFile::~ProjectFile() {
  if (!has_log_) return;
  try {
    database_.exec("PRAGMA journal_mode = DELETE");
  } catch (const SQLite::Exception&) {
    // A disk without room: the log stays beside the file, and the next who opens it plays it back.
  }
}

void ProjectFile::prepare_to_write() {
  if (transactions_++ != 1 || path_.empty()) return;
  const std::string mode = database_.execAndGet("PRAGMA journal_mode = WAL").getString();
  has_log_ = mode == "wal";  // some file systems have none: slower, no less safe
}

bool looks_like_project(const std::filesystem::path& file) {
  std::array<char, 72> header{};
  std::ifstream stream(file, std::ios::binary);
  if (!stream.read(header.data(), header.size())) return false;
  constexpr std::string_view kMagic("SQLite format 3\0", 16);
  if (std::string_view(header.data(), kMagic.size()) != kMagic) return false;
  // The application id: big-endian at byte 68 of every SQLite file.
  std::uint32_t id = 0;
  for (std::size_t i = 68; i < 72; ++i) id = id << 8U | static_cast<unsigned char>(header[i]);
  return id == static_cast<std::uint32_t>(kProjectApplicationId);
}

}  // namespace dowel
