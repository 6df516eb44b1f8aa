#include "rule_checks.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>
#include <utility>

#include "dowel/assembly/rules.h"
#include "facet.h"
#include "fixture_projects.h"
#include "library/builders.h"
#include "library/systems.h"

namespace dowel::bench {

namespace {

constexpr int kColumns = 32;
constexpr int kRows = 20;
constexpr double kPitch_mm = 40.0;
constexpr double kPlate_mm = 40.0;
constexpr double kSpacer_mm = 20.0;

/// A plate with `columns` x `rows` holes as those of the small plate, about the origin.
ProjectElement wide_plate(int columns, int rows) {
  std::vector<testing::DrilledHole> holes = testing::hole_grid(
      static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows), kPitch_mm, 5.053);
  std::vector<Feature> features;
  for (testing::DrilledHole& hole : holes) {
    hole.counterbore_radius_mm = 6.0;
    hole.counterbore_depth_mm = 15.0;
    features.push_back(testing::hole_feature("h" + std::to_string(features.size() + 1),
                                             {hole.x, hole.y, kPlate_mm}, -Eigen::Vector3d::UnitZ(),
                                             {{12.0, 15.0}, {10.106, 25.0}}, true));
  }
  const double length_mm = kPitch_mm * (columns + 1);
  const double width_mm = kPitch_mm * (rows + 1);
  for (const double side : {1.0, -1.0}) {
    features.push_back(
        testing::face_feature(side > 0.0 ? "top" : "bottom", {0, 0, side > 0.0 ? kPlate_mm : 0.0},
                              side * Eigen::Vector3d::UnitZ(), length_mm * width_mm));
  }
  ProjectElement plate = testing::element_of(
      "T/plate-wide", testing::plate_with_holes({length_mm, width_mm, kPlate_mm}, holes, 24),
      features);
  plate.element.role = "base plate";
  return plate;
}

ProjectElement spacer() {
  testing::DrilledHole hole;
  hole.radius_mm = 6.5;
  const Eigen::Vector3d size(36, 36, kSpacer_mm);
  const double area_mm2 = size.x() * size.y() - 42.25 * 3.14159;
  ProjectElement element = testing::element_of(
      "T/spacer-20", testing::plate_with_holes(size, {hole}, 24),
      {testing::hole_feature("h1", {0, 0, kSpacer_mm}, -Eigen::Vector3d::UnitZ(),
                             {{13.0, kSpacer_mm}}, true),
       testing::face_feature("top", {0, 0, kSpacer_mm}, Eigen::Vector3d::UnitZ(), area_mm2),
       testing::face_feature("bottom", {0, 0, 0}, -Eigen::Vector3d::UnitZ(), area_mm2)});
  element.element.role = "riser";
  return element;
}

/// The screw M12 x 65 of the tests, a stepped pin that no wrench turns, or the socket head screw of
/// the library. Their tips stand at z = 0.
ProjectElement screw(bool of_library) {
  ProjectElement element = testing::screw_element();
  if (of_library) {
    constexpr double kLength_mm = 65.0;
    const auto parts = library::socket_screws(library::systems().front());
    const auto part = std::ranges::find_if(
        parts, [](const library::Part& p) { return p.name.ends_with("/screw-M12x65"); });
    if (part == parts.end()) throw std::logic_error("the library has no screw M12x65");
    const Pose up = Pose::from_translation({0, 0, kLength_mm});
    std::vector<Feature> features = part->features;
    for (Feature& feature : features) feature.origin = up * feature.origin;
    element = testing::element_of(element.element.name,
                                  testing::transformed(up, facet(part->solid, {}).solid),
                                  std::move(features));
  }
  element.element.role = "fastener";
  return element;
}

/// A located and clamped block in the middle of a plate, and stacks of two spacers and a screw on
/// the holes around it, until there are `count` instances.
testing::FixtureBuilder fixture_of(std::size_t count, bool with_library_screws) {
  testing::FixtureBuilder builder = testing::sound_fixture();
  const int columns = count <= 200 ? kColumns / 2 : kColumns;
  const int rows = count <= 200 ? kRows / 2 : kRows;
  builder.add_element(wide_plate(columns, rows));
  builder.state.instances.at("PLATE").element = "T/plate-wide";
  builder.add_element(spacer());
  builder.add_element(screw(with_library_screws));
  for (int hole = 0; hole < columns * rows; ++hole) {
    const double x_mm = kPitch_mm * (hole % columns - 0.5 * (columns - 1));
    const double y_mm = kPitch_mm * (hole / columns - 0.5 * (rows - 1));
    if (std::abs(x_mm) < 100.0 && std::abs(y_mm) < 80.0) continue;
    const std::string number = std::to_string(hole + 1);
    const std::array<std::pair<std::string, double>, 3> stack{
        {{"LOW", kPlate_mm}, {"HIGH", kPlate_mm + kSpacer_mm}, {"SCREW", 15.0}}};
    for (const auto& [name, z_mm] : stack) {
      if (builder.state.instances.size() == count) return builder;
      builder.place(name == "SCREW" ? "T/screw-M12x65" : "T/spacer-20", name + number,
                    {x_mm, y_mm, z_mm});
    }
  }
  return builder;
}

double milliseconds_of(const auto& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start)
      .count();
}

