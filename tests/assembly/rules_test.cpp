#include "dowel/assembly/rules.h"

#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

#include "dowel/kernel/error.h"
#include "fixture_projects.h"
#include "program.h"
#include "random_geometry.h"

namespace {

using dowel::BrokenRule;
using dowel::Rule;
using dowel::RuleChecker;
using dowel::RuleFinding;
using dowel::RuleReport;
using dowel::RuleResult;
using dowel::RuleSet;
using dowel::RuleSeverity;
using dowel::RuleState;
namespace testing = dowel::testing;

const std::string kHeader =
    "-- id: T-1\n-- severity: error\n-- title: A title\n-- message: {subject} is {x_mm}\n"
    "-- reference: none\n";

std::string text_of(const std::string& sql) {
  return kHeader + sql;
}

RuleSet set_of(const std::vector<std::string>& texts) {
  RuleSet rules;
  for (std::size_t i = 0; i < texts.size(); ++i) {
    auto read = dowel::read_rule(texts[i], "t" + std::to_string(i) + ".sql", "test");
    REQUIRE(std::holds_alternative<Rule>(read));
    Rule rule = std::get<Rule>(read);
    rule.id += std::to_string(i);
    rules.rules.push_back(rule);
  }
  return rules;
}

RuleReport report_of(const testing::FixtureBuilder& builder, const RuleSet& rules) {
  const auto session = builder.session();
  return RuleChecker(*session, rules).check();
}

/// Everything that a report tells, as text.
std::string told_by(const RuleReport& report) {
  std::string text;
  for (const RuleResult& result : report.results) {
    text += result.rule.id + " " + std::string(to_string(result.state())) + "\n";
    for (const RuleFinding& finding : result.findings) {
      text += "  " + finding.subject + " " + std::string(to_string(finding.state)) + " " +
              finding.message;
      for (const auto& [name, value] : finding.values) text += " " + name + "=" + value;
      text += "\n";
    }
    if (result.broken) text += "  " + result.broken->message + "\n";
  }
  for (const auto& [rule, subject] : report.stale_waivers) text += rule + subject + " stale\n";
  return text;
}

/// What is wrong with a query, told by a check of it beside a sound rule.
std::string broken_by(const std::string& sql) {
  const RuleSet rules =
      set_of({text_of(sql), text_of("SELECT instance AS subject, 1 AS ok, x_mm FROM instances")});
  const RuleReport report = report_of(testing::sound_fixture(), rules);
  // The sound one is not affected.
  CHECK(report.results[1].state() == RuleState::Pass);
  if (!report.results[0].broken) return {};
  REQUIRE(report.broken.size() == 1);
  CHECK(report.broken[0].file == "t0.sql");
  return report.broken[0].message + " @" + std::to_string(report.broken[0].line);
}

}  // namespace

TEST_CASE("a rule answers for each of its subjects with its values", "[rule]") {
  const RuleSet rules = set_of({text_of(
      "SELECT instance AS subject, CASE instance WHEN 'WORK' THEN NULL ELSE x_mm >= 0 END AS ok, "
      "'it moves' AS reason, x_mm FROM instances WHERE instance IN ('REST1', 'REST2', 'WORK')")});
  const RuleReport report = report_of(testing::sound_fixture(), rules);
  const RuleResult& result = report.results.at(0);
  REQUIRE(result.findings.size() == 3);
  CHECK(result.findings[0].state == RuleState::Fail);
  CHECK(result.findings[0].message == "REST1 is -50");
  CHECK(result.findings[1].state == RuleState::Pass);
  CHECK(result.findings[2].state == RuleState::NotEvaluated);
  CHECK(result.findings[2].message == "it moves");
  CHECK(result.findings[0].values ==
        std::vector<std::pair<std::string, std::string>>{{"x_mm", "-50"}});
  CHECK(result.facts == std::vector<std::string>{"instances"});
  CHECK(report.findings_at(RuleSeverity::Error) == 1);
  CHECK(report.findings_at(RuleSeverity::Error, true) == 2);
}

