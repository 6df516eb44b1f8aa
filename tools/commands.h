#pragma once

#include <CLI/CLI.hpp>

namespace dowel::tools {

/// Exit codes of every command (the documented contract).
enum ExitCode : int { kDone = 0, kFindings = 1, kUsage = 2, kBadInput = 3, kInternal = 4 };

/// Each adds its subcommands to `app`. A subcommand runs in its callback, prints results to
/// standard output and everything else to standard error, and leaves its exit code in `exit_code`.
/// Bad input is thrown as dowel::Error; main turns it into one line and exit code 3.
void add_catalog_commands(CLI::App& app, int& exit_code);
void add_collide_command(CLI::App& app, int& exit_code);
void add_library_command(CLI::App& app, int& exit_code);
void add_project_commands(CLI::App& app, int& exit_code);

}  // namespace dowel::tools
