// What a library states about its elements in library.json, through dowel catalog build.

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include "dowel/catalog/catalog.h"
#include "library/builders.h"
#include "library/write_library.h"
#include "program.h"

namespace {

using Json = nlohmann::ordered_json;
using dowel::Catalog;
using dowel::Element;
using dowel::testing::ProgramResult;
using dowel::testing::read_text;
using dowel::testing::TemporaryFolder;
using dowel::testing::write_text;

constexpr const char* kSpacer = "H40-12/spacer-10";
constexpr const char* kFile = "parts/H40-12/spacer-10.step";

/// A folder with a library of one spacer in parts/.
class Shelf : public TemporaryFolder {
 public:
  Shelf() {
    auto parts = dowel::library::spacers(dowel::library::system_called("H40-12"));
    std::erase_if(parts, [](const auto& part) { return part.name != kSpacer; });
    dowel::library::write_library(path() / "parts", parts);
  }
  Json manifest() const { return Json::parse(read_text(*this / "parts/library.json")); }
  void write(const Json& manifest) const {
    write_text(*this / "parts/library.json", manifest.dump());
  }
  /// The only line of a build into c.db.
  Json build(const std::string& what = "parts") const {
    const ProgramResult result = dowel::testing::run_dowel(
        {"catalog", "build", what, "-o", "c.db", "--json"}, {.folder = path()});
    return Json::parse(result.out);
  }
  Element spacer() const {
    return Catalog(*this / "c.db", Catalog::Access::ReadOnly).find(kSpacer).value();
  }
};

}  // namespace

TEST_CASE("one system can be written by itself") {
  const TemporaryFolder folder;
  const auto dowel = [&folder](const std::vector<std::string>& arguments) {
    return dowel::testing::run_dowel(arguments, {.folder = folder.path()});
  };
  REQUIRE(dowel({"library", "out", "--system", "T14"}).exit_code == 0);
  const Json manifest = Json::parse(read_text(folder / "out/library.json"));
  CHECK(manifest["elements"].size() > 40);
  for (const Json& element : manifest["elements"]) {
    const auto family = element["family"].get<std::string>();
    CHECK((family == "T14" || family == "workpiece"));
    CHECK(std::filesystem::exists(folder / ("out/" + element["file"].get<std::string>())));
  }
  const auto unknown = dowel({"library", "none", "--system", "T15"});
  CHECK(unknown.exit_code == 2);
  CHECK_THAT(unknown.err, Catch::Contains("T15"));
  CHECK_FALSE(std::filesystem::exists(folder / "none"));
}

TEST_CASE("what a library states about an element is in the catalogue") {
  const Shelf shelf;
  REQUIRE(shelf.build()["status"] == "ok");
  const Element spacer = shelf.spacer();
  CHECK(spacer.role == "riser");
  CHECK(spacer.material == "steel C45");
  CHECK(spacer.licence == "Apache-2.0");
  CHECK(spacer.find_feature("h1")->fit == "H7");
  CHECK(spacer.find_feature("h1")->use == "bore");
  // 39.5 x 39.5 x 10 mm without a bore of 12 mm.
  CHECK(spacer.mass_kg().value() == Approx((15602.5 - 1130.973) * 7850e-9).epsilon(1e-6));
  CHECK(shelf.build()["status"] == "unchanged");
}

TEST_CASE("a file that is built by itself is described by the manifest above its folder") {
  const Shelf shelf;
  REQUIRE(shelf.build(kFile)["status"] == "ok");
  CHECK(shelf.spacer().role == "riser");
}

TEST_CASE("a manifest that changes is read again") {
  const Shelf shelf;
  REQUIRE(shelf.build()["status"] == "ok");
  Json manifest = shelf.manifest();
  manifest["elements"][0]["material"] = "brass";
  manifest["elements"][0]["density_kg_per_m3"] = 8500;
  shelf.write(manifest);
  CHECK(shelf.build()["status"] == "ok");
  CHECK(shelf.spacer().material == "brass");
  CHECK(shelf.spacer().density_kg_per_m3 == 8500.0);
}

TEST_CASE("an element that no manifest lists is what its solid is") {
  const Shelf shelf;
  Json manifest = shelf.manifest();
  manifest["elements"] = Json::array();
  SECTION("the manifest is of other elements") {
    shelf.write(manifest);
  }
  SECTION("the file is another program's") {
    write_text(shelf / "parts/library.json", R"({"name": "a library of something else"})");
  }
  REQUIRE(shelf.build()["status"] == "ok");
  CHECK(shelf.spacer().role.empty());
  CHECK_FALSE(shelf.spacer().mass_kg());
}

TEST_CASE("a manifest that makes no sense fails the file and names the place", "[fault]") {
  const Shelf shelf;
  Json manifest = shelf.manifest();
  Json& element = manifest["elements"][0];
  std::string expected;
  SECTION("no JSON") {
    write_text(shelf / "parts/library.json", "{\"format\": ");
    CHECK_THAT(shelf.build()["reason"].get<std::string>(), Catch::Contains("not JSON"));
    return;
  }
  SECTION("a newer format") {
    manifest["format"] = "dowel-library/2";
    expected = "library.json: format: expected \"dowel-library/1\"";
  }
  SECTION("a unit") {
    manifest["unit"] = "inch";
    expected = "library.json: unit: expected \"mm\"";
  }
  SECTION("elements that are no list") {
    manifest["elements"] = 3;
    expected = "library.json: elements: expected a list";
  }
  SECTION("a role that is no text") {
    element["role"] = 3;
    expected = "elements[0].role: expected a text";
  }
  SECTION("a density below zero") {
    element["density_kg_per_m3"] = -1;
    expected = "elements[0].density_kg_per_m3: expected a density above 0";
  }
  SECTION("a feature of no kind") {
    element["features"][0]["kind"] = "gear";
    expected = "elements[0].features[0].kind: expected hole, shaft, face or slot";
  }
  SECTION("a direction of no length") {
    element["features"][0]["axis"]["direction"] = {0, 0, 0};
    expected = "features[0].axis.direction: expected a vector of unit length";
  }
  SECTION("a place that is none") {
    element["features"][0]["axis"]["origin"] = {0, 0};
    expected = "features[0].axis.origin: expected a list of 3 numbers";
  }
  SECTION("one file twice") {
    manifest["elements"].push_back(element);
    expected = "elements[1].file: is listed twice";
  }
  SECTION("a hole that the solid does not have") {
    element["features"][0]["diameter"] = 13.0;
    expected = "the library states a hole \"h1\" that the solid does not have";
  }
  shelf.write(manifest);
  const Json line = shelf.build();
  CHECK(line["status"] == "failed");
  CHECK_THAT(line["reason"].get<std::string>(), Catch::Contains(expected));
}
