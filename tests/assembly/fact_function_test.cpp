// Functions that rules can call.

#include <algorithm>
#include <cstdlib>

#include <catch2/catch.hpp>

#include "dowel/assembly/rules.h"
#include "fixture_projects.h"

namespace {

using dowel::Rule;
using dowel::RuleChecker;
using dowel::RuleReport;
using dowel::RuleSet;
namespace testing = dowel::testing;

RuleSet rules_of(const std::string& value, const std::string& from = "limits LIMIT 1") {
  const auto read = dowel::read_rule(
      "-- id: T-1\n-- severity: error\n-- title: t\n-- message: {subject}\n-- reference: none\n"
      "SELECT 'it' AS subject, 1 AS ok, " +
          value + " AS v FROM " + from,
      "t.sql", "test");
  RuleSet rules;
  rules.rules.push_back(std::get<Rule>(read));
  return rules;
}

/// The value as a report tells it; what is broken where it is.
std::string told(const RuleReport& report) {
  if (!report.broken.empty()) return report.broken[0].message;
  return report.results.at(0).findings.at(0).values.at(0).second;
}

std::string told(dowel::Session& session, const std::string& value) {
  const RuleSet rules = rules_of(value);
  return told(RuleChecker(session, rules).check());
}

double number(dowel::Session& session, const std::string& value) {
  const std::string text = told(session, value);
  CAPTURE(value, text);
  char* end = nullptr;
  const double result = std::strtod(text.c_str(), &end);
  CHECK(*end == '\0');
  return result;
}

}  // namespace

TEST_CASE("functions of rules reckon gap, depth, fit and thread", "[rule]") {
  testing::FixtureBuilder builder = testing::sound_fixture();
  builder.place("T/stop-16x16x40", "NEAR", {69, 0, 40});
  builder.place("T/stop-16x16x40", "DEEP", {-67, 20, 40});
  dowel::ProjectElement screw = testing::screw_element();
  builder.add_element(screw);
  builder.place("T/screw-M12x65", "SCREW", {-80, 40, 15});
  const auto session = builder.session();
  CHECK(number(*session, "gap('NEAR', 'WORK')") == Approx(1.0).margin(1e-3));
  CHECK(number(*session, "gap('WORK', 'NEAR')") == Approx(1.0).margin(1e-3));
  CHECK(number(*session, "gap('REST1', 'WORK')") == Approx(0.0).margin(1e-3));
  CHECK(told(*session, "gap('STOP3', 'NEAR')") == "unknown");  // beyond 10 mm
  CHECK(number(*session, "depth('NEAR', 'WORK')") == 0.0);
  const double depth_mm = number(*session, "depth('DEEP', 'WORK')");
  CHECK(depth_mm > 0.01);
  CHECK(depth_mm <= 1.0 + 1e-9);
  // Published limits: 12 H7 is 0/+18, 12 g6 is -17/-6.
  CHECK(number(*session, "fit_min(12, 'H7', 'g6')") == Approx(6.0));
  CHECK(number(*session, "fit_max(12.0, 'H7', 'g6')") == Approx(35.0));
  CHECK(told(*session, "fit_min(12, 'H7', 'x9')") == "unknown");
  // From 15 to 25 in the plate its bore is a core hole: 25 mm from its bottom up to z = 25.
  CHECK(number(*session, "engagement('SCREW', 'PLATE')") == Approx(10.0));
  CHECK(number(*session, "engagement('SCREW', 'WORK')") == 0.0);
}

TEST_CASE("functions of rules reckon what the tables of the workpiece tell", "[rule]") {
  const auto session = testing::sound_fixture().session();
  CHECK(number(*session, "rank('WORK')") == 6.0);
  CHECK(told(*session, "rank('PLATE')") == "unknown");
  const RuleSet table = rules_of("condition", "workpieces");
  CHECK(told(*session, "condition('WORK')") == told(RuleChecker(*session, table).check()));
  const RuleSet seating = rules_of("seating_N", "locators WHERE instance = 'REST2'");
  CHECK(told(*session, "seating('WORK', 'REST2')") == told(RuleChecker(*session, seating).check()));
  CHECK(told(*session, "access('CLAMP')") == "unknown");  // it has no hexagon
}

TEST_CASE("a function that is asked of nobody breaks its rule with the name", "[rule]") {
  const auto session = testing::sound_fixture().session();
  CHECK(told(*session, "gap('NOBODY', 'WORK')").find("no instance \"NOBODY\"") !=
        std::string::npos);
  CHECK(told(*session, "gap(1, 'WORK')").find("expected the name of an instance") !=
        std::string::npos);
  CHECK(told(*session, "gap('WORK')").find("wrong number of arguments") != std::string::npos);
}

TEST_CASE("a rule that calls a function runs again when what that reckons with changed", "[rule]") {
  testing::FixtureBuilder builder = testing::sound_fixture();
  builder.place("T/stop-16x16x40", "NEAR", {69, 0, 40});
  const auto session = builder.session();
  session->set_mode(dowel::CheckMode::Off, "off");
  const RuleSet rules = rules_of("gap('NEAR', 'WORK')");
  RuleChecker checker(*session, rules);
  CHECK(std::stod(told(checker.check())) == Approx(1.0).margin(1e-3));
  session->move("NEAR", {70, 0, 40}, "move");
  CHECK(std::stod(told(checker.check())) == Approx(2.0).margin(1e-3));
  CHECK(checker.last_run() == 1);
  checker.check();
  CHECK(checker.last_run() == 0);
  const auto described = dowel::describe_functions();
  CHECK(std::ranges::find(described, "gap", &dowel::FunctionDescription::name) != described.end());
}
