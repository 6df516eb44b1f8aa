// A fixture of two thousand instances. Its times are in BENCHMARKS.md, study `project`.

#include <catch2/catch.hpp>

#include "dowel/assembly/session.h"
#include "large_fixture.h"
#include "program.h"

namespace testing = dowel::testing;

TEST_CASE("a fixture of two thousand instances opens, and takes a part in every free hole") {
  const testing::TemporaryFolder folder;
  testing::write_large_fixture(folder / "large.dwp", 2000);
  dowel::Session session(dowel::Project::open(folder / "large.dwp"));
  REQUIRE(session.state().instances.size() == 2000);
  const auto report = session.place("T/pin-12", "LAST", testing::over_last_hole(60, 25.0), "place");
  CHECK_FALSE(report.refused);
  REQUIRE(report.touches.size() == 1);
  CHECK(report.touches.front().with == "PLATE60");
  const dowel::Pose taken =
      testing::large_fixture_plate(60) * dowel::Pose::from_translation({40, 40, 25});
  CHECK(session.place("T/pin-12", "NONE", taken, "place").refused);
}
