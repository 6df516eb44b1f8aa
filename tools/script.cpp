#include "script.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <istream>

#include "commands.h"
#include "console_text.h"
#include "table.h"

namespace dowel::tools {
namespace {

/// A line longer than this is no command but a file of another kind.
constexpr std::size_t kLongestLine = 1U << 16U;

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// A run of a script: where it is and what has come of it.
class ScriptRun {
 public:
  ScriptRun(Console& console, std::string_view name, const ScriptOptions& options)
      : console_(console), name_(name), options_(options) {}

  /// False where the script is to end.
  bool run_line(std::string_view line) {
    ++line_;
    if (line_ == 1 && line.starts_with(kByteOrderMark)) line.remove_prefix(kByteOrderMark.size());
    std::vector<Word> words;
    try {
      if (line.size() > kLongestLine) {
        throw CommandError(ErrorCode::InvalidInput,
                           "the line has " + std::to_string(line.size()) +
                               " bytes, more than the " + std::to_string(kLongestLine) +
                               " that a command may have",
                           1);
      }
      words = split_words(line);
      if (words.empty()) return true;
      return run_words(words);
    } catch (const CommandError& error) {
      return fail(error, words.empty() ? std::string_view() : words.front().text);
    }
  }

  int exit_code() const { return exit_code_; }

 private:
  bool run_words(const std::vector<Word>& words) {
    if (options_.echo && !options_.json) print_line("> " + printable(join_words(words)));
    const auto start = std::chrono::steady_clock::now();
    const Reply reply = console_.run(words);
    ++done_;
    print_reply(reply, words.front().text, line_, seconds_since(start), options_);
    if (!reply.has_findings) return !reply.quits;
    exit_code_ = std::max<int>(exit_code_, kFindings);
    if (words.front().text != "expect") return true;
    tell_error(words.front().column, "the command did not end as expected");
    return go_on();
  }

  bool fail(const CommandError& error, std::string_view word) {
    exit_code_ = kBadInput;
    tell_error(error.column(), error.what());
    if (options_.json) {
      print_line(to_line({{"command", word},
                          {"line", line_},
                          {"column", error.column()},
                          {"outcome", "error"},
                          {"error", error.what()}}));
    }
    return go_on();
  }

  bool go_on() const {
    if (options_.keep_going) return true;
    const std::string before =
        done_ == 0 ? std::string() : "; " + counted(done_, "command") + " before it stay done";
    std::fprintf(stderr, "%s: stopped%s\n", printable(name_).c_str(), before.c_str());
    return false;
  }

  void tell_error(std::size_t column, const char* message) const {
    // Results that were printed before come first, also where both go to one file.
    std::fflush(stdout);
    std::fprintf(stderr, "%s:%zu:%zu: error: %s\n", printable(name_).c_str(), line_, column,
                 printable(message).c_str());
  }

  Console& console_;
  std::string_view name_;
  const ScriptOptions& options_;
  std::size_t line_ = 0;
  std::size_t done_ = 0;
  int exit_code_ = kDone;
};

}  // namespace

void print_reply(const Reply& reply, std::string_view word, std::size_t line, double seconds,
                 const ScriptOptions& options) {
  if (options.json) {
    Json json{{"command", word}};
    if (line > 0) json["line"] = line;
    json["outcome"] = reply.outcome;
    if (!reply.verdict.empty()) json["verdict"] = reply.verdict;
    json.update(reply.json);
    if (options.times) json["seconds"] = seconds;
    print_line(to_line(json));
    return;
  }
  if (!reply.text.empty()) print_line(reply.text);
  if (options.times) {
    std::fflush(stdout);
    std::fprintf(stderr, "%8.3f ms  line %zu  %s\n", 1.0e3 * seconds, line,
                 printable(word).c_str());
  }
}

int run_script(Console& console, std::string_view name, std::istream& script,
               const ScriptOptions& options) {
  ScriptRun run(console, name, options);
  std::string line;
  while (std::getline(script, line)) {
    if (!run.run_line(line)) break;
  }
  return run.exit_code();
}

}  // namespace dowel::tools
