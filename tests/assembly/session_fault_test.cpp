// Sessions that are killed while their commands run.

#include <array>
#include <csignal>
#include <cstring>

#include <SQLiteCpp/SQLiteCpp.h>
#include <catch2/catch.hpp>
#include <sys/wait.h>
#include <unistd.h>

#include "dowel/assembly/session.h"
#include "fixture_elements.h"
#include "program.h"
#include "random_geometry.h"

using dowel::Project;
using dowel::ProjectState;
using dowel::Session;
namespace testing = dowel::testing;

namespace {

/// What a session tells after each command.
struct Told {
  std::uint64_t commands = 0;  ///< of this session
  std::uint64_t done = 0;      ///< journal entries that are not undone
  std::uint64_t state = 0;     ///< a digest

  bool is_same_project(const Told& other) const {
    return done == other.done && state == other.state;
  }
};

/// FNV-1a over all that commands change.
std::uint64_t digest(const ProjectState& state) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  const auto add = [&](const void* data, std::size_t size) {
    const auto* bytes = static_cast<const unsigned char*>(data);
    for (std::size_t i = 0; i < size; ++i) hash = (hash ^ bytes[i]) * 0x100000001b3U;
  };
  for (const auto& [name, instance] : state.instances) {
    add(name.data(), name.size());
    add(instance.element.data(), instance.element.size());
    add(instance.X_WI.rotation().coeffs().data(), 4 * sizeof(double));
    add(instance.X_WI.translation().data(), 3 * sizeof(double));
    add(&instance.grounded, sizeof instance.grounded);
  }
  for (const auto& [number, mate] : state.mates) {
    add(&number, sizeof number);
    add(mate.moving.instance.data(), mate.moving.instance.size());
    add(mate.fixed.feature.data(), mate.fixed.feature.size());
  }
  return hash;
}

Told tell(const Project& project, std::uint64_t commands) {
  Told told;
  told.commands = commands;
  for (const dowel::JournalEntry& entry : project.journal()) told.done += entry.undone ? 0 : 1;
  told.state = digest(project.state());
  return told;
}

/// One command of any kind; those that are refused change nothing.
void run_any(Session& session, testing::RandomGeometry& random, std::uint64_t number) {
  const std::array<const char*, 3> elements{"T/block-40", "T/pin-12", "T/riser-60x60x40"};
  const std::string name = "P" + std::to_string(number);
  const auto pick = [&] {
    const auto placed = session.state().in_order();
    return placed[random.index(static_cast<std::uint32_t>(placed.size()))]->name;
  };
  const Eigen::Vector3d somewhere = random.point(400.0);
  switch (session.state().instances.empty() ? 0U : random.index(10)) {
    case 0:
    case 1:
    case 2:
      session.place(elements[random.index(3)], name, dowel::Pose::from_translation(somewhere),
                    "place " + name);
      break;
    case 3:
    case 4:
      session.move(pick(), somewhere, "move");
      break;
    case 5:
      session.rotate(pick(), somewhere, Eigen::Vector3d::UnitZ(), 0.5, "rotate");
      break;
    case 6:
      session.remove(pick(), "remove");
      break;
    case 7:
      session.set_mode(random.coin() ? dowel::CheckMode::Warn : dowel::CheckMode::Block, "mode");
      break;
    case 8:
      session.undo(1 + random.index(3));
      break;
    default:
      session.redo(1 + random.index(2));
  }
}

/// Runs commands and tells of each on `pipe` when it is done, until it is killed.
[[noreturn]] void work_for_ever(const std::filesystem::path& file,
                                const std::filesystem::path& catalog, std::uint64_t seed,
                                int pipe) {
  Session session(Project::open(file));
  session.use_catalog(
      std::make_shared<const dowel::Catalog>(catalog, dowel::Catalog::Access::ReadOnly));
  testing::RandomGeometry random(seed);
  for (std::uint64_t number = 1;; ++number) {
    run_any(session, random, 1000 * seed + number);
    const Told told = tell(session.project(), number);
    if (::write(pipe, &told, sizeof told) != sizeof told) ::_exit(1);
  }
}

/// Kills a session at a moment of its own and returns what it told last.
Told killed_session(const std::filesystem::path& file, const std::filesystem::path& catalog,
                    std::uint64_t seed, std::uint32_t delay_us) {
  std::array<int, 2> ends{};
  REQUIRE(::pipe(ends.data()) == 0);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    ::close(ends[0]);
    try {
      work_for_ever(file, catalog, seed, ends[1]);
    } catch (...) {
      ::_exit(2);
    }
  }
  ::close(ends[1]);
  // It is at work once it has told of one command.
  Told told;
  REQUIRE(::read(ends[0], &told, sizeof told) == sizeof told);
  ::usleep(delay_us);
  ::kill(child, SIGKILL);
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFSIGNALED(status));
  Told last = told;
  while (::read(ends[0], &told, sizeof told) == sizeof told) last = told;
  ::close(ends[0]);
  return last;
}

/// Kills `rounds` sessions on one project; returns how many commands they finished.
std::uint64_t kill_sessions(int rounds) {
  const testing::TemporaryFolder folder;
  const auto file = folder / "a.dwp";
  const auto catalog = folder / "catalog.db";
  testing::write_fixture_catalog(catalog);
  { const Project made = Project::create(file); }
  testing::RandomGeometry random(77);
  std::uint64_t finished = 0;
  for (int round = 0; round < rounds; ++round) {
    CAPTURE(round);
    const Told told =
        killed_session(file, catalog, static_cast<std::uint64_t>(round) + 1, random.index(15000));
    finished += told.commands;
    Project project = Project::open(file);
    {
      // What SQLite knows to check.
      project.save_copy(folder / "copy.dwp");
      SQLite::Database copy((folder / "copy.dwp").string(), SQLite::OPEN_READONLY);
      REQUIRE(copy.execAndGet("PRAGMA integrity_check").getString() == "ok");
      SQLite::Statement orphans(copy, "PRAGMA foreign_key_check");
      REQUIRE_FALSE(orphans.executeStep());
    }
    REQUIRE(project.replay() == project.state());
    const Told found = tell(project, 0);
    if (found.is_same_project(told)) continue;
    // The command in flight was finished, too: one step back is what was told. Undo and redo take
    // up to three.
    const bool was_undo = found.done < told.done;
    const auto apart =
        static_cast<std::size_t>(was_undo ? told.done - found.done : found.done - told.done);
    REQUIRE(apart >= 1);
    REQUIRE(apart <= 3);
    was_undo ? project.redo(apart) : project.undo(apart);
    REQUIRE(tell(project, 0).is_same_project(told));
  }
  return finished;
}

}  // namespace

TEST_CASE("a session that is killed at any moment has kept every finished command", "[fault]") {
  CHECK(kill_sessions(40) >= 40);
}

TEST_CASE("five hundred sessions that are killed keep every finished command", "[.long]") {
  const std::uint64_t finished = kill_sessions(500);
  WARN(finished << " commands finished");
  CHECK(finished >= 500);
}
