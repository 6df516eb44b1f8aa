#include "dowel/catalog/catalog.h"

#include <cmath>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <catch2/catch.hpp>

#include "catalog_files.h"
#include "dowel/kernel/blob.h"

using namespace dowel;
using namespace dowel::testing;

TEST_CASE("What is put into a catalogue is found again to the bit") {
  const TemporaryFolder folder;
  const ElementRecord record = block_record("H40/block");
  {
    Catalog catalog = writable(folder / "c.db");
    CHECK(put(catalog, "blocks/block.step", {record}) == std::vector<std::string>{"H40/block"});
  }
  const Catalog catalog = readable(folder / "c.db");
  CHECK(catalog.names() == std::vector<std::string>{"H40/block"});
  CHECK(catalog.file() == folder / "c.db");
  const auto found = catalog.find("H40/block");
  REQUIRE(found);
  const dowel::Element& put_in = record.element;
  CHECK(found->name == put_in.name);
  CHECK(found->family == put_in.family);
  CHECK(found->source == put_in.source);
  CHECK(found->sha256 == put_in.sha256);
  CHECK(found->unit_in_file == put_in.unit_in_file);
  CHECK(found->licence == put_in.licence);
  CHECK(found->role == put_in.role);
  CHECK(found->description == put_in.description);
  CHECK(found->material == put_in.material);
  CHECK(found->dimensions_by == put_in.dimensions_by);
  CHECK(found->mass_kg().value() == Approx(64000.0 * 7850.0e-9).epsilon(1e-12));
  CHECK(found->shape == put_in.shape);
  CHECK(found->solids == put_in.solids);
  CHECK(found->volume_mm3 == put_in.volume_mm3);
  CHECK(found->surface_mm2 == put_in.surface_mm2);
  CHECK(found->center_of_mass == put_in.center_of_mass);
  CHECK(found->obb.center == put_in.obb.center);
  CHECK(found->obb.axes == put_in.obb.axes);
  CHECK(found->obb.half_extents_mm == put_in.obb.half_extents_mm);
  CHECK(found->triangles.total == 12);
  CHECK(found->triangles.plane == 7);
  CHECK(found->triangles.hole == 3);
  CHECK(found->triangles.other == 2);
  CHECK(found->facet_error_mm == put_in.facet_error_mm);
  CHECK(found->colour == put_in.colour);

  REQUIRE(found->features.size() == put_in.features.size());
  for (std::size_t i = 0; i < put_in.features.size(); ++i) {
    const dowel::Feature& actual = found->features[i];
    const dowel::Feature& expected = put_in.features[i];
    CAPTURE(expected.name);
    CHECK(actual.name == expected.name);
    CHECK(actual.kind == expected.kind);
    CHECK(actual.origin == expected.origin);
    CHECK(actual.direction == expected.direction);
    CHECK(actual.diameter_mm == expected.diameter_mm);
    CHECK(actual.depth_mm == expected.depth_mm);
    CHECK(actual.through == expected.through);
    CHECK(actual.blind_end == expected.blind_end);
    CHECK(actual.entry == expected.entry);
    CHECK(actual.segments == expected.segments);
    CHECK(actual.slot == expected.slot);
    CHECK(actual.area_mm2 == expected.area_mm2);
    CHECK(actual.faces == expected.faces);
    CHECK(actual.use == expected.use);
    CHECK(actual.thread == expected.thread);
    CHECK(actual.thread_is_guess == expected.thread_is_guess);
    CHECK(actual.fit == expected.fit);
  }
  REQUIRE(found->bolt_circles.size() == 1);
  const dowel::BoltCircle& circle = found->bolt_circles.front();
  CHECK(circle.center == put_in.bolt_circles.front().center);
  CHECK(circle.direction == put_in.bolt_circles.front().direction);
  CHECK(circle.diameter_mm == 50.0);
  CHECK(circle.hole_diameter_mm == 12.0);
  CHECK(circle.holes == std::vector<std::string>{"cb1", "A1", "cb1"});
  CHECK(dowel::to_blob(*catalog.solid("H40/block")) == dowel::to_blob(record.solid));
  CHECK(catalog.brep("H40/block") == record.brep);
}

