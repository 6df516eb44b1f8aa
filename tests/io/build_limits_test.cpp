// What a build may spend on a file.

#include <filesystem>
#include <vector>

#include <BRepPrimAPI_MakeBox.hxx>
#include <catch2/catch.hpp>

#include "dowel/io/catalog_build.h"
#include "program.h"
#include "step_files.h"

using namespace dowel;

TEST_CASE("a file that took too long is tried again with other limits, and only then") {
  const testing::TemporaryFolder folder;
  testing::write_step(folder / "block.step", {BRepPrimAPI_MakeBox(10.0, 20.0, 30.0).Shape()});
  testing::write_step(folder / "plate.step", {testing::drilled_plate()});
  const std::vector<std::filesystem::path> one{folder / "block.step"};
  const std::vector<std::filesystem::path> both{folder / "block.step", folder / "plate.step"};
  REQUIRE(build_catalog(one, folder / "c.db", {}).at(0).status == BuildStatus::Ok);

  BuildOptions hasty;
  hasty.import.max_seconds = 1e-4;  // no STEP file is read that fast
  const BuiltFile first = build_catalog(both, folder / "c.db", hasty).at(1);
  CHECK(first.status == BuildStatus::Failed);
  CHECK_THAT(first.reason, Catch::StartsWith("time limit of 0.0001 s reached"));
  CHECK(first.seconds > 0.0);

  const BuiltFile again = build_catalog(both, folder / "c.db", hasty).at(1);
  CHECK(again.status == BuildStatus::Failed);
  CHECK(again.reason == first.reason);
  CHECK(again.seconds == 0.0);

  const std::vector<BuiltFile> patient = build_catalog(both, folder / "c.db", {});
  CHECK(patient.at(0).status == BuildStatus::Unchanged);
  CHECK(patient.at(1).status == BuildStatus::Ok);
}
