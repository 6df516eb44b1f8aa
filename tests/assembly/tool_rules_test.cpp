// Rules of wrenches, cutters and the way in of screws.

#include <cmath>
#include <numbers>

#include "dowel/assembly/fixture_analysis.h"
#include "hexagon_screw.h"
#include "random_geometry.h"
#include "rule_examples.h"

namespace dowel::testing {
namespace {

using Eigen::Vector3d;

/// A block on the plate's hole B2 at (-40, 0), and a hexagon screw through it: its head is from
/// z = 80 to 88.
FixtureBuilder screwed_down() {
  FixtureBuilder b;
  ProjectElement block = riser_element();
  block.element.role = "riser";
  b.add_element(block);
  b.add_element(hexagon_screw());
  b.place("T/riser-60x60x40", "BLOCK", {-40, 0, 40});
  b.place("T/hex-screw-M12x65", "SCREW", {-40, 0, 15});
  b.add_box("T/roof", {100, 100, 5}, "");
  b.add_box("T/wall", {5, 100, 60}, "");
  return b;
}

void wrench_examples(Seen& seen) {
  FixtureBuilder b = screwed_down();
  CHECK(state_of(b, "ACC-01", seen) == RuleState::Pass);
  CHECK(state_of(b, "COL-06", seen) == RuleState::Pass);
  // A roof 22 mm over the head leaves a spanner alone, and no way in for the screw.
  b.place("T/roof", "ROOF", {-40, 0, 110});
  b.fix("ROOF");
  const RuleResult roofed = result_of(b, "ACC-01", seen);
  CHECK(roofed.state() == RuleState::Pass);
  CHECK(roofed.findings.at(0).values.at(0).second == "spanner 18");
  CHECK(state_of(b, "COL-06", seen) == RuleState::Fail);
  // Walls on all sides, 27.5 mm from the axis: its head fits in between, its lever does not.
  for (const auto& [name, x_mm] : {std::pair("WALL1", -70.0), std::pair("WALL2", -10.0)}) {
    b.place("T/wall", name, {x_mm, 0, 50});
    b.fix(name);
  }
  const double lever_mm = 12.0 * 18.0;
  const RuleResult walled = result_of(b, "ACC-01", seen);
  // Along the walls, 100 mm long, it turns as far as their ends let it: not by 60 degrees.
  CHECK(lever_mm > 50.0);
  CHECK(walled.state() == RuleState::Fail);
  // What stands on what a screw holds comes later and is in no wrench's way.
  FixtureBuilder later = screwed_down();
  later.place("T/roof", "ROOF", {-40, 0, 110});
  CHECK(state_of(later, "COL-06", seen) == RuleState::Fail);
  Mate mate;
  mate.number = 9;
  mate.kind = MateKind::Fix;
  mate.moving = {"ROOF", ""};
  mate.fixed = {"BLOCK", ""};
  mate.X_FM = Pose::from_translation({0, 0, 70});
  later.state.mates[9] = mate;
  CHECK(state_of(later, "COL-06", seen) == RuleState::Pass);
}

/// A wall at a distance from the axis stops the lever where that reaches it: the free angle in
/// closed form.
void swing_example(Seen& seen) {
  FixtureBuilder b = screwed_down();
  b.place("T/roof", "ROOF", {-40, 0, 110});
  b.fix("ROOF");
  b.add_box("T/long-wall", {5, 900, 60}, "");
  // Its near side is 100 mm from the axis.
  b.place("T/long-wall", "WALL", {62.5, 0, 50});
  b.fix("WALL");
  const RuleResult result = result_of(b, "ACC-01", seen);
  CHECK(result.state() == RuleState::Pass);
  double swing_deg = 0.0;
  double lever_mm = 0.0;
  for (const auto& [name, value] : result.findings.at(0).values) {
    if (name == "swing_deg") swing_deg = std::stod(value);
    if (name == "lever_mm") lever_mm = std::stod(value);
  }
  REQUIRE(lever_mm == Approx(216.0));
  // Its middle line is free until its end is half its thickness (7.56 mm) before the wall.
  const double blocked_rad = 2.0 * std::acos((100.0 - 0.5 * 7.56) / lever_mm);
  const double free_deg = 360.0 - blocked_rad * 180.0 / std::numbers::pi;
  const double step_deg = 360.0 / 180.0 + 1.0;  // of the angles that are tried, at most
  CHECK(swing_deg <= free_deg + step_deg);
  CHECK(swing_deg >= free_deg - 3.0 * step_deg);
}

void cutter_examples(Seen& seen) {
  FixtureBuilder b = sound_fixture();
  CHECK(state_of(b, "ACC-04", seen) == RuleState::NotEvaluated);
  // At (30, 30); the clamp ends at x = 8, y = -2: 38.8 mm away.
  state(b, "BORE", "cutter_mm", 60.0);
  state(b, "BORE", "cutter_length_mm", 100.0);
  CHECK(state_of(b, "ACC-04", seen) == RuleState::Pass);
  state(b, "BORE", "cutter_mm", 68.0);
  CHECK(state_of(b, "ACC-04", seen) == RuleState::Fail);
  state(b, "BORE", "cutter_mm", 67.0);
  CHECK(state_of(b, "ACC-04", seen) == RuleState::Pass);
}

}  // namespace

void tool_examples(Seen& seen) {
  wrench_examples(seen);
  swing_example(seen);
  cutter_examples(seen);
}

}  // namespace dowel::testing

TEST_CASE("after edits wrenches are told as a first check tells them", "[rule][property]") {
  namespace testing = dowel::testing;
  testing::FixtureBuilder b = testing::screwed_down();
  b.place("T/riser-60x60x40", "BLOCK2", {40, 0, 40});
  b.place("T/hex-screw-M12x65", "SCREW2", {40, 0, 15});
  b.place("T/wall", "WALL", {0, 0, 50});
  b.place("T/roof", "ROOF", {0, 0, 110});
  const auto session = b.session();
  session->set_mode(dowel::CheckMode::Off, "off");
  dowel::RuleSet rules = dowel::shipped_rules();
  std::erase_if(rules.rules, [](const dowel::Rule& rule) {
    return rule.id != "ACC-01" && rule.id != "COL-06" && rule.id != "FST-01";
  });
  const auto told = [](const dowel::RuleReport& report) {
    std::string text;
    for (const auto& result : report.results) {
      for (const auto& finding : result.findings) {
        text += finding.subject + " " + std::string(to_string(finding.state));
        for (const auto& [name, value] : finding.values) text += " " + name + "=" + value;
        text += "\n";
      }
    }
    return text;
  };
  dowel::RuleChecker checker(*session, rules);
  testing::RandomGeometry random(3);
  std::set<std::string> seen;
  const std::vector<std::string> names{"WALL", "ROOF", "BLOCK2", "SCREW2"};
  for (std::size_t edit = 0; edit < 24; ++edit) {
    CAPTURE(edit);
    const std::string& name = names[edit % names.size()];
    const Eigen::Vector3d way = random.point(edit % 8 < 4 ? 40.0 : 400.0);
    session->move(name, session->instance(name).X_WI.translation() + way, "move");
    if (edit % 3 == 2) session->undo(1);
    const std::string text = told(checker.check());
    CHECK(text == told(dowel::RuleChecker(*session, rules).check()));
    seen.insert(text);
  }
  CHECK(seen.size() >= 4);
}

TEST_CASE("wrenches and cutters reach what they work on, or the part in the way is named",
          "[rule]") {
  dowel::testing::Seen seen;
  dowel::testing::tool_examples(seen);
}
