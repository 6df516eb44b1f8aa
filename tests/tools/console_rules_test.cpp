// Rules and analysis as their users run them.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <tuple>
#include <vector>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "../assembly/fixture_projects.h"
#include "program.h"

namespace {

using Json = nlohmann::json;
namespace testing = dowel::testing;

/// A folder with a project of the sound fixture.
struct Desk {
  testing::TemporaryFolder folder;

  explicit Desk(const testing::FixtureBuilder& builder = testing::sound_fixture()) {
    dowel::Project project;
    project.commit("build", builder.state, builder.elements);
    project.save_copy(folder / "p.dwp");
  }

  testing::ProgramResult dowel(std::vector<std::string> words) const {
    words.insert(words.end(), {"--project", "p.dwp"});
    return testing::run_dowel(words, {.folder = folder.path()});
  }
};

testing::FixtureBuilder loose_fixture() {
  testing::FixtureBuilder builder = testing::sound_fixture();
  builder.state.instances.erase("STOP3");
  std::erase_if(builder.state.mates,
                [](const auto& entry) { return entry.second.moving.instance == "STOP3"; });
  return builder;
}

constexpr const char* kRule =
    "-- id: SHOP-01\n-- severity: warning\n-- title: Parts are light\n-- message: {subject} has "
    "{mass_kg} kg\n-- reference: shop\n"
    "SELECT instance AS subject, mass_kg < 1 AS ok, mass_kg FROM instances WHERE instance = "
    "'PLATE'";

}  // namespace

TEST_CASE("a sound fixture passes the gate, one that is not located does not", "[rule]") {
  const auto sound = Desk().dowel({"rules", "check"});
  INFO(sound.out << sound.err);
  CHECK(sound.exit_code == 0);
  CHECK(sound.out.find("0 errors, 0 warnings") != std::string::npos);

  const Desk desk(loose_fixture());
  const auto loose = desk.dowel({"rules", "check"});
  CHECK(loose.exit_code == 1);
  CHECK(loose.out.find("error LOC-02 WORK: the locator matrix of 5 points has rank 5") !=
        std::string::npos);
  const Json json = Json::parse(desk.dowel({"rules", "check", "--json"}).out);
  CHECK(json["findings_at_gate"] == 2);
  CHECK(json["counts"]["error"] == 2);
}

TEST_CASE("the gate and --strict decide the exit code", "[rule]") {
  const Desk desk;
  testing::write_text(desk.folder / "SHOP-01.sql", kRule);
  CHECK(desk.dowel({"rules", "check", "--rules", "."}).exit_code == 0);
  const auto warned = desk.dowel({"rules", "check", "--gate", "warning", "--rules", "."});
  CHECK(warned.exit_code == 1);
  CHECK(warned.out.find("warning SHOP-01 PLATE has ") != std::string::npos);
  // Neither the clamp's stroke nor the cutter is stated yet.
  CHECK(desk.dowel({"rules", "check", "--strict"}).exit_code == 1);
  for (const auto& [subject, quantity, value] :
       {std::tuple("CLAMP", "stroke_mm", "5"), std::tuple("BORE", "cutter_mm", "20"),
        std::tuple("BORE", "cutter_length_mm", "100")}) {
    CHECK(desk.dowel({"design", subject, quantity, value, "reason", "a sheet"}).exit_code == 0);
  }
  CHECK(desk.dowel({"rules", "check", "--strict"}).exit_code == 0);
  CHECK(desk.dowel({"force", "CLAMP", "off"}).exit_code == 0);
  CHECK(desk.dowel({"load", "CUT", "off"}).exit_code == 0);
  CHECK(desk.dowel({"rules", "check"}).exit_code == 0);
  CHECK(desk.dowel({"rules", "check", "--strict"}).exit_code == 1);
}

TEST_CASE("a broken rule is told with its place, and the others still run", "[rule]") {
  const Desk desk;
  testing::write_text(desk.folder / "SHOP-01.sql", kRule);
  testing::write_text(
      desk.folder / "SHOP-02.sql",
      "-- id: SHOP-02\n-- severity: info\n-- title: t\n-- message: m\n-- reference: "
      "r\nSELECT instance AS subject,\n  typo AS ok\nFROM instances");
  const auto result = desk.dowel({"rules", "check", "--rules", "."});
  INFO(result.out << result.err);
  CHECK(result.exit_code == 3);
  CHECK(result.out.find("SHOP-02.sql:7: broken rule SHOP-02: no such column: typo") !=
        std::string::npos);
  CHECK(result.out.find("SHOP-01 PLATE") != std::string::npos);
}