TEST_CASE("An element without colour, features and boundary representation is kept as such") {
  const TemporaryFolder folder;
  ElementRecord record = block_record("bare");
  record.brep.clear();
  record.element.colour.reset();
  record.element.features.clear();
  record.element.bolt_circles.clear();
  Catalog catalog = writable(folder / "c.db");
  put(catalog, "bare.off", {record});
  CHECK(catalog.brep("bare").empty());
  CHECK_FALSE(catalog.find("bare")->colour);
  CHECK(catalog.find("bare")->features.empty());
}

TEST_CASE("Names are found as they were given, whatever is in them") {
  const TemporaryFolder folder;
  Catalog catalog = writable(folder / "c.db");
  const std::string with_nul("a\0b", 3);
  const std::vector<std::string> names{"'; DROP TABLE element; --", "Größe 12", "\xff\xfe broken",
                                       with_nul, "a"};
  for (const std::string& name : names) put(catalog, "file of " + name, {block_record(name)});
  for (const std::string& name : names) {
    CAPTURE(name);
    REQUIRE(catalog.find(name));
    CHECK(catalog.find(name)->name == name);
  }
  CHECK(catalog.names().size() == names.size());
}

TEST_CASE("A name that another source uses is told apart by a number") {
  const TemporaryFolder folder;
  Catalog catalog = writable(folder / "c.db");
  const auto plate = block_record("plate");
  CHECK(put(catalog, "a.step", {plate}) == std::vector<std::string>{"plate"});
  CHECK(put(catalog, "b.step", {plate, plate}) == std::vector<std::string>{"plate~2", "plate~3"});
  CHECK(put(catalog, "c.step", {plate}) == std::vector<std::string>{"plate~4"});
  SECTION("and keeps it when the source is read again") {
    CHECK(put(catalog, "b.step", {plate, plate}) == std::vector<std::string>{"plate~2", "plate~3"});
    CHECK(put(catalog, "a.step", {plate}) == std::vector<std::string>{"plate"});
  }
  CHECK(catalog.names().size() == 4);
}

TEST_CASE("Putting a source again replaces what it gave before and nothing else") {
  const TemporaryFolder folder;
  Catalog catalog = writable(folder / "c.db");
  put(catalog, "a.step", {block_record("one"), block_record("two")});
  put(catalog, "b.step", {block_record("three")});
  put(catalog, "a.step", {block_record("two", 99.0)});
  CHECK(catalog.names() == std::vector<std::string>{"three", "two"});
  CHECK(catalog.find("two")->volume_mm3 == 99.0 * 800.0);
  CHECK_FALSE(catalog.find("one"));

  const SQLite::Database database((folder / "c.db").string());
  // Facets of each and the representation that both have.
  for (const auto& [table, rows] :
       {std::pair("element", 2), std::pair("element_blob", 4), std::pair("blob", 3)}) {
    CAPTURE(table);
    SQLite::Statement count(database, std::string("SELECT count(*) FROM ") + table);
    REQUIRE(count.executeStep());
    CHECK(count.getColumn(0).getInt() == rows);
  }
  SQLite::Statement orphans(database, "PRAGMA foreign_key_check");
  CHECK_FALSE(orphans.executeStep());
}

TEST_CASE("Elements of one shape share their facets, until the last of them goes") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  Catalog catalog = writable(file);
  const auto blobs = [&file] {
    SQLite::Database database(file.string());
    return database.execAndGet("SELECT count(*) FROM blob").getInt();
  };
  put(catalog, "a.step", {block_record("one"), block_record("two")});
  CHECK(blobs() == 2);
  const auto size = std::filesystem::file_size(file);
  put(catalog, "b.step", {block_record("three"), block_record("wide", 120.0)});
  CHECK(blobs() == 3);
  CHECK(to_blob(*catalog.solid("three")) == to_blob(block_record("one").solid));
  CHECK(to_blob(*catalog.solid("wide")) != to_blob(block_record("one").solid));
  CHECK(std::filesystem::file_size(file) < 2 * size);
  put(catalog, "a.step", {});
  CHECK(blobs() == 3);
  CHECK(to_blob(*catalog.solid("three")) == to_blob(block_record("one").solid));
  put(catalog, "b.step", {block_record("wide", 120.0)});
  CHECK(blobs() == 2);
  put(catalog, "b.step", {});
  CHECK(blobs() == 0);
}

