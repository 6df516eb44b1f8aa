#pragma once

// What a command changes in a project, and the texts that the project file keeps of it.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/assembly/project.h"

namespace dowel {

/// Shortest text that reads back to the same double.
std::string number_text(double value);

struct SettingRow {
  std::string name;
  std::string value;

  bool operator==(const SettingRow&) const = default;
};

/// Some rows of a project's tables.
struct ProjectRows {
  std::vector<SettingRow> settings;
  std::vector<Instance> instances;
  std::vector<Mate> mates;

  bool is_empty() const { return settings.empty() && instances.empty() && mates.empty(); }
};

/// Takes `before` away and puts `after` in its place. Rows that stay the same are in neither.
struct ProjectChange {
  ProjectRows before;
  ProjectRows after;
};

/// The settings of a state, by name.
std::vector<SettingRow> settings_of(const ProjectState& state);

/// Throws Error{FileMalformed} for a name or value that makes no sense.
void apply_setting(ProjectState& state, const SettingRow& row);

ProjectChange difference(const ProjectState& from, const ProjectState& to);

/// The state after the change. Throws Error{FileMalformed} where a row to be taken away is not
/// there as it should be, or one to be put is.
ProjectState changed(const ProjectState& state, const ProjectChange& change);

/// First reason why the rows make no sound state, as one sentence; `elements` are the names of the
/// element copies.
std::optional<std::string> find_defect(const ProjectState& state,
                                       const std::vector<std::string>& elements);

/// JSON of rows; numbers read back to the bit.
std::string to_text(const ProjectRows& rows);

/// Throws Error{FileMalformed} beginning with `what`.
ProjectRows rows_from_text(const std::string& text, const std::string& what);

/// The mate's kind and mode by name; nothing where there is none of that name.
std::optional<MateKind> mate_kind_from(std::string_view text);
std::optional<CheckMode> check_mode_from(std::string_view text);

/// JSON of an element without its heavy parts.
std::string to_text(const Element& element);

/// Throws Error{FileMalformed} beginning with `what`, also where the element has a defect.
Element element_from_text(const std::string& text, const std::string& what);

}  // namespace dowel
