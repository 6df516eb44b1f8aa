// dowel run, dowel do, the verbs, and dowel alone: the prompt.

#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>
#include <unistd.h>

#include "commands.h"
#include "dowel/io/file.h"
#include "script.h"

namespace dowel::tools {
namespace {

/// Given before or after the word, they are the same.
struct ProjectOptions {
  std::string project;
  std::string catalog;
};
using SharedProjectOptions = std::shared_ptr<ProjectOptions>;

void add_options(CLI::App& app, ProjectOptions& options) {
  app.add_option("--project", options.project, "Project file")->type_name("FILE");
  app.add_option("--catalog", options.catalog, "Catalogue that elements come from")
      ->type_name("DB");
}

/// Opens what the options name. A project that does not exist yet is made where `may_create`.
void prepare(Console& console, const ProjectOptions& options, bool may_create) {
  if (!options.catalog.empty()) console.use_catalog(options.catalog);
  if (options.project.empty()) return;
  std::error_code ignored;
  if (may_create && !std::filesystem::exists(options.project, ignored)) {
    console.create(options.project);
  } else {
    console.open(options.project);
  }
}

struct RunOptions {
  std::string script;
  ScriptOptions how;
};

void add_run(CLI::App& app, const SharedProjectOptions& project, int& exit_code) {
  CLI::App* run = app.add_subcommand("run", "Runs a script of commands");
  const auto options = std::make_shared<RunOptions>();
  run->add_option("SCRIPT", options->script, "Script file; - for standard input")->required();
  add_options(*run, *project);
  run->add_flag("--json", options->how.json, "One JSON object a command");
  run->add_flag("--keep-going", options->how.keep_going, "Go on past errors");
  run->add_flag("--echo", options->how.echo, "Show each command before its reply");
  run->add_flag("--times", options->how.times, "Tell how long each command took");
  run->callback([options, project, &exit_code] {
    const bool from_stdin = options->script == "-";
    // Before the project is touched: a script that is missing or none changes nothing.
    const std::string text = from_stdin ? std::string() : read_file(options->script);
    if (!options->how.keep_going && !check_script(options->script, text, options->how)) {
      exit_code = kBadInput;
      return;
    }
    Console console;
    prepare(console, *project, true);
    std::istringstream lines(text);
    exit_code = from_stdin ? run_script(console, "<stdin>", std::cin, options->how)
                           : run_script(console, options->script, lines, options->how);
  });
}

struct VerbOptions {
  std::vector<std::string> words;
  bool json = false;
  std::vector<std::string> options;  ///< further words, given as options
  bool needs_project = true;
};

/// `first`: the verb's own word, or empty where the words hold it.
void run_verb(const VerbOptions& options, const ProjectOptions& project, std::string_view first,
              int& exit_code) {
  if (options.needs_project && project.project.empty()) throw CLI::RequiredError("--project");
  std::vector<Word> words;
  if (!first.empty()) words.push_back({std::string(first), 1, false});
  for (const std::string& word : options.words) words.push_back({word, 1, false});
  for (const std::string& word : options.options) words.push_back({word, 1, false});
  Console console;
  prepare(console, project, false);
  const Reply reply = console.run(words);
  print_reply(reply, words.front().text, 0, 0.0, {.json = options.json});
  exit_code = reply.has_bad_input ? kBadInput : reply.has_findings ? kFindings : kDone;
}

/// Words of rules and export that may be written as options, too: `--gate error`.
void add_word_options(CLI::App& verb, const std::shared_ptr<VerbOptions>& options) {
  for (const std::string word : {"gate", "rules", "format", "to"}) {
    verb.add_option_function<std::vector<std::string>>(
            "--" + word,
            [options, word](const std::vector<std::string>& values) {
              for (const std::string& value : values) {
                options->options.push_back(word);
                options->options.push_back(value);
              }
            },
            "As the word `" + word + "`")
        ->allow_extra_args(false);
  }
  verb.add_flag_callback(
      "--strict", [options] { options->options.emplace_back("strict"); }, "As the word `strict`");
}

/// A verb without a project would do its work and lose it.
bool needs_project(std::string_view word) {
  return word != "new" && word != "list" && word != "show" && word != "diff";
}

void add_verb(CLI::App& app, const SharedProjectOptions& project, const Command& command,
              int& exit_code) {
  CLI::App* verb = app.add_subcommand(std::string(command.word), std::string(command.help));
  const auto options = std::make_shared<VerbOptions>();
  options->needs_project = needs_project(command.word);
  add_options(*verb, *project);
  verb->add_flag("--json", options->json, "One JSON object");
  verb->add_option("WORDS", options->words, std::string(command.arguments));
  if (command.word == "rules" || command.word == "export") add_word_options(*verb, options);
  verb->group("On a project");
  verb->callback([options, project, word = command.word, &exit_code] {
    run_verb(*options, *project, word, exit_code);
  });
}

void add_do(CLI::App& app, const SharedProjectOptions& project, int& exit_code) {
  CLI::App* verb = app.add_subcommand("do", "Runs one command of the prompt");
  const auto options = std::make_shared<VerbOptions>();
  add_options(*verb, *project);
  verb->add_flag("--json", options->json, "One JSON object");
  verb->add_option("WORDS", options->words, "The command, as at the prompt")->required();
  verb->group("On a project");
  verb->callback([options, project, &exit_code] { run_verb(*options, *project, {}, exit_code); });
}

}  // namespace

void add_project_commands(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<ProjectOptions>();
  add_run(app, options, exit_code);
  add_do(app, options, exit_code);
  for (const Command& command : commands()) {
    if (command.is_verb) add_verb(app, options, command, exit_code);
  }
  add_options(app, *options);
  app.final_callback([&app, options, &exit_code] {
    if (!app.get_subcommands().empty()) return;
    Console console;
    prepare(console, *options, true);
    exit_code = ::isatty(STDIN_FILENO) == 1 ? run_prompt(console)
                                            : run_script(console, "<stdin>", std::cin, {});
  });
}

}  // namespace dowel::tools
