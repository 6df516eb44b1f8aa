// Every shipped rule has an example that it passes and one that it fails.

#include <algorithm>
#include <functional>
#include <map>
#include <set>

#include <catch2/catch.hpp>

#include "dowel/assembly/rules.h"
#include "fixture_projects.h"
#include "rule_examples.h"

namespace {

using dowel::Feature;
using dowel::ProjectElement;
using dowel::RuleReport;
using dowel::RuleResult;
using dowel::RuleState;
using dowel::testing::FixtureBuilder;
using Eigen::Vector3d;
namespace testing = dowel::testing;

const Vector3d kDown = -Vector3d::UnitZ();

struct Example {
  std::string what;
  std::set<std::string> fails;  ///< beside those that all block fixtures fail
  std::function<void(FixtureBuilder&)> spoil;
};

void move(FixtureBuilder& builder, const std::string& name, const Vector3d& to) {
  builder.state.instances.at(name).X_WI = dowel::Pose(Eigen::Quaterniond::Identity(), to);
  for (auto& [number, mate] : builder.state.mates) {
    if (mate.moving.instance == name) mate.X_FM = builder.state.instances.at(name).X_WI;
  }
}

void unfix(FixtureBuilder& builder, const std::string& name) {
  std::erase_if(builder.state.mates,
                [&](const auto& entry) { return entry.second.moving.instance == name; });
}

dowel::Element& element(FixtureBuilder& builder, const std::string& name) {
  return std::ranges::find_if(
             builder.elements,
             [&](const ProjectElement& candidate) { return candidate.element.name == name; })
      ->element;
}

/// Shipped rules that fail on it; those that are broken, too.
std::set<std::string> failing(const RuleReport& report) {
  std::set<std::string> ids;
  for (const RuleResult& result : report.results) {
    if (result.broken || result.count(RuleState::Fail) > 0) ids.insert(result.rule.id);
  }
  return ids;
}

using dowel::testing::Seen;

/// Tries the fixture, spoilt by the example, and notes what became of each rule.
void try_example(FixtureBuilder builder, const Example& example, std::set<std::string> expected,
                 Seen& seen) {
  CAPTURE(example.what);
  example.spoil(builder);
  const dowel::RuleSet rules = dowel::shipped_rules();
  const auto session = builder.session();
  const RuleReport report = dowel::RuleChecker(*session, rules).check();
  for (const RuleResult& result : report.results) {
    auto& [passes, fails] = seen[result.rule.id];
    passes = passes || result.count(RuleState::Pass) > 0;
    fails = fails || result.count(RuleState::Fail) > 0;
    if (result.broken) UNSCOPED_INFO(result.rule.id << ": " << result.broken->message);
    for (const auto& finding : result.findings) {
      if (finding.state == RuleState::Fail)
        UNSCOPED_INFO(result.rule.id << ": " << finding.message);
    }
  }
  expected.insert(example.fails.begin(), example.fails.end());
  CHECK(failing(report) == expected);
}

/// A block that stands on the plate's hole B2 by screw and pin: nothing of it is wrong.
FixtureBuilder screwed() {
  FixtureBuilder builder;
  ProjectElement block = testing::riser_element();
  block.element.role = "riser";
  builder.add_element(block);
  ProjectElement screw = testing::screw_element();
  screw.element.role = "fastener";
  screw.element.features[0].thread = "M12";
  builder.add_element(screw);
  for (ProjectElement& candidate : builder.elements) {
    for (Feature& feature : candidate.element.features) {
      if (feature.name == "B2" && candidate.element.name == "T/plate-5x3") feature.thread = "M12";
    }
  }
  builder.place("T/riser-60x60x40", "BLOCK", {-40, 0, 40});
  // Its head on the block: the tip is 65 below, 25 deep in the plate, 10 of them in the thread.
  builder.place("T/screw-M12x65", "SCREW", {-40, 0, 15});
  builder.state.design.limits["engagement_in_diameters"] = 0.8;
  return builder;
}

void block_examples(Seen& seen) {
  // A clamp straight down holds by friction: CLP-05 says so of all of these.
  const auto try_block = [&](const Example& example) {
    try_example(testing::sound_fixture(), example, {"CLP-05"}, seen);
  };
  try_block({"sound", {}, [](FixtureBuilder&) {}});
  try_block({"two stops only", {"LOC-01", "LOC-02"}, [](FixtureBuilder& b) { b.remove("STOP3"); }});
  try_block({"a fourth rest", {"LOC-03"}, [](FixtureBuilder& b) {
               b.place("T/rest-16x16x20", "REST4", {30, 30, 40});
               b.fix("REST4");
             }});
  try_block({"rests close together", {"LOC-04", "LOC-05", "LOC-06"}, [](FixtureBuilder& b) {
               move(b, "REST1", {-10, -12, 40});
               move(b, "REST2", {10, -12, 40});
               move(b, "REST3", {0, 12, 40});
               b.state.design.limits["condition"] = 5.0;
               b.state.design.points["BORE"].tolerance_mm = 0.05;
             }});
  try_block({"rests at one side",
             {"LOC-05", "LOC-07", "CLP-01", "CLP-02", "CLP-04"},
             [](FixtureBuilder& b) {
               move(b, "REST1", {-50, -28, 40});
               move(b, "REST2", {-50, 28, 40});
               move(b, "REST3", {-25, 0, 40});
             }});
  try_block({"clamp beside the supports", {"CLP-01", "CLP-02", "CLP-04"}, [](FixtureBuilder& b) {
               move(b, "CLAMP", {-50, 30, 90});
             }});
  try_block({"weak clamp", {"CLP-04"}, [](FixtureBuilder& b) {
               b.state.design.clamp_forces_N["CLAMP"] = 500.0;
             }});
  try_block({"strong clamp", {"CLP-09"}, [](FixtureBuilder& b) {
               b.state.design.clamp_forces_N["CLAMP"] = 1e5;
             }});
  try_block({"clamp where the tool works", {"CLP-10"}, [](FixtureBuilder& b) {
               b.state.design.points["BORE"].at = {10, -10, 90};
             }});
  try_block({"cutting force against the clamp", {"CLP-11"}, [](FixtureBuilder& b) {
               b.state.design.loads["CUT"].force_N = {0, 0, 300};
             }});
  try_block({"clamp away from the stop", {"CLP-03"}, [](FixtureBuilder& b) {
               b.place("T/clamp-16x16x20", "PUSH", {-68, 25, 62});
               b.fix("PUSH");
             }});
  try_block({"nothing holds the clamp", {"FST-01"}, [](FixtureBuilder& b) { unfix(b, "CLAMP"); }});
  try_block({"a hole off the middle that no locator minds", {"ACC-03"}, [](FixtureBuilder& b) {
               dowel::testing::DrilledHole hole;
               hole.radius_mm = 5.0;
               hole.x = 30.0;
               hole.y = 20.0;
               ProjectElement work = testing::element_of(
                   "W/drilled", testing::plate_with_holes({120, 80, 30}, {hole}, 24),
                   {testing::hole_feature("h1", {30, 20, 30}, kDown, {{10.0, 30.0}}, true)});
               work.element.role = "workpiece";
               b.add_element(work);
               b.state.instances.at("WORK").element = "W/drilled";
             }});
  try_block({"a roof over it", {"ACC-02"}, [](FixtureBuilder& b) {
               b.add_box("T/roof-140x100x5", {140, 100, 5}, "");
               b.add_box("T/wall-5x100x50", {5, 100, 50}, "");
               b.add_box("T/wall-100x5x50", {100, 5, 50}, "");
               b.place("T/roof-140x100x5", "ROOF", {0, 0, 115});
               b.place("T/wall-5x100x50", "WALL1", {66, 0, 40});
               b.place("T/wall-100x5x50", "WALL2", {0, 46, 40});
               for (const char* name : {"ROOF", "WALL1", "WALL2"}) b.fix(name);
               b.state.design.limits["lift_mm"] = 40.0;
             }});
}

void collision_examples(Seen& seen) {
  // A clamp straight down holds by friction: CLP-05 says so of all of these.
  const auto try_block = [&](const Example& example) {
    try_example(testing::sound_fixture(), example, {"CLP-05"}, seen);
  };
  try_block({"a stop in the workpiece", {"COL-01", "ACC-02"}, [](FixtureBuilder& b) {
               move(b, "STOP3", {-67.5, 0, 40});
             }});
  try_block({"a stop in the plate", {"COL-02", "STK-05"}, [](FixtureBuilder& b) {
               move(b, "STOP3", {-68, 0, 39.5});
             }});
  try_block({"a stop next to the workpiece", {"COL-03"}, [](FixtureBuilder& b) {
               b.place("T/stop-16x16x40", "NEAR", {69, 0, 40});
               b.fix("NEAR");
             }});
  try_block({"a mate that is off", {"COL-04"}, [](FixtureBuilder& b) {
               b.state.mates.begin()->second.X_FM =
                   dowel::Pose(Eigen::Quaterniond::Identity(), {-50, -30.05, 40});
             }});
  try_block({"one part twice", {"COL-01", "COL-05", "LOC-03"}, [](FixtureBuilder& b) {
               b.place("T/stop-16x16x40", "AGAIN", {-68, 0, 40});
               b.fix("AGAIN");
             }});
  try_block({"a lower support", {"STK-01"}, [](FixtureBuilder& b) {
               b.add_box("T/rest-16x16x15", {16, 16, 15}, "support");
               b.place("T/rest-16x16x15", "LOW", {25, 0, 40});
               b.fix("LOW");
             }});
  try_block({"a foot over a pit", {"STK-05", "SYS-02"}, [](FixtureBuilder& b) {
               b.place("T/stop-16x16x40", "EDGE", {120, 20, 40});
               b.fix("EDGE");
             }});
  try_block({"too high", {"SYS-03"}, [](FixtureBuilder& b) {
               b.state.design.limits["height_mm"] = 100.0;
             }});
  try_block({"too heavy to lift", {"SYS-06"}, [](FixtureBuilder& b) {
               b.state.design.limits["lifting_mass_kg"] = 5.0;
             }});
  try_block({"another family", {"CMP-01"}, [](FixtureBuilder& b) {
               b.add_box("U/stop-16x16x40", {16, 16, 40}, "riser");
               b.place("U/stop-16x16x40", "OTHER", {90, 0, 40});
               b.fix("OTHER");
             }});
  try_block({"faces known by their facets alone", {"COL-07", "STK-05"}, [](FixtureBuilder& b) {
               ProjectElement rough = testing::box_element("T/rough-16", {16, 16, 16}, "riser");
               dowel::FacetedSolid solid = *rough.solid;
               for (dowel::Face& face : solid.faces) {
                 face.surface = dowel::OtherSurface{};
                 face.facet_error_mm = 0.3;
               }
               rough.element.facet_error_mm = 0.3;
               rough.element.sha256 = std::string(64, '0');
               rough.solid = std::make_shared<const dowel::FacetedSolid>(solid);
               b.elements.push_back(rough);
               b.place("T/rough-16", "ROUGH", {90, 20, 40});
               b.fix("ROUGH");
             }});
}

void data_examples(Seen& seen) {
  // A clamp straight down holds by friction: CLP-05 says so of all of these.
  const auto try_block = [&](const Example& example) {
    try_example(testing::sound_fixture(), example, {"CLP-05"}, seen);
  };
  const std::string rest = "T/rest-16x16x20";
  try_block({"triangles that are not there", {"CAT-01"}, [&](FixtureBuilder& b) {
               element(b, rest).triangles.total += 1;
             }});
  try_block({"holes that are not declared", {"CAT-04"}, [&](FixtureBuilder& b) {
               dowel::TriangleCounts& counts = element(b, "T/plate-5x3").triangles;
               counts.hole = counts.other;
               counts.other = 0;
             }});
  try_block(
      {"no unit", {"CAT-05"}, [&](FixtureBuilder& b) { element(b, rest).unit_in_file.clear(); }});
  try_block(
      {"no licence", {"CAT-06"}, [&](FixtureBuilder& b) { element(b, rest).licence.clear(); }});
}

/// Collision refuses the rest once it is spoilt, so that rules that ask it are broken: rule `id`,
/// which tells why, is looked at alone.
void refused_example(Seen& seen, const std::string& id,
                     const std::function<void(ProjectElement&)>& spoil) {
  CAPTURE(id);
  FixtureBuilder builder = testing::sound_fixture();
  spoil(*std::ranges::find_if(builder.elements, [](const ProjectElement& candidate) {
    return candidate.element.name == "T/rest-16x16x20";
  }));
  const dowel::RuleSet rules = dowel::shipped_rules();
  const auto session = builder.session();
  const RuleReport report = dowel::RuleChecker(*session, rules).check();
  const auto told = std::ranges::find_if(
      report.results, [&](const RuleResult& result) { return result.rule.id == id; });
  REQUIRE(told != report.results.end());
  CHECK(told->count(RuleState::Fail) == 1);
  CHECK_FALSE(report.broken.empty());
  seen[id].second = told->count(RuleState::Fail) > 0;
}

void refused_examples(Seen& seen) {
  refused_example(seen, "CAT-02",
                  [](ProjectElement& rest) { rest.element.obb.half_extents_mm.x() -= 0.5; });
  refused_example(seen, "CAT-03", [](ProjectElement& rest) {
    dowel::FacetedSolid solid = *rest.solid;
    std::swap(solid.triangles[0][0], solid.triangles[0][1]);
    rest.solid = std::make_shared<const dowel::FacetedSolid>(solid);
  });
}

/// A pin of 11.99 mm at `at`, held, in the plate's hole; classes are stated where they are not
/// empty.
void add_pin(FixtureBuilder& b, const std::string& name, const std::string& fit, const Vector3d& at,
             const std::string& hole, const std::string& hole_fit) {
  ProjectElement pin =
      testing::element_of(name, testing::cylinder(5.995, 30.0, 24),
                          {testing::shaft_feature("pin1", {0, 0, 30}, kDown, 11.99, 30.0)});
  pin.element.features[0].fit = fit;
  b.add_element(pin);
  for (Feature& feature : element(b, "T/plate-5x3").features) {
    if (feature.name == hole) feature.fit = hole_fit;
  }
  b.place(name, name.substr(2), at);
  b.fix(name.substr(2));
}

void mate_pin(FixtureBuilder& b, const std::string& name, const std::string& hole,
              double offset_mm) {
  dowel::Mate mate;
  mate.number = static_cast<std::uint32_t>(b.state.mates.size() + 1);
  mate.kind = dowel::MateKind::ShaftInHole;
  mate.moving = {name.substr(2), "pin1"};
  mate.fixed = {"PLATE", hole};
  mate.offset_mm = offset_mm;
  b.state.mates[mate.number] = mate;
}

void make_blind(FixtureBuilder& b) {
  for (Feature& feature : element(b, "T/plate-5x3").features) {
    if (feature.name != "B2") continue;
    feature.through = false;
    feature.blind_end = "flat";
  }
}

/// Without the block, so that the screw's shank is free.
void add_nut(FixtureBuilder& b, double z_mm) {
  b.remove("BLOCK");
  dowel::testing::DrilledHole hole;
  hole.radius_mm = 5.053;
  ProjectElement nut =
      testing::element_of("T/nut-M12", testing::plate_with_holes({18, 18, 10}, {hole}, 24),
                          {testing::hole_feature("h1", {0, 0, 10}, kDown, {{10.106, 10.0}}, true)});
  nut.element.role = "fastener";
  nut.element.features[0].thread = "M12";
  b.add_element(nut);
  b.place("T/nut-M12", "NUT", {-40, 0, z_mm});
}

/// The screw's head in a counterbore 13 mm deep.
void sink_head(FixtureBuilder& b, double radius_mm) {
  b.remove("BLOCK");
  dowel::testing::DrilledHole hole;
  hole.radius_mm = 6.5;
  hole.counterbore_radius_mm = radius_mm;
  hole.counterbore_depth_mm = 13.0;
  b.add_element(
      testing::element_of("T/sunk-60x60x40", testing::plate_with_holes({60, 60, 40}, {hole}, 24),
                          {testing::hole_feature("h1", {0, 0, 40}, kDown,
                                                 {{2.0 * radius_mm, 13.0}, {13.0, 27.0}}, true)}));
  b.place("T/sunk-60x60x40", "SUNK", {-40, 0, 40});
  Feature head = testing::shaft_feature("pin2", {0, 0, 65}, Vector3d::UnitZ(), 18.0, 12.0);
  head.use = "head";
  element(b, "T/screw-M12x65").features.push_back(head);
  move(b, "SCREW", {-40, 0, 2});
}

void pinned_examples(Seen& seen) {
  try_example(testing::pinned_fixture(true),
              {"round and diamond pin", {"LOC-10"}, [](FixtureBuilder&) {}}, {}, seen);
  try_example(testing::pinned_fixture(false),
              {"two round pins", {"LOC-03", "LOC-08", "LOC-10"}, [](FixtureBuilder&) {}}, {}, seen);
}

void screwed_examples(Seen& seen) {
  const auto try_screwed = [&](const Example& example) {
    try_example(screwed(), example, {}, seen);
  };
  try_screwed({"sound", {}, [](FixtureBuilder&) {}});
  try_screwed(
      {"too little thread", {"FST-04"}, [](FixtureBuilder& b) { b.state.design.limits.clear(); }});
  try_screwed({"a thread of another size", {"CMP-02"}, [](FixtureBuilder& b) {
                 for (Feature& f : element(b, "T/screw-M12x65").features) {
                   if (f.name == "pin1") f.thread = "M12x1.5";
                 }
               }});
  try_screwed({"a hole that is too wide", {"CMP-04"}, [](FixtureBuilder& b) {
                 Feature& hole = element(b, "T/riser-60x60x40").features[0];
                 hole.diameter_mm = 15.0;
                 hole.segments[0].diameter_mm = hole.segments[0].diameter_end_mm = 15.0;
               }});
  try_screwed({"a pin that fits, and one that is too loose", {"CMP-03"}, [](FixtureBuilder& b) {
                 add_pin(b, "T/pin-loose", "f9", {40, -40, 30}, "A4", "H9");
                 add_pin(b, "T/pin-snug", "n6", {80, -40, 30}, "A5", "H7");
               }});
  try_screwed({"a locator that is pressed in", {}, [](FixtureBuilder& b) {
                 add_pin(b, "T/pin-snug", "n6", {80, -40, 30}, "A5", "H7");
                 b.state.design.roles["pin-snug"] = dowel::Role::Locator;
               }});
  try_screwed({"a locator on two clearance screws", {"FST-03"}, [](FixtureBuilder& b) {
                 b.remove("BLOCK");
                 dowel::testing::DrilledHole left;
                 left.radius_mm = 6.5;
                 left.x = -20.0;
                 dowel::testing::DrilledHole right = left;
                 right.x = 20.0;
                 b.add_element(testing::element_of(
                     "T/wide-100x60x40",
                     testing::plate_with_holes({100, 60, 40}, {left, right}, 24),
                     {testing::hole_feature("h1", {-20, 0, 40}, kDown, {{13.0, 40.0}}, true),
                      testing::hole_feature("h2", {20, 0, 40}, kDown, {{13.0, 40.0}}, true)}));
                 b.place("T/wide-100x60x40", "WIDE", {-20, 0, 40});
                 b.place("T/screw-M12x65", "SCREW2", {0, 0, 15});
                 b.state.design.roles["WIDE"] = dowel::Role::Locator;
               }});
  try_screwed({"two pins in one hole", {"FST-10"}, [](FixtureBuilder& b) {
                 add_pin(b, "T/pin-a", "", {40, -40, 30}, "A4", "");
                 add_pin(b, "T/pin-b", "", {40, -40, 60}, "A4", "");
                 mate_pin(b, "T/pin-a", "A4", 20.0);
                 mate_pin(b, "T/pin-b", "A4", 50.0);
               }});
  try_screwed({"one pin in one hole", {}, [](FixtureBuilder& b) {
                 add_pin(b, "T/pin-a", "", {40, -40, 30}, "A4", "");
                 mate_pin(b, "T/pin-a", "A4", 20.0);
               }});
  try_screwed({"a part that slides", {"FST-01", "FST-02", "SYS-01"}, [](FixtureBuilder& b) {
                 b.place("T/riser-60x60x40", "LOOSE", {50, 0, 40});
                 dowel::Mate mate;
                 mate.number = 9;
                 mate.kind = dowel::MateKind::FaceOnFace;
                 mate.moving = {"LOOSE", "bottom"};
                 mate.fixed = {"PLATE", "top"};
                 b.state.mates[9] = mate;
               }});
  try_screwed({"a blind hole, deep enough", {}, [](FixtureBuilder& b) { make_blind(b); }});
  try_screwed({"a screw that bottoms", {"FST-05"}, [](FixtureBuilder& b) {
                 make_blind(b);
                 b.remove("BLOCK");
                 move(b, "SCREW", {-40, 0, 1});
               }});
  try_screwed({"a nut on its thread", {}, [](FixtureBuilder& b) { add_nut(b, 50.0); }});
  try_screwed(
      {"a nut at the end of its thread", {"FST-07"}, [](FixtureBuilder& b) { add_nut(b, 69.5); }});
  try_screwed({"a head in its counterbore", {}, [](FixtureBuilder& b) { sink_head(b, 10.0); }});
  try_screwed(
      {"a head in a tight counterbore", {"CMP-05"}, [](FixtureBuilder& b) { sink_head(b, 9.2); }});
  try_screwed({"a stack of four", {"STK-02"}, [](FixtureBuilder& b) {
                 b.remove("BLOCK");
                 dowel::testing::DrilledHole hole;
                 hole.radius_mm = 6.5;
                 ProjectElement thin = testing::element_of(
                     "T/spacer-10", testing::plate_with_holes({60, 60, 10}, {hole}, 24),
                     {testing::hole_feature("h1", {0, 0, 10}, kDown, {{13.0, 10.0}}, true)});
                 thin.element.role = "riser";
                 b.add_element(thin);
                 for (int i = 0; i < 4; ++i) {
                   b.place("T/spacer-10", "S" + std::to_string(i), {-40, 0, 40.0 + 10.0 * i});
                 }
               }});
  try_screwed({"a locator on a clearance screw", {"FST-03", "FST-09"}, [](FixtureBuilder& b) {
                 b.state.design.roles["BLOCK"] = dowel::Role::Locator;
               }});
}

}  // namespace

