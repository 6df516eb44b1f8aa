// A fixture of two thousand instances.

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <string>

#include <catch2/catch.hpp>

#include "dowel/assembly/session.h"
#include "fixture_elements.h"
#include "program.h"

using dowel::Catalog;
using dowel::Instance;
using dowel::Mate;
using dowel::Pose;
using dowel::Project;
using dowel::ProjectState;
using dowel::Session;
namespace testing = dowel::testing;

namespace {

constexpr int kPlates = 125;
constexpr int kPinsOnPlate = 15;

Pose plate_pose(int plate) {
  return Pose::from_translation({250.0 * (plate % 12), 170.0 * static_cast<int>(plate / 12), 0.0});
}

/// 125 plates, each with a pin in all of its holes but the last, mated.
ProjectState large_state() {
  ProjectState state;
  std::uint32_t number = 0;
  const auto add = [&](const std::string& name, const std::string& element, const Pose& X_WI) {
    Instance instance;
    instance.number = ++number;
    instance.name = name;
    instance.element = element;
    instance.X_WI = X_WI;
    instance.grounded = element == "T/plate-5x3";
    state.instances.emplace(name, instance);
  };
  for (int plate = 0; plate < kPlates; ++plate) {
    const std::string plate_name = "PLATE" + std::to_string(plate);
    add(plate_name, "T/plate-5x3", plate_pose(plate));
    for (int hole = 0; hole + 1 < kPinsOnPlate; ++hole) {
      const int row = hole / 5;
      const int column = hole % 5;
      const std::string name = "PIN" + std::to_string(plate) + "-" + std::to_string(hole);
      add(name, "T/pin-12",
          plate_pose(plate) * Pose::from_translation({40.0 * (column - 2), 40.0 * (row - 1), 25}));
      Mate mate;
      mate.number = number;
      mate.moving = {name, "pin1"};
      mate.fixed = {plate_name,
                    std::string(1, static_cast<char>('A' + row)) + std::to_string(column + 1)};
      mate.offset_mm = 15.0;
      state.mates.emplace(mate.number, mate);
    }
    if (plate % 2 == 0) {
      const std::string name = "BLOCK" + std::to_string(plate);
      add(name, "T/block-40", plate_pose(plate) * Pose::from_translation({-90, 0, 180}));
    }
  }
  // To two thousand.
  for (int more = 0; number < 2000; ++more) {
    add("MORE" + std::to_string(more), "T/block-40",
        Pose::from_translation({45.0 * more, -200.0, 20.0}));
  }
  return state;
}

/// On the wall, and of this process alone: what others do on the machine, and its disk, count in
/// the one and not in the other.
struct Duration {
  double wall_ms = 0.0;
  double cpu_ms = 0.0;
};

class Clock {
 public:
  Duration passed() const {
    const auto wall = std::chrono::steady_clock::now() - wall_;
    constexpr double kMilli = 1000.0;
    return {std::chrono::duration<double, std::milli>(wall).count(),
            kMilli * static_cast<double>(std::clock() - cpu_) / CLOCKS_PER_SEC};
  }

 private:
  std::chrono::steady_clock::time_point wall_ = std::chrono::steady_clock::now();
  std::clock_t cpu_ = std::clock();
};

void write_large(const std::filesystem::path& file) {
  Project project = Project::create(file);
  std::vector<dowel::ProjectElement> copies{testing::plate_element(), testing::pin_element(),
                                            testing::block_element()};
  project.commit("large", large_state(), copies);
}

}  // namespace

TEST_CASE("a fixture of two thousand instances opens, and takes a part in every free hole") {
  const testing::TemporaryFolder folder;
  write_large(folder / "large.dwp");
  Session session(Project::open(folder / "large.dwp"));
  REQUIRE(session.state().instances.size() == 2000);
  const Pose X_WI = plate_pose(60) * Pose::from_translation({80, 40, 25});
  const auto report = session.place("T/pin-12", "LAST", X_WI, "place");
  CHECK_FALSE(report.refused);
  REQUIRE(report.touches.size() == 1);
  CHECK(report.touches.front().with == "PLATE60");
  CHECK(
      session
          .place("T/pin-12", "NONE", plate_pose(60) * Pose::from_translation({40, 40, 25}), "place")
          .refused);
}

TEST_CASE("times of a fixture of two thousand instances", "[.benchmark]") {
  const testing::TemporaryFolder folder;
  write_large(folder / "large.dwp");
  const Clock opening;
  Session session(Project::open(folder / "large.dwp"));
  const Duration open = opening.passed();
  std::vector<Duration> place;
  std::vector<Duration> insert;
  std::vector<Duration> move;
  Duration first;
  for (int plate = 0; plate < kPlates; ++plate) {
    const std::string name = "LAST" + std::to_string(plate);
    const Clock placing;
    REQUIRE_FALSE(session
                      .place("T/pin-12", name,
                             plate_pose(plate) * Pose::from_translation({80, 40, 100}), "place")
                      .refused);
    (plate == 0 ? first : place.emplace_back()) = placing.passed();
    const Clock inserting;
    REQUIRE_FALSE(
        session
            .insert(
                {{name, "pin1"}, {"PLATE" + std::to_string(plate), "C5"}, {}, {.offset_mm = 15.0}},
                "insert")
            .refused);
    insert.push_back(inserting.passed());
    const Clock moving;
    REQUIRE_FALSE(session
                      .move(name,
                            session.instance(name).X_WI.translation() + Eigen::Vector3d(0, 0, 30),
                            "move")
                      .refused);
    move.push_back(moving.passed());
  }
  const auto print = [](const char* what, const std::vector<Duration>& times) {
    const auto quantile = [&](double Duration::*which, std::size_t percent) {
      std::vector<double> sorted;
      for (const Duration& time : times) sorted.push_back(time.*which);
      std::ranges::sort(sorted);
      return sorted[(sorted.size() - 1) * percent / 100];
    };
    std::printf("%-18s median %8.2f ms (%8.2f of processor), 99 %% %8.2f ms (%8.2f)\n", what,
                quantile(&Duration::wall_ms, 50), quantile(&Duration::cpu_ms, 50),
                quantile(&Duration::wall_ms, 99), quantile(&Duration::cpu_ms, 99));
  };
  print("open", {open});
  print("first placement", {first});
  print("place", place);
  print("insert", insert);
  print("move out, swept", move);
  const Clock undoing;
  session.undo(100);
  print("undo 100", {undoing.passed()});
}
