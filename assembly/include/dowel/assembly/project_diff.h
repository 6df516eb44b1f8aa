#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "dowel/assembly/project.h"

namespace dowel {

/// What differs between two projects; of each pair the first is of A, the second of B. Instances
/// are the same where they have one name, mates where they are of one kind and between the same
/// features, whatever their numbers.
struct ProjectDiff {
  std::vector<Instance> removed;  ///< by name
  std::vector<Instance> added;
  /// Another element, place or grounding. Poses that are a picometre apart are the same.
  std::vector<std::pair<Instance, Instance>> changed;
  std::vector<Mate> mates_removed;  ///< by number
  std::vector<Mate> mates_added;
  std::vector<std::pair<Mate, Mate>> mates_changed;  ///< offset, angle, flip, held pose
  std::vector<std::string> settings;                 ///< "mode: block, warn"

  bool is_empty() const {
    return removed.empty() && added.empty() && changed.empty() && mates_removed.empty() &&
           mates_added.empty() && mates_changed.empty() && settings.empty();
  }
};

/// State of a project that is only looked at: the file is left as it is, of an older version, too.
/// Throws as Project::open.
ProjectState read_project_state(const std::filesystem::path& file);

ProjectDiff diff(const ProjectState& a, const ProjectState& b);

}  // namespace dowel