namespace {

/// Whether a log holds against the schema of SARIF 2.1.0.
bool is_valid_sarif(const std::filesystem::path& file) {
  const std::string command =
      "\"" DOWEL_NODE "\" \"" DOWEL_SARIF_CHECK_SCRIPT "\" \"" + file.string() + "\"";
  return std::system(command.c_str()) == 0;
}

}  // namespace

TEST_CASE("SARIF reports hold against the schema, and a spoilt one does not", "[rule]") {
  const Desk desk(loose_fixture());
  testing::write_text(desk.folder / "SHOP-01.sql", kRule);
  testing::write_text(desk.folder / "SHOP-02.sql", "no rule");
  std::string broken = kRule;
  broken.replace(broken.find("SHOP-01"), 7, "SHOP-03");
  broken.replace(broken.rfind("mass_kg <"), 7, "nobody ");
  testing::write_text(desk.folder / "SHOP-03.sql", broken);
  CHECK(desk.dowel({"rules", "waive", "LOC-02", "WORK", "reason", "known", "by", "QA"}).exit_code ==
        0);
  CHECK(desk.dowel({"rules", "override", "LOC-01", "off", "reason", "known"}).exit_code == 0);
  const auto report =
      desk.dowel({"rules", "check", "--rules", ".", "--format", "sarif", "--to", "r.sarif"});
  INFO(report.out << report.err);
  CHECK(report.exit_code == 3);
  CHECK(is_valid_sarif(desk.folder / "r.sarif"));
  Json log = Json::parse(testing::read_text(desk.folder / "r.sarif"));
  CHECK(log["runs"][0]["results"].size() > 10);
  log["runs"][0]["results"][0]["level"] = "awful";
  testing::write_text(desk.folder / "spoilt.sarif", log.dump());
  CHECK_FALSE(is_valid_sarif(desk.folder / "spoilt.sarif"));
}

TEST_CASE("SARIF, JUnit and HTML are what their readers expect", "[rule]") {
  const Desk desk(loose_fixture());
  const auto sarif = desk.dowel({"rules", "check", "--format", "sarif", "--to", "r.sarif"});
  CHECK(sarif.exit_code == 1);
  const Json log = Json::parse(testing::read_text(desk.folder / "r.sarif"));
  CHECK(log["version"] == "2.1.0");
  const Json& run = log["runs"][0];
  CHECK(run["tool"]["driver"]["name"] == "dowel");
  CHECK(run["invocations"][0]["executionSuccessful"] == true);
  std::size_t errors = 0;
  for (const Json& result : run["results"]) {
    const std::size_t index = result["ruleIndex"];
    CHECK(run["tool"]["driver"]["rules"][index]["id"] == result["ruleId"]);
    CHECK(result["partialFingerprints"]["ruleAndSubject/v1"].get<std::string>().size() == 16);
    if (result["level"] == "error" && result["kind"] == "fail") ++errors;
  }
  CHECK(errors == 2);

  CHECK(desk.dowel({"rules", "check", "--format", "junit", "--to", "r.xml"}).exit_code == 1);
  const std::string junit = testing::read_text(desk.folder / "r.xml");
  CHECK(junit.find("<testsuite name=\"locating\"") != std::string::npos);
  CHECK(junit.find("<failure type=\"error\"") != std::string::npos);

  CHECK(desk.dowel({"rules", "check", "--format", "html", "--to", "r.html"}).exit_code == 1);
  const std::string html = testing::read_text(desk.folder / "r.html");
  CHECK(html.find("LOC-02") != std::string::npos);
  CHECK(html.find("http") == std::string::npos);  // needs nothing else
  CHECK(desk.dowel({"rules", "check", "--format", "pdf"}).exit_code == 3);
}

TEST_CASE("an export with a gate writes nothing while findings stand", "[rule]") {
  const Desk desk(loose_fixture());
  const auto refused = desk.dowel({"export", "a.csv", "--gate", "error"});
  CHECK(refused.exit_code == 1);
  CHECK(refused.out.find("nothing was written") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(desk.folder / "a.csv"));
  for (const char* id : {"LOC-01", "LOC-02"}) {
    CHECK(
        desk.dowel({"rules", "waive", id, "WORK", "reason", "shown only", "by", "me"}).exit_code ==
        0);
  }
  CHECK(desk.dowel({"export", "a.csv", "--gate", "error"}).exit_code == 0);
  CHECK(std::filesystem::exists(desk.folder / "a.csv"));
}

