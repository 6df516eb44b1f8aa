// STEP files through dowel catalog build: damaged ones, ones with warnings, real ones.

#include <csignal>
#include <map>
#include <set>
#include <sstream>
#include <utility>
#include <variant>

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

#include "dowel/catalog/catalog.h"
#include "library/builders.h"
#include "library/write_library.h"
#include "program.h"

namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;
using dowel::Catalog;
using dowel::testing::ProgramResult;
using dowel::testing::read_text;
using dowel::testing::TemporaryFolder;
using dowel::testing::write_text;

constexpr const char* kSpacer = "H40-12/spacer-10";

std::vector<Json> lines_of(const ProgramResult& result) {
  std::istringstream stream(result.out);
  std::vector<Json> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(Json::parse(line));
  return lines;
}

/// A folder with a sound part.step, which is a spacer with one hole.
class Bench : public TemporaryFolder {
 public:
  Bench() { add_spacer(kSpacer, "part.step"); }
  void add_spacer(const std::string& name, const std::string& file) const {
    std::vector<dowel::library::Part> parts =
        dowel::library::spacers(dowel::library::system_called("H40-12"));
    std::erase_if(parts, [&](const auto& part) { return part.name != name; });
    dowel::library::write_library(path() / name, parts);
    fs::copy_file(path() / name / dowel::library::file_name(parts.at(0)), *this / file);
  }
  ProgramResult dowel(const std::vector<std::string>& arguments) const {
    return dowel::testing::run_dowel(arguments, {.folder = path()});
  }
  /// The only line of a build of `file` into c.db.
  Json build(const std::string& file) const {
    return lines_of(dowel({"catalog", "build", file, "-o", "c.db", "--json"})).at(0);
  }
};

/// Caps the size of files that programs write, as a disk without room does, while it lives.
class SmallDisk {
 public:
  explicit SmallDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    if (::getrlimit(RLIMIT_FSIZE, &old_) != 0) throw std::runtime_error("getrlimit failed");
    const rlimit small{bytes, old_.rlim_max};
    if (::setrlimit(RLIMIT_FSIZE, &small) != 0) throw std::runtime_error("setrlimit failed");
  }
  ~SmallDisk() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, handler_);
  }
  SmallDisk(const SmallDisk&) = delete;
  SmallDisk& operator=(const SmallDisk&) = delete;

 private:
  rlimit old_{};
  sighandler_t handler_;
};

bool has_real_files() {
  if (fs::exists(fs::path(DOWEL_SHARED_STEP) / "MANIFEST.tsv")) return true;
  WARN("no folder of real STEP files here: " << DOWEL_SHARED_STEP);
  return false;
}

std::size_t holes_in(const dowel::Element& element) {
  return static_cast<std::size_t>(
      std::ranges::count(element.features, dowel::FeatureKind::Hole, &dowel::Feature::kind));
}

}  // namespace

TEST_CASE("files that are no sound STEP fail with place and expectation", "[fault]") {
  const Bench bench;
  const std::string whole = read_text(bench / "part.step");
  write_text(bench / "cut.step", std::string_view(whole).substr(0, whole.size() / 2));
  write_text(bench / "empty.step", "");
  write_text(bench / "letter.step", "Dear Sir or Madam");
  struct Case {
    const char* file;
    const char* reason;
  };
  for (const Case& c : std::vector<Case>{
           {"missing.step", "no such file or folder"},
           {"cut.step", "the STEP reader refuses it: Line "},
           {"empty.step", "is empty, expected a STEP file"},
           {"letter.step", "not a STEP file: expected \"ISO-10303-21\" at its beginning"}}) {
    CAPTURE(c.file);
    const ProgramResult result = bench.dowel({"catalog", "build", c.file, "-o", "new.db"});
    INFO(result.out);
    CHECK(result.exit_code == 3);
    CHECK(result.out.find("failed     " + std::string(c.file) + ": " + c.reason) == 0);
    CHECK_FALSE(fs::exists(bench / "new.db"));
  }
}

TEST_CASE("a file that fails now keeps the elements that it gave before", "[fault]") {
  const Bench bench;
  REQUIRE(bench.build("part.step")["status"] == "ok");
  const std::string catalog = read_text(bench / "c.db");
  const std::string whole = read_text(bench / "part.step");
  write_text(bench / "part.step", std::string_view(whole).substr(0, whole.size() / 2));
  for (int i = 0; i < 2; ++i) {
    const Json line = bench.build("part.step");
    CHECK(line["status"] == "failed");
    CHECK_THAT(line["reason"].get<std::string>(),
               Catch::Contains("the catalogue keeps what this file gave before"));
  }
  CHECK(read_text(bench / "c.db") == catalog);
  write_text(bench / "part.step", whole);
  CHECK(bench.build("part.step")["status"] == "unchanged");
}

