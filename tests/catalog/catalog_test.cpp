#include "dowel/catalog/catalog.h"

#include <array>
#include <csignal>
#include <functional>
#include <random>

#include <SQLiteCpp/SQLiteCpp.h>
#include <catch2/catch.hpp>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "dowel/kernel/blob.h"
#include "dowel/kernel/error.h"
#include "program.h"
#include "records.h"

namespace {

using dowel::Catalog;
using dowel::ElementRecord;
using dowel::Error;
using dowel::ErrorCode;
using dowel::testing::block_record;
using dowel::testing::block_source;
using dowel::testing::read_text;
using dowel::testing::TemporaryFolder;
using dowel::testing::write_text;

Catalog writable(const std::filesystem::path& file) {
  return Catalog(file, Catalog::Access::ReadWrite);
}

Catalog readable(const std::filesystem::path& file) {
  return Catalog(file, Catalog::Access::ReadOnly);
}

std::vector<std::string> put(Catalog& catalog, const std::string& path,
                             const std::vector<ElementRecord>& records) {
  return catalog.put(block_source(path), records);
}

/// The error that `body` throws; fails where it throws none.
Error error_of(const std::function<void()>& body) {
  try {
    body();
  } catch (const Error& error) {
    return error;
  }
  FAIL("no error was thrown");
  throw std::logic_error("unreachable");
}

void execute(const std::filesystem::path& file, const std::string& sql) {
  SQLite::Database database(file.string(), SQLite::OPEN_READWRITE | SQLite::OPEN_CREATE);
  database.exec(sql);
}

/// Reads all there is in a catalogue.
void read_all(const std::filesystem::path& file) {
  const Catalog catalog = readable(file);
  for (const std::string& name : catalog.names()) {
    catalog.find(name);
    catalog.solid(name);
    catalog.brep(name);
  }
  catalog.source("blocks/block.step");
  catalog.similar_names("blok");
}

/// A catalogue of a few elements, as bytes.
std::string sample_bytes(const TemporaryFolder& folder) {
  const auto file = folder / "sample.db";
  Catalog catalog = writable(file);
  put(catalog, "blocks/block.step", {block_record("H40/block"), block_record("H40/slab", 120.0)});
  put(catalog, "other.step", {block_record("H40/block", 60.0)});
  return read_text(file);
}

std::size_t files_in(const TemporaryFolder& folder) {
  const std::filesystem::directory_iterator files(folder.path());
  return static_cast<std::size_t>(std::distance(begin(files), end(files)));
}

/// Runs `body` in a child process and returns its wait status.
int in_child(const std::function<void()>& body) {
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      body();
    } catch (...) {
      ::_exit(99);
    }
    ::_exit(0);
  }
  int status = 0;
  ::waitpid(child, &status, 0);
  return status;
}

}  // namespace

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
  for (const char* table : {"element", "content"}) {
    CAPTURE(table);
    SQLite::Statement count(database, std::string("SELECT count(*) FROM ") + table);
    REQUIRE(count.executeStep());
    CHECK(count.getColumn(0).getInt() == (table[0] == 'e' ? 2 : 4));
  }
  SQLite::Statement orphans(database, "PRAGMA foreign_key_check");
  CHECK_FALSE(orphans.executeStep());
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

