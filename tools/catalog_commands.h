#pragma once

namespace CLI {
class App;
}

namespace dowel::tools {

/// Words of `dowel catalog` that have a file of their own; see commands.h for how they behave.
void add_build_command(CLI::App& catalog, int& exit_code);
void add_sheet_command(CLI::App& catalog);

}  // namespace dowel::tools
