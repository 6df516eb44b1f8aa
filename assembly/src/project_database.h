#pragma once

// A project's tables in SQLite. Internal to Project.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>

#include "project_rows.h"

namespace dowel {

/// "DWLP" in the database header: tells a project from any other SQLite file.
inline constexpr std::int32_t kProjectApplicationId = 0x44574C50;

/// Grows with every change of the tables. Version 1 had no table "mate_target".
inline constexpr std::int32_t kProjectVersion = 2;
inline constexpr std::int32_t kProjectVersionWithoutTargets = 1;

/// Which journal entry to take.
enum class JournalEnd { LastDone, FirstUndone };

struct JournalRecord {
  std::uint32_t number = 0;
  std::string command;
  ProjectChange change;
};

/// Every function turns SQLite's exceptions into Error and names the file.
class ProjectDatabase {
 public:
  /// In memory, with empty tables.
  ProjectDatabase();

  /// Opens, locks and checks an existing project. Throws as Project::open.
  explicit ProjectDatabase(const std::filesystem::path& file);

  const std::filesystem::path& file() const { return file_; }
  /// The file's name, or "the project in memory".
  const std::string& title() const { return title_; }

  ProjectState read_state() const;
  std::vector<std::string> element_names() const;
  /// Throws Error{NotFound}.
  std::string element_text(std::string_view name) const;
  std::vector<std::byte> element_content(std::string_view name, const char* column) const;

  std::vector<JournalEntry> journal() const;
  /// The journal's entry at `end`, skipping `skip` further ones; nothing where there is none.
  std::optional<JournalRecord> record(JournalEnd end, std::size_t skip) const;
  /// All entries that are not undone, oldest first.
  void for_each_done(const std::function<void(const JournalRecord&)>& visit) const;

  /// One transaction each: all of it is on disk on return, or nothing.
  void commit(std::string_view command, const ProjectChange& change,
              std::span<const ProjectElement> elements);
  void step(const std::vector<JournalRecord>& records, bool undo);

  /// `title` stands for `file` in messages.
  void copy_into(const std::filesystem::path& file, const std::string& title) const;

 private:
  void write_rows(const ProjectRows& before, const ProjectRows& after);
  void write_elements(std::span<const ProjectElement> elements);

  std::filesystem::path file_;
  std::string title_;
  // Reading changes nothing that a caller could see.
  mutable SQLite::Database database_;
};

}  // namespace dowel