TEST_CASE("a rule without a subject is not applicable", "[rule]") {
  const RuleSet rules =
      set_of({text_of("SELECT moving AS subject, 0 AS ok, offset_mm AS x_mm FROM mates WHERE 0")});
  CHECK(report_of(testing::sound_fixture(), rules).results[0].state() == RuleState::NotApplicable);
}

TEST_CASE("a rule that is no query of facts is broken, by file and line, and hides no other",
          "[rule]") {
  CHECK(broken_by("SELECT nobody AS subject, 1 AS ok, 1 AS x_mm FROM instances")
            .find("no such column") == 0);
  CHECK(broken_by("SELECT 1 AS subject,\n1 AS ok,\nxx FROM instances").find("@8") !=
        std::string::npos);
  CHECK(broken_by("SELECT instance AS subject, 1 AS ok, \"typo\" AS x_mm FROM instances")
            .find("no such column") == 0);
  CHECK(broken_by("SELECT 1 AS ok, 2 AS x_mm FROM instances").find("column \"subject\"") !=
        std::string::npos);
  CHECK(broken_by("SELECT instance AS subject, 2 AS ok, 2 AS x_mm FROM instances")
            .find("1, 0 or NULL, not 2") != std::string::npos);
  CHECK(broken_by("SELECT instance AS subject, 1 AS ok FROM instances").find("\"x_mm\"") !=
        std::string::npos);
  CHECK(broken_by("SELECT instance AS subject, 1 AS ok, 1 AS x_mm FROM instances; SELECT 1")
            .find("more behind it") != std::string::npos);
  CHECK(broken_by("-- nothing").find("no query") != std::string::npos);
}

TEST_CASE("a rule can do nothing but read facts", "[rule]") {
  for (const char* sql :
       {"DELETE FROM instances", "CREATE TABLE t(x)", "CREATE TEMP TABLE t(x)", "DROP TABLE limits",
        "INSERT INTO limits VALUES (1, 2, 3, 4)", "PRAGMA user_version = 3", "PRAGMA table_list",
        "ATTACH 'x.db' AS x", "BEGIN", "VACUUM INTO 'x.db'", "SELECT * FROM sqlite_schema",
        "SELECT * FROM pragma_table_info('limits')"}) {
    CAPTURE(sql);
    CHECK_FALSE(broken_by(sql).empty());
  }
  for (const char* call : {"random()", "date('now')", "load_extension('x')", "zeroblob(9)"}) {
    CAPTURE(call);
    const std::string broken = broken_by(std::string("SELECT ") + call +
                                         " AS subject, 1 AS ok, 1 "
                                         "AS x_mm FROM instances");
    CHECK(broken.find("is not for rules") != std::string::npos);
  }
}

TEST_CASE("a query without an end is broken off", "[rule]") {
  CHECK(broken_by("WITH RECURSIVE n(i) AS (SELECT 1 UNION ALL SELECT i + 1 FROM n) "
                  "SELECT max(i) AS subject, 1 AS ok, 1 AS x_mm FROM n")
            .find("without an end") != std::string::npos);
}

TEST_CASE("a header says what it lacks", "[rule]") {
  const auto message = [](const std::string& text) {
    const auto read = dowel::read_rule(text, "f.sql", "test");
    return std::holds_alternative<BrokenRule>(read) ? std::get<BrokenRule>(read).message
                                                    : std::string();
  };
  CHECK(message(kHeader + "SELECT 1").empty());
  CHECK(message("SELECT 1").find("\"-- id: ...\"") != std::string::npos);
  CHECK(message("-- id: A B\n" + kHeader.substr(kHeader.find("-- sev"))).find("letters") !=
        std::string::npos);
  CHECK(message(kHeader + "-- id: X\nSELECT 1").find("a second") != std::string::npos);
  std::string severe = kHeader;
  severe.replace(severe.find("error"), 5, "awful");
  CHECK(message(severe).find("expected error, warning or info") != std::string::npos);
  std::string open = kHeader;
  open.replace(open.find("{subject}"), 9, "{subject");
  CHECK(message(open).find("without a }") != std::string::npos);
  const auto folded = dowel::read_rule(
      "-- id: T\n-- severity: info\n-- title: goes\n--     on\n-- message: m\n-- reference: r\n",
      "f", "t");
  CHECK(std::get<Rule>(folded).title == "goes on");
}