TEST_CASE("overrides, waivers, roles and loads are commands that undo takes back", "[rule]") {
  const Desk desk(loose_fixture());
  const auto override_both = [&] {
    for (const char* id : {"LOC-01", "LOC-02"}) {
      CHECK(desk.dowel({"rules", "override", id, "warning", "reason", "a study"}).exit_code == 0);
    }
  };
  override_both();
  const auto told = desk.dowel({"rules", "check"});
  CHECK(told.exit_code == 0);
  CHECK(told.out.find("override LOC-02: error counts as warning (a study)") != std::string::npos);
  CHECK(desk.dowel({"undo"}).exit_code == 0);
  CHECK(desk.dowel({"rules", "check"}).exit_code == 1);
  CHECK(desk.dowel({"redo"}).exit_code == 0);
  CHECK(desk.dowel({"rules", "check"}).exit_code == 0);
  CHECK(desk.dowel({"rules", "restore", "LOC-02"}).exit_code == 0);
  CHECK(desk.dowel({"rules", "check"}).exit_code == 1);
  CHECK(desk.dowel({"rules", "waive", "COL-01", "WORK PLATE", "reason", "x"}).exit_code == 3);
  const auto role = desk.dowel({"role", "REST1", "carpenter"});
  CHECK(role.exit_code == 3);
  CHECK(role.err.find("expected base plate, riser") != std::string::npos);
}

TEST_CASE("what is stated has a subject, a known quantity, a size and a reason", "[rule]") {
  const Desk desk;
  const auto refused = [&](const std::vector<std::string>& words, const std::string& told) {
    const auto result = desk.dowel(words);
    INFO(result.out << result.err);
    CHECK(result.exit_code == 3);
    CHECK(result.err.find(told) != std::string::npos);
  };
  refused({"design", "CLMP", "stroke_mm", "5", "reason", "x"}, "did you mean CLAMP?");
  refused({"design", "WORK.botom", "machined", "1", "reason", "x"}, "INSTANCE.FEATURE");
  refused({"design", "CLAMP", "stroke", "5", "reason", "x"}, "did you mean stroke_mm?");
  refused({"design", "CLAMP", "stroke_mm", "-5", "reason", "x"}, "expected 0 to");
  refused({"design", "CLAMP", "stroke_mm", "5"}, "expected `reason`");
  refused({"design", "CLAMP", "stroke_mm", "off"}, "is not stated");
  CHECK(desk.dowel({"design", "WORK.bottom", "machined", "1", "reason", "drawing"}).exit_code == 0);
  const Json json = Json::parse(desk.dowel({"design", "--json"}).out);
  REQUIRE(json["stated"].size() == 1);
  CHECK(json["stated"][0]["subject"] == "WORK.bottom");
  CHECK(json["stated"][0]["reason"] == "drawing");
  CHECK(desk.dowel({"undo"}).exit_code == 0);
  CHECK(Json::parse(desk.dowel({"design", "--json"}).out)["stated"].empty());
}

TEST_CASE("explain shows every number of a verdict", "[rule]") {
  const Desk desk;
  const auto result = desk.dowel({"rules", "explain", "LOC-04", "WORK"});
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);
  CHECK(result.out.find("WORK: pass") != std::string::npos);
  CHECK(result.out.find("condition = ") != std::string::npos);
  CHECK(result.out.find("largest = 10") != std::string::npos);
  const auto typo = desk.dowel({"rules", "explain", "LOC-4"});
  CHECK(typo.exit_code == 3);
  CHECK(typo.err.find("LOC-04") != std::string::npos);
}

TEST_CASE("analyse tells the same in text and JSON, and draws it", "[rule]") {
  const Desk desk;
  const auto text = desk.dowel({"analyse", "a.svg"});
  INFO(text.out << text.err);
  CHECK(text.exit_code == 0);
  CHECK(text.out.find("located by 6 points: rank 6 of 6") != std::string::npos);
  const std::string svg = testing::read_text(desk.folder / "a.svg");
  CHECK(svg.find("<svg") == 0);
  CHECK(svg.find("STOP3") != std::string::npos);
  const Json json = Json::parse(desk.dowel({"analyse", "--json"}).out);
  CHECK(json["rank"] == 6);
  CHECK(json["locators"].size() == 6);
  // 120 x 80 x 30 of steel.
  CHECK(json["mass_kg"].get<double>() == Approx(120 * 80 * 30 * 7.85e-6).epsilon(1e-9));
  // The clamp at (0, -10) and the weight at (0, 0): moments about the line of REST1 and REST2.
  const double weight_N = json["mass_kg"].get<double>() * 9.80665;
  CHECK(json["locators"][2]["seating_N"].get<double>() ==
        Approx((6000.0 * 20.0 + weight_N * 30.0) / 60.0).epsilon(1e-9));
  CHECK(json["unloading"]["free"] == true);
  CHECK(desk.dowel({"role", "WORK", "riser"}).exit_code == 0);
  const auto none = desk.dowel({"analyse"});
  CHECK(none.exit_code == 3);
  CHECK(none.err.find("role NAME workpiece") != std::string::npos);
}
