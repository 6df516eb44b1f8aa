#include "dowel/assembly/project.h"

#include <array>
#include <cstdio>
#include <set>
#include <string>

#include <SQLiteCpp/SQLiteCpp.h>
#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "fixture_elements.h"
#include "program.h"
#include "random_geometry.h"

using dowel::Error;
using dowel::ErrorCode;
using dowel::Instance;
using dowel::Pose;
using dowel::Project;
using dowel::ProjectElement;
using dowel::ProjectState;
namespace testing = dowel::testing;

namespace {

std::string hex_text(double value) {
  std::array<char, 64> buffer{};
  std::snprintf(buffer.data(), buffer.size(), "%a", value);
  return buffer.data();
}

/// All rows of the tables that commands change, as SQLite itself tells them.
std::string dump(const std::filesystem::path& file) {
  SQLite::Database database(file.string(), SQLite::OPEN_READONLY);
  std::string text;
  for (const std::string table : {"setting", "instance", "mate", "element"}) {
    text += table + "\n";
    SQLite::Statement rows(database, "SELECT * FROM " + table + " ORDER BY 1");
    while (rows.executeStep()) {
      for (int i = 0; i < rows.getColumnCount(); ++i) {
        const SQLite::Column column = rows.getColumn(i);
        text += (column.isFloat() ? hex_text(column.getDouble()) : column.getString()) + "|";
      }
      text += "\n";
    }
  }
  return text;
}

ProjectState with_instance(const ProjectState& state, const std::string& name,
                           const std::string& element, const Pose& X_WI) {
  ProjectState next = state;
  Instance instance;
  instance.number = static_cast<std::uint32_t>(state.instances.size() + 1);
  instance.name = name;
  instance.element = element;
  instance.X_WI = X_WI;
  next.instances.emplace(name, instance);
  return next;
}

ErrorCode code_of_opening(const std::filesystem::path& file) {
  try {
    Project::open(file);
  } catch (const Error& error) {
    CAPTURE(error.what());
    CHECK(std::string(error.what()).find(file.filename().string()) != std::string::npos);
    return error.code();
  }
  FAIL("opened");
  return ErrorCode::NotFound;
}

void set_pragma(const std::filesystem::path& file, const std::string& pragma) {
  SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
  database.exec("PRAGMA " + pragma);
}

}  // namespace

TEST_CASE("a project is found again in its file to the bit") {
  const testing::TemporaryFolder folder;
  const ProjectElement block = testing::block_element();
  testing::RandomGeometry random(7);
  ProjectState written;
  {
    Project project = Project::create(folder / "a.dwp");
    std::vector<ProjectElement> copies{block};
    for (int i = 0; i < 50; ++i) {
      const Pose X_WI(random.rotation(), random.point(5000));
      project.commit("place " + std::to_string(i),
                     with_instance(project.state(), "B" + std::to_string(i), "T/block-40", X_WI),
                     copies);
      copies.clear();
    }
    ProjectState next = project.state();
    next.mode = dowel::CheckMode::Warn;
    next.tolerance_mm = 0.1 + 0.2;
    next.instances.at("B3").grounded = true;
    dowel::Mate mate;
    mate.number = 1;
    mate.kind = dowel::MateKind::FaceOnFace;
    mate.moving = {"B1", "bottom"};
    mate.fixed = {"B2", "top"};
    mate.moving_face = {"B1", "left"};
    mate.fixed_face = {"B3", "right"};
    mate.offset_mm = 1.0 / 3.0;
    mate.flip = true;
    next.mates.emplace(1, mate);
    project.commit("more", next);
    written = project.state();
  }
  const Project project = Project::open(folder / "a.dwp");
  CHECK(project.state() == written);
  CHECK(project.replay() == written);
  CHECK(project.journal().size() == 51);
  CHECK(project.element_names() == std::vector<std::string>{"T/block-40"});
  const dowel::Element* copy = project.find_element("T/block-40");
  REQUIRE(copy != nullptr);
  CHECK(copy->features.size() == block.element.features.size());
  CHECK(copy->obb.half_extents_mm == block.element.obb.half_extents_mm);
  CHECK(project.solid("T/block-40")->vertices == block.solid->vertices);
  CHECK(project.brep("T/block-40").empty());
  CHECK(project.find_element("T/other") == nullptr);
  CHECK_THROWS_AS(project.solid("T/other"), Error);
}

