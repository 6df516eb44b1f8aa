#include "project_database.h"

#include <array>
#include <cmath>
#include <fstream>
#include <limits>
#include <new>

#include <sqlite3.h>

#include "dowel/kernel/blob.h"
#include "dowel/kernel/error.h"
#include "mate_target_table.h"

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

/// Says in our words what SQLite ran into.
[[noreturn]] void rethrow(const SQLite::Exception& error, const std::string& title) {
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

/// Runs `body` and turns SQLite's exceptions into Error.
template <class Body>
auto guarded(const std::string& title, Body&& body) {
  try {
    return body();
  } catch (const SQLite::Exception& error) {
    rethrow(error, title);
  }
}

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

SQLite::Database open_existing(const std::filesystem::path& file) {
  return guarded(file.string(), [&] {
    // The absolute path, so that no name is taken for a URI.
    return SQLite::Database(existing_file(file).string(), SQLite::OPEN_READWRITE, kBusyTimeout_ms);
  });
}

/// Takes the file for this program until it is closed.
void lock(SQLite::Database& database) {
  if (sqlite3_db_readonly(database.getHandle(), "main") == 1) return;
  database.exec("PRAGMA locking_mode = EXCLUSIVE");
  database.exec("PRAGMA journal_mode = DELETE");
  database.exec("BEGIN EXCLUSIVE");
  database.exec("COMMIT");
}

std::uint32_t number_in(const SQLite::Column& column, const std::string& title) {
  const std::int64_t value = column.getInt64();
  if (value < 0 || value > std::numeric_limits<std::uint32_t>::max()) {
    throw Error(ErrorCode::FileMalformed,
                title + ": is damaged: number " + std::to_string(value) + " is out of range");
  }
  return static_cast<std::uint32_t>(value);
}

Instance read_instance(SQLite::Statement& row, const std::string& title) {
  Instance instance;
  instance.number = number_in(row.getColumn(0), title);
  instance.name = row.getColumn(1).getString();
  instance.element = row.getColumn(2).getString();
  std::array<double, 7> values{};
  for (int i = 0; i < 7; ++i) {
    values[static_cast<std::size_t>(i)] = row.getColumn(3 + i).getDouble();
  }
  const Eigen::Quaterniond rotation(values[0], values[1], values[2], values[3]);
  const Eigen::Vector3d translation(values[4], values[5], values[6]);
  // Written so that NaN is refused.
  if (!(std::abs(rotation.norm() - 1.0) <= kUnitQuaternionSlack) ||
      !(translation.cwiseAbs().maxCoeff() <= kMaxCoordinate_mm)) {
    throw Error(ErrorCode::FileMalformed, title + ": is damaged: the pose of instance \"" +
                                              instance.name + "\" is not rigid or too far away");
  }
  instance.X_WI = Pose(rotation, translation);
  instance.grounded = row.getColumn(10).getInt() != 0;
  return instance;
}

Mate read_mate(SQLite::Statement& row, const std::string& title) {
  Mate mate;
  mate.number = number_in(row.getColumn(0), title);
  const auto kind = mate_kind_from(row.getColumn(1).getString());
  if (!kind) {
    throw Error(
        ErrorCode::FileMalformed,
        title + ": is damaged: mate " + std::to_string(mate.number) + " is of an unknown kind");
  }
  mate.kind = *kind;
  mate.moving = {row.getColumn(2).getString(), row.getColumn(3).getString()};
  mate.fixed = {row.getColumn(4).getString(), row.getColumn(5).getString()};
  if (!row.getColumn(6).isNull()) {
    mate.moving_face = {mate.moving.instance, row.getColumn(7).getString()};
    mate.fixed_face = {row.getColumn(6).getString(), row.getColumn(8).getString()};
  }
  mate.offset_mm = row.getColumn(9).getDouble();
  mate.flip = row.getColumn(10).getInt() != 0;
  mate.thread = row.getColumn(11).getInt() != 0;
  return mate;
}

/// `bytes` outlives the statement's next step. An empty blob is bound as one, not as NULL.
void bind_blob(SQLite::Statement& statement, int index, std::span<const std::byte> bytes) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    throw Error(ErrorCode::FileUnwritable, "an element is larger than 1 GB");
  }
  statement.bindNoCopy(index, bytes.empty() ? static_cast<const void*>("") : bytes.data(),
                       static_cast<int>(bytes.size()));
}

}  // namespace

ProjectDatabase::ProjectDatabase()
    : title_("the project in memory"),
      database_(":memory:", SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE) {
  guarded(title_, [&] {
    harden(database_);
    create_tables(database_);
  });
}

ProjectDatabase::ProjectDatabase(const std::filesystem::path& file)
    : file_(file), title_(file.string()), database_(open_existing(file)) {
  guarded(title_, [&] {
    harden(database_);
    lock(database_);
    expect_project(database_, title_);
    upgrade(database_);
  });
}

