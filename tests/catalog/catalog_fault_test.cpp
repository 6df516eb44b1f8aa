// Catalogue files that are damaged, or none at all.

#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/stat.h>

#include "catalog_files.h"

using namespace dowel;
using namespace dowel::testing;

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
  execute(file, "UPDATE blob SET bytes = x'010002' WHERE length(bytes) = 3");
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
