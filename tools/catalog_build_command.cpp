// dowel catalog build.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "catalog_commands.h"
#include "commands.h"
#include "dowel/io/catalog_build.h"
#include "interrupt.h"
#include "json.h"
#include "progress.h"
#include "table.h"

namespace dowel::tools {
namespace {

constexpr const char* kRed = "31";
constexpr const char* kGreen = "32";
constexpr const char* kYellow = "33";

struct BuildArguments {
  std::vector<std::string> paths;
  std::string output;
  unsigned jobs = std::max(1U, std::thread::hardware_concurrency());
  bool force = false;
  std::optional<std::string> licence;
  std::optional<std::string> assemblies;
  double max_seconds = ImportOptions().max_seconds;
  std::size_t max_memory_mb = ImportOptions().max_memory_mb;
  bool json = false;
};

/// Of one file, as text.
constexpr std::size_t kShownWarnings = 3;

bool has_elements(const BuiltFile& file) {
  return file.status == BuildStatus::Ok || file.status == BuildStatus::Unchanged;
}

Json to_json(const BuiltFile& file) {
  Json json;
  json["file"] = file.file;
  json["status"] = to_string(file.status);
  if (has_elements(file)) {
    json["elements"] = file.elements;
    if (file.status == BuildStatus::Ok) json["faces"] = file.faces;
  } else {
    json["reason"] = file.reason;
  }
  if (!file.project.empty()) {
    json["project"] = file.project;
    json["instances"] = file.instances;
  }
  if (!file.warnings.empty()) json["warnings"] = file.warnings;
  json["seconds"] = file.seconds;
  return json;
}

std::string to_text(const BuiltFile& file) {
  const char* const colour = file.status == BuildStatus::Failed  ? kRed
                             : file.status == BuildStatus::Empty ? kYellow
                                                                 : kGreen;
  std::string status(to_string(file.status));
  status.resize(std::string_view("unchanged").size(), ' ');
  std::string what = file.reason;
  if (has_elements(file)) {
    what.clear();
    for (const std::string& element : file.elements) what += (what.empty() ? "" : ", ") + element;
  }
  std::string text =
      coloured(status, colour) + "  " + printable(file.file) + ": " + printable(what);
  if (!file.project.empty()) {
    text += "\n           " + counted(file.instances, "instance") + " in project " +
            printable(file.project);
  }
  const std::size_t shown = std::min(file.warnings.size(), kShownWarnings);
  for (std::size_t i = 0; i < shown; ++i) {
    text += "\n           " + coloured("warning", kYellow) + " " + printable(file.warnings[i]);
  }
  if (shown < file.warnings.size()) {
    text += "\n           and " + counted(file.warnings.size() - shown, "more warning") +
            "; --json tells all";
  }
  return text;
}

std::size_t count(const std::vector<BuiltFile>& files, BuildStatus status) {
  return static_cast<std::size_t>(std::ranges::count(files, status, &BuiltFile::status));
}

/// Of the files that were read now: ", 3.1 files/s, 420 faces/s".
std::string throughput_text(const std::vector<BuiltFile>& files, double seconds) {
  std::size_t read = 0;
  std::size_t faces = 0;
  for (const BuiltFile& file : files) {
    if (file.seconds > 0.0) ++read;
    faces += file.faces;
  }
  if (read == 0 || !(seconds > 0.0)) return "";
  char text[80];
  std::snprintf(text, sizeof text, ", %.1f files/s, %.0f faces/s",
                static_cast<double>(read) / seconds, static_cast<double>(faces) / seconds);
  return text;
}

std::string build_summary(const std::vector<BuiltFile>& files, double seconds) {
  std::size_t elements = 0;
  for (const BuiltFile& file : files) elements += file.elements.size();
  std::string text = counted(files.size(), "file") + ", " + counted(elements, "element") + ": ";
  for (const BuildStatus status : {BuildStatus::Ok, BuildStatus::Unchanged, BuildStatus::Empty}) {
    text += std::to_string(count(files, status)) + " " + std::string(to_string(status)) + ", ";
  }
  return text + std::to_string(count(files, BuildStatus::Failed)) + " failed; " +
         duration_text(seconds) + throughput_text(files, seconds);
}

int run_build(const BuildArguments& arguments) {
  BuildOptions options;
  options.jobs = arguments.jobs;
  options.force = arguments.force;
  options.licence = arguments.licence;
  options.import.max_seconds = arguments.max_seconds;
  options.import.max_memory_mb = arguments.max_memory_mb;
  if (arguments.assemblies) options.assemblies = *arguments.assemblies;
  const std::vector<std::filesystem::path> paths(arguments.paths.begin(), arguments.paths.end());

  const auto start = std::chrono::steady_clock::now();
  Progress progress("files");
  std::size_t skipped = 0;
  std::size_t total_files = 0;
  const auto report = [&](const BuiltFile& file, std::size_t done, std::size_t total) {
    total_files = total;
    if (file.seconds == 0.0) ++skipped;
    if (arguments.json) {
      progress.clear();
      print_line(to_line(to_json(file)));
    } else if (file.status != BuildStatus::Unchanged) {
      progress.clear();
      print_line(to_text(file));
    }
    progress.update(done, total, file.file, skipped);
    return true;
  };
  const InterruptWatch watch;
  options.stop = [&watch] { return watch.signal() != 0; };
  const std::vector<BuiltFile> files = build_catalog(paths, arguments.output, options, report);
  progress.clear();
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start;
  if (!arguments.json) print_line(build_summary(files, taken.count()));
  if (watch.signal() != 0) {
    const std::string done = total_files == 0 ? "before the first file"
                                              : "after " + std::to_string(files.size()) + " of " +
                                                    counted(total_files, "file");
    std::fprintf(stderr, "dowel: interrupted %s; the same command goes on from there\n",
                 done.c_str());
    return kSignalled + watch.signal();
  }

  const std::size_t failed = count(files, BuildStatus::Failed);
  if (failed == 0) return kDone;
  return failed == files.size() ? kBadInput : kFindings;
}

}  // namespace

void add_build_command(CLI::App& catalog, int& exit_code) {
  const auto arguments = std::make_shared<BuildArguments>();
  CLI::App* const command = catalog.add_subcommand(
      "build",
      "Adds or refreshes the elements of STEP and mesh files. Unchanged files are skipped.");
  command->add_option("PATH", arguments->paths, "files, and folders with all files in them")
      ->required();
  command->add_option("-o,--output", arguments->output, "the catalogue; made where it is missing")
      ->required()
      ->type_name("CATALOG.db");
  command->add_option("--jobs", arguments->jobs, "files read at a time")
      ->check(CLI::Range(1U, 256U))
      ->capture_default_str();
  command->add_flag("--force", arguments->force, "reads unchanged files, too");
  command->add_option("--licence", arguments->licence, "recorded with the elements")
      ->type_name("TEXT");
  command
      ->add_option("--assemblies", arguments->assemblies,
                   "folder to write a project to for each file that places more than one part")
      ->type_name("FOLDER");
  command
      ->add_option("--max-seconds", arguments->max_seconds,
                   "processor time for a file; four times that by the clock")
      ->check(CLI::Range(1.0, 1.0e6))
      ->capture_default_str();
  command->add_option("--max-memory", arguments->max_memory_mb, "address space for a file in MB")
      ->check(CLI::Range(std::size_t{256}, std::size_t{1'000'000}))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "one line of JSON a file");
  command->callback([arguments, &exit_code] { exit_code = run_build(*arguments); });
}

}  // namespace dowel::tools