TEST_CASE("What is no catalogue is refused by name", "[fault]") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  const auto refused = [&](Catalog::Access access) {
    const Error error = error_of([&] { Catalog(file, access); });
    CHECK_THAT(error.what(), Catch::Contains(file.string()));
    CAPTURE(error.what());
    return error.code();
  };
  const auto read_only = Catalog::Access::ReadOnly;
  const auto read_write = Catalog::Access::ReadWrite;

  SECTION("a file that is missing") {
    CHECK(refused(read_only) == ErrorCode::FileUnreadable);
    CHECK(files_in(folder) == 0);
  }
  SECTION("a folder") {
    std::filesystem::create_directory(file);
    CHECK(refused(read_only) == ErrorCode::FileUnreadable);
    CHECK(refused(read_write) == ErrorCode::FileUnreadable);
  }
  SECTION("a pipe") {
    REQUIRE(::mkfifo(file.c_str(), 0600) == 0);
    CHECK(refused(read_only) == ErrorCode::FileUnreadable);
    CHECK(refused(read_write) == ErrorCode::FileUnreadable);
  }
  SECTION("an empty file that is to be read") {
    write_text(file, "");
    CHECK(refused(read_only) == ErrorCode::SchemaMismatch);
  }
  SECTION("a text") {
    const std::string text(5000, 'x');
    write_text(file, text);
    CHECK(refused(read_only) == ErrorCode::SchemaMismatch);
    CHECK(refused(read_write) == ErrorCode::SchemaMismatch);
    CHECK(read_text(file) == text);
  }
  SECTION("the database of another program") {
    execute(file, "CREATE TABLE element (name TEXT)");
    const std::string before = read_text(file);
    CHECK(refused(read_only) == ErrorCode::SchemaMismatch);
    CHECK(refused(read_write) == ErrorCode::SchemaMismatch);
    CHECK(read_text(file) == before);
  }
  SECTION("a catalogue of a newer version") {
    writable(file);
    execute(file, "PRAGMA user_version = 9");
    CHECK(refused(read_only) == ErrorCode::SchemaMismatch);
    CHECK_THAT(error_of([&] { readable(file); }).what(), Catch::Contains("version 9"));
    CHECK(refused(read_write) == ErrorCode::SchemaMismatch);
  }
  SECTION("a catalogue with another table") {
    writable(file);
    execute(file, "DROP TABLE content; CREATE VIEW content AS SELECT 1");
    CHECK(refused(read_only) == ErrorCode::SchemaMismatch);
  }
  SECTION("a catalogue with a trigger") {
    writable(file);
    execute(file, "CREATE TRIGGER t AFTER INSERT ON source BEGIN DELETE FROM source; END");
    CHECK(refused(read_write) == ErrorCode::SchemaMismatch);
  }
}

TEST_CASE("A catalogue is not made where its folder is missing", "[fault]") {
  const TemporaryFolder folder;
  const Error error = error_of([&] { writable(folder / "no/c.db"); });
  CHECK(error.code() == ErrorCode::FileUnwritable);
  CHECK_THAT(error.what(), Catch::Contains("there is no folder"));
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

TEST_CASE("A catalogue truncated at any length gives errors or its elements", "[fault]") {
  const TemporaryFolder folder;
  const std::string bytes = sample_bytes(folder);
  const auto file = folder / "cut.db";
  int errors = 0;
  for (std::size_t length = 1; length < bytes.size(); length += length < 200 ? 7 : 501) {
    CAPTURE(length, bytes.size());
    write_text(file, bytes.substr(0, length));
    try {
      read_all(file);
    } catch (const Error& error) {
      ++errors;
      CHECK_THAT(error.what(), Catch::Contains(file.string()));
      const bool is_right =
          error.code() == ErrorCode::FileMalformed || error.code() == ErrorCode::SchemaMismatch;
      CHECK(is_right);
    }
  }
  CHECK(errors > 50);
}

TEST_CASE("Flipped bits give errors or elements, never anything else", "[fault][property]") {
  const TemporaryFolder folder;
  const std::string bytes = sample_bytes(folder);
  const auto file = folder / "flipped.db";
  std::mt19937 random(7);
  int errors = 0;
  constexpr int kTries = 1000;
  for (int i = 0; i < kTries; ++i) {
    std::string flipped = bytes;
    const int flips = 1 + i % 4;
    for (int k = 0; k < flips; ++k) {
      // Half of them in the first page, where the structure is densest.
      const std::size_t range = k % 2 == 0 ? bytes.size() : 4096;
      flipped[random() % range] ^= static_cast<char>(1U << (random() % 8));
    }
    write_text(file, flipped);
    CAPTURE(i);
    try {
      read_all(file);
      if (i % 25 == 0) {  // writing waits for the disk
        Catalog catalog = writable(file);
        put(catalog, "blocks/block.step", {block_record("H40/slab")});
      }
    } catch (const Error& error) {
      ++errors;
      CHECK_THAT(error.what(), Catch::Contains(file.string()));
    }
    std::filesystem::remove(file.string() + "-journal");
  }
  CHECK(errors > kTries / 10);
  CHECK(errors < kTries);
}

TEST_CASE("A flipped bit in stored content is found by its checksum", "[fault]") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  Catalog(file, Catalog::Access::ReadWrite).put(block_source(), std::vector{block_record("a")});
  execute(file, "UPDATE content SET bytes = x'010002' WHERE kind = 'brep'");
  const Catalog catalog = readable(file);
  CHECK(catalog.find("a"));
  CHECK(error_of([&] { catalog.brep("a"); }).code() == ErrorCode::FileMalformed);
}

