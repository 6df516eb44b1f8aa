// The dowel program: picks the subcommand and turns what goes wrong into exit codes.

#include <csignal>
#include <cstdio>
#include <exception>

#include <CLI/CLI.hpp>

#include "commands.h"
#include "dowel/kernel/error.h"

int main(int argc, char** argv) {
  namespace tools = dowel::tools;
  // A limit on file sizes is to read like a full disk, not to end the program.
  std::signal(SIGXFSZ, SIG_IGN);
  int exit_code = tools::kDone;
  try {
    CLI::App app("Designs modular fixtures: catalogue, placement, collision checks, exports.",
                 "dowel");
    app.set_version_flag("--version", "dowel " DOWEL_VERSION);
    app.require_subcommand(0, 1);
    tools::add_catalog_commands(app, exit_code);
    tools::add_collide_command(app, exit_code);
    tools::add_library_command(app, exit_code);
    tools::add_project_commands(app, exit_code);
    try {
      app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
      return app.exit(error) == 0 ? tools::kDone : tools::kUsage;
    }
    return exit_code;
  } catch (const dowel::Error& error) {
    std::fprintf(stderr, "dowel: error: %s\n", error.what());
    return tools::kBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "dowel: internal error: %s\n", error.what());
    return tools::kInternal;
  }
}