TEST_CASE("what the reader goes on past is told as warnings") {
  const Bench bench;
  CHECK_FALSE(bench.build("part.step").contains("warnings"));
  std::string text = read_text(bench / "part.step");
  // A name that is a number, which the format does not allow.
  const std::string sound = "ADVANCED_FACE('',";
  for (auto at = text.find(sound); at != std::string::npos; at = text.find(sound, at)) {
    text.replace(at, sound.size(), "ADVANCED_FACE(12,");
  }
  write_text(bench / "odd.step", text);
  const Json line = bench.build("odd.step");
  CHECK(line["status"] == "ok");
  REQUIRE(line["warnings"].size() > 3);
  CHECK_THAT(line["warnings"][0].get<std::string>(), Catch::Matches("#[0-9]+: .*name.*"));
  const ProgramResult plain = bench.dowel({"catalog", "build", "odd.step", "-o", "d.db"});
  CHECK_THAT(plain.out, Catch::Contains("warning #") && Catch::Contains("--json tells all"));
}

TEST_CASE("a disk without room leaves the catalogue as it was", "[fault]") {
  const Bench bench;
  REQUIRE(bench.build("part.step")["status"] == "ok");
  const std::string catalog = read_text(bench / "c.db");
  bench.add_spacer("H40-12/spacer-30", "other.step");
  ProgramResult full;
  {
    const SmallDisk disk(catalog.size());
    full = bench.dowel({"catalog", "build", "other.step", "-o", "c.db"});
  }
  CAPTURE(full.out, full.err);
  CHECK(full.exit_code == 3);
  CHECK(full.err.find("dowel: error: c.db: ") == 0);
  CHECK(Catalog(bench / "c.db", Catalog::Access::ReadOnly).names() ==
        std::vector<std::string>{kSpacer});
  CHECK(bench.build("other.step")["status"] == "ok");
}

TEST_CASE("real STEP files show the holes that their geometry has") {
  if (!has_real_files()) return;
  // Counted in the files: axes with full inner cylinders that nothing fills.
  const std::map<std::string, std::size_t> expected{
      {"fcl2015/608ZZ_Ball_Bearing.step", 1},
      {"fcl2015/ANSI-ASME-B18.2.2_Hex_Nut_1_4-20.stp", 1},
      {"fcl2015/DIN463_M20TabWasher.step", 1},
      {"fcl2015/DIN7349_M5FlatWasher.step", 1},
      {"fcl2015/DN15_Stamped_Flange.step", 5},
      {"fcl2015/ISO4017_Hex_Head_Cap_Screw_M6x25.step", 0},
      {"fcl2015/ISO4032_Hex_Nut_M10.step", 1},
      {"fcl2015/ISO4032_Hex_Nut_M6.step", 1},
      {"fcl2015/ISO4032_Hex_Nut_M8.step", 1},
      {"fcl2015/ISO4762_Hex_Socket_Head_Cap_Screw_M3x10.step", 0},
      {"fcl2015/ISO4762_Hex_Socket_Head_Cap_Screw_M6x12.step", 0},
      {"fcl2015/ISO7091DIN126_CLASS_C_M33FlatWasher.step", 1},
      {"fcl2015/ISO7092DIN433_M24FlatWasher.step", 1},
      {"fcl2015/NEMA-23_Stepper_Motor.step", 4},
      {"o2ac/03-PANEL2.step", 7},
      {"partcad/AeroFrame_Plate.step", 23},
      {"pythonocc_core/as1-oc-214.stp", 11},  // plate 6, bracket 4, nut 1
      {"pythonocc_core/io1-ug-214.stp", 7},
      {"pythonocc_core/test_ocaf.stp", 0},
      {"stepnode/hole_model.stp", 23},
      {"stepnode/simple_block_workpiece.stp", 0},
      {"stepnode/vise.stp", 5}};
  const Bench bench;
  std::vector<std::string> arguments{"catalog", "build"};
  for (const auto& [file, holes] : expected) {
    arguments.push_back((fs::path(DOWEL_SHARED_STEP) / file).string());
  }
  arguments.insert(arguments.end(), {"-o", "c.db", "--json"});
  const ProgramResult build = bench.dowel(arguments);
  CAPTURE(build.out, build.err);
  REQUIRE(build.exit_code == 0);
  const auto lines = lines_of(build);
  REQUIRE(lines.size() == expected.size());
  const Catalog catalog(bench / "c.db", Catalog::Access::ReadOnly);
  auto line = lines.begin();
  for (const auto& [file, holes] : expected) {
    CAPTURE(file);
    std::size_t found = 0;
    for (const Json& name : (*line++)["elements"]) {
      found += holes_in(catalog.find(name.get<std::string>()).value());
    }
    CHECK(found == holes);
  }
}

