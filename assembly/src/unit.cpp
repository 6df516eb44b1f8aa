#include "dowel/assembly/unit.h"

#include <algorithm>
#include <set>

#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "mate_graph.h"

namespace dowel {

void save_unit(Session& session, const std::vector<std::string>& names,
               const std::filesystem::path& file) {
  DOWEL_EXPECTS(!names.empty());
  const Pose X_UW = session.instance(names.front()).X_WI.inverse();
  const std::set<std::string> wanted(names.begin(), names.end());
  ProjectState unit;
  std::vector<ProjectElement> copies;
  std::set<std::string> copied;
  const Project& project = session.project();
  for (const Instance* placed : session.state().in_order()) {
    if (!wanted.contains(placed->name)) continue;
    Instance part = *placed;
    part.X_WI = settled(X_UW * placed->X_WI);
    part.grounded = false;
    unit.instances.emplace(part.name, part);
    if (!copied.insert(part.element).second) continue;
    copies.push_back({*project.find_element(part.element), project.solid(part.element),
                      project.brep(part.element)});
  }
  for (const auto& [number, mate] : session.state().mates) {
    if (std::ranges::includes(wanted, parts_of(mate))) unit.mates.emplace(number, mate);
  }
  // In memory first, so that the file appears whole or not at all.
  std::error_code ignored;
  if (std::filesystem::exists(std::filesystem::symlink_status(file, ignored))) {
    throw Error(ErrorCode::FileUnwritable, file.string() + ": exists already; take another name");
  }
  Project made;
  made.commit("save-unit", unit, copies);
  made.save_copy(file);
}

}  // namespace dowel
