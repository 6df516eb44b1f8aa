#include "dowel/io/file.h"

#include <functional>
#include <iterator>
#include <string>

#include <catch2/catch.hpp>
#include <sys/stat.h>

#include "dowel/kernel/error.h"
#include "program.h"

namespace dowel {
namespace {

using testing::TemporaryFolder;

std::size_t files_in(const std::filesystem::path& folder) {
  const std::filesystem::directory_iterator all(folder);
  return static_cast<std::size_t>(std::distance(begin(all), end(all)));
}

ErrorCode code_of(const std::function<void()>& action) {
  try {
    action();
  } catch (const Error& error) {
    return error.code();
  }
  FAIL("nothing was thrown");
  return ErrorCode::NotFound;
}

TEST_CASE("a file has what was written, byte for byte") {
  const TemporaryFolder folder;
  const std::string content("line\r\n\0\xFF end", 13);
  write_file(folder / "a file", content);
  CHECK(read_file(folder / "a file") == content);
  write_file(folder / "a file", std::string_view());
  CHECK(read_file(folder / "a file").empty());
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("a file that cannot be read is named") {
  const TemporaryFolder folder;
  CHECK(code_of([&] { read_file(folder / "none"); }) == ErrorCode::FileUnreadable);
  CHECK(code_of([&] { read_file(folder.path()); }) == ErrorCode::FileUnreadable);
  write_file(folder / "long", std::string(100, 'x'));
  CHECK(code_of([&] { read_file(folder / "long", 99); }) == ErrorCode::FileUnreadable);
  CHECK(read_file(folder / "long", 100).size() == 100);
  CHECK_THROWS_WITH(read_file(folder / "none"), Catch::Contains("none"));
}

TEST_CASE("a write that fails leaves the old content and no leftovers", "[fault]") {
  const TemporaryFolder folder;
  CHECK(code_of([&] { write_file(folder / "missing" / "file", "x"); }) ==
        ErrorCode::FileUnwritable);
  std::filesystem::create_directory(folder / "taken");
  write_file(folder / "taken" / "inside", "x");
  CHECK(code_of([&] { write_file(folder / "taken", "x"); }) == ErrorCode::FileUnwritable);
  CHECK(files_in(folder.path()) == 1);
}

TEST_CASE("a written file has the permissions that others have") {
  const TemporaryFolder folder;
  const mode_t before = ::umask(0022);
  write_file(folder / "file", "x");
  ::umask(before);
  struct stat status {};
  REQUIRE(::stat((folder / "file").c_str(), &status) == 0);
  CHECK((status.st_mode & 0777U) == 0644U);
}

}  // namespace
}  // namespace dowel
