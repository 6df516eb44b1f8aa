// The console through the program: scripts, verbs, exit codes.

#include <csignal>
#include <sstream>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "../assembly/fixture_elements.h"
#include "program.h"

using Json = nlohmann::json;
namespace testing = dowel::testing;

namespace {

/// A folder with the fixture catalogue, in which the program runs.
struct Desk {
  testing::TemporaryFolder folder;

  Desk() { testing::write_fixture_catalog(folder / "catalog.db"); }

  testing::ProgramResult dowel(const std::vector<std::string>& arguments,
                               const std::string& input = {}) const {
    testing::ProgramOptions options;
    options.folder = folder.path();
    options.input = input;
    return testing::run_dowel(arguments, options);
  }

  testing::ProgramResult script(const std::string& text, std::vector<std::string> more = {}) const {
    testing::write_text(folder / "job.dowel", text);
    std::vector<std::string> arguments{"run", "job.dowel", "--catalog", "catalog.db"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return dowel(arguments);
  }
};

std::vector<Json> json_lines(const std::string& text) {
  std::vector<Json> lines;
  std::istringstream stream(text);
  std::string line;
  while (std::getline(stream, line)) lines.push_back(Json::parse(line));
  return lines;
}

/// A plate with two risers and a screw, all seated.
constexpr const char* kFixture = R"(# a small fixture
place T/plate-5x3 as PLATE
ground PLATE
place T/riser-60x60x40 at 0 0 300   # above
insert RISER1.h1 into PLATE.B2
place T/riser-60x60x40 at 0 0 300
insert RISER2.h1 into PLATE.B4 rot 90
place T/screw-M12x65 at 0 0 400
insert SCREW1.pin1 into RISER1.h1
)";

}  // namespace

TEST_CASE("a script builds a fixture, and check finds nothing wrong with it") {
  const Desk desk;
  const auto result =
      desk.script(std::string(kFixture) + "check\nbom bom.csv\nlist\n", {"--project", "a.dwp"});
  INFO(result.out << result.err);
  CHECK(result.exit_code == 0);
  CHECK(result.err.empty());
  CHECK(result.out.find("4 instances: 0 interferences") != std::string::npos);
  CHECK(testing::read_text(desk.folder / "bom.csv") ==
        "count,name,family,instances\r\n"
        "1,T/plate-5x3,T,PLATE\r\n"
        "2,T/riser-60x60x40,T,RISER1 RISER2\r\n"
        "1,T/screw-M12x65,T,SCREW1\r\n");
  CHECK(desk.dowel({"check", "--project", "a.dwp"}).exit_code == 0);
}

TEST_CASE("with --json each command is one object with pose, verdict and pairs") {
  const Desk desk;
  const auto result = desk.script(kFixture, {"--json"});
  CHECK(result.exit_code == 0);
  const std::vector<Json> lines = json_lines(result.out);
  REQUIRE(lines.size() == 8);
  CHECK(lines[0]["command"] == "place");
  CHECK(lines[0]["line"] == 2);
  CHECK(lines[0]["instance"] == "PLATE");
  CHECK(lines[3]["outcome"] == "done");
  CHECK(lines[3]["verdict"] == "contact");
  CHECK(lines[3]["pairs"][0]["with"] == "PLATE");
  CHECK(lines[3]["pose"]["t"] == Json({-40.0, 0.0, 40.0}));
  CHECK(lines[3]["mate"]["kind"] == "hole on hole");
  CHECK(lines[7]["mate"]["moving"] == "SCREW1.pin1");
}

TEST_CASE("the verbs do on a project what the script does") {
  const Desk desk;
  CHECK(desk.dowel({"new", "v.dwp"}).exit_code == 0);
  CHECK(desk.dowel({"place", "--project", "v.dwp", "--catalog", "catalog.db", "T/block-40", "as",
                    "A", "at", "-10", "-20.5", "-3e1"})
            .exit_code == 0);
  CHECK(desk.dowel({"do", "--project", "v.dwp", "place", "T/block-40", "as", "B", "at", "90",
                    "-20.5", "-30"})
            .exit_code == 0);
  const auto moved =
      desk.dowel({"move", "B", "by", "-60", "0", "0", "--project", "v.dwp", "--json"});
  CHECK(moved.exit_code == 0);
  const Json reply = Json::parse(moved.out);
  CHECK(reply["outcome"] == "done");
  CHECK(reply["verdict"] == "contact");
  const auto refused = desk.dowel({"move", "B", "by", "-1", "0", "0", "--project", "v.dwp"});
  CHECK(refused.exit_code == 0);
  CHECK(refused.out.find("refused, interference with A (depth") != std::string::npos);
  CHECK(desk.dowel({"mode", "--project", "v.dwp", "off"}).exit_code == 0);
  CHECK(desk.dowel({"move", "B", "by", "-1", "0", "0", "--project", "v.dwp"}).exit_code == 0);
  const auto check = desk.dowel({"check", "--project", "v.dwp", "--json"});
  CHECK(check.exit_code == 1);
  const Json found = Json::parse(check.out);
  CHECK(found["verdict"] == "interference");
  CHECK(found["interferences"] == 1);
  CHECK(found["pairs"][0]["instance"] == "A");
  CHECK(found["pairs"][0]["with"] == "B");
  CHECK(desk.dowel({"undo", "2", "--project", "v.dwp"}).exit_code == 0);
  CHECK(desk.dowel({"check", "--project", "v.dwp"}).exit_code == 0);
  CHECK(desk.dowel({"check", "--project", "missing.dwp"}).exit_code == 3);
  CHECK(desk.dowel({"check"}).exit_code == 2);
}

