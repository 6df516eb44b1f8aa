#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "../commands.h"
#include "builders.h"
#include "write_library.h"

namespace dowel::tools {
namespace {

struct LibraryOptions {
  std::string folder;
  std::vector<std::string> systems;  ///< none: all
  bool json = false;
};

std::vector<library::Part> parts_of(const std::vector<std::string>& systems) {
  if (systems.empty()) return library::all_parts();
  std::vector<library::Part> parts = library::workpieces();
  for (const library::System& system : library::systems()) {
    if (std::ranges::find(systems, system.name) == systems.end()) continue;
    for (library::Part& part : library::parts_of(system)) parts.push_back(std::move(part));
  }
  return parts;
}

void run_library(const LibraryOptions& options) {
  const std::vector<library::Part> parts = parts_of(options.systems);
  library::write_library(options.folder, parts);
  if (options.json) {
    nlohmann::ordered_json report;
    report["folder"] = options.folder;
    report["manifest"] = "library.json";
    report["files"] = nlohmann::ordered_json::array();
    for (const library::Part& part : parts) report["files"].push_back(library::file_name(part));
    std::printf("%s\n", report.dump().c_str());
  } else {
    std::printf("%zu elements written to %s, described in library.json\n", parts.size(),
                options.folder.c_str());
  }
}

}  // namespace

void add_library_command(CLI::App& app, int& exit_code) {
  const auto options = std::make_shared<LibraryOptions>();
  CLI::App* command = app.add_subcommand("library",
                                         "Writes the modular systems H40-12, H50-16, T14 and U12 "
                                         "and a sample workpiece as STEP files");
  command->add_option("folder", options->folder, "Folder to write to; made where it is missing")
      ->required();
  std::vector<std::string> names;
  for (const library::System& system : library::systems()) names.emplace_back(system.name);
  command
      ->add_option("--system", options->systems,
                   "only this one, and the workpiece; may be repeated")
      ->check(CLI::IsMember(names))
      ->type_name("NAME");
  command->add_flag("--json", options->json, "Report as JSON");
  command->callback([options, &exit_code] {
    run_library(*options);
    exit_code = kDone;
  });
}

}  // namespace dowel::tools
