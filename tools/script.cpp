#include "script.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <istream>
#include <sstream>

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

/// The lines of a script one after the other, and errors told with their place.
class ScriptLines {
 public:
  ScriptLines(std::string_view name, const ScriptOptions& options)
      : name_(name), options_(options) {}

  /// Number of the line that `next` split last, from 1.
  std::size_t number() const { return number_; }
  std::string name() const { return printable(name_); }

  /// The words of `line`, which follows the one before. Throws CommandError.
  std::vector<Word> next(std::string_view line) {
    ++number_;
    if (number_ == 1 && line.starts_with(kByteOrderMark)) {
      line.remove_prefix(kByteOrderMark.size());
    }
    if (line.size() > kLongestLine) {
      throw CommandError(ErrorCode::InvalidInput,
                         "the line has " + std::to_string(line.size()) + " bytes, more than the " +
                             std::to_string(kLongestLine) + " that a command may have",
                         1);
    }
    return split_words(line);
  }

  void tell(std::size_t column, const char* message) const {
    // Results that were printed before come first, also where both go to one file.
    std::fflush(stdout);
    std::fprintf(stderr, "%s:%zu:%zu: error: %s\n", name().c_str(), number_, column,
                 printable(message).c_str());
  }

  /// The same for the command `word`, also as JSON.
  void tell(const CommandError& error, std::string_view word) const {
    tell(error.column(), error.what());
    if (!options_.json) return;
    print_line(to_line({{"command", word},
                        {"line", number_},
                        {"column", error.column()},
                        {"outcome", "error"},
                        {"error", error.what()}}));
  }

 private:
  std::string_view name_;
  const ScriptOptions& options_;
  std::size_t number_ = 0;
};

/// A run of a script: where it is and what has come of it.
class ScriptRun {
 public:
  ScriptRun(Console& console, std::string_view name, const ScriptOptions& options)
      : console_(console), lines_(name, options), options_(options) {}

  /// False where the script is to end.
  bool run_line(std::string_view line) {
    std::vector<Word> words;
    try {
      words = lines_.next(line);
      if (words.empty()) return true;
      return run_words(words);
    } catch (const CommandError& error) {
      exit_code_ = kBadInput;
      lines_.tell(error, words.empty() ? std::string_view() : words.front().text);
      return go_on();
    }
  }

  int exit_code() const { return exit_code_; }

 private:
  bool run_words(const std::vector<Word>& words) {
    if (options_.echo && !options_.json) print_line("> " + printable(join_words(words)));
    const auto start = std::chrono::steady_clock::now();
    const Reply reply = console_.run(words);
    ++done_;
    print_reply(reply, words.front().text, lines_.number(), seconds_since(start), options_);
    if (reply.has_bad_input) exit_code_ = std::max(exit_code_, kBadInput);
    if (!reply.has_findings) return !reply.quits;
    exit_code_ = std::max(exit_code_, kFindings);
    if (words.front().text != "expect") return true;
    lines_.tell(words.front().column, "the command did not end as expected");
    return go_on();
  }

  bool go_on() const {
    if (options_.keep_going) return true;
    const std::string before = done_ == 0 ? std::string()
                                          : "; " + counted(done_, "command") + " before it " +
                                                (done_ == 1 ? "stays" : "stay") + " done";
    std::fprintf(stderr, "%s: stopped%s\n", lines_.name().c_str(), before.c_str());
    return false;
  }

  Console& console_;
  ScriptLines lines_;
  const ScriptOptions& options_;
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

bool check_script(std::string_view name, const std::string& text, const ScriptOptions& options) {
  ScriptLines lines(name, options);
  std::istringstream script(text);
  for (std::string line; std::getline(script, line);) {
    std::vector<Word> words;
    try {
      words = lines.next(line);
      if (words.empty()) continue;
      command_for(words.front());
      if (words.front().text == "quit") break;
    } catch (const CommandError& error) {
      lines.tell(error, words.empty() ? std::string_view() : words.front().text);
      std::fprintf(stderr, "%s: nothing of it was run\n", lines.name().c_str());
      return false;
    }
  }
  return true;
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
