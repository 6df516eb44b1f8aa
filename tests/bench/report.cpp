#include "report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <ostream>

#include <nlohmann/json.hpp>

#include "table.h"

namespace dowel::bench {

namespace {

std::vector<const Run*> select(const Results& results, const std::string& method, MotionKind kind,
                               const std::string& scenario = {}) {
  std::vector<const Run*> found;
  for (const Run& run : results.runs) {
    if (run.method == method && run.kind == kind && (scenario.empty() || run.scenario == scenario))
      found.push_back(&run);
  }
  return found;
}

std::vector<MotionKind> kinds_of(const Results& results) {
  std::vector<MotionKind> kinds;
  for (const MotionKind kind : kMotionKinds) {
    for (const Run& run : results.runs) {
      if (run.kind == kind) {
        kinds.push_back(kind);
        break;
      }
    }
  }
  return kinds;
}

constexpr const char* kReference = "FCL OBBRSS";

/// The motions that the times are compared on; triangle methods cannot judge the others.
bool is_compared(MotionKind kind) {
  return kind != MotionKind::Contained && kind != MotionKind::Tight;
}

/// Geometric mean over the motions of the reference's time over the method's.
double ratio(const Results& results, const std::string& method, double Statistics::*value) {
  double sum = 0.0;
  int count = 0;
  for (const MotionKind kind : kinds_of(results)) {
    if (!is_compared(kind)) continue;
    const auto reference = select(results, kReference, kind);
    if (reference.empty()) return 0.0;
    sum +=
        std::log(statistics(reference).*value / (statistics(select(results, method, kind)).*value));
    ++count;
  }
  return count == 0 ? 0.0 : std::exp(sum / count);
}

void header(std::ostream& out, const std::vector<std::string>& columns) {
  for (const std::string& column : columns) out << "| " << column << " ";
  out << "|\n";
  for (std::size_t i = 0; i < columns.size(); ++i) out << (i == 0 ? "|---" : "|---:");
  out << "|\n";
}

void write_scenarios(std::ostream& out, const Results& results) {
  if (results.scenarios.empty()) return;
  out << "### Scenes\n\nTriangles, and those of the paper's scenario of that name.\n\n";
  header(out, {"scene", "elements", "static", "paper", "moving", "paper"});
  for (const Scenario& scene : results.scenarios) {
    out << "| (" << scene.name << ") " << scene.title << " | " << scene.elements.size() << " | "
        << static_triangles(scene) << " | " << scene.paper_static_triangles << " | "
        << scene.moving->solid->triangles.size() << " | " << scene.paper_moving_triangles << " |\n";
  }
}

/// What the poses are known to be: a motion whose poses are all of one kind could be judged right
/// by a method that always gives the same answer.
void write_truth(std::ostream& out, const Results& results) {
  out << "\n### Poses by their truth\n\nOf all scenes; unknown ones are timed but not judged.\n\n";
  header(out, {"motion", "clear", "contact", "interference", "unknown"});
  for (const MotionKind kind : kinds_of(results)) {
    std::array<std::size_t, 4> counts{};
    for (const Run* run : select(results, results.methods.front(), kind)) {
      for (const Truth& truth : run->truth) {
        ++counts[truth.verdict ? static_cast<std::size_t>(*truth.verdict) : 3];
      }
    }
    out << "| " << to_string(kind);
    for (const std::size_t n : counts) out << " | " << n;
    out << " |\n";
  }
}

void write_times(std::ostream& out, const Results& results) {
  out << "\n### Time per move\n\nMicroseconds: median / 99th percentile / mean of a batch, over "
         "the "
         "poses of all scenes. A reading of the clock took "
      << text(results.clock_us)
      << " us in this run; medians and percentiles contain one, means do not. Last columns: how "
         "many times faster than "
      << kReference << ", geometric mean over free to contact of medians and of means.\n\n";
  std::vector<std::string> columns{"method"};
  const std::vector<MotionKind> kinds = kinds_of(results);
  for (const MotionKind kind : kinds) columns.emplace_back(to_string(kind));
  columns.insert(columns.end(), {"medians", "means"});
  header(out, columns);
  for (const std::string& method : results.methods) {
    out << "| " << method;
    for (const MotionKind kind : kinds) {
      const Statistics s = statistics(select(results, method, kind));
      out << " | " << text(s.median_us) << " / " << text(s.p99_us) << " / " << text(s.mean_us);
    }
    out << " | " << text(ratio(results, method, &Statistics::median_us)) << " | "
        << text(ratio(results, method, &Statistics::mean_us)) << " |\n";
  }
}

void write_scores(std::ostream& out, const Results& results, const char* title,
                  Score (*score)(std::span<const Run* const>)) {
  out << title;
  std::vector<std::string> columns{"method"};
  const std::vector<MotionKind> kinds = kinds_of(results);
  for (const MotionKind kind : kinds) {
    columns.emplace_back(to_string(kind));
  }
  header(out, columns);
  for (const std::string& method : results.methods) {
    out << "| " << method;
    for (const MotionKind kind : kinds) {
      const Score s = score(select(results, method, kind));
      out << " | " << s.false_yes << " / " << s.false_no;
      if (s.other != 0) out << " / " << s.other;
      out << " of " << s.known;
    }
    out << " |\n";
  }
}

std::string per_thousand(std::uint64_t count, std::size_t poses) {
  return std::to_string(
      std::llround(1000.0 * static_cast<double>(count) / static_cast<double>(poses)));
}

/// Hits, and tests where the method counts them.
std::string tests_of(const Run& run) {
  const std::size_t poses = run.answers.size();
  const auto hits = static_cast<std::uint64_t>(std::ranges::count(run.answers, true, &Answer::hit));
  std::string result = per_thousand(hits, poses);
  if (!run.counters) return result + "; –";
  return result + "; " + per_thousand(run.counters->box_tests, poses) + " / " +
         per_thousand(run.counters->triangle_tests, poses);
}

void write_counters(std::ostream& out, const Results& results) {
  out << "\n### Collisions and tests\n\nOf 1,000 moves: collisions that the method tells; N_b / "
         "N_p "
         "(box pairs, of elements and of tree nodes / triangle pairs). FCL: pairs of elements that "
         "its tree over them leaves and pairs of nodes, / pairs of leaves, by its own counters. "
         "AABB tree: the same behind the layers. ODE, Bullet and CGAL count nothing that a user "
         "could read.\n\n";
  std::vector<std::string> columns{"scene, method"};
  const std::vector<MotionKind> kinds = kinds_of(results);
  for (const MotionKind kind : kinds) columns.emplace_back(to_string(kind));
  header(out, columns);
  for (const Scenario& scene : results.scenarios) {
    for (const std::string& method : results.methods) {
      out << "| (" << scene.name << ") " << method;
      for (const MotionKind kind : kinds) {
        for (const Run* run : select(results, method, kind, scene.name)) {
          out << " | " << tests_of(*run);
        }
      }
      out << " |\n";
    }
  }
}

std::vector<const ScalePoint*> points_of(const Results& results, const std::string& method) {
  std::vector<const ScalePoint*> points;
  for (const ScalePoint& point : results.scale) {
    if (point.method == method) points.push_back(&point);
  }
  return points;
}

/// The power of the number of elements that a time grows with, by least squares of the logarithms;
/// from 100 elements on, below which fixed costs rule.
std::string exponent(const std::vector<const ScalePoint*>& points, double ScalePoint::*value) {
  double n = 0.0;
  double sum_x = 0.0;
  double sum_y = 0.0;
  double sum_xx = 0.0;
  double sum_xy = 0.0;
  for (const ScalePoint* point : points) {
    if (point->count < 100) continue;
    const double x = std::log(static_cast<double>(point->count));
    const double y = std::log(point->*value);
    n += 1.0;
    sum_x += x;
    sum_y += y;
    sum_xx += x * x;
    sum_xy += x * y;
  }
  if (n < 2.0) return "–";
  char buffer[32];
  (void)std::snprintf(buffer, sizeof buffer, "%.2f",
                      (n * sum_xy - sum_x * sum_y) / (n * sum_xx - sum_x * sum_x));
  return buffer;
}

/// One column for each number of elements that any method was run with.
std::vector<std::string> count_columns(const Results& results) {
  std::vector<std::string> columns{"method"};
  for (const ScalePoint* point : points_of(results, results.methods.front())) {
    columns.push_back(std::to_string(point->count));
  }
  return columns;
}

void write_scale(std::ostream& out, const Results& results) {
  if (results.scale.empty()) return;
  Table moves{"Growth: moves",
              "Microseconds of a move by the number of elements: median, batch mean; heap bytes "
              "that an element takes beyond what instances share; and the power of the number of "
              "elements that median and mean grow with from 100 on. A dash: the method's structure "
              "does not hold so many, or looks at each of them.",
              count_columns(results),
              {}};
  moves.columns.insert(moves.columns.end(), {"bytes", "power of medians", "of means"});
  Table changes{"Growth: changes",
                "Microseconds: adding an element / adding one and the first move after it / taking "
                "one away and the first move after it, medians but for the first; milliseconds: "
                "adding all elements one by one.",
                count_columns(results),
                {}};
  const std::size_t width = changes.columns.size();
  for (const std::string& method : results.methods) {
    std::vector<std::string> move_row{method};
    std::vector<std::string> change_row{method};
    const auto points = points_of(results, method);
    for (const ScalePoint* p : points) {
      move_row.push_back(text(p->move_us) + ", " + text(p->move_mean_us));
      change_row.push_back(text(p->add_us, p->add_and_move_us) + " / " + text(p->remove_us) + "; " +
                           text(p->build_ms));
    }
    move_row.resize(width, "–");
    change_row.resize(width, "–");
    move_row.push_back(std::to_string(std::llround(points.back()->bytes_per_element)));
    move_row.push_back(exponent(points, &ScalePoint::move_us));
    move_row.push_back(exponent(points, &ScalePoint::move_mean_us));
    moves.rows.push_back(std::move(move_row));
    changes.rows.push_back(std::move(change_row));
  }
  write(out, moves);
  write(out, changes);
}

void write_sizes(std::ostream& out, const Results& results) {
  if (results.sizes.empty()) return;
  Table table{"Size of the moving element",
              "A cube of this edge, in mm, slides 0.05 to 1 mm above the highest of 1,000 "
              "elements: mean microseconds of a move.",
              {"method"},
              {}};
  for (const std::string& method : results.methods) {
    std::vector<std::string> row{method};
    for (const SizePoint& point : results.sizes) {
      if (point.method != method) continue;
      if (table.rows.empty()) table.columns.push_back(text(point.size_mm));
      row.push_back(text(point.mean_us));
    }
    table.rows.push_back(std::move(row));
  }
  write(out, table);
}

}  // namespace

void write_tables(std::ostream& out, const Results& results) {
  write_scenarios(out, results);
  if (!results.runs.empty()) {
    write_truth(out, results);
    write_times(out, results);
    write_scores(
        out, results,
        "\n### Wrong answers to \"is there interference?\"\n\nFalse yes / false no of the poses "
        "whose truth is known by construction; / contact and clear mixed up. Triangle methods "
        "know only whether surfaces meet, and a hit is taken for interference.\n\n",
        score_interference);
    write_scores(
        out, results,
        "\n### Wrong answers to the method's own question\n\nFor dowel the verdict; for "
        "triangle methods whether the facets' surfaces meet, an exact touch included. False yes "
        "/ false no / contact and clear mixed up.\n\n",
        score_own_question);
    write_counters(out, results);
  }
  write_scale(out, results);
  write_sizes(out, results);
  for (const Table& table : results.tables) write(out, table);
}

std::string json_text(const Results& results) {
  nlohmann::json json;
  json["clock_us"] = results.clock_us;
  for (const Scenario& scene : results.scenarios) {
    json["scenes"].push_back({{"name", scene.name},
                              {"title", scene.title},
                              {"elements", scene.elements.size()},
                              {"static_triangles", static_triangles(scene)},
                              {"moving_triangles", scene.moving->solid->triangles.size()}});
  }
  for (const Run& run : results.runs) {
    const Run* const one[] = {&run};
    const Statistics s = statistics(one);
    const Score interference = score_interference(one);
    const Score own = score_own_question(one);
    const auto score = [](const Score& value) {
      return nlohmann::json{{"known", value.known},
                            {"false_yes", value.false_yes},
                            {"false_no", value.false_no},
                            {"other", value.other}};
    };
    nlohmann::json item{{"scene", run.scenario},     {"motion", to_string(run.kind)},
                        {"method", run.method},      {"poses", run.answers.size()},
                        {"median_us", s.median_us},  {"p99_us", s.p99_us},
                        {"mean_us", s.mean_us},      {"interference", score(interference)},
                        {"own_question", score(own)}};
    if (run.counters) {
      item["box_tests"] = run.counters->box_tests;
      item["triangle_tests"] = run.counters->triangle_tests;
    }
    json["runs"].push_back(std::move(item));
  }
  for (const ScalePoint& point : results.scale) {
    json["growth"].push_back({{"elements", point.count},
                              {"method", point.method},
                              {"add_us", point.add_us},
                              {"add_and_move_us", point.add_and_move_us},
                              {"remove_and_move_us", point.remove_us},
                              {"build_ms", point.build_ms},
                              {"move_median_us", point.move_us},
                              {"move_mean_us", point.move_mean_us},
                              {"bytes_per_element", point.bytes_per_element}});
  }
  for (const std::string& method : results.methods) {
    if (results.runs.empty()) break;
    json["times_faster_than_reference"][method] = {
        {"medians", ratio(results, method, &Statistics::median_us)},
        {"means", ratio(results, method, &Statistics::mean_us)}};
  }
  for (const Table& table : results.tables) {
    json["tables"].push_back(
        {{"title", table.title}, {"columns", table.columns}, {"rows", table.rows}});
  }
  return json.dump(1) + '\n';
}

Chart time_chart(const Results& results) {
  Chart chart;
  chart.title = "Time per move";
  chart.subtitle = "Median of all four scenes; the line above it ends at the 99th percentile";
  chart.x.label = "motion";
  chart.y.label = "time of a check, µs";
  const std::vector<MotionKind> kinds = kinds_of(results);
  for (const MotionKind kind : kinds) chart.categories.emplace_back(to_string(kind));
  const double step = 0.8 / static_cast<double>(results.methods.size());
  for (std::size_t m = 0; m < results.methods.size(); ++m) {
    Series series{results.methods[m], {}, SeriesStyle::Marks};
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      const Statistics s = statistics(select(results, results.methods[m], kinds[k]));
      const double place = static_cast<double>(k) + 0.6 + (static_cast<double>(m) + 0.5) * step;
      series.marks.push_back({place, s.median_us, {}, s.p99_us});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Chart growth_chart(const Results& results) {
  Chart chart;
  chart.title = "Growth";
  chart.subtitle = "A move close over the tops of a field of risers and pins: median";
  chart.x.label = "elements";
  chart.y.label = "time of a check, µs";
  for (const std::string& method : results.methods) {
    Series series{method, {}, SeriesStyle::Line};
    for (const ScalePoint& point : results.scale) {
      if (point.method != method) continue;
      series.marks.push_back({static_cast<double>(point.count), point.move_us, {}, 0.0});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

Chart size_chart(const Results& results) {
  Chart chart;
  chart.title = "Size of the moving element";
  chart.subtitle = "A cube slides close above the highest of 1,000 elements: mean";
  chart.x.label = "edge of the moving cube, mm";
  chart.y.label = "time of a check, µs";
  for (const std::string& method : results.methods) {
    Series series{method, {}, SeriesStyle::Line};
    for (const SizePoint& point : results.sizes) {
      if (point.method != method) continue;
      series.marks.push_back({point.size_mm, point.mean_us, {}, 0.0});
    }
    chart.series.push_back(std::move(series));
  }
  return chart;
}

bool has_wrong_verdict_of_dowel(const Results& results) {
  if (results.has_wrong_verdict) return true;
  return std::ranges::any_of(results.runs, [](const Run& one) {
    if (one.method != "dowel" && one.method != "dowel first") return false;
    const Run* const runs[] = {&one};
    const Score score = score_own_question(runs);
    return score.false_yes + score.false_no + score.other != 0;
  });
}

void write_wrong_verdicts(std::ostream& out, const Results& results, std::size_t limit) {
  for (const Run& run : results.runs) {
    std::size_t shown = 0;
    for (std::size_t i = 0; i < run.answers.size() && shown < limit; ++i) {
      const auto& got = run.answers[i].verdict;
      const auto& truth = run.truth[i].verdict;
      if (!got || !truth || *got == *truth) continue;
      ++shown;
      out << run.method << ", scene " << run.scenario << ", " << to_string(run.kind) << " pose "
          << i << ": " << dowel::to_string(*got) << ", should be " << dowel::to_string(*truth)
          << '\n';
    }
  }
}

}  // namespace dowel::bench
