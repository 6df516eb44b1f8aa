// Assemblies in STEP files: distinct parts once, instances where the file has them, projects.

#include <algorithm>
#include <cctype>
#include <map>

#include <catch2/catch.hpp>

#include "dowel/assembly/project.h"
#include "dowel/catalog/catalog.h"
#include "dowel/catalog/recognition.h"
#include "dowel/io/catalog_build.h"
#include "dowel/io/import.h"
#include "dowel/io/step_writer.h"
#include "program.h"
#include "step_files.h"

namespace {

namespace fs = std::filesystem;
using namespace dowel;
using testing::TemporaryFolder;

Pose pose(double w, double x, double y, double z, const Eigen::Vector3d& t) {
  return {Eigen::Quaterniond(w, x, y, z).normalized(), t};
}

/// Two parts by our own reader and writer: a drilled plate and a plain block.
std::vector<ExportPart> sample_parts(const TemporaryFolder& folder) {
  testing::write_step(folder / "plate.step", {testing::drilled_plate()});
  testing::write_step(folder / "block.step", {BRepPrimAPI_MakeBox(10.0, 20.0, 30.0).Shape()});
  std::vector<ExportPart> parts;
  for (const char* name : {"plate", "block"}) {
    const ImportResult result = import_file(folder / (std::string(name) + ".step"), {});
    REQUIRE(result.parts.size() == 1);
    parts.push_back({name, result.parts[0].brep, {}});
  }
  return parts;
}

/// Some of these names no instance of a project may have.
std::vector<ExportInstance> sample_instances() {
  return {{"base", 0, Pose()},
          {"left.block", 1, pose(1, 0, 0, 0, {-50.0, 0.0, 10.0})},
          {"right block", 1, pose(0.5, 0.5, 0.5, 0.5, {70.0, 5.0, 0.25})},
          {"lid", 0, pose(0.8, 0.0, 0.6, 0.0, {1e3, -2e3, 3e3})},
          {"right block", 1, pose(0.1, -0.3, 0.7, 0.2, {0.0, 0.0, 200.0})}};
}

double distance(const Pose& a, const Pose& b) {
  double result = 0.0;
  for (const Eigen::Vector3d& p : {Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(100, 0, 0),
                                   Eigen::Vector3d(0, 100, 0), Eigen::Vector3d(0, 0, 100)}) {
    result = std::max(result, (a * p - b * p).norm());
  }
  return result;
}

/// Of all instances, weighed by volume; that of the file as one part is OpenCascade's.
Eigen::Vector3d center_of_mass(const ImportResult& result) {
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  double volume_mm3 = 0.0;
  for (const ImportedInstance& instance : result.instances) {
    const ImportedPart& part = result.parts[instance.part];
    moment += part.volume_mm3 * (instance.X_WI * part.center_of_mass);
    volume_mm3 += part.volume_mm3;
  }
  return moment / volume_mm3;
}

std::string lower(std::string text) {
  std::ranges::transform(text, text.begin(),
                         [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

}  // namespace

TEST_CASE("an assembly of our own writer comes back with its parts, instances and poses") {
  const TemporaryFolder folder;
  const std::vector<ExportInstance> written = sample_instances();
  write_step_assembly(folder / "a.step", "sample", sample_parts(folder), written);
  const ImportResult result = import_file(folder / "a.step", {});
  REQUIRE(result.status == ImportResult::Status::Ok);
  REQUIRE(result.parts.size() == 2);
  REQUIRE(result.instances.size() == written.size());
  for (std::size_t i = 0; i < written.size(); ++i) {
    CAPTURE(i);
    CHECK(result.instances[i].name == written[i].name);
    CHECK(result.parts[result.instances[i].part].name ==
          (written[i].part == 0 ? "plate" : "block"));
    CHECK(distance(result.instances[i].X_WI, written[i].X_WI) < 1e-9);
  }
}

TEST_CASE("a file of one part has one instance, as one whole file has") {
  const TemporaryFolder folder;
  testing::write_step(folder / "plate.step", {testing::drilled_plate()});
  for (const bool whole : {false, true}) {
    ImportOptions options;
    options.whole_file = whole;
    const ImportResult result = import_file(folder / "plate.step", options);
    REQUIRE(result.instances.size() == 1);
    CHECK(result.instances[0].part == 0);
    CHECK(distance(result.instances[0].X_WI, Pose()) == 0.0);
  }
}

TEST_CASE("an assembly becomes a project, once") {
  const TemporaryFolder folder;
  fs::create_directory(folder / "in");
  const std::vector<ExportInstance> written = sample_instances();
  write_step_assembly(folder / "in/a.step", "sample", sample_parts(folder), written);
  const std::vector<fs::path> paths{folder / "in"};
  BuildOptions options;
  SECTION("at once") {}
  SECTION("later, from the catalogue") {
    REQUIRE(build_catalog(paths, folder / "c.db", options).at(0).project.empty());
  }
  options.assemblies = folder / "out";
  const BuiltFile built = build_catalog(paths, folder / "c.db", options).at(0);
  CHECK(built.project == (folder / "out/a.dowelproj").string());
  CHECK(built.instances == 5);
  CHECK(built.warnings.empty());
  {
    const Project project = Project::open(built.project);
    const std::vector<const Instance*> instances = project.state().in_order();
    REQUIRE(instances.size() == written.size());
    const std::vector<std::string> names{"base", "left_block", "right_block", "lid",
                                         "right_block-2"};
    for (std::size_t i = 0; i < written.size(); ++i) {
      CHECK(instances[i]->name == names[i]);
      CHECK(instances[i]->element == (written[i].part == 0 ? "plate" : "block"));
      CHECK(distance(instances[i]->X_WI, written[i].X_WI) < 1e-9);
    }
    CHECK(project.element_names() == std::vector<std::string>{"block", "plate"});
    CHECK(project.replay() == project.state());
  }
  const std::string before = testing::read_text(built.project);
  options.force = true;
  const BuiltFile again = build_catalog(paths, folder / "c.db", options).at(0);
  CHECK(again.project.empty());
  REQUIRE(again.warnings.size() == 1);
  CHECK_THAT(again.warnings[0], Catch::Contains("exists and is left as it is"));
  CHECK(testing::read_text(built.project) == before);
}

TEST_CASE("a project that cannot be written is a warning, the elements are kept", "[fault]") {
  const TemporaryFolder folder;
  write_step_assembly(folder / "a.step", "sample", sample_parts(folder), sample_instances());
  testing::write_text(folder / "out", "a file");
  BuildOptions options;
  options.assemblies = folder / "out";
  const std::vector<fs::path> paths{folder / "a.step"};
  const BuiltFile built = build_catalog(paths, folder / "c.db", options).at(0);
  CHECK(built.status == BuildStatus::Ok);
  CHECK(built.elements.size() == 2);
  REQUIRE(built.warnings.size() == 1);
  CHECK_THAT(built.warnings[0], Catch::StartsWith("no project: "));
  CHECK(testing::read_text(folder / "out") == "a file");
}

TEST_CASE("the AS1 assembly has the same parts and features from every system") {
  const fs::path folder = fs::path(DOWEL_SHARED_STEP) / "pythonocc_core";
  if (!fs::exists(folder)) {
    WARN("no folder of real STEP files here: " << DOWEL_SHARED_STEP);
    return;
  }
  // As the assembly is known: a plate with two brackets, each held by three bolts with their nuts,
  // and a rod with two nuts.
  struct Known {
    std::size_t instances;
    std::size_t holes;
  };
  const std::map<std::string, Known> known{
      {"plate", {1, 6}}, {"l-bracket", {2, 4}}, {"bolt", {6, 0}}, {"nut", {8, 1}}, {"rod", {1, 0}}};
  for (const char* file : {"as1-oc-214.stp", "as1_pe_203.stp"}) {
    CAPTURE(file);
    const ImportResult result = import_file(folder / file, {});
    REQUIRE(result.status == ImportResult::Status::Ok);
    CHECK(result.parts.size() == known.size());
    CHECK(result.instances.size() == 18);
    for (std::size_t i = 0; i < result.parts.size(); ++i) {
      const auto expected = known.find(lower(result.parts[i].name));
      REQUIRE(expected != known.end());
      CAPTURE(expected->first);
      CHECK(static_cast<std::size_t>(std::ranges::count(
                result.instances, i, &ImportedInstance::part)) == expected->second.instances);
      const std::vector<Feature> features = recognise_features(result.parts[i].solid);
      CHECK(static_cast<std::size_t>(std::ranges::count(features, FeatureKind::Hole,
                                                        &Feature::kind)) == expected->second.holes);
    }
    ImportOptions whole;
    whole.whole_file = true;
    const ImportResult one = import_file(folder / file, whole);
    REQUIRE(one.parts.size() == 1);
    const double size_mm = std::cbrt(one.parts[0].volume_mm3);
    CHECK((center_of_mass(result) - one.parts[0].center_of_mass).norm() < 1e-6 * size_mm);
  }
}