ProjectState ProjectDatabase::read_state() const {
  return guarded(title_, [&] {
    ProjectState state;
    SQLite::Statement settings(database_, "SELECT name, value FROM setting ORDER BY name");
    while (settings.executeStep()) {
      const SettingRow row{settings.getColumn(0).getString(), settings.getColumn(1).getString()};
      try {
        apply_setting(state, row);
      } catch (const Error& error) {
        throw Error(error.code(), title_ + ": is damaged: " + error.what());
      }
    }
    SQLite::Statement instances(database_,
                                "SELECT number, name, element, qw, qx, qy, qz, x_mm, y_mm, z_mm, "
                                "grounded FROM instance ORDER BY number");
    while (instances.executeStep()) {
      Instance instance = read_instance(instances, title_);
      state.instances.emplace(instance.name, instance);
    }
    SQLite::Statement mates(database_,
                            "SELECT number, kind, moving, moving_feature, fixed, fixed_feature, "
                            "seat, moving_face, fixed_face, offset_mm, flip, thread FROM mate "
                            "ORDER BY number");
    while (mates.executeStep()) {
      Mate mate = read_mate(mates, title_);
      state.mates.emplace(mate.number, mate);
    }
    read_mate_targets(database_, state, title_);
    if (const auto defect = find_defect(state, element_names())) {
      throw Error(ErrorCode::FileMalformed, title_ + ": is damaged: " + *defect);
    }
    return state;
  });
}

std::vector<std::string> ProjectDatabase::element_names() const {
  return guarded(title_, [&] {
    std::vector<std::string> names;
    SQLite::Statement rows(database_, "SELECT name FROM element ORDER BY name");
    while (rows.executeStep()) names.push_back(rows.getColumn(0).getString());
    return names;
  });
}

std::string ProjectDatabase::element_text(std::string_view name) const {
  return guarded(title_, [&] {
    SQLite::Statement row(database_, "SELECT description FROM element WHERE name = ?");
    row.bind(1, std::string(name));
    if (!row.executeStep()) {
      throw Error(ErrorCode::NotFound,
                  title_ + ": has no copy of element \"" + std::string(name) + "\"");
    }
    return row.getColumn(0).getString();
  });
}

std::vector<std::byte> ProjectDatabase::element_content(std::string_view name,
                                                        const char* column) const {
  return guarded(title_, [&] {
    SQLite::Statement row(database_,
                          std::string("SELECT ") + column + " FROM element WHERE name = ?");
    row.bind(1, std::string(name));
    if (!row.executeStep()) {
      throw Error(ErrorCode::NotFound,
                  title_ + ": has no copy of element \"" + std::string(name) + "\"");
    }
    const SQLite::Column blob = row.getColumn(0);
    const auto* const bytes = static_cast<const std::byte*>(blob.getBlob());
    return std::vector<std::byte>(bytes, bytes + blob.getBytes());
  });
}

std::vector<JournalEntry> ProjectDatabase::journal() const {
  return guarded(title_, [&] {
    std::vector<JournalEntry> entries;
    SQLite::Statement rows(database_,
                           "SELECT number, command, undone FROM journal ORDER BY number");
    while (rows.executeStep()) {
      entries.push_back({number_in(rows.getColumn(0), title_), rows.getColumn(1).getString(),
                         rows.getColumn(2).getInt() != 0});
    }
    return entries;
  });
}

namespace {

JournalRecord read_record(SQLite::Statement& row, const std::string& title) {
  JournalRecord record;
  record.number = number_in(row.getColumn(0), title);
  record.command = row.getColumn(1).getString();
  const std::string what = title + ": journal entry " + std::to_string(record.number);
  record.change.before = rows_from_text(row.getColumn(2).getString(), what);
  record.change.after = rows_from_text(row.getColumn(3).getString(), what);
  return record;
}

}  // namespace

std::optional<JournalRecord> ProjectDatabase::record(JournalEnd end, std::size_t skip) const {
  return guarded(title_, [&]() -> std::optional<JournalRecord> {
    SQLite::Statement row(
        database_, end == JournalEnd::LastDone
                       ? "SELECT number, command, before, after FROM journal WHERE undone = 0 "
                         "ORDER BY number DESC LIMIT 1 OFFSET ?"
                       : "SELECT number, command, before, after FROM journal WHERE undone = 1 "
                         "ORDER BY number LIMIT 1 OFFSET ?");
    row.bind(1, static_cast<std::int64_t>(skip));
    if (!row.executeStep()) return std::nullopt;
    return read_record(row, title_);
  });
}

void ProjectDatabase::for_each_done(const std::function<void(const JournalRecord&)>& visit) const {
  guarded(title_, [&] {
    SQLite::Statement rows(database_,
                           "SELECT number, command, before, after FROM journal WHERE undone = 0 "
                           "ORDER BY number");
    while (rows.executeStep()) visit(read_record(rows, title_));
  });
}

