// Projects that the program cannot read: a clear error, and nothing lost.

#include <filesystem>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "../assembly/fixture_elements.h"
#include "program.h"

namespace testing = dowel::testing;

namespace {

/// A folder with a project of one plate and what the program says there.
struct Desk {
  testing::TemporaryFolder folder;
  std::filesystem::path project = folder / "p.dwp";

  Desk() {
    testing::write_fixture_catalog(folder / "catalog.db");
    testing::write_text(folder / "job.dowel", "place T/plate-5x3 as PLATE\n");
    REQUIRE(run({"run", "job.dowel"}).exit_code == 0);
  }

  testing::ProgramResult run(std::vector<std::string> words) const {
    words.insert(words.end(), {"--project", "p.dwp", "--catalog", "catalog.db"});
    testing::ProgramOptions options;
    options.folder = folder.path();
    return testing::run_dowel(words, options);
  }

  std::size_t files() const {
    const std::filesystem::directory_iterator all(folder.path());
    return static_cast<std::size_t>(std::distance(begin(all), end(all)));
  }
};

/// Each word that reads or changes a project refuses `bytes` in its place with `what`, and leaves
/// them as they are.
void expect_refused(const Desk& desk, const std::string& bytes, const std::string& what) {
  testing::write_text(desk.project, bytes);
  const std::size_t files = desk.files();
  for (const std::vector<std::string>& words : {std::vector<std::string>{"list"},
                                                {"check"},
                                                {"undo"},
                                                {"bom"},
                                                {"history"},
                                                {"place", "T/block-40", "at", "0", "0", "100"},
                                                {"export", "out.csv"}}) {
    CAPTURE(words.front());
    const testing::ProgramResult result = desk.run(words);
    CHECK(result.exit_code == 3);
    CHECK(result.out.empty());
    CHECK_THAT(result.err, Catch::Contains("p.dwp") && Catch::Contains(what));
    CHECK(testing::read_text(desk.project) == bytes);
    CHECK(desk.files() == files);
  }
}

}  // namespace

TEST_CASE("a project of a newer version is refused with both versions, and stays", "[fault]") {
  const Desk desk;
  std::string bytes = testing::read_text(desk.project);
  // The header of an SQLite file has the program's version from byte 60 on, high byte first.
  REQUIRE(bytes.substr(60, 4) == std::string("\0\0\0\2", 4));
  bytes[63] = 7;
  expect_refused(desk, bytes, "is a project of version 7, this program reads version 2");
  bytes[63] = 2;
  testing::write_text(desk.project, bytes);
  CHECK_THAT(desk.run({"list"}).out, Catch::Contains("PLATE"));
}

TEST_CASE("a damaged project is refused as damaged, and stays", "[fault]") {
  const Desk desk;
  const std::string bytes = testing::read_text(desk.project);
  expect_refused(desk, bytes.substr(0, bytes.size() / 2), "damaged");
  expect_refused(desk, "", "is not a dowel project");
  expect_refused(desk, "place T/block-40\n", "is not a dowel project");
}