TEST_CASE("a copy of an element keeps what its maker states of it") {
  ProjectElement plate = testing::plate_element();
  plate.element.role = "base plate";
  plate.element.description = "a plate";
  plate.element.material = "steel C45";
  plate.element.dimensions_by = "like nothing";
  plate.element.density_kg_per_m3 = 7850.0;
  plate.element.bolt_circles.push_back(
      {{1, 2, 3}, -Eigen::Vector3d::UnitZ(), 80.0, 12.0, {"A1", "B1", "C1"}});
  plate.element.features[0].use = "node";
  plate.element.features[0].thread = "M12";
  plate.element.features[0].thread_is_guess = true;
  plate.element.features[0].fit = "H7";
  const testing::TemporaryFolder folder;
  Project::create(folder / "a.dwp")
      .commit("place", with_instance({}, "P", plate.element.name, Pose()),
              std::vector<ProjectElement>{plate});
  const Project project = Project::open(folder / "a.dwp");
  const dowel::Element& copy = *project.find_element(plate.element.name);
  CHECK(copy.role == "base plate");
  CHECK(copy.description == "a plate");
  CHECK(copy.material == "steel C45");
  CHECK(copy.dimensions_by == "like nothing");
  CHECK(copy.density_kg_per_m3 == 7850.0);
  REQUIRE(copy.bolt_circles.size() == 1);
  CHECK(copy.bolt_circles[0].center == Eigen::Vector3d(1, 2, 3));
  CHECK(copy.bolt_circles[0].holes == std::vector<std::string>{"A1", "B1", "C1"});
  CHECK(copy.features[0].use == "node");
  CHECK(copy.features[0].thread == "M12");
  CHECK(copy.features[0].thread_is_guess);
  CHECK(copy.features[0].fit == "H7");
  CHECK(copy.features[1].use.empty());
}

TEST_CASE("undo and redo lead back to identical rows, also after reopening", "[property]") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "a.dwp";
  testing::RandomGeometry random(11);
  std::vector<std::string> dumps;
  int kinds[4] = {0, 0, 0, 0};
  {
    Project::create(file).commit(
        "first", with_instance({}, "B0", "T/block-40", Pose(random.rotation(), random.point(100))),
        std::vector<ProjectElement>{testing::block_element()});
  }
  dumps.push_back(dump(file));
  for (int step = 1; step < 40; ++step) {
    Project project = Project::open(file);
    ProjectState next = project.state();
    const auto kind = next.instances.empty() ? 0U : random.index(4);
    ++kinds[kind];
    if (kind == 0) {
      next = with_instance(next, "B" + std::to_string(step), "T/block-40",
                           Pose(random.rotation(), random.point(100)));
      next.instances.at("B" + std::to_string(step)).number = static_cast<std::uint32_t>(step + 1);
    } else if (kind == 1) {
      next.instances.begin()->second.X_WI = Pose(random.rotation(), random.point(100));
    } else if (kind == 2) {
      next.tolerance_mm = random.uniform(0.001, 1.0);
    } else {
      next.instances.erase(std::prev(next.instances.end()));
    }
    project.commit("step " + std::to_string(step), next);
    dumps.push_back(std::string());
    const ProjectState state = project.state();
    CHECK(project.replay() == state);
    project = Project();  // lets go of the file
    dumps.back() = dump(file);
  }
  for (const int count : kinds) CHECK(count >= 4);

  for (std::size_t i = dumps.size() - 1; i > 0; --i) {
    CHECK(Project::open(file).undo().size() == 1);
    REQUIRE(dump(file) == dumps[i - 1]);
  }
  CHECK(Project::open(file).redo(1000).size() == dumps.size() - 1);
  CHECK(dump(file) == dumps.back());
  CHECK(Project::open(file).redo().empty());
  CHECK(Project::open(file).undo(1000).size() == dumps.size());
  CHECK(Project::open(file).state() == ProjectState{});
}

TEST_CASE("a new command drops what could be redone, and one that changes nothing is none") {
  Project project;
  const std::vector<ProjectElement> copies{testing::block_element()};
  project.commit("a", with_instance(project.state(), "A", "T/block-40", Pose()), copies);
  project.commit("b", with_instance(project.state(), "B", "T/block-40", Pose()));
  CHECK(project.undo() == std::vector<std::string>{"b"});
  project.commit("nothing", project.state());
  CHECK(project.redo() == std::vector<std::string>{"b"});
  project.undo();
  project.commit("c", with_instance(project.state(), "C", "T/block-40", Pose()));
  CHECK(project.redo().empty());
  const auto journal = project.journal();
  REQUIRE(journal.size() == 2);
  CHECK(journal[1].command == "c");
  CHECK(journal[1].number == 2);
}

