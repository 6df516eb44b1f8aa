#include <algorithm>
#include <array>
#include <cstdio>
#include <exception>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>

#include "report.h"

namespace dowel::bench {

namespace {

std::vector<Method> all_methods() {
  return {
      {"dowel", make_dowel},
      {"dowel first", make_dowel_first},
      {"dowel paper", make_dowel_paper},
      {"published", make_published, 5},
#ifdef DOWEL_BENCH_FCL
      {"FCL OBBRSS", make_fcl_obbrss},
#endif
#ifdef DOWEL_BENCH_FCL_FLOAT
      {"FCL OBB float", make_fcl_obb_float},
#endif
#ifdef DOWEL_BENCH_ODE
      {"ODE", make_ode},
#endif
#ifdef DOWEL_BENCH_BULLET
      {"Bullet", make_bullet},
#endif
#ifdef DOWEL_BENCH_CGAL
      {"CGAL", make_cgal, 5},
#endif
  };
}

bool is_wanted(const std::vector<std::string>& wanted, std::string_view name) {
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

int run(int argc, char** argv) {
  CLI::App app(
      "Times dowel's collision checks against other libraries on the same triangles and poses");
  Plan plan;
  bool is_quick = false;
  std::string json_file;
  std::vector<std::string> method_names;
  std::vector<std::string> scene_names;
  std::vector<std::string> motion_names;
  std::vector<std::size_t> counts{10, 100, 1000, 10000};
  bool has_growth = true;
  std::size_t wrong_limit = 3;
  app.add_flag("--quick", is_quick,
               "Few poses, one round; fails where a verdict of dowel is wrong");
  app.add_option("--json", json_file, "Writes all figures to this file");
  app.add_option("--poses", plan.poses, "Poses of a motion")->capture_default_str();
  app.add_option("--rounds", plan.rounds, "Each pose counts with its fastest round")
      ->capture_default_str();
  app.add_option("--methods", method_names, "dowel,\"FCL OBBRSS\",...")->delimiter(',');
  app.add_option("--scenes", scene_names, "a,b,c,d")->delimiter(',');
  app.add_option("--motions", motion_names, "free,near,insert,fit,contact,contained,tight")
      ->delimiter(',');
  app.add_option("--wrong", wrong_limit, "Wrong verdicts shown of each scene and motion")
      ->capture_default_str();
  app.add_flag("--growth,!--no-growth", has_growth, "Scenes of 10 to 10,000 elements");
  CLI11_PARSE(app, argc, argv);
  if (is_quick) {
    plan.poses = 100;
    plan.rounds = 1;
    counts.pop_back();
  }
  for (const MotionKind kind : kMotionKinds) {
    if (is_wanted(motion_names, to_string(kind))) plan.kinds.push_back(kind);
  }
  std::vector<Method> methods;
  for (const Method& method : all_methods()) {
    if (is_wanted(method_names, method.name)) methods.push_back(method);
  }

  Results results;
  for (const Method& method : methods) results.methods.emplace_back(method.name);
  for (Scenario& scenario : paper_scenarios()) {
    if (!is_wanted(scene_names, scenario.name)) continue;
    std::fprintf(stderr, "scene %s\n", scenario.name.c_str());
    std::vector<Run> runs = run_scenario(scenario, methods, plan);
    std::move(runs.begin(), runs.end(), std::back_inserter(results.runs));
    results.scenarios.push_back(std::move(scenario));
  }
  if (has_growth && !methods.empty()) {
    for (const Method& method : methods) {
      for (const std::size_t count : counts) {
        std::fprintf(stderr, "growth %s %zu\n", std::string(method.name).c_str(), count);
        results.scale.push_back(run_scale(count, method, plan));
      }
    }
  }
  write_tables(std::cout, results);
  write_wrong_verdicts(std::cerr, results, wrong_limit);
  const bool is_wrong = std::any_of(results.runs.begin(), results.runs.end(), [](const Run& one) {
    if (one.method != "dowel" && one.method != "dowel first") return false;
    const Run* const runs[] = {&one};
    const Score score = score_own_question(runs);
    return score.false_yes + score.false_no + score.other != 0;
  });
  if (!json_file.empty()) {
    std::ofstream file(json_file);
    write_json(file, results);
    if (!file.flush()) {
      std::cerr << json_file << ": cannot be written\n";
      return 3;
    }
  }
  return is_quick && is_wrong ? 1 : 0;
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