TEST_CASE("project and catalogue may be named before the word as well as after it") {
  const Desk desk;
  testing::write_text(desk.folder / "job.dowel", "place T/plate-5x3 as PLATE\n");
  const std::vector<std::string> where{"--catalog", "catalog.db", "--project", "f.dowelproj"};
  std::vector<std::string> arguments = where;
  arguments.insert(arguments.end(), {"run", "job.dowel"});
  const auto result = desk.dowel(arguments);
  CHECK(result.exit_code == 0);
  CHECK(result.out.find("PLATE: placed") != std::string::npos);
  const auto listed = desk.dowel({"--project", "f.dowelproj", "bom"});
  CHECK(listed.exit_code == 0);
  CHECK(listed.out.find("T/plate-5x3") != std::string::npos);
  // A verb without a project has nothing to work on.
  CHECK(desk.dowel({"bom"}).exit_code == 2);
}

TEST_CASE("bad lines name file, line and column, and what was expected") {
  struct Case {
    const char* line;
    const char* place;
    const char* message;
  };
  const Desk desk;
  const std::vector<Case> cases{
      {"plaec T/block-40", "1:1", "did you mean place?"},
      {"  place T/blok-40", "1:9", "did you mean T/block-40"},
      {"place", "1:1", "expected an element"},
      {"place T/block-40 at 1 2", "1:23", "expected three coordinates"},
      {"place T/block-40 at 1 2 nan", "1:25", "expected three coordinates"},
      {"place T/block-40 at 1 2 1e999", "1:25", "expected three coordinates"},
      {"place T/block-40 at 1 2 1e6", "1:1", "beyond"},
      {"place T/block-40 as a.b", "1:1", "dot"},
      {"place T/block-40 sideways", "1:18", "expected `as`, `at`, `on`, `pattern` or `rot`"},
      {"place T/block-40 rot 90 rot 90", "1:25", "each once"},
      {"place T/block-40 rot 400", "1:22", "at most 360"},
      {"place T/block-40 at NOBODY.top", "1:21", "no instance is called \"NOBODY\""},
      {"place \"T/block-40", "1:7", "quote is not closed"},
      {"insert A.b", "1:8", "no instance is called \"A\""},
      {"move X by 1 2 3", "1:6", "no instance is called \"X\""},
      {"rotate X 90", "1:8", "no instance is called \"X\""},
      {"undo 0", "1:6", "expected how many"},
      {"undo 1.5", "1:6", "expected how many"},
      {"mode sometimes", "1:6", "expected block, warn or off"},
      {"tolerance 0", "1:11", "out of range"},
      {"tolerance 1 2", "1:13", "expected the end"},
      {"open missing.dwp", "1:6", "no such file"},
      {"open catalog.db", "1:6", "is not a dowel project"},
      {"catalog missing.db", "1:9", "missing.db"},
      {"export a.xyz", "1:8", "unknown ending"},
      {"save", "1:1", "expected a file"},
      {"save catalog.db", "1:6", "is not a dowel project"},
      {"bom parts.txt", "1:5", "ends in .csv"},
      {"list features NONE", "1:15", "no instance or element"},
      {"help plaec", "1:6", "did you mean place?"},
      {"expect trouble list", "1:8", "expected clear"},
      {"expect clear", "1:8", "expected a command"},
      {"ground", "1:1", "expected an instance"},
  };
  const std::string catalog = testing::read_text(desk.folder / "catalog.db");
  for (const Case& c : cases) {
    CAPTURE(c.line);
    const auto result = desk.script(c.line);
    CHECK(result.exit_code == 3);
    CHECK(result.out.empty());
    INFO(result.err);
    CHECK(result.err.starts_with("job.dowel:" + std::string(c.place) + ": error: "));
    CHECK(result.err.find(c.message) != std::string::npos);
  }
  CHECK(testing::read_text(desk.folder / "catalog.db") == catalog);
}

