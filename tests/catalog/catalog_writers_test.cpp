// Writers that are killed, run out of room or get into each other's way.

#include <array>
#include <csignal>
#include <random>
#include <string>
#include <vector>

#include <SQLiteCpp/SQLiteCpp.h>
#include <catch2/catch.hpp>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "catalog_files.h"

using namespace dowel;
using namespace dowel::testing;

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
TEST_CASE("A reader that has read, or met damage, leaves the file free for writers") {
  const TemporaryFolder folder;
  const auto file = folder / "c.db";
  Catalog catalog = writable(file);
  put(catalog, "a.step", {block_record("a"), block_record("b")});
  const Catalog reader = readable(file);
  CHECK(reader.find("a"));
  put(catalog, "c.step", {block_record("c")});
  CHECK(reader.find("c"));
  execute(file, "UPDATE bolt_circle SET diameter_mm = -1.0");
  CHECK(error_of([&] { reader.find("a"); }).code() == ErrorCode::FileMalformed);
  put(catalog, "a.step", {block_record("a"), block_record("b")});
  CHECK(reader.find("a"));
}
