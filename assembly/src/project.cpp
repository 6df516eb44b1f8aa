#include "dowel/assembly/project.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "dowel/kernel/blob.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "project_database.h"

namespace dowel {
namespace {

[[noreturn]] void fail_to_write(const std::filesystem::path& file, int error_number) {
  throw Error(ErrorCode::FileUnwritable,
              file.string() + ": cannot be written: " + std::strerror(error_number));
}

/// Brings a file's content, or a folder's entries, to disk. Returns 0 or an errno.
int flush(const std::filesystem::path& path, int flags) {
  const int descriptor = ::open(path.c_str(), flags | O_CLOEXEC);
  if (descriptor < 0) return errno;
  const int error_number = ::fsync(descriptor) == 0 ? 0 : errno;
  ::close(descriptor);
  return error_number;
}

/// A fresh empty file beside another, gone again unless it took the other's place.
class Neighbour {
 public:
  explicit Neighbour(const std::filesystem::path& file) : file_(file) {
    std::string pattern = std::filesystem::absolute(file).string() + ".XXXXXX";
    const int descriptor = ::mkstemp(pattern.data());
    if (descriptor < 0) fail_to_write(file, errno);
    path_ = pattern;
    const mode_t mask = ::umask(0);
    ::umask(mask);
    ::fchmod(descriptor, 0666U & ~mask);
    ::close(descriptor);
  }
  ~Neighbour() {
    if (!path_.empty()) ::unlink(path_.c_str());
  }
  Neighbour(const Neighbour&) = delete;
  Neighbour& operator=(const Neighbour&) = delete;

  const std::filesystem::path& path() const { return path_; }

  void take_place() {
    int error_number = flush(path_, O_RDONLY);
    if (error_number == 0 && ::rename(path_.c_str(), file_.c_str()) != 0) error_number = errno;
    if (error_number != 0) fail_to_write(file_, error_number);
    const std::filesystem::path folder = path_.parent_path();
    path_.clear();
    // The copy is whole whichever name survives a power cut; no reason to fail.
    flush(folder, O_RDONLY | O_DIRECTORY);
  }

 private:
  std::filesystem::path file_;
  std::filesystem::path path_;
};

bool is_taken(const std::filesystem::path& file) {
  std::error_code ignored;
  return std::filesystem::exists(std::filesystem::symlink_status(file, ignored));
}

}  // namespace

struct Project::Impl {
  ProjectDatabase database;
  ProjectState state;
  std::vector<std::string> element_names;  // sorted
  // Filled on first use; pointers to its values are handed out.
  mutable std::map<std::string, Element, std::less<>> elements;

