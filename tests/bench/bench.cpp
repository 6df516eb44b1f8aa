#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>

#include "error_study.h"
#include "judged_moves.h"
#include "object_index.h"
#include "paper_tables.h"
#include "preparation.h"
#include "project_commands.h"
#include "query_files.h"
#include "report.h"
#include "rule_checks.h"
#include "skips.h"
#include "stability.h"

namespace dowel::bench {

namespace {

constexpr std::array kStudies{"moves",   "growth", "judged",    "error", "solids",
                              "objects", "skips",  "stability", "rules", "project"};

struct Arguments {
  Plan plan;
  bool is_quick = false;
  std::string json_file;
  std::string plot_folder;
  std::string query_folder;
  std::vector<std::string> studies;
  std::vector<std::string> methods;
  std::vector<std::string> scenes;
  std::vector<std::string> motions;
  std::size_t wrong_limit = 3;
};

bool is_wanted(const std::vector<std::string>& wanted, std::string_view name) {
  return wanted.empty() || std::ranges::find(wanted, name) != wanted.end();
}

/// A list that takes these names alone.
void add_names(CLI::App& app, const char* option, std::vector<std::string>& given,
               const char* purpose, std::vector<std::string> names) {
  app.add_option(option, given, purpose)->delimiter(',')->check(CLI::IsMember(std::move(names)));
}

void add_options(CLI::App& app, Arguments& given) {
  app.add_flag("--quick", given.is_quick,
               "Few poses, one round; fails where a verdict of dowel is wrong");
  add_names(app, "--only", given.studies, "Studies to run; all if not given",
            {kStudies.begin(), kStudies.end()});
  app.add_option(
         "--queries", given.query_folder,
         "Instead of all studies: judges the public test data in this folder (CSV of "
         "edge-edge and vertex-face, pairs of triangles in .tri); fails where dowel is wrong")
      ->check(CLI::ExistingDirectory);
  app.add_option("--json", given.json_file, "Writes all figures to this file");
  app.add_option("--plots", given.plot_folder, "Writes the diagrams into this folder")
      ->check(CLI::ExistingDirectory);
  app.add_option("--poses", given.plan.poses, "Poses of a motion")
      ->check(CLI::Range(1U, 1'000'000U))
      ->capture_default_str();
  app.add_option("--rounds", given.plan.rounds, "Each pose counts with its fastest round")
      ->check(CLI::Range(1U, 1'000'000U))
      ->capture_default_str();
  std::vector<std::string> methods;
  for (const Method& method : all_methods()) methods.emplace_back(method.name);
  add_names(app, "--methods", given.methods, "Methods to run", std::move(methods));
  add_names(app, "--scenes", given.scenes, "Scenes of the moves", {"a", "b", "c", "d"});
  std::vector<std::string> motions;
  motions.reserve(kMotionKinds.size());
  for (const MotionKind kind : kMotionKinds) motions.emplace_back(to_string(kind));
  add_names(app, "--motions", given.motions, "Motions to run", std::move(motions));
  app.add_option("--wrong", given.wrong_limit, "Wrong verdicts shown of each scene and motion")
      ->capture_default_str();
}

void run_moves(const Arguments& given, const std::vector<Method>& methods, Results& results) {
  for (Scenario& scenario : paper_scenarios()) {
    if (!is_wanted(given.scenes, scenario.name)) continue;
    std::fprintf(stderr, "scene %s\n", scenario.name.c_str());
    std::vector<Run> runs = run_scenario(scenario, methods, given.plan);
    std::move(runs.begin(), runs.end(), std::back_inserter(results.runs));
    results.scenarios.push_back(std::move(scenario));
  }
}

void run_growth(const Arguments& given, const std::vector<Method>& methods, Results& results) {
  std::vector<std::size_t> counts{10, 100, 1000, 10000, 100000};
  if (given.is_quick) counts.resize(3);
  for (const Method& method : methods) {
    for (const std::size_t count : counts) {
      if (count > method.most_elements) continue;
      std::fprintf(stderr, "growth %s %zu\n", std::string(method.name).c_str(), count);
      results.scale.push_back(run_scale(count, method, given.plan));
    }
  }
  for (const Method& method : methods) {
    for (const double size_mm : {5.0, 10.0, 20.0, 50.0, 100.0, 200.0, 400.0}) {
      results.sizes.push_back(run_size(size_mm, method, given.plan));
    }
  }
  results.tables.push_back(preparation(methods, given.plan));
}

Results run_studies(const Arguments& given) {
  std::vector<Method> methods;
  for (const Method& method : all_methods()) {
    if (is_wanted(given.methods, method.name)) methods.push_back(method);
  }
  Results results;
  results.clock_us = clock_us();
  for (const Method& method : methods) results.methods.emplace_back(method.name);
  if (is_wanted(given.studies, "moves")) run_moves(given, methods, results);
  results.tables = paper_tables(results);
  if (is_wanted(given.studies, "growth") && !methods.empty()) run_growth(given, methods, results);
  if (is_wanted(given.studies, "judged")) {
    std::fprintf(stderr, "verdicts of many moves\n");
    JudgedMoves judged = run_judged_moves(methods, given.plan);
    results.tables.push_back(std::move(judged.table));
    results.has_wrong_verdict = results.has_wrong_verdict || judged.dowel_wrong != 0;
  }
  if (is_wanted(given.studies, "error")) {
    std::fprintf(stderr, "run time against error\n");
    const std::vector<ErrorPoint> points = run_error_study(given.plan);
    results.has_wrong_verdict = results.has_wrong_verdict || has_wrong_exact_verdict(points);
    results.tables.push_back(error_table(points));
    results.charts["time-against-error"] = error_chart(points);
  }
  if (is_wanted(given.studies, "solids")) {
    std::fprintf(stderr, "run time against error by OpenCascade\n");
    const std::vector<ErrorPoint> points = run_solid_study(given.plan);
    results.has_wrong_verdict = results.has_wrong_verdict || has_wrong_exact_verdict(points);
    results.tables.push_back(solid_table(points));
  }
  const auto take = [&](const char* study, std::vector<Table> (*run_study)(const Plan&)) {
    if (!is_wanted(given.studies, study)) return;
    std::fprintf(stderr, "%s\n", study);
    for (Table& table : run_study(given.plan)) results.tables.push_back(std::move(table));
  };
  take("objects", run_object_study);
  take("skips", run_skip_study);
  take("stability", run_stability);
  take("rules", run_rule_study);
  take("project", run_project_study);
  if (!results.runs.empty()) results.charts["time-per-move"] = time_chart(results);
  if (!results.scale.empty()) results.charts["growth"] = growth_chart(results);
  if (!results.sizes.empty()) results.charts["moving-size"] = size_chart(results);
  return results;
}

/// Throws std::runtime_error where the file cannot be written.
void write_file(const std::filesystem::path& path, const std::string& content) {
  std::ofstream file(path, std::ios::binary);
  file << content;
  if (!file.flush()) throw std::runtime_error(path.string() + ": cannot be written");
}

int run(int argc, char** argv) {
  CLI::App app(
      "Times dowel's collision checks against other libraries on the same triangles and poses");
  Arguments given;
  add_options(app, given);
  CLI11_PARSE(app, argc, argv);
  if (!given.query_folder.empty()) {
    const QueryStudy study = run_query_files(given.query_folder);
    write(std::cout, study.table);
    return study.wrong == 0 ? 0 : 1;
  }
  if (given.is_quick) {
    given.plan.poses = 100;
    given.plan.rounds = 1;
  }
  for (const MotionKind kind : kMotionKinds) {
    if (is_wanted(given.motions, to_string(kind))) given.plan.kinds.push_back(kind);
  }
  const Results results = run_studies(given);
  write_tables(std::cout, results);
  write_wrong_verdicts(std::cerr, results, given.wrong_limit);
  try {
    if (!given.plot_folder.empty()) {
      for (const auto& [name, chart] : results.charts) {
        write_file(std::filesystem::path(given.plot_folder) / (name + ".svg"), svg(chart));
      }
    }
    if (!given.json_file.empty()) write_file(given.json_file, json_text(results));
  } catch (const std::runtime_error& error) {
    std::cerr << error.what() << '\n';
    return 3;
  }
  return given.is_quick && has_wrong_verdict_of_dowel(results) ? 1 : 0;
}

}  // namespace

}  // namespace dowel::bench

int main(int argc, char** argv) {
  try {
    return dowel::bench::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 4;
  }
}