TEST_CASE("a script stops at its first error and keeps what was done, or goes on") {
  const Desk desk;
  const std::string text = "place T/block-40 as A\nplace T/blok\nplace T/block-40 as B at 99 0 0\n";
  const auto stopped = desk.script(text, {"--project", "a.dwp"});
  CHECK(stopped.exit_code == 3);
  CHECK(stopped.err.find("job.dowel:2:7: error: ") == 0);
  CHECK(stopped.err.find("stopped; 1 command before it stays done") != std::string::npos);
  CHECK(Json::parse(desk.dowel({"list", "--project", "a.dwp", "--json"}).out)["instances"].size() ==
        1);

  const auto gone_on = desk.script(text, {"--project", "b.dwp", "--keep-going", "--json"});
  CHECK(gone_on.exit_code == 3);
  const auto lines = json_lines(gone_on.out);
  REQUIRE(lines.size() == 3);
  CHECK(lines[1]["outcome"] == "error");
  CHECK(lines[1]["column"] == 7);
  CHECK(Json::parse(desk.dowel({"list", "--project", "b.dwp", "--json"}).out)["instances"].size() ==
        2);
}

TEST_CASE("a script with a line that is no command changes nothing", "[fault]") {
  const Desk desk;
  const auto result =
      desk.script("place T/block-40 as A\nplaec T/block-40\n", {"--project", "a.dwp"});
  CHECK(result.exit_code == 3);
  CHECK(result.out.empty());
  CHECK(result.err ==
        "job.dowel:2:1: error: unknown command \"plaec\"; did you mean place?\n"
        "job.dowel: nothing of it was run\n");
  CHECK_FALSE(std::filesystem::exists(desk.folder / "a.dwp"));
  CHECK(desk.script("place T/block-40\nquit\nno more commands\n").exit_code == 0);
  const auto gone_on = desk.script("plaec\nplace T/block-40\n", {"--keep-going"});
  CHECK(gone_on.exit_code == 3);
  CHECK(gone_on.out.find("BLOCK1: placed") == 0);
}

TEST_CASE("expect turns an outcome into a test") {
  const Desk desk;
  const std::string start = "place T/block-40 as A\nplace T/block-40 as B at 40 0 0\n";
  CHECK(desk.script(start + "expect refused move B by -5 0 0\nexpect contact move B by 0 1 0\n"
                            "expect clear move B by 5 0 0\nexpect error move C by 1 0 0\n"
                            "expect clear check\nmode warn\nexpect interference move B by -9 0 0\n"
                            "expect interference check\n")
            .exit_code == 0);
  const auto failed = desk.script(start + "expect clear move B by -5 0 0\nlist\n");
  CHECK(failed.exit_code == 1);
  CHECK(failed.out.find("expected clear, got refused") != std::string::npos);
  CHECK(failed.err.find("job.dowel:3:1: error: ") == 0);
  CHECK(failed.out.find("place ") == std::string::npos);
  CHECK(desk.script(start + "mode off\nmove B by -5 0 0\ncheck\nlist\n").exit_code == 1);
}

TEST_CASE("the journal as a script makes the same instances anew") {
  const Desk desk;
  const auto first = desk.script(std::string(kFixture) +
                                     "move RISER2 by 0 0 12.25\nundo\nrotate RISER2 1\n"
                                     "move SCREW1 along z 0.25\nexport job2.dowel\n",
                                 {"--project", "a.dwp"});
  INFO(first.err);
  REQUIRE(first.exit_code == 0);
  CHECK(desk.dowel({"run", "job2.dowel", "--project", "b.dwp", "--catalog", "catalog.db"})
            .exit_code == 0);
  const auto list = [&](const std::string& project, const std::string& what) {
    return desk.dowel({"list", what, "--project", project, "--json"}).out;
  };
  CHECK(list("a.dwp", "instances") == list("b.dwp", "instances"));
  CHECK(list("a.dwp", "mates") == list("b.dwp", "mates"));
  CHECK_FALSE(list("a.dwp", "instances").empty());
}