TEST_CASE("rules of folders join the shipped ones, and none takes another's place", "[rule]") {
  const testing::TemporaryFolder folder;
  std::filesystem::create_directory(folder / "own");
  testing::write_text(folder / "own/T-1.sql", text_of("SELECT 1"));
  testing::write_text(folder / "LOC-02.sql",
                      "-- id: LOC-02\n-- severity: info\n-- title: t\n-- message: m\n-- reference: "
                      "r\nSELECT 1");
  testing::write_text(folder / "bad.sql", "SELECT 1");
  testing::write_text(folder / "notes.txt", "no rule");
  RuleSet rules = dowel::shipped_rules();
  const std::size_t shipped = rules.rules.size();
  CHECK(rules.broken.empty());
  dowel::add_rules(rules, folder.path());
  CHECK(rules.rules.size() == shipped + 1);
  const auto own = std::ranges::find(rules.rules, "T-1", &Rule::id);
  REQUIRE(own != rules.rules.end());
  CHECK(own->family == "own");
  REQUIRE(rules.broken.size() == 2);
  CHECK(rules.broken[0].message.find("LOC-02 is there already") != std::string::npos);
  CHECK_THROWS_AS(dowel::add_rules(rules, folder / "none"), dowel::Error);
}

namespace {

/// Lets go of what holds the part, so that it alone moves.
void release(dowel::Session& session, const std::string& name) {
  std::vector<std::uint32_t> holding;
  for (const auto& [number, mate] : session.state().mates) {
    if (mate.moving.instance == name) holding.push_back(number);
  }
  session.unmate(holding, "unmate");
}

}  // namespace

TEST_CASE("a waiver holds while the geometry of its subjects stays, and is told as stale after",
          "[rule]") {
  const RuleSet rules = set_of({text_of(
      "SELECT a.instance || ' ' || b.instance AS subject, 0 AS ok, a.x_mm FROM instances AS a, "
      "instances AS b WHERE a.instance = 'REST1' AND b.instance = 'REST2'")});
  const auto session = testing::sound_fixture().session();
  RuleChecker checker(*session, rules);
  dowel::FixtureDesign design = session->state().design;
  design.waivers[{"T-10", "REST1 REST2"}] = {"agreed", "somebody",
                                             dowel::geometry_digest(*session, "REST1 REST2")};
  session->set_design(design, "waive");
  RuleReport report = checker.check();
  CHECK(report.results[0].findings[0].state == RuleState::Waived);
  CHECK(report.findings_at(RuleSeverity::Error) == 0);
  CHECK(report.stale_waivers.empty());
  // Another part may move.
  session->set_mode(dowel::CheckMode::Off, "off");
  release(*session, "REST3");
  release(*session, "REST2");
  session->move("REST3", {0, 20, 40}, "move");
  CHECK(checker.check().findings_at(RuleSeverity::Error) == 0);
  session->move("REST2", {50, -29.9, 40}, "move");
  report = checker.check();
  CHECK(report.results[0].findings[0].state == RuleState::Fail);
  CHECK(report.results[0].findings[0].waiver_is_stale);
  REQUIRE(report.stale_waivers.size() == 1);
  session->undo(1);
  CHECK(checker.check().findings_at(RuleSeverity::Error) == 0);
}

