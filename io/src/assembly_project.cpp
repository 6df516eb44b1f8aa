#include "assembly_project.h"

#include <algorithm>
#include <map>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "dowel/assembly/names.h"
#include "dowel/assembly/project.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// Room for a number behind it.
constexpr std::size_t kLongestBase = 48;

/// `name` as an instance may be called. Expects: UTF-8.
std::string instance_name(const std::string& name) {
  std::string result;
  for (const char c : name) {
    const bool is_refused = static_cast<unsigned char>(c) <= 0x20 || c == 0x7F || c == '.' ||
                            c == '"' || c == '\'' || (c == '#' && result.empty());
    result += is_refused ? '_' : c;
  }
  // Not in the middle of a character.
  std::size_t end = std::min(result.size(), kLongestBase);
  while (end > 0 && end < result.size() &&
         (static_cast<unsigned char>(result[end]) & 0xC0U) == 0x80U) {
    --end;
  }
  result.resize(end);
  return instance_name_defect(result) ? "PART" : result;
}

/// One name each: "bolt", "bolt-2", ...
class Names {
 public:
  std::string next(const std::string& wanted) {
    const std::string base = instance_name(wanted);
    for (std::size_t& number = numbers_[base];;) {
      ++number;
      std::string name = number == 1 ? base : base + "-" + std::to_string(number);
      if (taken_.insert(name).second) return name;
    }
  }

 private:
  std::map<std::string, std::size_t> numbers_;
  std::set<std::string> taken_;
};

ProjectState state_of(const SourceRecord& source) {
  ProjectState state;
  Names names;
  std::uint32_t number = 0;
  for (const SourceInstance& from : source.instances) {
    // Written so that NaN is refused.
    if (!(from.X_WI.translation().cwiseAbs().maxCoeff() <= kMaxCoordinate_mm)) {
      throw Error(ErrorCode::InvalidInput,
                  "instance \"" + from.name + "\" stands more than 100 m away from the origin");
    }
    Instance instance;
    instance.number = ++number;
    instance.name = names.next(from.name);
    instance.element = source.elements.at(from.element);
    instance.X_WI = from.X_WI;
    std::string key = instance.name;
    state.instances.emplace(std::move(key), std::move(instance));
  }
  return state;
}

}  // namespace

void write_assembly_project(const std::filesystem::path& file, const Catalog& catalog,
                            const SourceRecord& source) {
  const ProjectState state = state_of(source);
  std::vector<ProjectElement> copies;
  for (const std::string& name : source.elements) {
    const bool is_placed = std::ranges::any_of(
        state.instances, [&name](const auto& entry) { return entry.second.element == name; });
    if (!is_placed) continue;
    copies.push_back({catalog.find(name).value(), catalog.solid(name), catalog.brep(name)});
  }
  Project project = Project::create(file);
  try {
    project.commit("import " + source.path, state, copies);
  } catch (...) {
    project = Project();
    std::error_code ignored;
    std::filesystem::remove(file, ignored);
    throw;
  }
}

}  // namespace dowel
