#pragma once

namespace CLI {
class App;
}

namespace dowel::tools {

/// Exit codes of every command (the documented contract).
inline constexpr int kDone = 0;
inline constexpr int kFindings = 1;
inline constexpr int kUsage = 2;
inline constexpr int kBadInput = 3;
inline constexpr int kInternal = 4;
/// Ended by a signal that was caught, as a shell tells it: 130 for Ctrl-C. What was done stays.
inline constexpr int kSignalled = 128;

/// Each adds its subcommands to `app`. A subcommand runs in its callback, prints results to
/// standard output and everything else to standard error, and leaves its exit code in `exit_code`.
/// Bad input is thrown as dowel::Error; main turns it into one line and exit code 3.
void add_catalog_commands(CLI::App& app, int& exit_code);
void add_collide_command(CLI::App& app, int& exit_code);
void add_library_command(CLI::App& app, int& exit_code);
void add_project_commands(CLI::App& app, int& exit_code);

}  // namespace dowel::tools