TEST_CASE("names with blanks, dots and quotes survive the console and the journal") {
  const Desk desk;
  {
    dowel::Catalog catalog(desk.folder / "catalog.db", dowel::Catalog::Access::ReadWrite);
    auto odd = testing::block_element();
    odd.element.name = "odd/a \"b\" c.d #1";
    dowel::SourceRecord source;
    source.path = "odd.step";
    source.status = "ok";
    const std::vector<dowel::ElementRecord> records{{odd.element, *odd.solid, {}}};
    catalog.put(source, records);
  }
  const auto result = desk.script(
      "place \"odd/a \\\"b\\\" c.d #1\" as Größe at 0 0 0 # comment\nplace 'odd/a \"b\" c.d #1' at "
      "50 0 0\n"
      "export again.dowel\nbom bom.csv\n");
  INFO(result.err);
  REQUIRE(result.exit_code == 0);
  CHECK(testing::read_text(desk.folder / "bom.csv").find("2,\"odd/a \"\"b\"\" c.d #1\",") !=
        std::string::npos);
  CHECK(desk.dowel({"run", "again.dowel", "--catalog", "catalog.db"}).exit_code == 0);
}

TEST_CASE("dowel alone reads commands from standard input like a script") {
  const Desk desk;
  const auto result =
      desk.dowel({"--catalog", "catalog.db"}, "place T/block-40\nlist\nquit\nnonsense\n");
  CHECK(result.exit_code == 0);
  CHECK(result.out.find("BLOCK1: placed at 0 0 0, clear") == 0);
  const auto bad = desk.dowel({}, "\n\nnonsense\n");
  CHECK(bad.exit_code == 3);
  CHECK(bad.err.find("<stdin>:3:1: error: unknown command \"nonsense\"") == 0);
  CHECK(desk.dowel({}, "").exit_code == 0);
}

TEST_CASE("every example of the help is a line that the console understands") {
  const Desk desk;
  const auto all = desk.dowel({"run", "-", "--json"}, "help\n");
  REQUIRE(all.exit_code == 0);
  std::size_t examples = 0;
  const Json reply = Json::parse(all.out);
  for (const Json& word : reply["commands"]) {
    const auto one = desk.dowel({"run", "-", "--json"}, "help " + word.get<std::string>() + "\n");
    const std::string example = Json::parse(one.out)["example"];
    CAPTURE(example);
    CHECK(example.starts_with(word.get<std::string>()));
    // Names in it are nobody's here; the words must be right all the same.
    const auto run = desk.dowel({"run", "-"}, example + "\n");
    CHECK(run.err.find("unknown command") == std::string::npos);
    CHECK(run.err.find("expected") == std::string::npos);
    CHECK((run.exit_code == 0 || run.exit_code == 3));
    ++examples;
  }
  CHECK(examples == 49);
}

TEST_CASE("exports appear whole, and a disk without room damages nothing", "[fault]") {
  const Desk desk;
  REQUIRE(desk.script(kFixture, {"--project", "a.dwp"}).exit_code == 0);
  CHECK(desk.dowel({"export", "a.glb", "--project", "a.dwp"}).exit_code == 0);
  CHECK(testing::read_text(desk.folder / "a.glb").substr(0, 4) == "glTF");
  CHECK(desk.dowel({"export", "a.html", "--project", "a.dwp"}).exit_code == 0);
  CHECK(testing::read_text(desk.folder / "a.html").find("</html>") != std::string::npos);
  const auto step = desk.dowel({"export", "a.step", "--project", "a.dwp"});
  CHECK(step.exit_code == 3);
  CHECK(step.err.find("has no boundary representation") != std::string::npos);

  const std::string project = testing::read_text(desk.folder / "a.dwp");
  const std::string catalog = testing::read_text(desk.folder / "catalog.db");
  rlimit old{};
  REQUIRE(::getrlimit(RLIMIT_FSIZE, &old) == 0);
  const auto before = std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{4096, old.rlim_max};
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &small) == 0);
  const auto placed = desk.dowel({"place", "--project", "a.dwp", "--catalog", "catalog.db",
                                  "T/pin-12", "at", "500", "0", "0"});
  const auto page = desk.dowel({"export", "b.html", "--project", "a.dwp"});
  const auto created = desk.dowel({"new", "c.dwp"});
  REQUIRE(::setrlimit(RLIMIT_FSIZE, &old) == 0);
  std::signal(SIGXFSZ, before);

  for (const auto* result : {&placed, &page, &created}) {
    INFO(result->err);
    CHECK(result->exit_code == 3);
    CHECK(result->signal == 0);
    CHECK(result->err.find("error: ") != std::string::npos);
  }
  CHECK(created.err.find("error: c.dwp: ") != std::string::npos);
  CHECK_FALSE(std::filesystem::exists(desk.folder / "b.html"));
  CHECK_FALSE(std::filesystem::exists(desk.folder / "c.dwp"));
  CHECK(testing::read_text(desk.folder / "catalog.db") == catalog);
  CHECK(Json::parse(desk.dowel({"list", "--project", "a.dwp", "--json"}).out)["instances"].size() ==
        4);
}
