#pragma once

// Running the dowel program as its users do, and a folder that goes away with the test.

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace dowel::testing {

/// A fresh empty folder, removed with all that is in it at the end.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (std::filesystem::temp_directory_path() / "dowel-test-XXXXXX").string();
    if (::mkdtemp(pattern.data()) == nullptr) throw std::runtime_error("mkdtemp failed");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(std::string_view name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

inline std::string read_text(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw std::runtime_error("cannot read " + file.string());
  return {std::istreambuf_iterator<char>(stream), {}};
}

inline void write_text(const std::filesystem::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  if (!stream.flush()) throw std::runtime_error("cannot write " + file.string());
}

/// What a finished program left behind.
struct ProgramResult {
  int exit_code = -1;  ///< -1 where a signal ended it
  int signal = 0;      ///< the signal that ended it, or 0
  std::string out;     ///< all of standard output
  std::string err;     ///< all of standard error
};

struct ProgramOptions {
  std::filesystem::path folder{};  ///< working folder; empty: the caller's
  std::string input{};             ///< standard input
  std::filesystem::path out{};     ///< where standard output goes instead of `ProgramResult::out`
  std::vector<std::pair<std::string, std::string>> environment{};  ///< added or replaced
};

/// Runs `program` with `arguments` to its end.
inline ProgramResult run(const std::filesystem::path& program,
                         const std::vector<std::string>& arguments,
                         const ProgramOptions& options = {}) {
  const TemporaryFolder streams;
  write_text(streams / "in", options.input);
  const std::string in = (streams / "in").string();
  const std::string out = (options.out.empty() ? streams / "out" : options.out).string();
  const std::string err = (streams / "err").string();
  std::vector<std::string> words{program.string()};
  words.insert(words.end(), arguments.begin(), arguments.end());
  std::vector<char*> argv;
  argv.reserve(words.size() + 1);
  for (std::string& word : words) argv.push_back(word.data());
  argv.push_back(nullptr);

  const pid_t child = ::fork();
  if (child < 0) throw std::runtime_error("fork failed");
  if (child == 0) {
    for (const auto& [name, value] : options.environment) {
      ::setenv(name.c_str(), value.c_str(), 1);
    }
    const bool ready = ::dup2(::open(in.c_str(), O_RDONLY), STDIN_FILENO) >= 0 &&
                       ::dup2(::open(out.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO) >= 0 &&
                       ::dup2(::open(err.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO) >= 0 &&
                       (options.folder.empty() || ::chdir(options.folder.c_str()) == 0);
    if (ready) ::execv(argv[0], argv.data());
    ::_exit(127);
  }
  int status = 0;
  while (::waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) throw std::runtime_error("waitpid failed");
  }
  ProgramResult result;
  if (WIFEXITED(status)) result.exit_code = WEXITSTATUS(status);
  if (WIFSIGNALED(status)) result.signal = WTERMSIG(status);
  if (options.out.empty()) result.out = read_text(out);
  result.err = read_text(err);
  return result;
}

/// Runs the dowel program of this build.
inline ProgramResult run_dowel(const std::vector<std::string>& arguments,
                               const ProgramOptions& options = {}) {
  return run(DOWEL_PROGRAM, arguments, options);
}

}  // namespace dowel::testing
