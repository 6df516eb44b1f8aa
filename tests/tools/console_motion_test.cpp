// Dragging, snapping, units, sequences and differences at the prompt.

#include <sstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "../assembly/fixture_elements.h"
#include "program.h"

using Json = nlohmann::json;
namespace testing = dowel::testing;

namespace {

struct Desk {
  testing::TemporaryFolder folder;

  Desk() { testing::write_fixture_catalog(folder / "catalog.db"); }

  testing::ProgramResult run(std::vector<std::string> arguments) const {
    testing::ProgramOptions options;
    options.folder = folder.path();
    return testing::run_dowel(arguments, options);
  }

  testing::ProgramResult script(const std::string& text, std::vector<std::string> more = {}) const {
    testing::write_text(folder / "job.dowel", text);
    std::vector<std::string> arguments{"run", "job.dowel", "--catalog", "catalog.db"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return run(arguments);
  }
};

constexpr const char* kStart = R"(place T/plate-5x3 as PLATE
ground PLATE
place T/riser-60x60x40 as R at -60 0 40
mate seat R.bottom PLATE.top
place T/block-40 as B at 90 0 60
)";

bool has(const testing::ProgramResult& result, const std::string& text) {
  return result.out.find(text) != std::string::npos;
}

}  // namespace

TEST_CASE("a drag says what its mates left of it and what stopped it") {
  const Desk desk;
  const auto result = desk.script(std::string(kStart) + R"(drag R by 30 0 10
drag R along x 500
expect refused drag R along x 1
drag R by 20 15 0 slide
drag R turn 10
expect error drag R along z 5
expect error drag R turn 10 about x
expect error drag PLATE by 1 0 0
undo 2
)",
                                  {"--keep-going"});
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);
  CHECK(has(result,
            "R: dragged to -30 0 40, contact with PLATE\n"
            "R: its mates leave 30 of 31.6228 mm, by 30 0 0\n"));
  CHECK(has(result, "R: dragged to 40 0 40, contact with PLATE, B; stopped by B after 14 % of"));
  CHECK(has(result, "R: dragged to 40 15 40, contact with PLATE, B; slid along B\n"));
  CHECK(has(result, "R cannot slide like that: its mates leave it 2 slides and 1 turn"));
  CHECK(has(result, "PLATE is grounded and does not move; use `ground PLATE off` first"));
}

TEST_CASE("a part is snapped, placed where it can go, and brought in on a free way") {
  const Desk desk;
  const auto result = desk.script(std::string(kStart) + R"(mode off
place T/pin-12 as PIN at 2 1 27
mode block
snap PIN
snap PIN take 1
way PIN
where T/pin-12
sequence
)");
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);
  CHECK(has(result,
            "PIN: snapped to 0 0 25, contact with PLATE\n"
            "mated: PIN.pin1 into PLATE.B3 offset 15 (shaft in hole)\n"));
  CHECK(has(result, "PIN: can be brought in and taken out\n  along PLATE.B3 (0 0 1): free"));
  // The riser covers two of the fifteen holes, the block one, and one has the pin. It also goes
  // through the riser's own.
  CHECK(has(result, "12 places\n"));
  CHECK(has(result, "base: PLATE\n1. R: by 0 0 "));
  CHECK(has(result, "3. PIN: by 0 0 "));
}

