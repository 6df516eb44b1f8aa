// dowel catalog, run as its users run it.

#include <array>
#include <sstream>
#include <utility>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sys/stat.h>

#include "program.h"

namespace {

using Json = nlohmann::ordered_json;
using dowel::testing::ProgramResult;
using dowel::testing::run_dowel;
using dowel::testing::TemporaryFolder;
using dowel::testing::write_text;

/// A closed block as an OFF file; `height` is a number as text.
std::string block_off(const std::string& height) {
  const std::string h = " " + height + "\n";
  return "OFF\n8 12 0\n0 0 0\n80 0 0\n80 40 0\n0 40 0\n0 0" + h + "80 0" + h + "80 40" + h +
         "0 40" + h +
         "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n"
         "3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
}

/// A block of 100 x 60 x 20 along x with a groove of 12 x 8 in the middle of its top.
std::string grooved_off() {
  const std::vector<std::pair<int, int>> outline{{0, 0},   {60, 0},  {60, 20}, {36, 20},
                                                 {36, 12}, {24, 12}, {24, 20}, {0, 20}};
  std::string text = "OFF\n16 28 0\n";
  for (const char* x : {"0 ", "100 "}) {
    for (const auto& [y, z] : outline) {
      text += x + std::to_string(y) + " " + std::to_string(z) + "\n";
    }
  }
  for (int i = 0; i < 8; ++i) {
    const std::string a = std::to_string(i);
    const std::string b = std::to_string((i + 1) % 8);
    const std::string a_far = std::to_string(i + 8);
    const std::string b_far = std::to_string((i + 1) % 8 + 8);
    text += "3 " + a + " " + b_far + " " + a_far + "\n3 " + a + " " + b + " " + b_far + "\n";
  }
  const std::vector<std::array<int, 3>> cap{{0, 1, 4}, {1, 3, 4}, {1, 2, 3},
                                            {0, 4, 5}, {0, 5, 7}, {5, 6, 7}};
  for (const auto& [a, b, c] : cap) {
    const auto line = [](int p, int q, int r) {
      return "3 " + std::to_string(p) + " " + std::to_string(q) + " " + std::to_string(r) + "\n";
    };
    text += line(a, c, b) + line(a + 8, b + 8, c + 8);
  }
  return text;
}

std::vector<Json> json_lines(const std::string& text) {
  std::istringstream stream(text);
  std::vector<Json> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(Json::parse(line));
  return lines;
}

std::vector<std::string> keys_of(const Json& object) {
  std::vector<std::string> keys;
  for (const auto& item : object.items()) keys.push_back(item.key());
  return keys;
}

/// A folder with parts/block.off, parts/deep/slab.off and parts/bad.off.
class Parts : public TemporaryFolder {
 public:
  Parts() {
    std::filesystem::create_directories(*this / "parts/deep");
    write_text(*this / "parts/block.off", block_off("20"));
    write_text(*this / "parts/deep/slab.off", block_off("10.5"));
    write_text(*this / "parts/bad.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n");
    write_text(*this / "parts/notes.txt", "not a part");
  }
  ProgramResult dowel(const std::vector<std::string>& arguments) const {
    return run_dowel(arguments, {.folder = path()});
  }
  ProgramResult build(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments{"catalog", "build", "parts", "-o", "c.db", "--json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return dowel(arguments);
  }
};

}  // namespace

TEST_CASE("A build prints a line of JSON for each file, sorted, and goes on past a bad one") {
  const Parts parts;
  const ProgramResult result = parts.build();
  CAPTURE(result.out, result.err);
  CHECK(result.exit_code == 1);
  const auto lines = json_lines(result.out);
  REQUIRE(lines.size() == 3);
  CHECK(keys_of(lines[0]) == std::vector<std::string>{"file", "status", "reason", "seconds"});
  CHECK(lines[0]["file"] == "parts/bad.off");
  CHECK(lines[0]["status"] == "failed");
  CHECK(keys_of(lines[1]) ==
        std::vector<std::string>{"file", "status", "elements", "faces", "seconds"});
  CHECK(lines[1]["file"] == "parts/block.off");
  CHECK(lines[1]["status"] == "ok");
  CHECK(lines[1]["elements"] == Json({"block"}));
  CHECK(lines[2]["file"] == "parts/deep/slab.off");
  CHECK(lines[2]["elements"] == Json({"slab"}));
}

TEST_CASE("A second build reads what has changed and nothing else") {
  const Parts parts;
  REQUIRE(parts.build().exit_code == 1);
  write_text(parts / "parts/block.off", block_off("25"));
  const auto lines = json_lines(parts.build().out);
  REQUIRE(lines.size() == 3);
  CHECK(lines[0]["status"] == "failed");
  CHECK(lines[0]["seconds"] == 0.0);
  CHECK(lines[0]["reason"] != "");
  CHECK(lines[1]["status"] == "ok");
  CHECK(lines[2]["status"] == "unchanged");
  CHECK(lines[2]["elements"] == Json({"slab"}));
  const auto shown = json_lines(parts.dowel({"catalog", "show", "c.db", "block", "--json"}).out);
  CHECK(shown.at(0)["volume_mm3"].get<double>() == Approx(80'000.0).epsilon(1e-12));

  for (const Json& line : json_lines(parts.build({"--force"}).out)) {
    CHECK(line["status"] != "unchanged");
  }
}

TEST_CASE("A build without failures exits with 0") {
  const Parts parts;
  std::filesystem::remove(parts / "parts/bad.off");
  CHECK(parts.build().exit_code == 0);
  CHECK(parts.build().exit_code == 0);
  const ProgramResult plain = parts.dowel({"catalog", "build", "parts", "-o", "c.db"});
  CHECK(plain.exit_code == 0);
  CHECK_THAT(plain.out, Catch::Contains("2 files, 2 elements: 0 ok, 2 unchanged"));
  CHECK(plain.err.empty());
}

TEST_CASE("A file that several paths lead to is read once") {
  const Parts parts;
  const ProgramResult result = parts.dowel({"catalog", "build", "parts/block.off", "parts",
                                            "./parts/deep/../block.off", "-o", "c.db", "--json"});
  CHECK(json_lines(result.out).size() == 3);
}

TEST_CASE("A folder is the same source however its path is written") {
  const Parts parts;
  REQUIRE(parts.build().exit_code == 1);
  const ProgramResult again =
      parts.dowel({"catalog", "build", "./parts/deep/../", "-o", "c.db", "--json"});
  const auto lines = json_lines(again.out);
  REQUIRE(lines.size() == 3);
  CHECK(lines[1]["file"] == "parts/block.off");
  CHECK(lines[1]["status"] == "unchanged");
}

TEST_CASE("The catalogue is the same for any number of jobs", "[determinism]") {
  const Parts parts;
  const auto bytes_with = [&parts](const std::string& jobs) {
    const std::string name = jobs + ".db";
    parts.dowel({"catalog", "build", "parts", "-o", name, "--jobs", jobs});
    return dowel::testing::read_text(parts / name);
  };
  CHECK(bytes_with("1") == bytes_with("3"));
}

TEST_CASE("Where nothing can be read, a build exits with 3 and makes nothing", "[fault]") {
  const Parts parts;
  SECTION("a missing path") {
    const ProgramResult result = parts.dowel({"catalog", "build", "no.step", "-o", "c.db"});
    CHECK(result.exit_code == 3);
    CHECK_THAT(result.out, Catch::Contains("no.step") && Catch::Contains("no such file"));
    CHECK_FALSE(std::filesystem::exists(parts / "c.db"));
  }
  SECTION("a folder without parts") {
    std::filesystem::create_directory(parts / "empty");
    CHECK(parts.dowel({"catalog", "build", "empty", "-o", "c.db"}).exit_code == 3);
    CHECK_FALSE(std::filesystem::exists(parts / "c.db"));
  }
  SECTION("a file of another kind") {
    CHECK(parts.dowel({"catalog", "build", "parts/notes.txt", "-o", "c.db"}).exit_code == 3);
  }
  SECTION("a pipe") {
    REQUIRE(::mkfifo((parts / "pipe.step").c_str(), 0600) == 0);
    CHECK(parts.dowel({"catalog", "build", "pipe.step", "-o", "c.db"}).exit_code == 3);
  }
  SECTION("an output that is no catalogue") {
    const ProgramResult result =
        parts.dowel({"catalog", "build", "parts", "-o", "parts/notes.txt"});
    CHECK(result.exit_code == 3);
    CHECK_THAT(result.err, Catch::Contains("parts/notes.txt: is not an element catalogue"));
    CHECK(dowel::testing::read_text(parts / "parts/notes.txt") == "not a part");
  }
  SECTION("an output in a folder that is missing") {
    CHECK(parts.dowel({"catalog", "build", "parts", "-o", "no/c.db"}).exit_code == 3);
  }
}

TEST_CASE("A missing path beside good ones is one failure") {
  const Parts parts;
  const ProgramResult result =
      parts.dowel({"catalog", "build", "no.step", "parts/block.off", "-o", "c.db", "--json"});
  CHECK(result.exit_code == 1);
  const auto lines = json_lines(result.out);
  REQUIRE(lines.size() == 2);
  CHECK(lines[0]["status"] == "failed");
  CHECK(lines[1]["status"] == "ok");
}

TEST_CASE("An element is shown with the documented keys in their order") {
  const Parts parts;
  parts.build();
  const ProgramResult result = parts.dowel({"catalog", "show", "c.db", "block", "--json"});
  CHECK(result.exit_code == 0);
  const Json shown = json_lines(result.out).at(0);
  auto keys = keys_of(shown);
  REQUIRE(keys.size() >= 13);
  keys.resize(13);
  CHECK(keys == std::vector<std::string>{"name", "family", "shape", "unit_in_file", "source",
                                         "sha256", "solids", "volume_mm3", "surface_mm2", "obb",
                                         "triangles", "facet_error_mm", "features"});
  CHECK(shown["name"] == "block");
  CHECK(shown["source"] == "parts/block.off");
  // From sha256sum of the same bytes.
  CHECK(shown["sha256"] == "b7f366731c19576caa4334678e4575951ff65808f15eac03a8049ca02a59369e");
  CHECK(shown["solids"] == 1);
  CHECK(shown["volume_mm3"].get<double>() == Approx(64'000.0).epsilon(1e-12));
  CHECK(shown["surface_mm2"].get<double>() == Approx(11'200.0).epsilon(1e-12));
  CHECK(shown["shape"] == "block");
  CHECK(keys_of(shown["obb"]) == std::vector<std::string>{"center", "axes", "half_extents"});
  CHECK(shown["obb"]["center"] == Json({40.0, 20.0, 10.0}));
  CHECK(shown["obb"]["half_extents"] == Json({40.0, 20.0, 10.0}));
  CHECK(shown["obb"]["axes"] == Json({{1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, 1.0}}));
  CHECK(shown["triangles"] == Json({{"total", 12}, {"plane", 12}, {"hole", 0}, {"other", 0}}));
  CHECK(shown["facet_error_mm"] == 0.0);
  REQUIRE(shown["features"].size() == 6);
  for (const Json& feature : shown["features"]) {
    CHECK(keys_of(feature) ==
          std::vector<std::string>{"name", "kind", "axis", "area_mm2", "on_hull", "outline"});
    CHECK(feature["on_hull"] == true);
    CHECK(feature["outline"]["inner"].empty());
    REQUIRE(feature["outline"]["outer"].size() == 4);
    const Json& edge = feature["outline"]["outer"][0];
    CHECK(keys_of(edge) == std::vector<std::string>{"type", "from", "to"});
    CHECK(edge["type"] == "line");
    CHECK(feature["kind"] == "face");
    CHECK(keys_of(feature["axis"]) == std::vector<std::string>{"origin", "direction"});
  }
}

TEST_CASE("A slot is shown with its width, run and ends, and found by its width") {
  const Parts parts;
  write_text(parts / "parts/grooved.off", grooved_off());
  parts.build();
  const ProgramResult result = parts.dowel({"catalog", "show", "c.db", "grooved", "--json"});
  REQUIRE(result.exit_code == 0);
  const Json slot = json_lines(result.out).at(0)["features"].back();
  CHECK(slot == Json({{"name", "slot1"},
                      {"kind", "slot"},
                      {"type", "plain"},
                      {"width", 12.0},
                      {"depth", 8.0},
                      {"axis", {{"origin", {50.0, 30.0, 20.0}}, {"direction", {0.0, 0.0, -1.0}}}},
                      {"through", false},
                      {"entry", nullptr},
                      {"run", {1.0, 0.0, 0.0}},
                      {"length", 100.0},
                      {"ends", {"open", "open"}}}));
  const ProgramResult text = parts.dowel({"catalog", "show", "c.db", "grooved"});
  CHECK_THAT(text.out, Catch::Contains("slot1") && Catch::Contains("plain, 100 along"));
  const auto found = [&](const char* term) {
    return parts.dowel({"catalog", "search", "c.db", term, "--json"}).out;
  };
  CHECK_THAT(found("slot=12"), Catch::Contains("\"grooved\""));
  CHECK_THAT(found("slot1"), Catch::Contains("\"grooved\""));
  CHECK(found("slot<12").empty());
}

TEST_CASE("A name that is not there gets a guess") {
  const Parts parts;
  parts.build();
  const ProgramResult result = parts.dowel({"catalog", "show", "c.db", "blok", "--json"});
  CHECK(result.exit_code == 3);
  CHECK(result.out.empty());
  CHECK_THAT(result.err, Catch::Contains("c.db") && Catch::Contains("did you mean \"block\"?"));
}

TEST_CASE("Elements are listed and searched by words and sizes") {
  const Parts parts;
  parts.build();
  const auto names = [&parts](std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), "catalog");
    arguments.emplace_back("--json");
    const ProgramResult result = parts.dowel(arguments);
    CHECK(result.exit_code == 0);
    std::vector<std::string> found;
    for (const Json& line : json_lines(result.out)) found.push_back(line["name"]);
    return found;
  };
  using Names = std::vector<std::string>;
  CHECK(names({"list", "c.db"}) == Names{"block", "slab"});
  CHECK(names({"search", "c.db", "LAB"}) == Names{"slab"});
  CHECK(names({"search", "c.db", "height>=15"}) == Names{"block"});
  CHECK(names({"search", "c.db", "height=10..11"}) == Names{"slab"});
  CHECK(names({"search", "c.db", "hole=12"}).empty());
  CHECK(parts.dowel({"catalog", "search", "c.db", "height>=x"}).exit_code == 3);
  const ProgramResult table = parts.dowel({"catalog", "list", "c.db"});
  CHECK_THAT(table.out, Catch::Contains("80 x 40 x 10.5") && Catch::Contains("2 elements"));
}

TEST_CASE("A lint exits with 1 only where a finding reaches the gate") {
  const Parts parts;
  parts.build();
  const ProgramResult warned = parts.dowel({"catalog", "lint", "c.db", "--json"});
  CAPTURE(warned.out);
  CHECK(warned.exit_code == 0);
  const auto lines = json_lines(warned.out);
  REQUIRE(lines.size() == 3);
  CHECK(lines[0]["rule"] == "CAT-06");
  CHECK(lines[0]["severity"] == "warning");
  CHECK(lines.back()["summary"] == Json({{"elements", 2}, {"errors", 0}, {"warnings", 2}}));
  CHECK(parts.dowel({"catalog", "lint", "c.db", "--gate", "warning"}).exit_code == 1);

  parts.build({"--licence", "CC0-1.0"});
  CHECK(parts.dowel({"catalog", "lint", "c.db", "--gate", "warning"}).exit_code == 0);
  parts.build({"--force"});  // keeps the licence
  CHECK(parts.dowel({"catalog", "lint", "c.db", "--gate", "warning"}).exit_code == 0);

  write_text(parts / "parts/huge.off", block_off("1e5"));
  parts.build();
  CHECK(parts.dowel({"catalog", "lint", "c.db"}).exit_code == 1);
}

TEST_CASE("Catalogues that cannot be read are errors of the input", "[fault]") {
  const Parts parts;
  for (const char* file : {"missing.db", "parts", "parts/notes.txt"}) {
    for (const char* verb : {"list", "lint"}) {
      CAPTURE(file, verb);
      const ProgramResult result = parts.dowel({"catalog", verb, file, "--json"});
      CHECK(result.exit_code == 3);
      CHECK(result.out.empty());
      CHECK_THAT(result.err, Catch::Contains(file));
    }
  }
}

TEST_CASE("A wrong command line exits with 2", "[fault]") {
  const Parts parts;
  using Arguments = std::vector<std::string>;
  for (const Arguments& arguments : {Arguments{"catalog"},
                                     {"catalog", "frobnicate"},
                                     {"catalog", "build", "parts"},
                                     {"catalog", "build", "-o", "c.db"},
                                     {"catalog", "build", "parts", "-o", "c", "--jobs", "0"},
                                     {"catalog", "show", "c.db"},
                                     {"catalog", "lint", "c.db", "--gate", "none"}}) {
    CHECK(parts.dowel(arguments).exit_code == 2);
  }
}

TEST_CASE("Names that are no UTF-8 do not break the JSON") {
  const Parts parts;
  write_text(parts / "parts/\xff\n.off", block_off("30"));
  const ProgramResult build = parts.build();
  CHECK(json_lines(build.out).size() == 4);
  const ProgramResult list = parts.dowel({"catalog", "list", "c.db", "--json"});
  CHECK(list.exit_code == 0);
  CHECK(json_lines(list.out).size() == 3);
}

TEST_CASE("A full disk under standard output is an error", "[fault]") {
  const Parts parts;
  parts.build();
  const ProgramResult result = run_dowel({"catalog", "list", "c.db", "--json"},
                                         {.folder = parts.path(), .out = "/dev/full"});
  CHECK(result.exit_code == 3);
  CHECK_THAT(result.err, Catch::Contains("standard output"));
}
