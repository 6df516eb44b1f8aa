#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/io/import.h"
#include "dowel/kernel/mesh_defect.h"

namespace dowel {
namespace {

using Status = ImportResult::Status;

/// A line of the folder's table; counts are those of another program.
struct Expected {
  std::filesystem::path file;
  std::uintmax_t bytes = 0;
  std::optional<std::size_t> solids;
  std::optional<std::size_t> cylinders;
};

std::optional<std::size_t> count_in(const std::string& field) {
  if (field == "-") return std::nullopt;
  return std::stoul(field);
}

std::vector<Expected> table(const std::filesystem::path& folder) {
  std::vector<Expected> rows;
  std::ifstream manifest(folder / "MANIFEST.tsv");
  std::string line;
  std::getline(manifest, line);
  while (std::getline(manifest, line)) {
    std::istringstream fields(line);
    std::vector<std::string> field;
    for (std::string each; std::getline(fields, each, '\t');) field.push_back(each);
    if (field.size() < 13) continue;
    rows.push_back(
        {folder / field[0], std::stoull(field[5]), count_in(field[8]), count_in(field[10])});
  }
  return rows;
}

struct Counts {
  std::size_t solids = 0;
  std::size_t cylinders = 0;
};

Counts counts_of(const ImportResult& result) {
  Counts counts;
  for (const ImportedPart& part : result.parts) {
    counts.solids += part.solid.solid_count;
    for (const Face& face : part.solid.faces) {
      if (std::holds_alternative<CylinderSurface>(face.surface)) ++counts.cylinders;
    }
  }
  return counts;
}

void check_against_table(std::uintmax_t largest_bytes) {
  const std::filesystem::path folder = DOWEL_SHARED_STEP;
  if (!std::filesystem::exists(folder / "MANIFEST.tsv")) {
    WARN("no folder of real STEP files here: " << folder.string());
    return;
  }
  std::vector<Expected> rows;
  std::vector<std::filesystem::path> files;
  for (const Expected& row : table(folder)) {
    if (row.bytes > largest_bytes) continue;
    rows.push_back(row);
    files.push_back(row.file);
  }
  std::size_t ok = 0;
  import_files(files, {.whole_file = true}, 2, [&](std::size_t i, ImportResult&& result) {
    CAPTURE(rows[i].file.filename().string(), result.reason);
    const std::size_t expected = rows[i].solids.value_or(0);
    CHECK((result.status == Status::Ok) == (expected > 0));
    const Counts counts = counts_of(result);
    CHECK(counts.solids == expected);
    // Sewn cracks and swept surfaces may make a few cylinders more; none may get lost.
    CHECK(counts.cylinders >= rows[i].cylinders.value_or(0));
    for (const ImportedPart& part : result.parts) CHECK_FALSE(find_defect(part.solid));
    if (result.status == Status::Ok) ++ok;
    return true;
  });
  CHECK(ok > rows.size() / 2);
}

TEST_CASE("real STEP files give the solids and cylinders that their table says") {
  check_against_table(60'000);
}

// Half a minute: run by name or tag.
TEST_CASE("all real STEP files give the solids and cylinders that their table says", "[.slow]") {
  check_against_table(1'000'000'000);
}

}  // namespace
}  // namespace dowel
