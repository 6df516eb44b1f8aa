// Rules that are evaluated text by text of a column.

#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

#include "dowel/assembly/rules.h"
#include "fixture_projects.h"
#include "hexagon_screw.h"
#include "random_geometry.h"

namespace dowel::testing {
namespace {

const std::string kHeader =
    "-- id: T-1\n-- severity: error\n-- title: A title\n-- message: {subject} is {x_mm}\n"
    "-- reference: none\n";

RuleSet only(const std::string& each, const std::string& sql) {
  auto read = read_rule(kHeader + "-- each: " + each + "\n" + sql, "t.sql", "test");
  REQUIRE(std::holds_alternative<Rule>(read));
  return {{std::get<Rule>(read)}, {}};
}

/// Everything that a report tells, a line for each finding.
std::vector<std::string> told_by(const RuleReport& report) {
  std::vector<std::string> lines;
  for (const RuleResult& result : report.results) {
    for (const RuleFinding& finding : result.findings) {
      std::string& line =
          lines.emplace_back(result.rule.id + " " + finding.subject + " " +
                             std::string(to_string(finding.state)) + " " + finding.message);
      for (const auto& [name, value] : finding.values) line += " " + name + "=" + value;
      if (finding.waiver_is_stale) line += " stale";
    }
    if (result.broken) lines.push_back(result.rule.id + " " + result.broken->message);
  }
  return lines;
}

/// The block among risers on screws, pins in holes and a loose block: something for most rules.
FixtureBuilder furnished() {
  FixtureBuilder b = sound_fixture();
  ProjectElement riser = riser_element();
  riser.element.role = "riser";
  b.add_element(riser);
  b.add_element(hexagon_screw());
  ProjectElement pin = pin_element();
  pin.element.role = "locator";
  pin.element.features[0].fit = "g6";
  b.add_element(pin);
  for (ProjectElement& known : b.elements) {
    if (known.element.name != "T/plate-5x3") continue;
    for (Feature& feature : known.element.features) feature.fit = feature.depth_mm > 0 ? "H7" : "";
  }
  b.place("T/riser-60x60x40", "RISER1", {-80, 40, 40});
  b.place("T/hex-screw-M12x65", "SCREW1", {-80, 40, 15});
  b.place("T/riser-60x60x40", "RISER2", {80, -40, 40});
  b.place("T/hex-screw-M12x65", "SCREW2", {80, -40, 15});
  b.place("T/pin-12", "PIN", {80, 40, 25});
  return b;
}

void edit_design(FixtureDesign& design, const std::string& name, RandomGeometry& random) {
  const double value = random.uniform(0.0, 1.0);
  switch (random.index(6)) {
    case 0:
      design.limits["friction"] = 0.1 + 0.1 * value;
      break;
    case 1:
      design.limits["gap_element_mm"] = 5.0 * value;
      break;
    case 2:
      design.clamp_forces_N["CLAMP"] = 500.0 + 8000.0 * value;
      break;
    case 3:
      design.roles[name] = value < 0.5 ? Role::AdjustableSupport : Role::Locator;
      break;
    case 4:
      design.stated[{"preload_N", "SCREW1"}] = {1e5 * value, "a test"};
      break;
    default:
      design.overrides["COL-03"] = {value < 0.5 ? "error" : "off", "a test"};
  }
}

/// One of what a designer does, with checks off, so that none is refused.
void edit(Session& session, RandomGeometry& random) {
  std::vector<std::string> names;
  for (const auto& [name, instance] : session.state().instances) {
    if (!instance.grounded) names.push_back(name);
  }
  const std::string& name = names[random.index(static_cast<std::uint32_t>(names.size()))];
  std::vector<std::uint32_t> holding;
  for (const auto& [number, mate] : session.state().mates) {
    if (mate.moving.instance == name) holding.push_back(number);
  }
  switch (random.index(8)) {
    case 0:
    case 1:
    case 2: {
      if (!holding.empty()) session.unmate(holding, "unmate");
      const Eigen::Vector3d at = session.instance(name).X_WI.translation();
      session.move(name, at + random.point(random.index(2) == 0 ? 0.3 : 30.0), "move");
      break;
    }
    case 3: {
      FixtureDesign design = session.state().design;
      edit_design(design, name, random);
      session.set_design(design, "design");
      break;
    }
    case 4:
      session.undo(1);
      break;
    case 5:
      session.remove(name, "remove");
      break;
    case 6:
      session.place(
          "T/riser-60x60x40", "MORE" + std::to_string(random.index(1000000)),
          Pose::from_translation({random.uniform(-80, 80), random.uniform(-40, 40), 40.0}),
          "place");
      break;
    default:
      if (!holding.empty()) session.unmate(holding, "unmate");
  }
}

}  // namespace

TEST_CASE("a rule with `each` is asked for those texts alone whose rows changed", "[rule]") {
  const auto session = furnished().session();
  session->set_mode(CheckMode::Off, "off");
  const RuleSet rules = only("instances.instance",
                             "SELECT i.instance AS subject, i.x_mm < l.value AS ok, i.x_mm "
                             "FROM instances AS i JOIN limits AS l ON l.name = 'height_mm'");
  RuleChecker checker(*session, rules);
  checker.check();
  const std::size_t all = session->state().instances.size();
  CHECK(checker.last_queries() == all);
  session->move("SCREW1", {-81, 40, 15}, "move");
  checker.check();
  CHECK(checker.last_queries() == 1);
  session->move("SCREW1", {-81, 40, 16}, "move");  // in a column that is not read
  checker.check();
  CHECK(checker.last_queries() == 0);
  session->remove("SCREW1", "remove");
  CHECK(checker.check().results[0].findings.size() == all - 1);
  CHECK(checker.last_queries() == 0);
  session->undo(1);
  CHECK(checker.check().results[0].findings.size() == all);
  CHECK(checker.last_queries() == 1);
  FixtureDesign design = session->state().design;
  design.limits["friction"] = 0.19;
  session->set_design(design, "another limit");
  checker.check();
  CHECK(checker.last_queries() == 0);
  design.limits["height_mm"] = 1.0;
  session->set_design(design, "its limit");
  CHECK(checker.check().results[0].count(RuleState::Fail) > 0);
  CHECK(checker.last_queries() == all);
}

TEST_CASE("an `each` that names no column of a table that is read is told with its line",
          "[rule]") {
  const auto session = furnished().session();
  const std::string sql = "SELECT instance AS subject, 1 AS ok, x_mm FROM instances";
  for (const char* each : {"instances", "instances.nobody", "nowhere.instance", "limits.name"}) {
    CAPTURE(each);
    const RuleSet rules = only(each, sql);
    const RuleReport report = RuleChecker(*session, rules).check();
    REQUIRE(report.broken.size() == 1);
    CHECK(report.broken[0].message.find("expected TABLE.COLUMN") != std::string::npos);
    CHECK(report.broken[0].line == 6);
  }
}

TEST_CASE("a fault in a rule with `each` is told though no row is there, or in some", "[rule]") {
  const auto session = furnished().session();
  const RuleSet formless = only("slot_fits.instance", "SELECT instance AS subject FROM slot_fits");
  CHECK(RuleChecker(*session, formless).check().broken.size() == 1);
  const RuleSet partly = only("instances.instance",
                              "SELECT instance AS subject, x_mm > 80 OR 2 * (x_mm > 79) AS ok, "
                              "x_mm FROM instances WHERE instance <> 'RISER2'");
  session->set_mode(CheckMode::Off, "off");
  RuleChecker checker(*session, partly);
  CHECK(checker.check().broken.empty());
  const RuleSet wrong = only("instances.instance",
                             "SELECT instance AS subject, CASE WHEN instance = 'SCREW1' THEN "
                             "round(x_mm) ELSE 1 END AS ok, x_mm FROM instances");
  RuleChecker breaks(*session, wrong);
  CHECK(breaks.check().broken.size() == 1);
  session->remove("SCREW1", "remove");
  CHECK(breaks.check().broken.empty());
  session->undo(1);
  CHECK(breaks.check().broken.size() == 1);
}

TEST_CASE(
    "after any edits all shipped rules tell what a first check tells, and what they tell "
    "evaluated whole",
    "[rule][property]") {
  const auto seed = GENERATE(range(0U, 4U));
  CAPTURE(seed);
  const RuleSet rules = shipped_rules();
  RuleSet whole = rules;
  for (Rule& rule : whole.rules) rule.each.clear();
  const auto session = furnished().session();
  session->set_mode(CheckMode::Off, "off");
  RuleChecker checker(*session, rules);
  RandomGeometry random(seed);
  std::size_t asked = 0;
  std::set<std::vector<std::string>> told;
  checker.check();
  const std::size_t first = checker.last_queries();
  for (int i = 0; i < 12; ++i) {
    CAPTURE(i);
    edit(*session, random);
    const RuleReport report = checker.check();
    asked += checker.last_queries();
    std::vector<std::string> lines = told_by(report);
    CHECK(lines == told_by(RuleChecker(*session, rules).check()));
    told.insert(lines);
    if (i % 4 != 3) continue;
    std::vector<std::string> of_whole = told_by(RuleChecker(*session, whole).check());
    std::ranges::sort(lines);
    std::ranges::sort(of_whole);
    CHECK(lines == of_whole);
  }
  // The sample is worth something: what is told changes, and less is asked than each time anew.
  CHECK(told.size() >= 6);
  CHECK(asked < 12 * first);
}

}  // namespace dowel::testing