TEST_CASE("Rows that make no sound element are reported with the element's name", "[fault]") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  Catalog(file, Catalog::Access::ReadWrite).put(block_source(), std::vector{block_record("a")});
  const std::string edit = GENERATE(
      "UPDATE element SET obb_half_1_mm = -1.0", "UPDATE element SET obb_axis_1_x = 9e999",
      "UPDATE element SET solids = -1", "UPDATE element SET triangles = 1 << 40",
      "UPDATE element SET volume_mm3 = 9e999", "UPDATE feature SET faces = '[1,'",
      "UPDATE feature SET faces = '[1,-2]'", "UPDATE feature SET faces = ''",
      "UPDATE feature SET faces = '[99999999999]'", "UPDATE feature SET faces = '[1]x'",
      "UPDATE feature SET direction_x = 0.5", "UPDATE feature SET name = '' WHERE position = 1",
      "UPDATE hole_segment SET to_mm = -1.0", "UPDATE slot SET run_x = 0.5",
      "UPDATE slot SET length_mm = -1.0", "UPDATE slot SET nominal_mm = -14",
      "UPDATE slot SET feature_position = 0", "UPDATE element_design SET density_kg_per_m3 = -1.0",
      "UPDATE element_design SET density_kg_per_m3 = 9e999",
      "UPDATE bolt_circle SET direction_x = 2.0", "UPDATE bolt_circle SET diameter_mm = -1.0",
      "UPDATE bolt_circle_hole SET hole = 'pin1' WHERE position = 2");
  CAPTURE(edit);
  execute(file, edit);
  const Catalog catalog = readable(file);
  const Error error = error_of([&] { catalog.find("a"); });
  CHECK(error.code() == ErrorCode::FileMalformed);
  CHECK_THAT(error.what(), Catch::Contains(file.string()) && Catch::Contains("\"a\""));
}

TEST_CASE("A catalogue of the first version is read, and brought up to this one by a writer") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  Catalog(file, Catalog::Access::ReadWrite).put(block_source(), std::vector{block_record("a")});
  execute(file,
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
}

TEST_CASE("A second writer waits, then says who is in the way", "[fault]") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  Catalog catalog = writable(file);
  put(catalog, "a.step", {block_record("a")});

  SQLite::Database other(file.string(), SQLite::OPEN_READWRITE);
  SQLite::Transaction lock(other, SQLite::TransactionBehavior::EXCLUSIVE);
  const Error error = error_of([&] { put(catalog, "b.step", {block_record("b")}); });
  CHECK(error.code() == ErrorCode::FileUnwritable);
  CHECK_THAT(error.what(), Catch::Contains("another program"));
  lock.commit();
  put(catalog, "b.step", {block_record("b")});
  CHECK(catalog.names().size() == 2);
}

TEST_CASE("Two programs may fill one catalogue at once") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  const auto fill = [&](const std::string& prefix) {
    Catalog catalog = writable(file);
    for (int i = 0; i < 20; ++i) {
      const std::string name = prefix + std::to_string(i);
      put(catalog, name + ".step", {block_record(name)});
    }
  };
  const pid_t child = ::fork();
  if (child == 0) {
    try {
      fill("child");
    } catch (...) {
      ::_exit(1);
    }
    ::_exit(0);
  }
  fill("parent");
  int status = 0;
  ::waitpid(child, &status, 0);
  CHECK(status == 0);
  CHECK(readable(file).names().size() == 40);
}