TEST_CASE("fixtures of a block fail the rules that their fault is of", "[rule]") {
  Seen seen;
  block_examples(seen);
}

TEST_CASE("fixtures of a block with parts in each other fail the rules of collision", "[rule]") {
  Seen seen;
  collision_examples(seen);
}

TEST_CASE("elements with faulty data fail the rules of the catalogue", "[rule]") {
  Seen seen;
  data_examples(seen);
}

TEST_CASE("a damaged mesh fails its rule, and breaks those that need it alone", "[rule]") {
  Seen seen;
  refused_examples(seen);
}

TEST_CASE("screwed fixtures fail the rules that their fault is of", "[rule]") {
  Seen seen;
  screwed_examples(seen);
}

TEST_CASE("a workpiece on a round and a diamond pin is located, on two round ones too much",
          "[rule]") {
  Seen seen;
  pinned_examples(seen);
}

TEST_CASE("every shipped rule has an example that it passes and one that it fails", "[rule]") {
  Seen seen;
  block_examples(seen);
  collision_examples(seen);
  data_examples(seen);
  refused_examples(seen);
  screwed_examples(seen);
  pinned_examples(seen);
  testing::stated_examples(seen);
  testing::slot_examples(seen);
  testing::tool_examples(seen);
  testing::catalogue_part_examples(seen);
  CHECK(seen.size() == dowel::shipped_rules().rules.size());
  for (const auto& [rule, states] : seen) {
    CAPTURE(rule);
    CHECK(states.first);
    CHECK(states.second);
  }
}
