// The prompt on a pseudo-terminal.

#include <algorithm>
#include <cctype>
#include <chrono>
#include <string>

#include <catch2/catch.hpp>
#include <poll.h>
#include <pty.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

#include "../assembly/fixture_elements.h"
#include "program.h"

namespace {

namespace testing = dowel::testing;

/// The program on a terminal of its own.
class Terminal {
 public:
  explicit Terminal(const std::filesystem::path& folder) {
    child_ = ::forkpty(&terminal_, nullptr, nullptr, nullptr);
    if (child_ < 0) throw std::runtime_error("forkpty failed");
    if (child_ == 0) {
      ::setenv("TERM", "xterm", 1);
      ::setenv("HOME", folder.c_str(), 1);
      if (::chdir(folder.c_str()) == 0) {
        ::execl(DOWEL_PROGRAM, DOWEL_PROGRAM, "--catalog", "catalog.db", nullptr);
      }
      ::_exit(127);
    }
  }
  ~Terminal() {
    if (terminal_ >= 0) ::close(terminal_);
    if (child_ > 0) ::waitpid(child_, nullptr, 0);
  }
  Terminal(const Terminal&) = delete;
  Terminal& operator=(const Terminal&) = delete;

  /// Expects a prompt. The editor writes it just before it takes the keys one by one: a Ctrl-D that
  /// comes between is the terminal's own, and lost.
  void type(const std::string& keys) {
    seen_.clear();
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (takes_lines() && std::chrono::steady_clock::now() < deadline) ::usleep(1000);
    if (::write(terminal_, keys.data(), keys.size()) < 0) throw std::runtime_error("write failed");
  }

  /// What came since the last `type`, without moves of the cursor, up to the next prompt, or all
  /// where none comes in time. A line that is edited stands behind its prompt, so that a prompt at
  /// the end of all is a new one; it is written once the editor reads keys.
  std::string reply() {
    const auto deadline = std::chrono::steady_clock::now() + kPatience;
    while (!plain().ends_with("\ndowel> ") && std::chrono::steady_clock::now() < deadline) {
      pollfd polled{terminal_, POLLIN, 0};
      if (::poll(&polled, 1, 1000) <= 0) continue;
      char buffer[4096];
      const ssize_t count = ::read(terminal_, buffer, sizeof buffer);
      if (count <= 0) break;  // the program has gone
      seen_.append(buffer, static_cast<std::size_t>(count));
    }
    return plain();
  }

  /// Ends a program that has not ended.
  int exit_status() {
    ::close(std::exchange(terminal_, -1));
    int status = 0;
    ::waitpid(std::exchange(child_, -1), &status, 0);
    return status;
  }

 private:
  static constexpr std::chrono::minutes kPatience{1};

  bool takes_lines() const {
    termios mode{};
    return ::tcgetattr(terminal_, &mode) == 0 && (mode.c_lflag & ICANON) != 0;
  }

  /// A line editor may move the cursor to where it stands in the middle of a word.
  std::string plain() const {
    std::string result;
    for (auto it = seen_.begin(); it != seen_.end(); ++it) {
      if (*it == '\x1b') {  // up to the letter that ends the sequence
        it = std::find_if(it, seen_.end(), [](unsigned char c) { return std::isalpha(c) != 0; });
        if (it == seen_.end()) break;
      } else if (*it != '\r') {
        result += *it;
      }
    }
    return result;
  }

  int terminal_ = -1;
  pid_t child_ = -1;
  std::string seen_;
};

}  // namespace

TEST_CASE("the prompt completes names, drops a line at Ctrl-C and leaves at Ctrl-D") {
  using Catch::Contains;
  const testing::TemporaryFolder folder;
  testing::write_fixture_catalog(folder / "catalog.db");
  Terminal terminal(folder.path());
  CHECK_THAT(terminal.reply(), Contains("`help` lists the commands"));
  terminal.type("pla\tT/blo\tas A\n");  // only a completed line is understood
  CHECK_THAT(terminal.reply(), Contains("A: placed at 0 0 0, clear"));
  terminal.type("nonsense\x03");
  CHECK_THAT(terminal.reply(), Contains("^C"));
  terminal.type("remove A\n");
  CHECK_THAT(terminal.reply(), Contains("removed") && !Contains("unknown command"));
  terminal.type("\x04");
  terminal.reply();  // there is none: the terminal closes
  CHECK(terminal.exit_status() == 0);
}