TEST_CASE("a real assembly becomes a project that the console opens") {
  if (!has_real_files()) return;
  const Bench bench;
  const std::string file = (fs::path(DOWEL_SHARED_STEP) / "pythonocc_core/as1-oc-214.stp").string();
  const ProgramResult build =
      bench.dowel({"catalog", "build", file, "-o", "c.db", "--assemblies", "projects", "--json"});
  CAPTURE(build.out, build.err);
  REQUIRE(build.exit_code == 0);
  const Json line = lines_of(build).at(0);
  CHECK(line["project"] == "projects/as1-oc-214.dowelproj");
  CHECK(line["instances"] == 18);
  const ProgramResult bom = bench.dowel({"bom", "--project", "projects/as1-oc-214.dowelproj"});
  CAPTURE(bom.out, bom.err);
  CHECK(bom.exit_code == 0);
  // Eight nuts.
  CHECK_THAT(bom.out, Catch::Contains("nut") && Catch::Contains("8"));
}

TEST_CASE("in a real assembly every bolt is found in its nut, bracket and plate") {
  if (!has_real_files()) return;
  const Bench bench;
  const std::string file = (fs::path(DOWEL_SHARED_STEP) / "pythonocc_core/as1-oc-214.stp").string();
  const std::string project = "projects/as1-oc-214.dowelproj";
  REQUIRE(
      bench.dowel({"catalog", "build", file, "-o", "c.db", "--assemblies", "projects"}).exit_code ==
      0);
  const Json found =
      lines_of(bench.dowel({"recognise", "dry-run", "--project", project, "--json"})).at(0);
  // Pairs of a kind between parts of two sorts: a plate, two brackets, each held by three bolts
  // with their nuts, and a rod through both with a nut at each end.
  const auto pairs = [&](const std::string& kind, const std::string& a, const std::string& b) {
    std::set<std::pair<std::string, std::string>> parts;
    for (const Json& mate : found["mates"]) {
      std::string one = mate["moving"];
      std::string other = mate["fixed"];
      one.resize(one.find('.'));
      other.resize(other.find('.'));
      if (one.rfind(a, 0) != 0) std::swap(one, other);
      if (mate["kind"] == kind && one.rfind(a, 0) == 0 && other.rfind(b, 0) == 0) {
        parts.emplace(one, other);
      }
    }
    return parts.size();
  };
  CHECK(pairs("align", "bolt", "nut") == 6);
  CHECK(pairs("align", "bolt", "l-bracket") == 6);
  CHECK(pairs("align", "bolt", "plate") == 6);
  CHECK(pairs("align", "rod", "nut") == 2);
  CHECK(pairs("align", "rod", "l-bracket") == 2);
  CHECK(pairs("face on face", "l-bracket", "plate") == 2);
  CHECK(pairs("face on face", "bolt", "l-bracket") == 6);

  const ProgramResult made = bench.dowel({"recognise", "--project", project});
  CHECK(made.exit_code == 0);
  const Json mates = lines_of(bench.dowel({"list", "mates", "--project", project, "--json"})).at(0);
  CHECK(mates["mates"].size() > 24);
  for (const Json& mate : mates["mates"]) CHECK(mate["off_axis_mm"].get<double>() < 1e-4);
  // The rod is held by axes alone.
  const Json rod =
      lines_of(bench.dowel({"freedoms", "rod_1", "--project", project, "--json"})).at(0);
  REQUIRE(rod["freedoms"].size() == 2);
  CHECK(rod["freedoms"][0]["kind"] == "slide");
  CHECK(rod["freedoms"][1]["kind"] == "turn");
}

// A minute: run by name or tag.
TEST_CASE("all real STEP files go through one build, and those that load are whole", "[.slow]") {
  if (!has_real_files()) return;
  const Bench bench;
  const ProgramResult build =
      bench.dowel({"catalog", "build", DOWEL_SHARED_STEP, "-o", "c.db", "--json"});
  CHECK(build.exit_code == 1);
  CHECK(build.err.empty());
  std::map<std::string, std::size_t> files;
  for (const Json& line : lines_of(build)) {
    CAPTURE(line.dump());
    const std::string status = line["status"];
    ++files[status];
    CHECK(line.contains("elements") == (status == "ok"));
    CHECK(line.contains("reason") == (status != "ok"));
  }
  CHECK(files == std::map<std::string, std::size_t>{{"empty", 4}, {"failed", 3}, {"ok", 69}});

  const Catalog catalog(bench / "c.db", Catalog::Access::ReadOnly);
  for (const std::string& name : catalog.names()) {
    CAPTURE(name);
    const dowel::Element element = catalog.find(name).value();
    CHECK(element.triangles.total > 0);
    CHECK(element.obb.half_extents_mm.minCoeff() > 0.0);
    const std::vector<dowel::Face> faces = catalog.solid(name)->faces;
    const bool may_have_features = std::ranges::any_of(faces, [](const dowel::Face& face) {
      return std::holds_alternative<dowel::PlaneSurface>(face.surface) ||
             std::holds_alternative<dowel::CylinderSurface>(face.surface);
    });
    CHECK(!element.features.empty() == may_have_features);
  }
}