TEST_CASE("Different contents of one checksum are kept apart") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  Catalog catalog = writable(file);
  put(catalog, "a.step", {block_record("a")});
  ElementRecord other = block_record("b");
  other.brep = {std::byte{7}};
  put(catalog, "b.step", {other});
  // As if the first had the second's checksum: it must not be taken for it.
  execute(
      file,
      "UPDATE blob SET repeat = 1, checksum = (SELECT checksum FROM blob WHERE length(bytes) = 1)"
      " WHERE length(bytes) = 3");
  put(catalog, "c.step", {other});
  CHECK(catalog.brep("b~2") == other.brep);
  CHECK(catalog.brep("b") == other.brep);
}

TEST_CASE("A source is remembered with its hash, its settings and what came of it") {
  const TemporaryFolder folder;
  Catalog catalog = writable(folder / "c.db");
  CHECK_FALSE(catalog.source("bad.step"));
  catalog.put({"bad.step", "0123", "d 0.1", "failed", "crashed", {}}, {});
  const auto bad = catalog.source("bad.step");
  REQUIRE(bad);
  CHECK(bad->path == "bad.step");
  CHECK(bad->sha256 == "0123");
  CHECK(bad->settings == "d 0.1");
  CHECK(bad->status == "failed");
  CHECK(bad->reason == "crashed");
  CHECK(bad->elements.empty());
  put(catalog, "good.step", {block_record("z"), block_record("a")});
  CHECK(catalog.source("good.step")->elements == std::vector<std::string>{"z", "a"});
}

TEST_CASE("Where an assembly has its elements is kept, and checked as it is read") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  dowel::SourceRecord source = block_source();
  const dowel::Pose X_WI(Eigen::Quaterniond(0.5, 0.5, -0.5, 0.5), {1.0, 2.0, 1.0 / 3.0});
  source.instances = {{"left", 1, X_WI}, {"left", 0, dowel::Pose()}};
  {
    Catalog catalog = writable(file);
    catalog.put(source, std::vector{block_record("a"), block_record("b")});
    const auto found = catalog.source(source.path);
    REQUIRE(found);
    REQUIRE(found->instances.size() == 2);
    CHECK(found->instances[0].name == "left");
    CHECK(found->instances[0].element == 1);
    CHECK(found->instances[0].X_WI.rotation().coeffs() == X_WI.rotation().coeffs());
    CHECK(found->instances[0].X_WI.translation() == X_WI.translation());
    // What the file gives now replaces what it gave.
    source.instances = {{"one", 0, X_WI}};
    catalog.put(source, std::vector{block_record("a")});
    CHECK(catalog.source(source.path)->instances.size() == 1);
  }
  const std::string edit = GENERATE(
      "UPDATE instance SET element_position = 1", "UPDATE instance SET element_position = -1",
      "UPDATE instance SET qw = 2.0", "UPDATE instance SET x_mm = 9e999");
  CAPTURE(edit);
  execute(file, edit);
  const Error error = error_of([&] { readable(file).source(source.path); });
  CHECK(error.code() == ErrorCode::FileMalformed);
  CHECK_THAT(error.what(), Catch::Contains(file.string()) && Catch::Contains(source.path));
}

TEST_CASE("An element that is not there is nothing, its content an error that names it") {
  const TemporaryFolder folder;
  Catalog catalog = writable(folder / "c.db");
  CHECK_FALSE(catalog.find("plate"));
  const Error error = error_of([&] { catalog.solid("plate"); });
  CHECK(error.code() == ErrorCode::NotFound);
  CHECK_THAT(error.what(), Catch::Contains("c.db") && Catch::Contains("\"plate\""));
  CHECK(error_of([&] { catalog.brep("plate"); }).code() == ErrorCode::NotFound);
}