TEST_CASE("an override changes how much a rule counts, and one of no rule is told", "[rule]") {
  const RuleSet rules = set_of({text_of(
      "SELECT instance AS subject, 0 AS ok, x_mm FROM instances WHERE instance = 'WORK'")});
  testing::FixtureBuilder builder = testing::sound_fixture();
  builder.state.design.overrides["T-10"] = {"warning", "known"};
  builder.state.design.overrides["NONE"] = {"off", "?"};
  const RuleReport report = report_of(builder, rules);
  CHECK(report.findings_at(RuleSeverity::Error) == 0);
  CHECK(report.findings_at(RuleSeverity::Warning) == 1);
  CHECK(report.unknown_overrides == std::vector<std::string>{"NONE"});
  builder.state.design.overrides["T-10"] = {"off", "known"};
  CHECK(report_of(builder, rules).findings_at(RuleSeverity::Info) == 0);
}

TEST_CASE("after an edit only rules whose facts changed run again", "[rule]") {
  const RuleSet rules =
      set_of({text_of("SELECT instance AS subject, 1 AS ok, x_mm FROM instances"),
              text_of("SELECT moving AS subject, 1 AS ok, offset_mm AS x_mm FROM mates"),
              text_of("SELECT name AS subject, 1 AS ok, value AS x_mm FROM limits"),
              text_of("SELECT element AS subject, 1 AS ok, count AS x_mm FROM bom")});
  const auto session = testing::sound_fixture().session();
  RuleChecker checker(*session, rules);
  checker.check();
  CHECK(checker.last_run() == 4);
  checker.check();
  CHECK(checker.last_run() == 0);
  dowel::FixtureDesign design = session->state().design;
  design.limits["friction"] = 0.2;
  session->set_design(design, "limit");
  checker.check();
  CHECK(checker.last_run() == 1);
  session->set_mode(dowel::CheckMode::Off, "off");
  // `instances` is another, but not in the column that is read; `bom` is made anew and the same.
  session->move("WORK", {0, 0, 61}, "move");
  checker.check();
  CHECK(checker.last_run() == 0);
  session->move("WORK", {1, 0, 61}, "move");
  checker.check();
  CHECK(checker.last_run() == 1);
}

TEST_CASE("a check after edits tells what a first check tells", "[rule][property]") {
  const auto seed = GENERATE(range(0U, 6U));
  CAPTURE(seed);
  const RuleSet rules = dowel::shipped_rules();
  const auto session = testing::sound_fixture().session();
  session->set_mode(dowel::CheckMode::Off, "off");
  RuleChecker checker(*session, rules);
  testing::RandomGeometry random(seed);
  std::set<std::string> told;
  const std::vector<std::string> names{"REST1", "STOP2", "WORK", "CLAMP"};
  for (const std::string& name : names) {
    if (name != "WORK") release(*session, name);
  }
  for (int edit = 0; edit < 12; ++edit) {
    CAPTURE(edit);
    const std::string& name = names[static_cast<std::size_t>(edit) % names.size()];
    dowel::FixtureDesign design = session->state().design;
    switch ((static_cast<unsigned>(edit) + seed) % 4) {
      case 0:
        session->move(name, session->instance(name).X_WI.translation() + random.point(2.0), "move");
        break;
      case 1:
        design.limits["friction"] = 0.1 + 0.01 * edit;
        design.clamp_forces_N["CLAMP"] = 500.0 * (edit + 1);
        session->set_design(design, "design");
        break;
      case 2:
        session->undo(1);
        break;
      default:
        design.roles[name] = edit % 2 == 0 ? dowel::Role::AdjustableSupport : dowel::Role::Locator;
        session->set_design(design, "role");
    }
    const std::string incremental = told_by(checker.check());
    CHECK(incremental == told_by(RuleChecker(*session, rules).check()));
    told.insert(incremental);
  }
  // The sample is worth something where the edits change what is told.
  CHECK(told.size() >= 4);
}