  explicit Impl(ProjectDatabase opened)
      : database(std::move(opened)),
        state(database.read_state()),
        element_names(database.element_names()) {}
};

std::string_view to_string(CheckMode mode) {
  switch (mode) {
    case CheckMode::Block:
      return "block";
    case CheckMode::Warn:
      return "warn";
    case CheckMode::Off:
      return "off";
  }
  DOWEL_EXPECTS(false && "a known mode");
  return {};
}

const Instance* ProjectState::find(std::string_view name) const {
  const auto found = instances.find(name);
  return found == instances.end() ? nullptr : &found->second;
}

std::vector<const Instance*> ProjectState::in_order() const {
  std::vector<const Instance*> result;
  result.reserve(instances.size());
  for (const auto& [name, instance] : instances) result.push_back(&instance);
  std::ranges::sort(result, {}, &Instance::number);
  return result;
}

Pose settled(const Pose& pose) {
  // Constructing a pose normalises it where it is off by more than rounding, which may leave it
  // off by a bit less: once more settles it.
  Pose present = pose.canonical();
  for (int pass = 0; pass < 4; ++pass) {
    const Pose again(present.rotation(), present.translation());
    if (again == present) break;
    present = again;
  }
  return present;
}

Project::Project() : impl_(std::make_unique<Impl>(ProjectDatabase())) {}
Project::Project(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Project::~Project() = default;
Project::Project(Project&&) noexcept = default;
Project& Project::operator=(Project&&) noexcept = default;

Project Project::create(const std::filesystem::path& file) {
  if (is_taken(file)) {
    throw Error(ErrorCode::FileUnwritable,
                file.string() + ": exists already; open it, or take another name");
  }
  Project().save_copy(file);
  return open(file);
}

Project Project::open(const std::filesystem::path& file) {
  return Project(std::make_unique<Impl>(ProjectDatabase(file, ProjectAccess::ReadWrite)));
}

const std::filesystem::path& Project::file() const {
  return impl_->database.file();
}

const ProjectState& Project::state() const {
  return impl_->state;
}

void Project::commit(std::string_view command, const ProjectState& next,
                     std::span<const ProjectElement> elements) {
  ProjectState settled_next = next;
  for (auto& [name, instance] : settled_next.instances) instance.X_WI = settled(instance.X_WI);
  const ProjectChange change = difference(impl_->state, settled_next);
  if (change.before.is_empty() && change.after.is_empty()) return;

  std::vector<std::string> names = impl_->element_names;
  for (const ProjectElement& element : elements) names.push_back(element.element.name);
  std::ranges::sort(names);
  DOWEL_EXPECTS(std::ranges::adjacent_find(names) == names.end());
  DOWEL_EXPECTS(!find_defect(settled_next, names));

  impl_->database.commit(command, change, elements);
  impl_->state = std::move(settled_next);
  impl_->element_names = std::move(names);
}

namespace {

/// The commands at the journal's `end`, at most `count`, and the state after going through them.
struct Steps {
  std::vector<JournalRecord> records;
  ProjectState state;
};

Steps steps_from(const ProjectDatabase& database, const ProjectState& state, JournalEnd end,
                 std::size_t count) {
  Steps steps{{}, state};
  while (steps.records.size() < count) {
    auto record = database.record(end, steps.records.size());
    if (!record) break;
    ProjectChange change = record->change;
    if (end == JournalEnd::LastDone) std::swap(change.before, change.after);
    try {
      steps.state = changed(steps.state, change);
    } catch (const Error& error) {
      throw Error(ErrorCode::FileMalformed, database.title() + ": " + error.what());
    }
    steps.records.push_back(std::move(*record));
  }
  return steps;
}

std::vector<std::string> commands_of(const std::vector<JournalRecord>& records) {
  std::vector<std::string> commands;
  commands.reserve(records.size());
  for (const JournalRecord& record : records) commands.push_back(record.command);
  return commands;
}

void expect_sound(const Steps& steps, const std::vector<std::string>& elements,
                  const ProjectDatabase& database) {
  if (const auto defect = find_defect(steps.state, elements)) {
    throw Error(ErrorCode::FileMalformed,
                database.title() + ": the journal does not fit the project: " + *defect);
  }
}

}  // namespace

std::vector<std::string> Project::undo(std::size_t count) {
  Steps steps = steps_from(impl_->database, impl_->state, JournalEnd::LastDone, count);
  expect_sound(steps, impl_->element_names, impl_->database);
  impl_->database.step(steps.records, true);
  impl_->state = std::move(steps.state);
  return commands_of(steps.records);
}

std::vector<std::string> Project::redo(std::size_t count) {
  Steps steps = steps_from(impl_->database, impl_->state, JournalEnd::FirstUndone, count);
  expect_sound(steps, impl_->element_names, impl_->database);
  impl_->database.step(steps.records, false);
  impl_->state = std::move(steps.state);
  return commands_of(steps.records);
}

std::vector<JournalEntry> Project::journal() const {
  return impl_->database.journal();
}

ProjectState Project::replay() const {
  ProjectState state;
  impl_->database.for_each_done([&](const JournalRecord& record) {
    try {
      state = changed(state, record.change);
    } catch (const Error& error) {
      throw Error(ErrorCode::FileMalformed, impl_->database.title() + ": journal entry " +
                                                std::to_string(record.number) + ": " +
                                                error.what());
    }
  });
  return state;
}

std::vector<std::string> Project::element_names() const {
  return impl_->element_names;
}

const Element* Project::find_element(std::string_view name) const {
  if (!std::ranges::binary_search(impl_->element_names, name)) return nullptr;
  const auto found = impl_->elements.find(name);
  if (found != impl_->elements.end()) return &found->second;
  const std::string what =
      impl_->database.title() + ": the copy of element \"" + std::string(name) + "\"";
  Element element = element_from_text(impl_->database.element_text(name), what);
  if (element.name != name) {
    throw Error(ErrorCode::FileMalformed,
                what + " is damaged: it calls itself \"" + element.name + "\"");
  }
  return &impl_->elements.emplace(std::string(name), std::move(element)).first->second;
}

std::shared_ptr<const FacetedSolid> Project::solid(std::string_view name) const {
  const std::vector<std::byte> blob = impl_->database.element_content(name, "facets");
  const std::string what =
      impl_->database.title() + ": the copy of element \"" + std::string(name) + "\"";
  return std::make_shared<const FacetedSolid>(from_blob(blob, what.c_str()));
}

std::vector<std::byte> Project::brep(std::string_view name) const {
  return impl_->database.element_content(name, "brep");
}

void Project::save_copy(const std::filesystem::path& file) const {
  if (is_taken(file) && !looks_like_project(file)) {
    throw Error(ErrorCode::FileUnwritable,
                file.string() + ": exists and is not a dowel project; take another name");
  }
  std::error_code ignored;
  if (!impl_->database.file().empty() &&
      std::filesystem::equivalent(file, impl_->database.file(), ignored)) {
    return;  // every command is on disk already
  }
  Neighbour copy(file);
  impl_->database.copy_into(copy.path(), file.string());
  copy.take_place();
}

}  // namespace dowel
