#include "preparation.h"

#include <algorithm>
#include <limits>
#include <string>

namespace dowel::bench {

namespace {

struct Cost {
  double elements_ms = std::numeric_limits<double>::infinity();
  double placing_ms = std::numeric_limits<double>::infinity();
  double elements_mb = 0.0;
  double all_mb = 0.0;
};

/// The fastest of the rounds.
Cost cost(const Scenario& scene, const Method& method, std::size_t rounds) {
  constexpr double kMegabyte = 1.0e6;
  Cost best;
  for (std::size_t round = 0; round < rounds; ++round) {
    const std::size_t bytes = heap_bytes();
    const auto grown_mb = [&] {
      return (static_cast<double>(heap_bytes()) - static_cast<double>(bytes)) / kMegabyte;
    };
    const std::unique_ptr<Checker> checker = method.make();
    const double start_us = processor_us();
    for (const Placed& placed : scene.elements) checker->prepare(placed.element);
    checker->prepare(scene.moving);
    const double ready_us = processor_us();
    best.elements_mb = grown_mb();
    const double place_us = processor_us();
    for (const Placed& placed : scene.elements) checker->add(placed);
    checker->set_moving(scene.moving);
    checker->finish();
    (void)checker->check(scene.elements.front().X_WE);  // builds what is put off until then
    best.placing_ms = std::min(best.placing_ms, 1.0e-3 * (processor_us() - place_us));
    best.elements_ms = std::min(best.elements_ms, 1.0e-3 * (ready_us - start_us));
    best.all_mb = grown_mb();
  }
  return best;
}

}  // namespace

Table preparation(const std::vector<Method>& methods, const Plan& plan) {
  Table table{
      "Preparation",
      "Before the first move: milliseconds for what is built once of each distinct element (trees "
      "and whatever else its instances share) / for placing all elements one by one and one check; "
      "MB of heap that the first takes / that both take.",
      {"method"},
      {}};
  const std::vector<Scenario> scenes = paper_scenarios();
  for (const Scenario& scene : scenes) table.columns.push_back("(" + scene.name + ")");
  for (const Method& method : methods) {
    std::vector<std::string> row{std::string(method.name)};
    for (const Scenario& scene : scenes) {
      const Cost found = cost(scene, method, plan.rounds);
      row.push_back(text(found.elements_ms, found.placing_ms) + "; " +
                    text(found.elements_mb, found.all_mb));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace dowel::bench