TEST_CASE("A disk without room leaves the old content", "[fault]") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  {
    Catalog catalog = writable(file);
    put(catalog, "old.step", {block_record("old")});
  }
  const auto size = std::filesystem::file_size(file);
  ElementRecord large = block_record("large");
  large.brep.assign(1U << 20U, std::byte{42});

  const std::size_t room = GENERATE(0U, 1U, 5000U, 100'000U, 900'000U);
  const int status = in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{size + room, size + room};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    Catalog catalog = writable(file);
    const Error error = [&] {
      try {
        put(catalog, "old.step", {large});
      } catch (const Error& caught) {
        return caught;
      }
      ::_exit(2);
    }();
    if (error.code() != ErrorCode::FileUnwritable) ::_exit(3);
    // The same object goes on with what there is.
    if (catalog.names() != std::vector<std::string>{"old"}) ::_exit(4);
  });
  CAPTURE(room);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  const Catalog catalog = readable(file);
  CHECK(catalog.names() == std::vector<std::string>{"old"});
  CHECK(catalog.find("old")->volume_mm3 == 64'000.0);
  CHECK(catalog.solid("old")->triangles.size() == 12);
}

TEST_CASE("A catalogue that cannot be started leaves nothing that looks like one", "[fault]") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  const int status = in_child([&] {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit limit{6000, 6000};
    ::setrlimit(RLIMIT_FSIZE, &limit);
    try {
      writable(file);
    } catch (const Error& error) {
      ::_exit(error.code() == ErrorCode::FileUnwritable ? 0 : 1);
    }
    ::_exit(2);
  });
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 0);
  // With room again, it is made.
  Catalog catalog = writable(file);
  CHECK(catalog.names().empty());
}

TEST_CASE("A writer killed at any moment leaves whole elements", "[fault]") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  put(*std::make_unique<Catalog>(writable(file)), "pair.step",
      {block_record("left", 1.0), block_record("right", 1.0)});

  std::mt19937 random(11);
  int changed = 0;
  double last = 1.0;
  constexpr int kKills = 40;
  for (int i = 0; i < kKills; ++i) {
    std::array<int, 2> started{};
    REQUIRE(::pipe(started.data()) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
      try {
        Catalog catalog = writable(file);
        for (int k = 2;; ++k) {
          if (k == 3 && ::write(started[1], "x", 1) != 1) ::_exit(1);
          // Both always say the same length; the content is large enough to be cut.
          ElementRecord left = block_record("left", i * 1000.0 + k);
          ElementRecord right = block_record("right", i * 1000.0 + k);
          left.brep.assign(200'000, static_cast<std::byte>(k));
          right.brep.assign(200'000, static_cast<std::byte>(k));
          put(catalog, "pair.step", {left, right});
        }
      } catch (...) {
        ::_exit(1);
      }
    }
    char one = 0;
    ::close(started[1]);
    REQUIRE(::read(started[0], &one, 1) == 1);
    ::close(started[0]);
    ::usleep(static_cast<useconds_t>(random() % 30'000));
    ::kill(child, SIGKILL);
    int status = 0;
    ::waitpid(child, &status, 0);
    REQUIRE(WIFSIGNALED(status));

    CAPTURE(i);
    const Catalog catalog = readable(file);
    REQUIRE(catalog.names() == std::vector<std::string>{"left", "right"});
    const double length = catalog.find("left")->volume_mm3;
    CHECK(catalog.find("right")->volume_mm3 == length);
    CHECK(catalog.brep("left") == catalog.brep("right"));
    CHECK(catalog.solid("left")->triangles.size() == 12);
    changed += length != last ? 1 : 0;
    last = length;
  }
  CHECK(changed > kKills / 4);  // the kills came while there was writing
}

TEST_CASE("A journal that a killed writer left is played back by a reader", "[fault]") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  put(*std::make_unique<Catalog>(writable(file)), "a.step", {block_record("a")});
  const int status = in_child([&] {
    // A cache of a few pages spills into the file before the transaction ends.
    SQLite::Database database(file.string(), SQLite::OPEN_READWRITE);
    database.exec("PRAGMA cache_size = 2");
    SQLite::Transaction transaction(database);
    database.exec("DELETE FROM source");
    database.exec("CREATE TABLE junk (bytes BLOB)");
    database.exec("INSERT INTO junk VALUES (randomblob(300000)), (randomblob(300000))");
    ::raise(SIGKILL);
  });
  REQUIRE(WIFSIGNALED(status));
  REQUIRE(std::filesystem::file_size(file.string() + "-journal") > 0);
  REQUIRE(std::filesystem::file_size(file) > 300'000);
  const Catalog catalog = readable(file);
  CHECK(catalog.names() == std::vector<std::string>{"a"});
  CHECK(catalog.solid("a")->triangles.size() == 12);
}