double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

std::vector<std::string> measured(std::size_t count, bool with_library_screws, const Plan& plan) {
  const auto session = fixture_of(count, with_library_screws).session();
  session->set_mode(CheckMode::Off, "mode off");
  const RuleSet rules = shipped_rules();
  double full_ms = 0.0;
  for (std::size_t round = 0; round < plan.rounds; ++round) {
    RuleChecker fresh(*session, rules);
    const double time_ms = milliseconds_of([&] { fresh.check(); });
    full_ms = round == 0 ? time_ms : std::min(full_ms, time_ms);
  }
  RuleChecker checker(*session, rules);
  checker.check();
  const std::size_t all = checker.last_queries();
  std::vector<std::string> movable;
  for (const auto& [name, instance] : session->state().instances) {
    if (!instance.grounded && session->unit(name).size() == 1) movable.push_back(name);
  }
  std::mt19937 random(7);
  std::uniform_real_distribution<double> way_mm(-15.0, 15.0);
  std::vector<double> check_ms;
  std::vector<double> both_ms;
  std::size_t ran = 0;
  std::size_t asked = 0;
  const std::size_t moves = std::clamp<std::size_t>(plan.poses / 5, 10, 200);
  for (std::size_t i = 0; i < moves; ++i) {
    const std::string& name = movable[random() % movable.size()];
    const Eigen::Vector3d from = session->instance(name).X_WI.translation();
    const Eigen::Vector3d to =
        from + Eigen::Vector3d(way_mm(random), way_mm(random), way_mm(random));
    // There and back: the fixture stays what it is.
    for (const Eigen::Vector3d& place : {to, from}) {
      const double move_ms = milliseconds_of([&] { session->move(name, place, "move"); });
      check_ms.push_back(milliseconds_of([&] { checker.check(); }));
      both_ms.push_back(move_ms + check_ms.back());
      ran += checker.last_run();
      asked += checker.last_queries();
    }
  }
  const auto mean = [&](std::size_t sum) {
    return std::to_string((sum + check_ms.size() / 2) / check_ms.size());
  };
  return {std::to_string(count),
          with_library_screws ? "library" : "pins",
          text(full_ms),
          text(quantile(check_ms, 0.5), quantile(check_ms, 0.99)),
          text(quantile(both_ms, 0.5), quantile(both_ms, 0.99)),
          mean(ran) + " of " + std::to_string(rules.rules.size()),
          mean(asked) + " of " + std::to_string(all)};
}

}  // namespace

std::vector<Table> run_rule_study(const Plan& plan) {
  Table table{
      "Design rules",
      "All shipped rules on a located and clamped block among stacks of two spacers and a "
      "screw, on a plate of 160 holes (800 instances: 640). Screws: stepped pins, which no wrench "
      "turns, or the socket head screws of the library. Full: a new checker, to whose time the "
      "models of all elements belong; the fastest of the rounds. After a move: one part goes up to "
      "26 mm away, or back, unchecked; median / 99th percentile. Queries: a rule's, for one "
      "subject "
      "where the rule allows it. Times in ms.",
      {"instances", "screws", "full check", "check after a move", "move and check",
       "rules run anew", "queries"},
      {}};
  for (const std::size_t count : {50U, 200U, 800U}) {
    for (const bool with_library_screws : {false, true}) {
      table.rows.push_back(measured(count, with_library_screws, plan));
    }
  }
  return {table};
}

}  // namespace dowel::bench
