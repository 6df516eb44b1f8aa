// dowel catalog build that is interrupted, and dowel catalog sheet, run as their users run them.

#include <csignal>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "program.h"

namespace {

using dowel::testing::ProgramResult;
using dowel::testing::read_text;
using dowel::testing::run_dowel;
using dowel::testing::TemporaryFolder;
using dowel::testing::write_text;

constexpr int kFiles = 150;

std::string block_off(int height_mm) {
  const std::string h = " " + std::to_string(height_mm) + "\n";
  return "OFF\n8 12 0\n0 0 0\n80 0 0\n80 40 0\n0 40 0\n0 0" + h + "80 0" + h + "80 40" + h +
         "0 40" + h +
         "3 0 2 1\n3 0 3 2\n3 4 5 6\n3 4 6 7\n3 0 1 5\n3 0 5 4\n"
         "3 1 2 6\n3 1 6 5\n3 2 3 7\n3 2 7 6\n3 3 0 4\n3 3 4 7\n";
}

std::size_t lines(const std::string& text, const std::string& with = "") {
  std::size_t count = 0;
  for (std::size_t from = 0, to = 0; (to = text.find('\n', from)) != text.npos; from = to + 1) {
    if (text.substr(from, to - from).find(with) != std::string::npos) ++count;
  }
  return count;
}

/// Starts a build in `folder` whose output goes to the files out and err there, in a group of its
/// own, as a shell starts a command.
pid_t start_build(const std::filesystem::path& folder) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  ::setpgid(0, 0);
  const bool ready =
      ::chdir(folder.c_str()) == 0 &&
      ::dup2(::open("out", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDOUT_FILENO) >= 0 &&
      ::dup2(::open("err", O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO) >= 0;
  if (ready) {
    ::execl(DOWEL_PROGRAM, DOWEL_PROGRAM, "catalog", "build", "parts", "-o", "c.db", "--json",
            "--jobs", "2", nullptr);
  }
  ::_exit(127);
}

}  // namespace

TEST_CASE("a build that Ctrl-C ends keeps what is done, and the next one takes up there") {
  const int signal = GENERATE(SIGINT, SIGTERM);
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "parts");
  for (int i = 0; i < kFiles; ++i) {
    write_text(folder / ("parts/block" + std::to_string(100 + i) + ".off"), block_off(10 + i));
  }
  const pid_t build = start_build(folder.path());
  while (!std::filesystem::exists(folder / "out") || lines(read_text(folder / "out")) < 3) {
    ::usleep(1000);
    REQUIRE(::waitpid(build, nullptr, WNOHANG) == 0);
  }
  // To the whole group, as a terminal sends it.
  REQUIRE(::kill(-build, signal) == 0);
  int status = 0;
  REQUIRE(::waitpid(build, &status, 0) == build);
  REQUIRE(WIFEXITED(status));
  CHECK(WEXITSTATUS(status) == 128 + signal);
  const std::size_t done = lines(read_text(folder / "out"));
  CHECK(lines(read_text(folder / "out"), "\"ok\"") == done);  // none is stored as failed
  CHECK(done >= 3);
  CHECK(done < kFiles);
  CHECK(read_text(folder / "err") == "dowel: interrupted after " + std::to_string(done) +
                                         " of 150 files; the same command goes on from there\n");

  const ProgramResult rest =
      run_dowel({"catalog", "build", "parts", "-o", "c.db", "--json"}, {.folder = folder.path()});
  CHECK(rest.exit_code == 0);
  CHECK(lines(rest.out, "\"unchanged\"") == done);
  CHECK(lines(rest.out, "\"ok\"") == kFiles - done);
}

TEST_CASE("a build tells its throughput in files and faces") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "parts");
  write_text(folder / "parts/a.off", block_off(10));
  write_text(folder / "parts/b.off", block_off(20));
  const std::vector<std::string> build{"catalog", "build", "parts", "-o", "c.db"};
  const ProgramResult first = run_dowel(build, {.folder = folder.path()});
  CHECK_THAT(first.out, Catch::Contains("files/s") && Catch::Contains("faces/s"));
  // Nothing is read, nothing is told.
  const ProgramResult second = run_dowel(build, {.folder = folder.path()});
  CHECK_THAT(second.out, !Catch::Contains("files/s"));
  const ProgramResult forced = run_dowel(
      {"catalog", "build", "parts", "-o", "c.db", "--force", "--json"}, {.folder = folder.path()});
  CHECK(lines(forced.out, "\"faces\":6") == 2);
}

TEST_CASE("a sheet is written of all elements or of those that match, whole or not at all") {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "parts");
  write_text(folder / "parts/low.off", block_off(10));
  write_text(folder / "parts/high.off", block_off(90));
  const auto dowel = [&](const std::vector<std::string>& arguments) {
    return run_dowel(arguments, {.folder = folder.path()});
  };
  REQUIRE(dowel({"catalog", "build", "parts", "-o", "c.db"}).exit_code == 0);
  const ProgramResult all = dowel({"catalog", "sheet", "c.db", "all.html"});
  CHECK(all.exit_code == 0);
  CHECK(all.out == "2 elements drawn in all.html\n");
  const ProgramResult some = dowel({"catalog", "sheet", "c.db", "some.html", "height>50"});
  CHECK(some.out == "1 element drawn in some.html\n");
  const std::string sheet = read_text(folder / "some.html");
  CHECK_THAT(sheet, Catch::Contains("<h3>high") && !Catch::Contains("<h3>low"));

  const ProgramResult none = dowel({"catalog", "sheet", "c.db", "none.html", "height>500"});
  CHECK(none.exit_code == 3);
  CHECK_THAT(none.err, Catch::Contains("c.db: no element to draw matches"));
  CHECK_FALSE(std::filesystem::exists(folder / "none.html"));
  CHECK(dowel({"catalog", "sheet", "missing.db", "x.html"}).exit_code == 3);
  CHECK(dowel({"catalog", "sheet", "c.db"}).exit_code == 2);
  CHECK(dowel({"catalog", "sheet", "c.db", "no/such/folder/x.html"}).exit_code == 3);
}
