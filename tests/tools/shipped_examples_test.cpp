// The fixtures that tools/demo shows: one that is sound, one with planted faults.

#include <filesystem>
#include <set>
#include <sstream>
#include <string>

#include <catch2/catch.hpp>

#include "program.h"

namespace {

namespace testing = dowel::testing;

/// The rules that a printed report tells as `severity`.
std::set<std::string> rules_told(const std::string& report, const std::string& severity) {
  std::set<std::string> result;
  std::istringstream lines(report);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string first;
    std::string rule;
    if (words >> first >> rule && first == severity) result.insert(rule);
  }
  return result;
}

}  // namespace

TEST_CASE("the demo's fixture passes, the one with planted faults fails the rules that it should",
          "[rule]") {
  const testing::TemporaryFolder folder;
  const auto dowel = [&](const std::vector<std::string>& words) {
    return testing::run_dowel(words, {.folder = folder.path()});
  };
  REQUIRE(dowel({"library", "elements", "--system", "H40-12"}).exit_code == 0);
  REQUIRE(dowel({"catalog", "build", "elements", "-o", "catalog.db"}).exit_code == 0);
  for (const std::string name : {"demo.dowel", "faults.dowel"}) {
    std::filesystem::copy_file(std::filesystem::path(DOWEL_TOOLS_FOLDER) / name, folder / name);
  }

  const auto sound = dowel({"run", "demo.dowel", "--catalog", "catalog.db"});
  INFO(sound.out << sound.err);
  CHECK(sound.exit_code == 0);
  CHECK(rules_told(sound.out, "error").empty());
  CHECK(sound.out.find(" 0 errors") != std::string::npos);

  const auto faulty = dowel({"run", "faults.dowel", "--catalog", "catalog.db"});
  INFO(faulty.out << faulty.err);
  CHECK(faulty.exit_code == 1);
  // A clamp beside the rests; spacers in each other, one of them loose and off the grid, as is the
  // locator that nobody screwed down; and a workpiece that can slide along x.
  CHECK(rules_told(faulty.out, "error") ==
        std::set<std::string>{"CLP-01", "COL-01", "FST-01", "LOC-01", "LOC-02"});
  CHECK(rules_told(faulty.out, "warning") == std::set<std::string>{"CMP-10", "STK-05", "SYS-01"});
}
