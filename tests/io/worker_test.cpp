#include "worker.h"

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstddef>
#include <cstdio>
#include <functional>
#include <new>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace dowel {
namespace {

using Report = std::function<void(WorkerStage)>;

WorkerOutcome run_one(const WorkerLimits& limits, const WorkerTask& task) {
  WorkerOutcome only;
  run_workers(1, 1, limits, task, [&](std::size_t, WorkerOutcome&& outcome) {
    only = std::move(outcome);
    return true;
  });
  return only;
}

std::vector<std::byte> bytes_of(const std::string& text) {
  const auto bytes = std::as_bytes(std::span(text.data(), text.size()));
  return {bytes.begin(), bytes.end()};
}

bool has_children() {
  return ::waitpid(-1, nullptr, WNOHANG) >= 0 || errno != ECHILD;
}

TEST_CASE("a worker hands its bytes back, however many") {
  const std::string large(3'000'000, 'x');
  const WorkerOutcome outcome = run_one({}, [&](std::size_t, const Report& report) {
    report(WorkerStage::Read);
    report(WorkerStage::Mesh);
    return bytes_of(large);
  });
  CHECK(outcome.failure.empty());
  CHECK(outcome.output == bytes_of(large));
  CHECK_FALSE(has_children());
}

TEST_CASE("a crash tells its signal and stage") {
  const WorkerOutcome outcome = run_one({}, [](std::size_t, const Report& report) {
    report(WorkerStage::Transfer);
    std::raise(SIGSEGV);
    return std::vector<std::byte>{};
  });
  CHECK(outcome.failure == "reader crashed (SIGSEGV) in transfer");
  CHECK(outcome.output.empty());
  CHECK_FALSE(has_children());
}

TEST_CASE("a worker that hangs is ended at its time limit") {
  const auto start = std::chrono::steady_clock::now();
  const WorkerOutcome outcome =
      run_one({.max_seconds = 0.3}, [](std::size_t, const Report& report) {
        report(WorkerStage::Mesh);
        for (;;) ::pause();
        return std::vector<std::byte>{};
      });
  CHECK(outcome.failure == "time limit of 0.3 s reached in mesh");
  CHECK(std::chrono::steady_clock::now() - start < std::chrono::seconds(20));
  CHECK_FALSE(has_children());
}

TEST_CASE("a worker that computes without end is ended by its processor time") {
  const WorkerOutcome outcome =
      run_one({.max_seconds = 1.0}, [](std::size_t, const Report& report) {
        report(WorkerStage::Mesh);
        for (volatile unsigned i = 0;;) i = i + 1;
        return std::vector<std::byte>{};
      });
  CHECK(outcome.failure == "time limit of 1 s reached in mesh");
  CHECK_FALSE(has_children());
}

TEST_CASE("exceptions of a worker become its failure") {
  const auto thrown = [](auto exception) {
    return run_one({},
                   [&](std::size_t, const Report& report) -> std::vector<std::byte> {
                     report(WorkerStage::Read);
                     throw exception;
                   })
        .failure;
  };
  CHECK(thrown(std::runtime_error("no such face")) == "no such face");
  CHECK(thrown(std::bad_alloc()) == "memory limit of 4096 MB reached in read");
  CHECK(thrown(42) == "unknown exception in read");
}

#ifndef DOWEL_SANITIZED
TEST_CASE("a worker gets no more memory than its limit") {
  const WorkerOutcome outcome =
      run_one({.max_memory_mb = 64}, [](std::size_t, const Report& report) {
        report(WorkerStage::Mesh);
        std::vector<std::byte> hoard(std::size_t{1} << 30U, std::byte{1});
        return std::vector<std::byte>(1, hoard.back());
      });
  CHECK(outcome.failure == "memory limit of 64 MB reached in mesh");
}
#endif

TEST_CASE("a worker that leaves without a result has failed") {
  const WorkerOutcome outcome = run_one({}, [](std::size_t, const Report&) {
    ::_exit(7);
    return std::vector<std::byte>{};
  });
  CHECK(outcome.failure == "reader ended without a result (exit code 7) in start");
}

TEST_CASE("what a worker prints is not printed") {
  const int saved = ::dup(STDOUT_FILENO);
  std::FILE* captured = std::tmpfile();
  REQUIRE(captured != nullptr);
  std::fflush(stdout);
  ::dup2(::fileno(captured), STDOUT_FILENO);
  std::printf("parent ");  // stays in the buffer that the child inherits
  const WorkerOutcome outcome = run_one({}, [](std::size_t, const Report&) {
    std::printf("child");
    std::fflush(stdout);
    return bytes_of("done");
  });
  std::fflush(stdout);
  ::dup2(saved, STDOUT_FILENO);
  ::close(saved);
  std::rewind(captured);
  std::string text(64, '\0');
  text.resize(std::fread(text.data(), 1, text.size(), captured));
  std::fclose(captured);
  CHECK(outcome.failure.empty());
  CHECK(text == "parent ");
}

TEST_CASE("outcomes come in order, whatever order the workers end in") {
  std::vector<std::size_t> order;
  run_workers(
      9, 3, {},
      [](std::size_t index, const Report&) {
        ::usleep(index % 3 == 0 ? 60'000 : 1'000);
        return bytes_of(std::to_string(index));
      },
      [&](std::size_t index, WorkerOutcome&& outcome) {
        CHECK(outcome.output == bytes_of(std::to_string(index)));
        order.push_back(index);
        return true;
      });
  CHECK(order == std::vector<std::size_t>{0, 1, 2, 3, 4, 5, 6, 7, 8});
}

TEST_CASE("no outcome follows the one that was answered with false, and no child stays") {
  std::size_t calls = 0;
  run_workers(
      100, 4, {},
      [](std::size_t index, const Report&) {
        if (index > 2) ::sleep(60);
        return std::vector<std::byte>{};
      },
      [&](std::size_t, WorkerOutcome&&) { return ++calls < 2; });
  CHECK(calls == 2);
  CHECK_FALSE(has_children());
}

TEST_CASE("whoever stops the workers gets no outcome after that, and no child stays") {
  std::size_t calls = 0;
  bool is_stopped = false;
  run_workers(
      100, 2, {},
      [](std::size_t index, const Report&) {
        if (index > 2) ::sleep(60);
        return std::vector<std::byte>{};
      },
      [&](std::size_t, WorkerOutcome&&) {
        is_stopped = ++calls == 3;
        return true;
      },
      [&] { return is_stopped; });
  CHECK(calls == 3);
  CHECK_FALSE(has_children());
}

TEST_CASE("a worker is out of reach of the Ctrl-C that its caller gets") {
  const pid_t group = ::getpgrp();
  const WorkerOutcome outcome = run_one({}, [&](std::size_t, const Report&) {
    return bytes_of(::getpgrp() == group ? "the same group" : "a group of its own");
  });
  CHECK(outcome.output == bytes_of("a group of its own"));
}

TEST_CASE("an exception of the receiver leaves no child behind") {
  CHECK_THROWS_AS(run_workers(
                      3, 2, {},
                      [](std::size_t index, const Report&) {
                        if (index > 0) ::sleep(60);
                        return std::vector<std::byte>{};
                      },
                      [](std::size_t, WorkerOutcome&&) -> bool { throw std::runtime_error("no"); }),
                  std::runtime_error);
  CHECK_FALSE(has_children());
}

}  // namespace
}  // namespace dowel
