#pragma once

// The words of the prompt, of scripts and of the verbs: one table, one interpreter.

#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/assembly/session.h"
#include "json.h"
#include "script_words.h"

namespace dowel::tools {

/// What a command has to say.
struct Reply {
  /// "done", "refused"; the verdict of a move or check is `verdict`.
  std::string outcome = "done";
  std::string verdict;  ///< "clear", "contact", "interference"; empty where nothing was checked
  std::string text;     ///< for people, without the last line end; may be empty
  Json json = Json::object();  ///< further keys
  bool has_findings = false;   ///< exit code 1
  bool has_bad_input = false;  ///< exit code 3, though what could be done was
  bool quits = false;
};

class RuleDesk;

/// A project under the hands of a user, in a file or in memory, and the catalogue in use.
class Console {
 public:
  /// Works in memory until `create`, `open` or `save`.
  Console();
  ~Console();
  Console(const Console&) = delete;
  Console& operator=(const Console&) = delete;

  Session& session() { return *session_; }
  /// Checks of rules on this project, kept from one to the next.
  RuleDesk& rules();

  void create(const std::filesystem::path& file);
  void open(const std::filesystem::path& file);
  void use_catalog(const std::filesystem::path& file);

  /// Runs one command. `words` is not empty. Throws CommandError for bad input, Error where a file
  /// fails; nothing has changed then.
  Reply run(const std::vector<Word>& words);

  /// What the word under the cursor may become: `before` are the words in front of it.
  std::vector<std::string> completions(const std::vector<Word>& before, std::string_view start);

 private:
  void adopt(Project project);

  std::shared_ptr<const Catalog> catalog_;
  std::unique_ptr<Session> session_;
  std::unique_ptr<RuleDesk> rules_;  // of the session, so that it goes first
};

struct Command {
  std::string_view word;
  std::string_view arguments;
  std::string_view help;     ///< one sentence
  std::string_view example;  ///< one line, without the prompt
  bool is_verb;              ///< of use as `dowel WORD --project FILE ...`
  Reply (*run)(Console&, Arguments&);
};

/// In the order in which help shows them.
std::span<const Command> commands();

/// The command called `word`; nothing where there is none.
const Command* find_command(std::string_view word);

/// Throws CommandError, with suggestions, for a word that is no command.
const Command& command_for(const Word& word);

}  // namespace dowel::tools