TEST_CASE("An element that is not sound is the caller's fault") {
  const TemporaryFolder folder;
  Catalog catalog = writable(folder / "c.db");
  ElementRecord record = block_record("x");
  SECTION("a volume that is no number") {
    record.element.volume_mm3 = std::nan("");
  }
  SECTION("a box with skewed axes") {
    record.element.obb.axes(0, 0) = 0.5;
  }
  SECTION("two features of one name") {
    record.element.features.push_back(record.element.features[0]);
  }
  SECTION("a direction that is not of unit length") {
    record.element.features[0].direction *= 2.0;
  }
  SECTION("a hole segment upside down") {
    std::swap(record.element.features[0].segments[0].from_mm,
              record.element.features[0].segments[0].to_mm);
  }
  CHECK_THROWS_AS(put(catalog, "x.step", {record}), std::logic_error);
  CHECK(catalog.names().empty());
  CHECK_FALSE(catalog.source("x.step"));
}

TEST_CASE("The same puts give the same bytes", "[determinism]") {
  const TemporaryFolder one;
  const TemporaryFolder two;
  CHECK(sample_bytes(one) == sample_bytes(two));
}

TEST_CASE("Reading leaves the file and its folder alone") {
  const TemporaryFolder folder;
  const std::string before = sample_bytes(folder);
  read_all(folder / "sample.db");
  CHECK(read_text(folder / "sample.db") == before);
  CHECK(files_in(folder) == 1);
}

TEST_CASE("File names that mean something to SQLite are plain names") {
  const TemporaryFolder folder;
  const auto before = std::filesystem::current_path();
  std::filesystem::current_path(folder.path());
  for (const char* name : {":memory:", "file:x?mode=memory", "a b%20'.db"}) {
    CAPTURE(name);
    {
      Catalog catalog = writable(name);
      put(catalog, "a.step", {block_record("a")});
    }
    CHECK(std::filesystem::is_regular_file(name));
    CHECK(readable(name).names().size() == 1);
  }
  std::filesystem::current_path(before);
}

TEST_CASE("A catalogue of the first version is read, and brought up to this one by a writer") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  Catalog(file, Catalog::Access::ReadWrite).put(block_source(), std::vector{block_record("a")});
  execute(file,
          "INSERT INTO content SELECT element_id, kind, checksum, bytes"
          " FROM element_blob JOIN blob ON blob.id = blob_id;"
          "DROP TABLE element_blob; DROP TABLE blob;"
          "DROP TABLE instance; DROP TABLE bolt_circle_hole; DROP TABLE bolt_circle;"
          "DROP TABLE slot; DROP TABLE feature_design; DROP TABLE element_design;"
          "PRAGMA user_version = 1");
  const std::string before = read_text(file);
  {
    const Catalog catalog = readable(file);
    const auto found = catalog.find("a");
    REQUIRE(found);
    REQUIRE(found->find_feature("slot1") != nullptr);
    CHECK_FALSE(found->find_feature("slot1")->slot);
    CHECK(found->role.empty());
    CHECK(found->bolt_circles.empty());
    CHECK_FALSE(found->mass_kg());
    CHECK(found->find_feature("pin1")->fit.empty());
  }
  CHECK(read_text(file) == before);
  CHECK(readable(file).brep("a") == block_record("a").brep);
  {
    Catalog catalog = writable(file);
    put(catalog, "b.step", {block_record("b")});
  }
  const Catalog catalog = readable(file);
  CHECK_FALSE(catalog.find("a")->find_feature("slot1")->slot);
  CHECK(catalog.find("a")->role.empty());
  CHECK(catalog.find("b")->find_feature("slot1")->slot ==
        block_record("b").element.features[4].slot);
  CHECK(catalog.find("b")->role == "locator");
  CHECK(catalog.brep("a") == block_record("a").brep);
  CHECK(to_blob(*catalog.solid("a")) == to_blob(block_record("a").solid));
  CHECK(catalog.brep("b") == block_record("b").brep);
}
