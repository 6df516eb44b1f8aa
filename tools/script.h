#pragma once

#include <iosfwd>
#include <string>
#include <string_view>

#include "console.h"

namespace dowel::tools {

struct ScriptOptions {
  bool json = false;        ///< one JSON object a command on standard output, nothing else there
  bool keep_going = false;  ///< go on past errors and failed expectations
  bool echo = false;        ///< show each command before its reply
  bool times = false;       ///< tell how long each command took
};

/// Prints what a command said; `line` is its place in a script, 0 where it has none.
void print_reply(const Reply& reply, std::string_view word, std::size_t line, double seconds,
                 const ScriptOptions& options);

/// True where each line of the script begins with a word of the console. Else tells, as
/// `run_script` does, where and why not.
bool check_script(std::string_view name, const std::string& text, const ScriptOptions& options);

/// Runs the commands of `script` one after the other and returns the exit code. Errors are told on
/// standard error as `name:line:column: error: ...`. Commands before an error stay done.
int run_script(Console& console, std::string_view name, std::istream& script,
               const ScriptOptions& options);

/// Reads commands from a terminal, with editing, history and completion. Returns the exit code.
int run_prompt(Console& console);

}  // namespace dowel::tools