TEST_CASE("a part without a straight way in is placed, and told by what it is blocked") {
  const Desk desk;
  const std::string start = std::string(kStart) + "place T/block-40 as LID at 0 40 100\n";
  const auto result = desk.script(start + R"(place T/pin-12 as PIN at 0 40 200
mate insert PIN.pin1 PLATE.C3 offset 15
place T/riser-60x60x40 as R2 at PLATE.B3
place T/pin-12 as FREE at 40 40 200
insert FREE.pin1 into PLATE.C4 offset 15
)");
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);  // a warning
  CHECK(has(result, "PIN: mated at 0 40 25, contact with PLATE"));
  CHECK(has(result,
            "PIN: no straight way in along its mates\n  along PLATE.C3 (0 0 1): blocked by "
            "LID after 2"));  // its top is at 55, the lid from 80
  CHECK(has(result, "  along PLATE.C3 (0 0 -1): blocked by PLATE after 0 of "));
  CHECK(has(result, "R2: no straight way in along its mates\n"));
  CHECK(has(result, "FREE: inserted at 40 40 25, contact with PLATE"));
  CHECK_FALSE(has(result, "FREE: no"));

  const auto json = desk.script(start + R"(place T/pin-12 as PIN at 0 40 200
insert PIN.pin1 into PLATE.C3 offset 15
place T/pin-12 as FREE at 40 40 200
insert FREE.pin1 into PLATE.C4 offset 15
)",
                                {"--json"});
  std::vector<Json> replies;
  std::istringstream lines(json.out);
  for (std::string line; std::getline(lines, line);) replies.push_back(Json::parse(line));
  REQUIRE(replies.size() >= 4);
  const Json& blocked = replies[replies.size() - 3];
  CHECK(blocked["way_in"]["free"] == false);
  CHECK(blocked["way_in"]["ways"][0]["blocked_by"] == Json::array({"LID"}));
  CHECK(blocked["way_in"]["ways"][0]["free_mm"].get<double>() == Approx(25.0).margin(0.2));
  CHECK(replies.back()["way_in"]["free"] == true);
  // Without a mate there is no way in to speak of.
  CHECK_FALSE(replies[replies.size() - 2].contains("way_in"));
}

TEST_CASE("a unit goes from project to project, and what differs is told") {
  const Desk desk;
  const auto made = desk.script(std::string(kStart) + R"(unit R B
drag R by 0 5 0
save-unit R unit.dwp
save first.dwp
insert-unit unit.dwp as U at 0 0 300
move U-B by 0 0 10
save second.dwp
)",
                                {"--project", "a.dwp"});
  INFO(made.out << made.err);
  REQUIRE(made.exit_code == 0);
  CHECK(has(made, "moves as one: B, R\n"));
  CHECK(has(made, "R: dragged to -60 5 40, contact with PLATE\nB: goes along\n"));
  CHECK(has(made, "U-R: placed at 0 0 300, clear\nU-B: placed at 150 0 320, clear\n"));

  const auto none = desk.run({"diff", "first.dwp", "first.dwp"});
  CHECK(none.exit_code == 0);
  CHECK(none.out == "no difference\n");
  const auto result = desk.run({"diff", "first.dwp", "second.dwp", "--json"});
  INFO(result.out << result.err);
  CHECK(result.exit_code == 1);
  const Json json = Json::parse(result.out);
  REQUIRE(json["added"].size() == 2);
  CHECK(json["added"][0]["name"] == "U-B");
  CHECK(json["added"][1]["pose"]["t"] == Json::array({0.0, 0.0, 310.0}));
  CHECK(json["mates_added"].size() == 1);
  CHECK(json["removed"].empty());
  CHECK(desk.run({"diff", "first.dwp", "nowhere.dwp"}).exit_code == 3);
  // The project at hand is compared as it is, though its file is locked, and is no unit of its own.
  const auto own = desk.run({"diff", "second.dwp", "--project", "second.dwp"});
  CHECK(own.out == "no difference\n");
  const auto itself = desk.run({"insert-unit", "second.dwp", "--project", "second.dwp"});
  CHECK(itself.exit_code == 3);
  CHECK(itself.err.find("is the project at hand") != std::string::npos);
}

TEST_CASE("parts that stand mated are recognised at the prompt, once") {
  const Desk desk;
  const auto result = desk.script(R"(place T/plate-5x3 as PLATE
ground PLATE
place T/riser-60x60x40 as R at 40 0 40
recognise dry-run
recognise
recognise
freedoms R
)");
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);
  CHECK(has(result,
            "2 pairs of features that are mated as they stand\n"
            "  R.h1 with PLATE.B4 (align)\n  R.bottom into PLATE.top (face on face)\n"));
  CHECK(has(result, "0 pairs of features"));
  CHECK(has(result, "R: turns about z at 40 0 "));
}