void ProjectDatabase::write_elements(std::span<const ProjectElement> elements) {
  SQLite::Statement insert(database_, "INSERT INTO element VALUES (?, ?, ?, ?)");
  for (const ProjectElement& element : elements) {
    const std::vector<std::byte> facets = to_blob(*element.solid);
    insert.bind(1, element.element.name);
    insert.bind(2, to_text(element.element));
    bind_blob(insert, 3, facets);
    bind_blob(insert, 4, element.brep);
    insert.exec();
    insert.reset();
  }
}

void ProjectDatabase::write_rows(const ProjectRows& before, const ProjectRows& after) {
  const auto erase = [&](const char* sql, std::uint32_t number) {
    SQLite::Statement statement(database_, sql);
    statement.bind(1, number);
    statement.exec();
  };
  for (const Mate& mate : before.mates) erase("DELETE FROM mate WHERE number = ?", mate.number);
  // A renumbered name would meet UNIQUE: all go before any comes. Mates may point to a row that
  // comes back at the end of the transaction.
  for (const Instance& instance : before.instances) {
    erase("DELETE FROM instance WHERE number = ?", instance.number);
  }
  for (const SettingRow& row : before.settings) {
    SQLite::Statement erase_setting(database_, "DELETE FROM setting WHERE name = ?");
    erase_setting.bind(1, row.name);
    erase_setting.exec();
  }
  for (const SettingRow& row : after.settings) {
    SQLite::Statement insert(database_, "INSERT INTO setting VALUES (?, ?)");
    insert.bind(1, row.name);
    insert.bind(2, row.value);
    insert.exec();
  }
  for (const Instance& instance : after.instances) {
    SQLite::Statement insert(database_,
                             "INSERT INTO instance VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    const Eigen::Quaterniond& q = instance.X_WI.rotation();
    const Eigen::Vector3d& t = instance.X_WI.translation();
    insert.bind(1, instance.number);
    insert.bind(2, instance.name);
    insert.bind(3, instance.element);
    int column = 4;
    for (const double value : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) {
      insert.bind(column++, value);
    }
    insert.bind(column, instance.grounded ? 1 : 0);
    insert.exec();
  }
  for (const Mate& mate : after.mates) {
    SQLite::Statement insert(database_,
                             "INSERT INTO mate VALUES (?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?, ?)");
    insert.bind(1, mate.number);
    insert.bind(2, std::string(to_string(mate.kind)));
    insert.bind(3, mate.moving.instance);
    insert.bind(4, mate.moving.feature);
    insert.bind(5, mate.fixed.instance);
    insert.bind(6, mate.fixed.feature);
    if (mate.has_seat()) {
      insert.bind(7, mate.fixed_face.instance);
      insert.bind(8, mate.moving_face.feature);
      insert.bind(9, mate.fixed_face.feature);
    }
    insert.bind(10, mate.offset_mm);
    insert.bind(11, mate.flip ? 1 : 0);
    insert.bind(12, mate.thread ? 1 : 0);
    insert.exec();
    write_mate_target(database_, mate);
  }
}

void ProjectDatabase::commit(std::string_view command, const ProjectChange& change,
                             std::span<const ProjectElement> elements) {
  guarded(title_, [&] {
    SQLite::Transaction transaction(database_);
    database_.exec("DELETE FROM journal WHERE undone = 1");
    write_elements(elements);
    write_rows(change.before, change.after);
    SQLite::Statement insert(
        database_,
        "INSERT INTO journal VALUES ((SELECT coalesce(max(number), 0) + 1 FROM "
        "journal), ?, ?, ?, 0)");
    insert.bind(1, std::string(command));
    insert.bind(2, to_text(change.before));
    insert.bind(3, to_text(change.after));
    insert.exec();
    transaction.commit();
  });
}

void ProjectDatabase::step(const std::vector<JournalRecord>& records, bool undo) {
  guarded(title_, [&] {
    SQLite::Transaction transaction(database_);
    for (const JournalRecord& record : records) {
      const ProjectChange& change = record.change;
      write_rows(undo ? change.after : change.before, undo ? change.before : change.after);
      SQLite::Statement mark(database_, "UPDATE journal SET undone = ? WHERE number = ?");
      mark.bind(1, undo ? 1 : 0);
      mark.bind(2, record.number);
      mark.exec();
    }
    transaction.commit();
  });
}

void ProjectDatabase::copy_into(const std::filesystem::path& file, const std::string& title) const {
  guarded(title, [&] {
    SQLite::Statement vacuum(database_, "VACUUM INTO ?");
    vacuum.bind(1, std::filesystem::absolute(file).string());
    vacuum.exec();
  });
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
