#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/assembly/fixture_design.h"
#include "dowel/assembly/mate.h"
#include "dowel/catalog/element.h"
#include "dowel/kernel/faceted_solid.h"
#include "dowel/kernel/pose.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {

/// What becomes of a move that ends in, or goes through, an interference: it is taken back, it is
/// done and reported, or nobody looks.
enum class CheckMode : std::uint8_t { Block, Warn, Off };

/// "block", "warn", "off".
std::string_view to_string(CheckMode mode);

/// A placed element.
struct Instance {
  std::uint32_t number = 0;  ///< order of placing, unique
  std::string name;
  std::string element;
  Pose X_WI;
  bool grounded = false;  ///< never moves

  bool operator==(const Instance&) const = default;
};

/// A feature by name; written INSTANCE.FEATURE.
struct FeatureName {
  std::string instance;
  std::string feature;

  std::string text() const { return instance + "." + feature; }
  bool operator==(const FeatureName&) const = default;
};

/// A mate that was made and still holds: `moving` went to `fixed`.
struct Mate {
  std::uint32_t number = 0;  ///< order of making, unique
  MateKind kind = MateKind::ShaftInHole;
  FeatureName moving;
  FeatureName fixed;
  FeatureName moving_face;  ///< of the seat; empty where there is none
  FeatureName fixed_face;
  double offset_mm = 0.0;
  bool flip = false;
  bool thread = false;       ///< shaft and hole form a thread
  double angle_rad = 0.0;    ///< Angle
  std::optional<Pose> X_FM;  ///< Fix, and only then: moving in fixed part, whose features are none

  bool has_seat() const { return !fixed_face.instance.empty(); }
  bool operator==(const Mate&) const = default;
};

/// All that commands change. A value: a command makes the next state out of a copy.
struct ProjectState {
  CheckMode mode = CheckMode::Block;
  double tolerance_mm = kDefaultTolerance_mm;
  std::map<std::string, Instance, std::less<>> instances;  ///< by name
  std::map<std::uint32_t, Mate> mates;                     ///< by number
  FixtureDesign design;

  const Instance* find(std::string_view name) const;
  /// In order of placing.
  std::vector<const Instance*> in_order() const;

  bool operator==(const ProjectState&) const = default;
};

/// An element as a project keeps it.
struct ProjectElement {
  Element element;
  std::shared_ptr<const FacetedSolid> solid;
  std::vector<std::byte> brep;  ///< opaque; may be empty
};

struct JournalEntry {
  std::uint32_t number = 0;  ///< from 1
  std::string command;
  bool undone = false;  ///< can be redone
};

/// An assembly project: one SQLite file that holds instances, mates, settings, the journal of
/// commands and copies of the elements in use, and needs nothing else. Each commit, undo and redo
/// is one transaction that is on disk when the call returns; a process that is killed loses at most
/// the one in flight. The file is locked while it is open. Movable; one thread at a time.
///
/// A function that throws leaves project and file as they were.
class Project {
 public:
  /// A project in memory, without a file.
  Project();

  /// Creates `file`. Throws Error{FileUnwritable} where it exists or cannot be written.
  static Project create(const std::filesystem::path& file);

  /// Throws Error{FileUnreadable} (missing, a folder), Error{SchemaMismatch} (no project, or of a
  /// newer version), Error{FileMalformed} (damaged), Error{FileUnwritable} (in use by another
  /// program). A file that is write-protected opens for reading.
  static Project open(const std::filesystem::path& file);

  ~Project();
  Project(Project&&) noexcept;
  Project& operator=(Project&&) noexcept;

  /// Empty where the project is in memory.
  const std::filesystem::path& file() const;

  const ProjectState& state() const;

  /// Makes `next` the state and adds `command` to the journal, unless nothing changes; what was
  /// undone before can no longer be redone. `elements`: copies that `next` needs and the project
  /// does not have. Poses are stored with w >= 0, to the bit. Throws Error{FileUnwritable}.
  /// Expects: instances whose element, and mates whose instances, are there.
  void commit(std::string_view command, const ProjectState& next,
              std::span<const ProjectElement> elements = {});

  /// Takes back up to `count` commands, does them again; the commands, in the order that this
  /// happened. Throws Error{FileUnwritable}, or Error{FileMalformed} where the journal does not
  /// fit the state.
  std::vector<std::string> undo(std::size_t count = 1);
  std::vector<std::string> redo(std::size_t count = 1);

  /// Oldest first.
  std::vector<JournalEntry> journal() const;

  /// The state that the journal alone leads to, from an empty project. Equals `state()` unless the
  /// file was tampered with. Throws Error{FileMalformed}.
  ProjectState replay() const;

  /// Names of the element copies, sorted.
  std::vector<std::string> element_names() const;
  /// Nothing where the project has no copy.
  const Element* find_element(std::string_view name) const;
  /// Throw Error{NotFound} where there is no copy, Error{FileMalformed} where it is damaged.
  std::shared_ptr<const FacetedSolid> solid(std::string_view name) const;
  std::vector<std::byte> brep(std::string_view name) const;

  /// Writes a copy that appears whole or not at all; an older project of that name is replaced,
  /// anything else is not. Throws Error{FileUnwritable}.
  void save_copy(const std::filesystem::path& file) const;

 private:
  struct Impl;
  explicit Project(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

/// True where `file` starts as a project does.
bool looks_like_project(const std::filesystem::path& file);

/// The pose as a project stores it: w >= 0, and such that reading it back gives the same bits.
Pose settled(const Pose& pose);

}  // namespace dowel
