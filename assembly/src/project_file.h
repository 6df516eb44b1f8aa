#pragma once

// A project's SQLite file: its tables, opening, locking, the log. Internal to ProjectDatabase.

#include <cstdint>
#include <filesystem>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>

namespace dowel {

/// "DWLP" in the database header: tells a project from any other SQLite file.
inline constexpr std::int32_t kProjectApplicationId = 0x44574C50;

/// Grows with every change of the tables. Version 1 had no table "mate_target".
inline constexpr std::int32_t kProjectVersion = 2;
inline constexpr std::int32_t kProjectVersionWithoutTargets = 1;

/// ReadOnly: the file is left as it is, of an older version, too, and not kept from others.
enum class ProjectAccess { ReadWrite, ReadOnly };

/// Says in our words what SQLite ran into.
[[noreturn]] void rethrow_as_project_error(const SQLite::Exception& error,
                                           const std::string& title);

/// Runs `body` and turns SQLite's exceptions into Error.
template <class Body>
auto guarded(const std::string& title, Body&& body) {
  try {
    return body();
  } catch (const SQLite::Exception& error) {
    rethrow_as_project_error(error, title);
  }
}

/// An open project with the tables that it should have.
///
/// The first command of a program is written with a rollback journal, all others with a write-ahead
/// log, which asks the disk once for each, not four times, but takes some to begin and to end. Who
/// closes the file folds the log into it, so that it is one file again.
class ProjectFile {
 public:
  /// In memory, with empty tables.
  ProjectFile();

  /// Opens, locks and checks an existing project. Throws as Project::open.
  ProjectFile(const std::filesystem::path& file, ProjectAccess access);

  ProjectFile(ProjectFile&& other) noexcept;
  ProjectFile& operator=(ProjectFile&&) = delete;
  ~ProjectFile();

  const std::filesystem::path& path() const { return path_; }
  /// The file's name, or "the project in memory".
  const std::string& title() const { return title_; }
  SQLite::Database& database() { return database_; }

  /// To be called before each transaction that writes.
  void prepare_to_write();

 private:
  std::filesystem::path path_;
  std::string title_;
  SQLite::Database database_;
  std::uint64_t transactions_ = 0;
  bool has_log_ = false;
};

}  // namespace dowel