TEST_CASE("a copy is whole, replaces projects only and may go over itself") {
  const testing::TemporaryFolder folder;
  Project project;
  project.commit("a", with_instance({}, "A", "T/block-40", Pose()),
                 std::vector<ProjectElement>{testing::block_element()});
  project.save_copy(folder / "copy.dwp");
  project.save_copy(folder / "again.dwp");
  CHECK(testing::read_text(folder / "copy.dwp") == testing::read_text(folder / "again.dwp"));
  CHECK(Project::open(folder / "copy.dwp").state() == project.state());
  project.commit("b", with_instance(project.state(), "B", "T/block-40", Pose()));
  project.save_copy(folder / "copy.dwp");
  Project opened = Project::open(folder / "copy.dwp");
  CHECK(opened.state() == project.state());
  CHECK_NOTHROW(opened.save_copy(folder / "copy.dwp"));
  CHECK(opened.undo() == std::vector<std::string>{"b"});

  testing::write_text(folder / "letter.txt", "Dear Sir");
  CHECK_THROWS_AS(project.save_copy(folder / "letter.txt"), Error);
  CHECK(testing::read_text(folder / "letter.txt") == "Dear Sir");
  CHECK_THROWS_AS(project.save_copy(folder / "no-folder" / "x.dwp"), Error);
  CHECK_THROWS_AS(Project::create(folder / "letter.txt"), Error);
  // Nothing is left lying about; SQLite keeps a side file while a project is open.
  opened = Project();
  std::set<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    names.insert(entry.path().filename().string());
  }
  CHECK(names == std::set<std::string>{"again.dwp", "copy.dwp", "letter.txt"});
}

TEST_CASE("what is no project is refused with the name of the file and what it is", "[fault]") {
  const testing::TemporaryFolder folder;
  CHECK(code_of_opening(folder / "missing.dwp") == ErrorCode::FileUnreadable);
  std::filesystem::create_directory(folder / "folder.dwp");
  CHECK(code_of_opening(folder / "folder.dwp") == ErrorCode::FileUnreadable);
  testing::write_text(folder / "empty.dwp", "");
  CHECK(code_of_opening(folder / "empty.dwp") == ErrorCode::SchemaMismatch);
  testing::write_text(folder / "text.dwp", std::string(5000, 'x'));
  CHECK(code_of_opening(folder / "text.dwp") == ErrorCode::SchemaMismatch);
  testing::write_fixture_catalog(folder / "catalog.db");
  CHECK(code_of_opening(folder / "catalog.db") == ErrorCode::SchemaMismatch);
  Project::create(folder / "newer.dwp");
  set_pragma(folder / "newer.dwp", "user_version = 3");
  CHECK(code_of_opening(folder / "newer.dwp") == ErrorCode::SchemaMismatch);
  Project::create(folder / "trigger.dwp");
  {
    SQLite::Database database((folder / "trigger.dwp").string(), SQLite::OPEN_READWRITE);
    database.exec("CREATE TRIGGER t AFTER INSERT ON instance BEGIN DELETE FROM journal; END");
  }
  CHECK(code_of_opening(folder / "trigger.dwp") == ErrorCode::SchemaMismatch);
}

TEST_CASE("rows that make no sense are refused, not believed", "[fault]") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "a.dwp";
  Project::create(file).commit("a", with_instance({}, "A", "T/block-40", Pose()),
                               std::vector<ProjectElement>{testing::block_element()});
  const std::string sound = testing::read_text(file);
  for (const char* sql :
       {"UPDATE instance SET qw = 0.5", "UPDATE instance SET x_mm = 1e9",
        "UPDATE instance SET name = 'a b'", "UPDATE instance SET number = -5",
        "UPDATE instance SET element = 'none'", "UPDATE setting SET value = 'maybe'",
        "DELETE FROM element",
        "INSERT INTO mate VALUES (1, 'glue', 'A', 'x', 'A', 'y', NULL, NULL, NULL, 0, 0, 0)"}) {
    CAPTURE(sql);
    testing::write_text(file, sound);
    {
      SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
      database.exec("PRAGMA foreign_keys = OFF");
      database.exec(sql);
    }
    CHECK(code_of_opening(file) == ErrorCode::FileMalformed);
  }
  for (const char* sql :
       {"UPDATE journal SET before = '{', after = '{'",
        "UPDATE journal SET after = '{\"instances\": [1]}'", "UPDATE journal SET after = '{}'"}) {
    CAPTURE(sql);
    testing::write_text(file, sound);
    {
      SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
      database.exec(sql);
    }
    Project project = Project::open(file);
    const ProjectState before = project.state();
    try {
      project.undo();
    } catch (const Error& error) {
      CHECK(error.code() == ErrorCode::FileMalformed);
      CHECK(project.state() == before);
    }
  }
  testing::write_text(file, sound);
  {
    SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
    database.exec("UPDATE element SET description = '{}', facets = x'00'");
  }
  const Project project = Project::open(file);
  CHECK_THROWS_AS(project.find_element("T/block-40"), Error);
  CHECK_THROWS_AS(project.solid("T/block-40"), Error);
}

TEST_CASE("a second program is told that the project is in use", "[fault]") {
  const testing::TemporaryFolder folder;
  const auto file = folder / "a.dwp";
  const Project holder = Project::create(file);
  const pid_t child = ::fork();
  REQUIRE(child >= 0);
  if (child == 0) {
    int code = 1;
    try {
      Project::open(file);
    } catch (const Error& error) {
      if (std::string(error.what()).find("in use") != std::string::npos) code = 0;
    }
    ::_exit(code);
  }
  int status = -1;
  REQUIRE(::waitpid(child, &status, 0) == child);
  CHECK(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
}
