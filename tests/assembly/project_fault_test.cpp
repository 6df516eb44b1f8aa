// Killed writers, full disks, damaged files.

#include <array>
#include <csignal>
#include <string>

#include <catch2/catch.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dowel/assembly/project.h"
#include "dowel/kernel/error.h"
#include "fixture_elements.h"
#include "program.h"
#include "random_geometry.h"

using dowel::Error;
using dowel::ErrorCode;
using dowel::Instance;
using dowel::Pose;
using dowel::Project;
using dowel::ProjectState;
namespace testing = dowel::testing;

namespace {

ProjectState with_block(const ProjectState& state, std::uint32_t number) {
  ProjectState next = state;
  Instance instance;
  instance.number = number;
  instance.name = "B" + std::to_string(number);
  instance.element = "T/block-40";
  instance.X_WI = Pose::from_translation({50.0 * number, 0, 0});
  next.instances.emplace(instance.name, instance);
  return next;
}

/// Commits blocks 1, 2, 3, ... and tells the number of each on `pipe` once it is done.
[[noreturn]] void place_for_ever(const std::filesystem::path& file, int pipe) {
  Project project = Project::open(file);
  auto number = static_cast<std::uint32_t>(project.state().instances.size());
  while (true) {
    ++number;
    project.commit("place " + std::to_string(number), with_block(project.state(), number));
    if (::write(pipe, &number, sizeof number) != sizeof number) ::_exit(1);
  }
}

Project project_with_block(const std::filesystem::path& file) {
  Project project = Project::create(file);
  project.commit("place 1", with_block({}, 1),
                 std::vector<dowel::ProjectElement>{testing::block_element()});
  return project;
}

}  // namespace

TEST_CASE("a process that is killed at any moment keeps every finished command", "[fault]") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "a.dwp";
  project_with_block(file);
  std::uint32_t told_in_all = 0;
  for (int round = 0; round < 15; ++round) {
    std::array<int, 2> ends{};
    REQUIRE(::pipe(ends.data()) == 0);
    const pid_t child = ::fork();
    REQUIRE(child >= 0);
    if (child == 0) {
      ::close(ends[0]);
      try {
        place_for_ever(file, ends[1]);
      } catch (...) {
        ::_exit(2);
      }
    }
    ::close(ends[1]);
    // A few commands in, and then somewhere inside the next one: the rounds differ in how far.
    std::uint32_t told = 0;
    for (int i = 0; i < 3; ++i) REQUIRE(::read(ends[0], &told, sizeof told) == sizeof told);
    ::usleep(static_cast<useconds_t>(137 * round));
    ::kill(child, SIGKILL);
    int status = 0;
    REQUIRE(::waitpid(child, &status, 0) == child);
    REQUIRE(WIFSIGNALED(status));
    std::uint32_t last = told;
    while (::read(ends[0], &told, sizeof told) == sizeof told) last = told;
    ::close(ends[0]);

    const Project project = Project::open(file);
    const std::size_t count = project.state().instances.size();
    // What was told is there; one more may have been finished but not told.
    CHECK(count >= last);
    CHECK(count <= last + 1);
    CHECK(project.journal().size() == count);
    REQUIRE(project.replay() == project.state());
    told_in_all = last;
  }
  CHECK(told_in_all >= 46);
}

TEST_CASE("a disk without room fails the command and leaves the project as it was", "[fault]") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "a.dwp";
  project_with_block(file);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    int code = 1;
    try {
      Project project = Project::open(file);
      const auto size = static_cast<rlim_t>(std::filesystem::file_size(file));
      const rlimit limit{size, size};
      ::setrlimit(RLIMIT_FSIZE, &limit);
      std::uint32_t number = 1;
      try {
        // A large command text needs pages that the file does not have.
        for (;; ++number) {
          project.commit(std::string(20000, 'x'), with_block(project.state(), number + 1));
        }
      } catch (const Error& error) {
        const bool same = project.state().instances.size() == number;
        const bool works =
            project.journal().size() == number && project.replay() == project.state();
        bool copies = true;
        try {
          project.save_copy(folder / "copy.dwp");
        } catch (const Error&) {
          copies = !std::filesystem::exists(folder / "copy.dwp");
        }
        if (error.code() == ErrorCode::FileUnwritable && same && works && copies) code = 0;
      }
    } catch (...) {
      code = 2;
    }
    ::_exit(code);
  }
  int status = 0;
  REQUIRE(::waitpid(child, &status, 0) == child);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  const Project project = Project::open(file);
  CHECK(project.replay() == project.state());
}

TEST_CASE("a damaged project file gives an error or a project, never a crash", "[fault]") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "a.dwp";
  {
    Project project = project_with_block(file);
    for (std::uint32_t i = 2; i < 12; ++i) project.commit("p", with_block(project.state(), i));
  }
  const std::string sound = testing::read_text(file);
  const dowel::ProjectState sound_state = Project::open(file).state();
  const auto try_all = [&] {
    try {
      Project project = Project::open(file);
      project.journal();
      project.find_element("T/block-40");
      project.solid("T/block-40");
      project.brep("T/block-40");
      project.replay();
      project.undo(3);
      project.commit("q", with_block(project.state(), 99));
      return true;
    } catch (const Error&) {
      return false;
    }
  };
  int opened = 0;
  int refused = 0;
  for (std::size_t step = 0; step < 40; ++step) {
    const std::size_t length = sound.size() * step / 40;
    CAPTURE(length);
    testing::write_text(file, sound.substr(0, length));
    std::filesystem::remove(folder / "a.dwp-journal");
    // The last page ends in zeros, which SQLite reads where there is nothing: then nothing is lost.
    const bool is_whole = sound.find_first_not_of('\0', length) == std::string::npos;
    if (is_whole) CHECK(Project::open(file).state() == sound_state);
    const bool is_opened = try_all();
    CHECK(is_opened == is_whole);
    is_opened ? ++opened : ++refused;
  }
  CHECK(refused >= 30);
  testing::RandomGeometry random(3);
  opened = 0;
  refused = 0;
  for (int round = 0; round < 120; ++round) {
    CAPTURE(round);
    std::string damaged = sound;
    for (int flips = 0; flips < 1 + round % 4; ++flips) {
      char& byte = damaged[random.index(static_cast<std::uint32_t>(damaged.size()))];
      byte = static_cast<char>(static_cast<unsigned char>(byte) ^ (1U << random.index(8)));
    }
    testing::write_text(file, damaged);
    std::filesystem::remove(folder / "a.dwp-journal");
    try_all() ? ++opened : ++refused;
  }
  CHECK(refused >= 10);
  CHECK(opened >= 5);
}
