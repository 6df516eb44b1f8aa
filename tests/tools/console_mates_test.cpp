// Mates, patterns, fits, stacks and fastenings at the prompt.

#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "../assembly/fixture_elements.h"
#include "program.h"

using Json = nlohmann::json;
namespace testing = dowel::testing;

namespace {

struct Desk {
  testing::TemporaryFolder folder;

  Desk() {
    testing::write_fixture_catalog(folder / "catalog.db");
    dowel::Catalog catalog(folder / "catalog.db", dowel::Catalog::Access::ReadWrite);
    const auto screw = testing::element_of(
        "T/screw-M12x70", testing::stepped_pin({{6.0, 70.0}, {9.0, 12.0}}, 24),
        {testing::shaft_feature("pin1", {0, 0, 70}, -Eigen::Vector3d::UnitZ(), 12.0, 70.0)});
    dowel::SourceRecord source;
    source.path = "screw.step";
    source.status = "ok";
    const std::vector<dowel::ElementRecord> records{{screw.element, *screw.solid, {}}};
    catalog.put(source, records);
  }

  testing::ProgramResult script(const std::string& text, std::vector<std::string> more = {}) const {
    testing::write_text(folder / "job.dowel", text);
    std::vector<std::string> arguments{"run", "job.dowel", "--catalog", "catalog.db"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    testing::ProgramOptions options;
    options.folder = folder.path();
    return testing::run_dowel(arguments, options);
  }
};

constexpr const char* kStart = R"(place T/plate-5x3 as PLATE
ground PLATE
place T/riser-60x60x40 as R at 7 8 300 rot 30
)";

bool has(const testing::ProgramResult& result, const std::string& text) {
  return result.out.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("mates tell what is left to move, and the journal makes them anew") {
  const Desk desk;
  const auto result = desk.script(std::string(kStart) + R"(mate insert R.h1 PLATE.B3
freedoms R
mate angle R.right PLATE.bottom 90
place T/block-40 as BLOCK at 200 0 400
mate fix BLOCK R
mate seat BLOCK.top PLATE.top
expect refused mate seat R.bottom PLATE.top offset 5
unmate BLOCK R
list mates
export again.dowel
)",
                                  {"--project", "a.dwp", "--keep-going"});
  INFO(result.out << result.err);
  CHECK(has(result, "R: mated at 0 0 40, contact with PLATE\nR: turns about z at 0 0 40\n"));
  CHECK(has(result, "mate 1: R.h1 into PLATE.B3 (hole on hole), takes 5 of 6"));
  CHECK(has(result, "redundant: earlier mates hold all of this"));
  CHECK(has(result, "BLOCK: mated at 200 0 400, clear\n"));
  // A block fixed to the riser with its top up cannot lie on the plate with it.
  CHECK(has(result, "BLOCK: refused, mate BLOCK.top into PLATE.top (face on face) cannot hold"));
  CHECK(has(result, "it misses by 5 mm; against mate 1: R.h1 into PLATE.B3 (hole on hole)"));
  CHECK(has(result, "mate 3: taken out: BLOCK to R (fix)"));
  CHECK(result.err.empty());
  const auto again =
      desk.script(testing::read_text(desk.folder / "again.dowel") + "list mates\n", {"--json"});
  CHECK(again.exit_code == 0);
  std::istringstream lines(again.out);
  std::string line;
  std::string last;
  while (std::getline(lines, line)) last = line;
  CHECK(Json::parse(last)["mates"].size() == 2);
}

TEST_CASE("mates with --json carry freedoms and conflicts") {
  const Desk desk;
  const auto result = desk.script(std::string(kStart) +
                                      "mate insert R.h1 PLATE.B3\n"
                                      "mate align R.h1 PLATE.B4\n",
                                  {"--json", "--keep-going"});
  std::istringstream lines(result.out);
  std::string line;
  std::vector<Json> replies;
  while (std::getline(lines, line)) replies.push_back(Json::parse(line));
  REQUIRE(replies.size() == 5);
  REQUIRE(replies[3]["freedoms"].size() == 1);
  CHECK(replies[3]["freedoms"][0]["kind"] == "turn");
  CHECK(replies[4]["outcome"] == "refused");
  CHECK(replies[4]["conflict"]["against"] == Json::array({1}));
  CHECK(replies[4]["conflict"]["off_mm"].get<double>() == Approx(40.0));
}

TEST_CASE("what mates cannot mean is told with its column") {
  const Desk desk;
  const auto error = [&](const std::string& line) {
    const auto result = desk.script(std::string(kStart) + line + "\n");
    CHECK(result.exit_code == 3);
    return result.err;
  };
  CHECK(error("mate glue R.h1 PLATE.B3").find("4:6: error: expected insert, align") !=
        std::string::npos);
  CHECK(error("mate align R.h1").find("expected a feature of the instance that stays") !=
        std::string::npos);
  CHECK(error("mate angle R.top PLATE.top 200").find("0 to 180 degrees") != std::string::npos);
  CHECK(error("mate insert PLATE.B3 R.h1").find("grounded") != std::string::npos);
  CHECK(error("unmate 7").find("there is no mate 7") != std::string::npos);
  CHECK(error("unmate R PLATE").find("no mate is between R and PLATE") != std::string::npos);
  CHECK(error("fit 12 H7").find("such as H7/g6") != std::string::npos);
  CHECK(error("fit 100 H7/g6").find("at most 80 mm") != std::string::npos);
  CHECK(error("stack 30 at PLATE.B2").find("there are none") != std::string::npos);
  CHECK(error("place T/riser-60x60x40 at PLATE.A1 pattern 2").find("there are 1 way") !=
        std::string::npos);
}

TEST_CASE("fits, patterns and fastenings explain themselves") {
  const Desk desk;
  const auto result = desk.script(std::string(kStart) + R"(fit 12 H7/g6
pattern T/riser-60x60x40 at PLATE.B2
place T/riser-60x60x40 as S at PLATE.B2 pattern 1
undo
place T/pin-12 as PIN at 200 0 300
expect error mate insert PIN.pin1 PLATE.A1
mate insert PIN.pin1 PLATE.A1 offset 15
freedoms PIN
remove PIN
mate insert R.h1 PLATE.B3
fasten R.h1 dry-run
fasten R.h1
freedoms SCREW1
undo
list
expect error fasten PLATE.B3
)");
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);
  CHECK(has(result, "12 H7/g6: clearance fit, clearance 6 to 35 um\n"));
  CHECK(has(result, "h1 on B2"));
  CHECK(has(result, "mated: S.h1 into PLATE.B2 (hole on hole)"));
  CHECK(has(result,
            "shaft PIN.pin1 of diameter 11.98 mm does not go into hole PLATE.A1, which is "
            "10.106 mm wide from 15 to 40 mm of depth"));
  CHECK(has(result, "shaft 11.98 mm in hole 12 mm: play 0.02 mm as drawn"));
  // 40 and 15 to the thread and 12 in it: the 65 is too short, the 70 does.
  CHECK(has(result,
            "would take T/screw-M12x70: grip 55 mm, 15 mm (1.25 d) in the thread of PLATE.B3, "
            "10 mm before its end; the shortest that holds"));
  CHECK(has(result, "SCREW1: placed at 0 0 10, contact with PLATE, R"));
  CHECK(has(result, "nothing fastens PLATE.B3: in its counterbore "));
  CHECK(has(result,
            "on its face a screw M12 has to be 27 mm of thread to 38.25 mm long, and there "
            "are 65, 70"));
}
