#pragma once

// A project's rows in SQLite. Internal to Project.

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "project_file.h"
#include "project_rows.h"

namespace dowel {

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
  ProjectDatabase() = default;

  /// Throws as Project::open.
  ProjectDatabase(const std::filesystem::path& file, ProjectAccess access);

  const std::filesystem::path& file() const { return file_.path(); }
  /// The file's name, or "the project in memory".
  const std::string& title() const { return file_.title(); }

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

  SQLite::Database& database() const { return file_.database(); }

  // Reading changes nothing that a caller could see.
  mutable ProjectFile file_;
};

}  // namespace dowel
