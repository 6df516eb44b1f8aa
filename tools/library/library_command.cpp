#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
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
  bool json = false;
};

void run_library(const LibraryOptions& options) {
  const std::vector<library::Part> parts = library::all_parts();
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
  command->add_flag("--json", options->json, "Report as JSON");
  command->callback([options, &exit_code] {
    run_library(*options);
    exit_code = kDone;
  });
}

}  // namespace dowel::tools
