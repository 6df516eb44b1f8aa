#include "project_commands.h"

#include <algorithm>
#include <chrono>
#include <ctime>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

#include <unistd.h>

#include "dowel/assembly/session.h"
#include "large_fixture.h"

namespace dowel::bench {

namespace {

/// A new folder of this process, gone at the end with what is in it.
class Folder {
 public:
  Folder()
      : path_(std::filesystem::temp_directory_path() /
              ("dowel-bench-" + std::to_string(::getpid()))) {
    if (!std::filesystem::create_directory(path_)) {
      throw std::runtime_error(path_.string() + ": is there already");
    }
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::filesystem::path operator/(const char* name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

/// On the wall, and of this process alone: what others do on the machine, and its disk, count in
/// the one and not in the other.
struct Duration {
  double wall_ms = 0.0;
  double cpu_ms = 0.0;
};

Duration duration_of(const auto& work) {
  constexpr double kMilli = 1000.0;
  const auto wall = std::chrono::steady_clock::now();
  const std::clock_t cpu = std::clock();
  work();
  return {
      std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - wall).count(),
      kMilli * static_cast<double>(std::clock() - cpu) / CLOCKS_PER_SEC};
}

std::string cell(std::vector<double> values_ms) {
  std::ranges::sort(values_ms);
  const std::size_t last = values_ms.size() - 1;
  if (last == 0) return text(values_ms.front());
  return text(values_ms[last / 2], values_ms[last * 99 / 100]);
}

std::vector<std::string> row(const std::string& what, const std::vector<Duration>& durations) {
  std::vector<double> wall_ms;
  std::vector<double> cpu_ms;
  for (const Duration& duration : durations) {
    wall_ms.push_back(duration.wall_ms);
    cpu_ms.push_back(duration.cpu_ms);
  }
  return {what, std::to_string(durations.size()), cell(wall_ms), cell(cpu_ms)};
}

void expect_done(bool is_done) {
  if (!is_done) throw std::logic_error("a command of the study `project` was refused");
}

/// What the commands took, each in the order of the plates.
struct Commands {
  std::vector<Duration> first;
  std::vector<Duration> place;
  std::vector<Duration> insert;
  std::vector<Duration> way;
  std::vector<Duration> move;
};

/// On one plate: a pin is placed in its last hole, mated there, asked for its way in, drawn out.
void run_commands(Session& session, std::size_t plate, Commands& commands) {
  const FeatureName hole{"PLATE" + std::to_string(plate), "C5"};
  const std::string name = "LAST" + std::to_string(plate);
  const Duration placing = duration_of([&] {
    const Pose X_WI = testing::over_last_hole(plate, 25.0);
    const MoveReport report = session.place("T/pin-12", name, X_WI, "place");
    expect_done(!report.refused && report.verdict == Verdict::Contact);
  });
  (plate == 0 ? commands.first : commands.place).push_back(placing);
  commands.insert.push_back(duration_of([&] {
    const InsertRequest request{{name, "pin1"}, hole, {}, {.offset_mm = 15.0}};
    expect_done(!session.insert(request, "insert").refused);
  }));
  commands.way.push_back(duration_of([&] {
    const std::vector<WayOut> ways = session.ways_out(
        name,
        {.without = {}, .with_sub_assembly = true, .first_free = true, .by_mates_alone = true});
    expect_done(!ways.empty() && ways.front().blocked_by.empty());
  }));
  commands.move.push_back(duration_of([&] {
    const Eigen::Vector3d up =
        session.instance(name).X_WI.translation() + Eigen::Vector3d(0, 0, 80);
    expect_done(!session.move(name, up, "move").refused);
  }));
}

Table measured(std::size_t instances) {
  const Folder folder;
  testing::write_large_fixture(folder / "large.dwp", instances);
  std::optional<Session> session;
  const std::vector<Duration> open{
      duration_of([&] { session.emplace(Project::open(folder / "large.dwp")); })};
  Commands commands;
  for (std::size_t plate = 0; plate < instances / 16; ++plate) {
    run_commands(*session, plate, commands);
  }
  const std::vector<Duration> undo{duration_of([&] { session->undo(100); })};
  const std::vector<Duration> redo{duration_of([&] { session->redo(100); })};
  return {"Commands on a project of " + std::to_string(instances) + " instances",
          "Plates full of pins, mated, on disk. Each command is checked against all other "
          "instances and is on disk with its journal entry when it ends. ms on the wall (with the "
          "disk) and of the processor, median / 99th percentile. The first placement makes the "
          "models of the elements near by.",
          {"command", "times", "wall", "processor"},
          {row("open", open), row("first placement", commands.first),
           row("place in a hole", commands.place), row("insert, mated", commands.insert),
           row("its way in, as `insert` tells it", commands.way),
           row("draw it out, swept", commands.move), row("undo 100 commands", undo),
           row("redo 100 commands", redo)}};
}

}  // namespace

std::vector<Table> run_project_study(const Plan& plan) {
  constexpr std::size_t kMany = 2000;
  constexpr std::size_t kFew = 400;
  // Few poses: only to show that all still works.
  return {measured(plan.poses < 1000 ? kFew : kMany)};
}

}  // namespace dowel::bench
