// dowel collide: a moving element against all others, at poses from a file.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>

#include "commands.h"
#include "dowel/catalog/catalog.h"
#include "dowel/catalog/recognition.h"
#include "dowel/collision/scene.h"
#include "dowel/io/import.h"
#include "dowel/io/scene_file.h"
#include "dowel/kernel/error.h"
#include "json.h"

namespace dowel::tools {
namespace {

using Clock = std::chrono::steady_clock;

struct CollideArguments {
  std::string scene;
  std::string poses;
  std::string catalog;
  std::string holes = "exact";
  double tolerance_mm = kDefaultTolerance_mm;
  double deflection_mm = 0.0;
  unsigned repeat = 1;
  bool sweep = false;
  bool first = false;
  bool json = false;
};

double microseconds_since(Clock::time_point start) {
  return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

std::vector<std::uint32_t> hole_faces(const FacetedSolid& solid,
                                      const std::vector<Feature>& features) {
  const std::vector<FacetClass> classes = classify_faces(solid, features);
  std::vector<std::uint32_t> faces;
  for (std::uint32_t i = 0; i < classes.size(); ++i) {
    if (classes[i] == FacetClass::Hole) faces.push_back(i);
  }
  return faces;
}

std::shared_ptr<const CollisionElement> element_of_file(ImportResult&& import,
                                                        const std::string& file, HoleMode holes) {
  if (import.status != ImportResult::Status::Ok || import.parts.empty()) {
    throw Error(ErrorCode::FileMalformed, file + ": " + import.reason);
  }
  ImportedPart& part = import.parts.front();
  auto solid = std::make_shared<const FacetedSolid>(std::move(part.solid));
  std::vector<std::uint32_t> walls;
  if (holes == HoleMode::Paper) walls = hole_faces(*solid, part.features);
  return std::make_shared<const CollisionElement>(
      part.obb, [solid] { return solid; }, std::move(walls));
}

/// Reads what the scene's bodies are made of, each file and element once.
class ElementLoader {
 public:
  ElementLoader(const CollideArguments& arguments, HoleMode holes) : holes_(holes) {
    options_.whole_file = true;
    options_.deflection_mm = arguments.deflection_mm;
    if (!arguments.catalog.empty()) {
      catalog_ = std::make_shared<Catalog>(arguments.catalog, Catalog::Access::ReadOnly);
    }
  }

  /// Reads all files that the scene names, several at a time.
  void read_files(const SceneFile& scene) {
    std::vector<std::filesystem::path> files;
    for (const SceneBody& body : scene.bodies) {
      if (!body.source.empty()) files.push_back(body.source);
    }
    std::ranges::sort(files);
    files.erase(std::unique(files.begin(), files.end()), files.end());
    import_files(files, options_, std::max(1U, std::thread::hardware_concurrency()),
                 [&](std::size_t i, ImportResult&& import) {
                   by_file_[files[i]] =
                       element_of_file(std::move(import), files[i].string(), holes_);
                   return true;
                 });
  }

  std::shared_ptr<const CollisionElement> element(const SceneBody& body) {
    if (!body.source.empty()) return by_file_.at(body.source);
    auto& element = by_name_[body.element];
    if (!element) element = from_catalog(body.element);
    return element;
  }

 private:
  std::shared_ptr<const CollisionElement> from_catalog(const std::string& name) {
    if (!catalog_) {
      throw Error(ErrorCode::InvalidInput,
                  "the scene names element \"" + name + "\": give its catalogue with --catalog DB");
    }
    const std::optional<Element> found = catalog_->find(name);
    if (!found) {
      std::string message = catalog_->file().string() + ": no element \"" + name + "\"";
      const auto similar = catalog_->similar_names(name, 1);
      if (!similar.empty()) message += "; did you mean \"" + similar.front() + "\"?";
      throw Error(ErrorCode::NotFound, message);
    }
    std::vector<std::uint32_t> walls;
    if (holes_ == HoleMode::Paper) walls = hole_faces(*catalog_->solid(name), found->features);
    return std::make_shared<const CollisionElement>(
        found->obb, [catalog = catalog_, name] { return catalog->solid(name); }, std::move(walls));
  }

  HoleMode holes_;
  ImportOptions options_;
  std::shared_ptr<Catalog> catalog_;
  std::map<std::filesystem::path, std::shared_ptr<const CollisionElement>> by_file_;
  std::map<std::string, std::shared_ptr<const CollisionElement>> by_name_;
};

/// What one pose gave.
struct PoseReport {
  Verdict verdict = Verdict::Clear;
  std::vector<BodyVerdict> pairs;
  std::optional<SweepResult> sweep;
  double time_us = std::numeric_limits<double>::infinity();
};

/// A scene ready to be asked at poses.
class Checker {
 public:
  Checker(const CollideArguments& arguments, const SceneFile& file, const std::vector<Pose>& poses)
      : file_(file), poses_(poses), is_sweep_(arguments.sweep) {
    options_ = {.tolerance_mm = arguments.tolerance_mm,
                .holes = arguments.holes == "paper" ? HoleMode::Paper : HoleMode::Exact,
                .first_only = arguments.first};
    ElementLoader loader(arguments, options_.holes);
    loader.read_files(file);
    const Clock::time_point start = Clock::now();
    for (const SceneBody& body : file.bodies) {
      elements_.push_back(loader.element(body));
      bodies_.push_back(scene_.add(elements_.back(), body.X_WB));
    }
    for (const std::size_t i : file.moving) {
      moving_.push_back(bodies_[i]);
      X_UB_.push_back(file.moves_as_unit ? file.bodies[i].X_WB : Pose());
    }
    build_ms = microseconds_since(start) / 1000.0;
  }

  /// Asks at every pose, `repeat` times; keeps each pose's fastest time. Models that a pose makes
  /// the scene build are not part of its time.
  std::vector<PoseReport> run(unsigned repeat) {
    std::vector<PoseReport> reports(poses_.size());
    for (unsigned round = 0; round < repeat; ++round) {
      counters = {};
      for (std::size_t i = 0; i < poses_.size(); ++i) {
        const std::size_t loaded_before = loaded_count();
        double time_us = ask(i, reports[i]);
        if (loaded_count() != loaded_before) {
          const double warm_us = ask(i, reports[i]);
          build_ms += std::max(0.0, time_us - warm_us) / 1000.0;
          time_us = warm_us;
        }
        reports[i].time_us = std::min(reports[i].time_us, time_us);
        counters.box_tests += scene_.counters().box_tests;
        counters.triangle_tests += scene_.counters().triangle_tests;
      }
    }
    return reports;
  }

  /// Ids that are not clear at this pose with their verdicts, in the order of the scene file.
  std::vector<std::pair<std::string, Verdict>> pairs_by_id(const PoseReport& report) const {
    std::vector<std::pair<std::string, Verdict>> result;
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      Verdict verdict = Verdict::Clear;
      for (const BodyVerdict& pair : report.pairs) {
        if (pair.with == bodies_[i]) verdict = std::max(verdict, pair.pair.verdict);
      }
      if (verdict != Verdict::Clear) result.emplace_back(file_.bodies[i].id, verdict);
    }
    return result;
  }

  std::size_t memory_bytes() const { return scene_.memory_bytes(); }

  double build_ms = 0.0;
  QueryCounters counters;

 private:
  double ask(std::size_t i, PoseReport& report) {
    scene_.reset_counters();
    if (is_sweep_) {
      const Pose& from = poses_[i == 0 ? 0 : i - 1];
      const Clock::time_point start = Clock::now();
      report.sweep = scene_.sweep(moving_, X_UB_, from, poses_[i], options_);
      const double time_us = microseconds_since(start);
      report.pairs = report.sweep->pairs;
      report.verdict = report.sweep->verdict;
      return time_us;
    }
    placed_.clear();
    for (const Pose& X_UB : X_UB_) placed_.push_back(poses_[i] * X_UB);
    const Clock::time_point start = Clock::now();
    const auto verdicts = scene_.check(moving_, placed_, options_);
    report.pairs.assign(verdicts.begin(), verdicts.end());
    const double time_us = microseconds_since(start);
    report.verdict = worst(report.pairs);
    return time_us;
  }

  std::size_t loaded_count() const {
    return static_cast<std::size_t>(
        std::ranges::count_if(elements_, [](const auto& element) { return element->is_loaded(); }));
  }

  const SceneFile& file_;
  const std::vector<Pose>& poses_;
  bool is_sweep_;
  QueryOptions options_;
  CollisionScene scene_;
  std::vector<std::shared_ptr<const CollisionElement>> elements_;
  std::vector<BodyId> bodies_;
  std::vector<BodyId> moving_;
  std::vector<Pose> X_UB_;
  std::vector<Pose> placed_;
};

Json to_json(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation();
  const Eigen::Vector3d& t = pose.translation();
  return {{"q", {q.w(), q.x(), q.y(), q.z()}}, {"t", {t.x(), t.y(), t.z()}}};
}

Json pose_line(const Checker& checker, std::size_t index, const PoseReport& report) {
  Json line{{"pose", index}, {"verdict", to_string(report.verdict)}, {"pairs", Json::array()}};
  for (const auto& [id, verdict] : checker.pairs_by_id(report)) {
    line["pairs"].push_back({{"with", id}, {"verdict", to_string(verdict)}});
  }
  if (report.sweep) {
    line["time_of_impact"] = report.sweep->time_of_impact;
    line["free_pose"] = to_json(report.sweep->free_pose);
  }
  return line;
}

Json time_summary(const std::vector<PoseReport>& reports) {
  std::vector<double> times;
  double sum = 0.0;
  for (const PoseReport& report : reports) {
    times.push_back(report.time_us);
    sum += report.time_us;
  }
  std::ranges::sort(times);
  const auto quantile = [&times](double part) {
    if (times.empty()) return 0.0;
    return times[static_cast<std::size_t>(std::ceil(part * static_cast<double>(times.size()))) - 1];
  };
  const double mean = times.empty() ? 0.0 : sum / static_cast<double>(times.size());
  return {
      {"median", quantile(0.5)}, {"p99", quantile(0.99)}, {"mean", mean}, {"max", quantile(1.0)}};
}

Json summary(const Checker& checker, const std::vector<PoseReport>& reports) {
  const auto count = [&reports](Verdict verdict) {
    return std::ranges::count(reports, verdict, &PoseReport::verdict);
  };
  return {{"poses", reports.size()},
          {"clear", count(Verdict::Clear)},
          {"contact", count(Verdict::Contact)},
          {"interference", count(Verdict::Interference)},
          {"box_tests", checker.counters.box_tests},
          {"triangle_tests", checker.counters.triangle_tests},
          {"build_ms", checker.build_ms},
          {"model_bytes", checker.memory_bytes()},
          {"time_us", time_summary(reports)}};
}

void print_text(const Checker& checker, const std::vector<PoseReport>& reports) {
  for (std::size_t i = 0; i < reports.size(); ++i) {
    std::string others;
    for (const auto& [id, verdict] : checker.pairs_by_id(reports[i])) {
      others += (others.empty() ? "  " : ", ") + id + " " + std::string(to_string(verdict));
    }
    const std::string verdict(to_string(reports[i].verdict));
    std::printf("pose %zu: %s%s", i, verdict.c_str(), others.c_str());
    if (reports[i].sweep && reports[i].sweep->time_of_impact < 1.0) {
      std::printf("  at %.6f of the way", reports[i].sweep->time_of_impact);
    }
    std::printf("\n");
  }
  const Json all = summary(checker, reports);
  const Json& time = all["time_us"];
  std::printf("%zu poses: %ld clear, %ld contact, %ld interference\n", reports.size(),
              all["clear"].get<long>(), all["contact"].get<long>(),
              all["interference"].get<long>());
  std::printf("time a pose: median %.2f us, p99 %.2f us, mean %.2f us, max %.2f us\n",
              time["median"].get<double>(), time["p99"].get<double>(), time["mean"].get<double>(),
              time["max"].get<double>());
  std::printf("%lu box tests, %lu triangle tests; model %lu bytes, built in %.1f ms\n",
              all["box_tests"].get<unsigned long>(), all["triangle_tests"].get<unsigned long>(),
              all["model_bytes"].get<unsigned long>(), all["build_ms"].get<double>());
}

void collide(const CollideArguments& arguments) {
  const SceneFile scene = read_scene(arguments.scene);
  const std::vector<Pose> poses = read_poses(arguments.poses);
  Checker checker(arguments, scene, poses);
  const std::vector<PoseReport> reports = checker.run(arguments.repeat);
  if (!arguments.json) return print_text(checker, reports);
  for (std::size_t i = 0; i < reports.size(); ++i) {
    print_line(to_line(pose_line(checker, i, reports[i])));
  }
  print_line(to_line({{"summary", summary(checker, reports)}}));
}

}  // namespace

void add_collide_command(CLI::App& app, int& exit_code) {
  auto arguments = std::make_shared<CollideArguments>();
  CLI::App* command = app.add_subcommand(
      "collide", "Check a moving element against all others at poses from a file.");
  command->add_option("SCENE", arguments->scene, "scene file, JSON (dowel-scene/1)")->required();
  command->add_option("--poses", arguments->poses, "poses of the moving element, CSV")->required();
  command
      ->add_option("--tolerance", arguments->tolerance_mm,
                   "mm: deeper is interference, nearer is contact")
      ->check(CLI::Range(kMinTolerance_mm, 100.0))
      ->capture_default_str();
  command
      ->add_option("--holes", arguments->holes,
                   "exact, or paper: triangles of holes are left out (Peng et al. 2009)")
      ->check(CLI::IsMember({"exact", "paper"}))
      ->capture_default_str();
  command
      ->add_option("--deflection", arguments->deflection_mm,
                   "mm: how far facets may stand off curved faces of STEP sources")
      ->check(CLI::Range(1e-4, 100.0));
  command->add_flag("--sweep", arguments->sweep,
                    "check the motion from each pose to the next, not just the poses");
  command->add_flag("--first", arguments->first, "stop a pose at its first interference");
  command->add_option("--repeat", arguments->repeat, "run all poses N times, report the fastest")
      ->check(CLI::Range(1U, 1'000'000U));
  command->add_option("--catalog", arguments->catalog, "catalogue that elements are taken from");
  command->add_flag("--json", arguments->json, "one JSON object a pose, then a summary");
  command->callback([arguments, &exit_code] {
    collide(*arguments);
    exit_code = kDone;
  });
}

}  // namespace dowel::tools
