// The write-ahead log of a project that is open, and projects that are only read.

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <catch2/catch.hpp>

#include "dowel/assembly/project.h"
#include "dowel/assembly/project_diff.h"
#include "fixture_elements.h"
#include "program.h"

using dowel::Instance;
using dowel::Pose;
using dowel::Project;
using dowel::ProjectState;
namespace testing = dowel::testing;

namespace {

std::string bytes_of(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::vector<std::string> files_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

/// Places block 1, then moves it `moves` times.
void work(Project& project, int moves) {
  ProjectState next = project.state();
  Instance block;
  block.number = 1;
  block.name = "B1";
  block.element = "T/block-40";
  next.instances.emplace(block.name, block);
  project.commit("place", next, std::vector<dowel::ProjectElement>{testing::block_element()});
  for (int i = 1; i <= moves; ++i) {
    next.instances.at("B1").X_WI = Pose::from_translation({1.0 * i, 0, 0});
    project.commit("move", next);
  }
}

}  // namespace

TEST_CASE("a project is one file once it is closed, though it has a log while it is open") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "a.dwp";
  {
    Project project = Project::create(file);
    work(project, 5);
    CHECK(std::filesystem::exists(folder / "a.dwp-wal"));
    CHECK_FALSE(std::filesystem::exists(folder / "a.dwp-shm"));
    // Moving it about does not close it.
    Project moved = std::move(project);
    CHECK(std::filesystem::exists(folder / "a.dwp-wal"));
  }
  CHECK(files_in(file.parent_path()) == std::vector<std::string>{"a.dwp"});
  // Bytes 18 and 19 of the header: 1 is a rollback journal, which read-only media can do with.
  const std::string bytes = bytes_of(file);
  CHECK(bytes.at(18) == 1);
  CHECK(bytes.at(19) == 1);
  CHECK(Project::open(file).state().instances.at("B1").X_WI.translation().x() == 5.0);
}

TEST_CASE("the same commands give the same bytes") {
  const testing::TemporaryFolder folder;
  for (const char* name : {"a.dwp", "b.dwp"}) {
    Project project = Project::create(folder / name);
    work(project, 7);
  }
  CHECK(bytes_of(folder / "a.dwp") == bytes_of(folder / "b.dwp"));
}

TEST_CASE("a project of version 1 that is only read stays as it is") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "old.dwp";
  {
    Project project = Project::create(file);
    work(project, 1);
  }
  {
    SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
    database.exec("DROP TABLE mate_target; PRAGMA user_version = 1");
  }
  const std::string before = bytes_of(file);
  CHECK(dowel::read_project_state(file).instances.size() == 1);
  CHECK(bytes_of(file) == before);
  CHECK(files_in(file.parent_path()) == std::vector<std::string>{"old.dwp"});
}