TEST_CASE("a sequence says which parts interfere as they stand, for they have no way") {
  const Desk desk;
  const auto result = desk.script(R"(mode off
place T/block-40 as A at 0 0 60
place T/block-40 as C at 200 0 60
place T/block-40 as B at 30 0 60
sequence
)");
  INFO(result.out << result.err);
  CHECK(has(result, "base: A, placed first; nothing is grounded\n1. C: by "));
  CHECK(has(result, "cannot be brought in: B\n  along A (0 0 1): blocked by A after 0 of 41 mm"));
  CHECK(has(result,
            "these interfere as they stand, and no way is free for parts that do; `check` tells "
            "where:\n  A with B\n"));
}

TEST_CASE("the words about motion say what is wrong and where") {
  const Desk desk;
  struct BadLine {
    const char* line;
    const char* message;
  };
  for (const auto& [line, message] : {
           BadLine{"drag Q by 1 0 0", "no instance is called \"Q\""},
           BadLine{"drag R sideways", "expected `by`, `to`, `along` or `turn`"},
           BadLine{"drag R turn 0", "a turn is not of 0 degrees"},
           BadLine{"drag R by 0 0 0", "R is there already"},
           BadLine{"unit R B R", "R is named twice"},
           BadLine{"drag R by 1 0 0 bounce", "bounce"},
           BadLine{"snap R within -1", "a distance is more than 0"},
           BadLine{"snap B take 99", "`snap B` lists them"},
           BadLine{"where T/riser-60x60x4", "did you mean T/riser-60x60x40?"},
           BadLine{"unit", "expected an instance"},
           BadLine{"insert-unit nothing.dwp", "no such file"},
           BadLine{"insert-unit catalog.db", "is not a dowel project"},
           BadLine{"save-unit R job.dowel", "exists already"},
           BadLine{"diff", "expected a project file"},
       }) {
    CAPTURE(line);
    const auto result = desk.script(std::string(kStart) + line + "\n");
    INFO(result.out << result.err);
    CHECK(result.exit_code == 3);
    CHECK(result.err.find(message) != std::string::npos);
  }
}

TEST_CASE("a fit is told by the classes that the catalogue states, also from a project's copy") {
  const testing::TemporaryFolder folder;
  {
    dowel::Catalog catalog(folder / "catalog.db", dowel::Catalog::Access::ReadWrite);
    dowel::ProjectElement plate = testing::plate_element();
    for (dowel::Feature& feature : plate.element.features) {
      if (feature.kind == dowel::FeatureKind::Hole) feature.fit = "F7";
    }
    dowel::ProjectElement pin = testing::pin_element();
    pin.element.features.front().fit = "n6";
    for (const dowel::ProjectElement& element : {plate, pin}) {
      dowel::SourceRecord source;
      source.path = element.element.source;
      source.status = "ok";
      const std::vector<dowel::ElementRecord> records{{element.element, *element.solid, {}}};
      catalog.put(source, records);
    }
  }
  testing::ProgramOptions options;
  options.folder = folder.path();
  testing::write_text(folder / "job.dowel",
                      "place T/plate-5x3 as PLATE\nplace T/pin-12 as PIN at 0 0 300\n");
  REQUIRE(testing::run_dowel({"run", "job.dowel", "--catalog", "catalog.db", "--project", "a.dwp"},
                             options)
              .exit_code == 0);
  // Over 10 to 18 mm F7 is 16 to 34 um (ISO 286-2) and n6 is 12 to 23 um.
  const auto result =
      testing::run_dowel({"fit", "PIN.pin1", "PLATE.B3", "--project", "a.dwp"}, options);
  INFO(result.out << result.err);
  CHECK(result.out.find("12 F7/n6: transition fit, clearance -7 to 22 um (as stated)") !=
        std::string::npos);
}
