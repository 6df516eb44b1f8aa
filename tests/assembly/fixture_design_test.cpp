#include "dowel/assembly/fixture_design.h"

#include <SQLiteCpp/SQLiteCpp.h>
#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "fixture_projects.h"
#include "program.h"

namespace {

using dowel::Error;
using dowel::FixtureDesign;
using dowel::Project;
namespace testing = dowel::testing;

FixtureDesign full_design() {
  FixtureDesign design;
  design.roles["REST1"] = dowel::Role::AdjustableSupport;
  design.clamp_forces_N["CLAMP"] = 0.1 + 0.2;
  design.locator_errors_mm["STOP1"] = 1.0 / 3.0;
  design.loads["CUT"] = {{1, -2, 1e-17}, {0.1, 0.2, 0.3}, {7, 8, 9}};
  design.points["P"] = {{1, 2, 3}, 0.05};
  design.limits["friction"] = 0.2;
  design.stated[{"stroke_mm", "CLAMP"}] = {12.5, "maker's \"sheet\""};
  design.stated[{"machined", "WORK.bottom"}] = {1.0, "drawing"};
  design.overrides["LOC-04"] = {"warning", "a \"study\"\nof two lines"};
  design.waivers[{"COL-01", "REST1 WORK"}] = {"agreed", "somebody", "0123"};
  return design;
}

}  // namespace

TEST_CASE("a design is found again in the project's file, and in its journal") {
  const testing::TemporaryFolder folder;
  const testing::FixtureBuilder builder = testing::sound_fixture();
  {
    Project project = Project::create(folder / "a.dwp");
    project.commit("build", builder.state, builder.elements);
    dowel::ProjectState next = project.state();
    next.design = full_design();
    project.commit("design", next);
  }
  Project project = Project::open(folder / "a.dwp");
  CHECK(project.state().design == full_design());
  CHECK(project.replay() == project.state());
  CHECK(project.undo() == std::vector<std::string>{"design"});
  CHECK(project.state().design == builder.state.design);
  project.redo();
  CHECK(project.state().design == full_design());
}

TEST_CASE("a part that is removed takes its role and force with it") {
  const auto session = testing::sound_fixture().session();
  FixtureDesign design = session->state().design;
  design.roles["CLAMP"] = dowel::Role::Clamp;
  design.stated[{"stroke_mm", "CLAMP"}] = {12.5, "sheet"};
  design.stated[{"machined", "CLAMP.bottom"}] = {1.0, "drawing"};
  session->set_design(design, "role");
  session->remove("CLAMP", "remove");
  CHECK(session->state().design.clamp_forces_N.empty());
  CHECK(session->state().design.roles.empty());
  CHECK(session->state().design.stated.empty());
  session->undo(1);
  CHECK(session->state().design == design);
}

TEST_CASE("a design in a file that makes no sense is refused by its row", "[fault]") {
  for (const auto& [name, value] :
       {std::pair("role REST1", "\"carpenter\""), std::pair("role REST1", "7"),
        std::pair("limit gravity", "9.81"), std::pair("limit friction", "\"much\""),
        std::pair("limit friction", "["), std::pair("load CUT", "{}"),
        std::pair("waiver COL-01", "{\"reason\":\"\",\"by\":\"\",\"digest\":\"\"}"),
        std::pair("clamp-force CLAMP", "1e999"),
        std::pair("stated colour CLAMP", "{\"value\":1,\"reason\":\"\"}"),
        std::pair("stated stroke_mm", "{\"value\":1,\"reason\":\"\"}"),
        std::pair("stated stroke_mm CLAMP", "7"), std::pair("nothing", "7")}) {
    CAPTURE(name, value);
    const testing::TemporaryFolder folder;
    Project::create(folder / "a.dwp");
    {
      SQLite::Database database((folder / "a.dwp").string(), SQLite::OPEN_READWRITE);
      SQLite::Statement insert(database, "INSERT INTO setting VALUES (?, ?)");
      insert.bind(1, name);
      insert.bind(2, value);
      insert.exec();
    }
    try {
      Project::open(folder / "a.dwp");
      FAIL("opened");
    } catch (const Error& error) {
      CHECK(error.code() == dowel::ErrorCode::FileMalformed);
      CHECK(std::string(error.what()).find(name) != std::string::npos);
    }
  }
}
