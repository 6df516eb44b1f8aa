#include "error_study.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "known_pair.h"
#include "methods.h"
#include "random_geometry.h"
#include "solid_pair.h"

namespace dowel::bench {

namespace {

constexpr double kLeastGap_mm = 1.0e-7;
constexpr double kLargestGap_mm = 1.0;
constexpr double kReach_mm = 300.0;  // of the pairs' places in the world

/// Shares of the tolerance: verdicts are held to from 0.9 to 1.1 of it.
constexpr double kBand = 0.1;

constexpr const char* kExact = "dowel exact";
constexpr const char* kExactByTolerance = "dowel exact, by tolerance";

struct Setting {
  std::string method;
  double facet_error_mm = 0.1;
  double tolerance_mm = 0.0;
  std::function<std::unique_ptr<Checker>()> make;
  std::size_t most_rounds = std::numeric_limits<std::size_t>::max();
};

Setting dowel_setting(const char* name, DowelMode mode, double facet_error_mm) {
  return {name, facet_error_mm, mode.tolerance_mm, [mode] { return make_dowel(mode); }};
}

/// Each method over facet errors; dowel over tolerances as well.
std::vector<Setting> settings() {
  constexpr std::array kFacetErrors_mm{1.0, 0.5, 0.2, 0.1, 0.05, 0.02, 0.01, 0.005};
  constexpr std::array kTolerances_mm{0.1, 0.01, 1.0e-3, 1.0e-4, 1.0e-5, 1.0e-6};
  constexpr double kSmall_mm = 1.0e-4;          // where facets are to show their own error
  constexpr double kFinestPublished_mm = 0.05;  // it looks at all pairs of facets
  std::vector<Setting> result;
  result.reserve(16 * kFacetErrors_mm.size());
  for (const double error : kFacetErrors_mm) {
    result.push_back(dowel_setting(kExact, {.tolerance_mm = 1.0e-3}, error));
  }
  for (const double tolerance : kTolerances_mm) {
    result.push_back(dowel_setting(kExactByTolerance, {.tolerance_mm = tolerance}, 0.1));
  }
  for (const double error : kFacetErrors_mm) {
    result.push_back(dowel_setting("dowel facets",
                                   {.tolerance_mm = kSmall_mm, .knows_facets_alone = true}, error));
  }
  for (const double error : kFacetErrors_mm) {
    result.push_back(dowel_setting("dowel paper holes",
                                   {.tolerance_mm = 1.0e-3, .holes = HoleMode::Paper}, error));
  }
  for (const Method& method : all_methods()) {
    if (method.name.starts_with("dowel")) continue;  // in modes of their own
    for (const double error : kFacetErrors_mm) {
      if (method.name == "published" && error < kFinestPublished_mm) continue;
      result.push_back({std::string(method.name), error, 0.0, method.make});
      if (method.stride > 1) result.back().most_rounds = 1;
    }
  }
  return result;
}

PlacedPair on_its_path(const KnownPair& pair, std::size_t count) {
  PlacedPair result{pair.name, pair.moving, pair.still, {}, {}};
  for (std::size_t i = 0; i < count; ++i) {
    const double s = (static_cast<double>(i) + 0.5) / static_cast<double>(count);
    result.gaps_mm.push_back(swept_gap_mm(s, kLeastGap_mm, kLargestGap_mm));
    result.X_SM.push_back(pair.X_SM(result.gaps_mm.back(), 5.0 * s));
  }
  return result;
}

void judge(const PlacedPair& pair, const Run& run, ErrorPoint& point) {
  for (std::size_t i = 0; i < pair.gaps_mm.size(); ++i) {
    const double gap = pair.gaps_mm[i];
    ++point.judged;
    const bool hit = run.answers[i].hit;
    if (hit != (gap < 0.0)) {
      ++point.wrong;
      double& off_mm = hit ? point.gap_hit_mm : point.depth_missed_mm;
      off_mm = std::max(off_mm, std::abs(gap));
    }
    const double beyond = gap + point.tolerance_mm;  // negative: interference for the method
    if (hit != (beyond < 0.0) && std::abs(beyond) > point.off_threshold_mm) {
      point.off_threshold_mm = std::abs(beyond);
      point.off_on = pair.name;
    }
  }
}

/// What the method says of how far or how deep, where it says so.
void judge_measures(Checker& checker, const PlacedPair& pair, const std::vector<Pose>& poses,
                    ErrorPoint& point) {
  for (std::size_t i = 0; i < poses.size(); i += 5) {
    if (const auto gap = checker.measured_gap_mm(poses[i])) {
      point.measured_off_mm = std::max(point.measured_off_mm, std::abs(*gap - pair.gaps_mm[i]));
    }
  }
}

/// All settings of one fineness on one pair, taking turns.
void run_pair(const PlacedPair& pair, const Pose& X_WS, std::span<const Setting> settings,
              std::span<ErrorPoint> points, std::size_t rounds) {
  std::vector<Pose> poses;
  for (const Pose& X_SM : pair.X_SM) poses.push_back(X_WS * X_SM);
  std::vector<std::unique_ptr<Checker>> checkers;
  std::vector<Run> runs;
  for (const Setting& setting : settings) {
    checkers.push_back(setting.make());
    checkers.back()->add(placed(pair.still, X_WS));
    checkers.back()->set_moving(pair.moving);
    checkers.back()->finish();
    runs.push_back(blank_run(poses.size()));
  }
  for (std::size_t round = 0; round < rounds; ++round) {
    for (std::size_t i = 0; i < settings.size(); ++i) {
      if (round >= settings[i].most_rounds) continue;
      run_timed(*checkers[i], poses, runs[i]);
      run_batch(*checkers[i], poses, runs[i]);
    }
  }
  for (std::size_t i = 0; i < settings.size(); ++i) {
    judge(pair, runs[i], points[i]);
    judge_measures(*checkers[i], pair, poses, points[i]);
    if (runs[i].batch_mean_us > points[i].slowest_us) {
      points[i].slowest_us = runs[i].batch_mean_us;
      points[i].slowest_on = pair.name;
    }
    points[i].mean_us += runs[i].batch_mean_us;  // summed here, divided by the pairs at the end
  }
}

/// Runs all settings over the pairs that `pairs_at` gives for a facet error.
std::vector<ErrorPoint> run_settings(
    std::vector<Setting> all, std::size_t rounds,
    const std::function<std::vector<PlacedPair>(double facet_error_mm)>& pairs_at) {
  std::vector<std::string> order;  // of the methods, as they were named
  order.reserve(all.size());
  for (const Setting& setting : all) order.push_back(setting.method);
  std::vector<ErrorPoint> points;
  points.reserve(all.size());
  // Those of one fineness side by side, since they share elements.
  std::ranges::stable_sort(all, std::ranges::greater(), &Setting::facet_error_mm);
  for (const Setting& setting : all) {
    points.emplace_back();
    points.back().method = setting.method;
    points.back().facet_error_mm = setting.facet_error_mm;
    points.back().tolerance_mm = setting.tolerance_mm;
  }
  for (std::size_t first = 0; first < all.size();) {
    std::size_t count = 0;
    const double error = all[first].facet_error_mm;
    while (first + count < all.size() && all[first + count].facet_error_mm == error) ++count;
    testing::RandomGeometry random(71);
    const std::vector<PlacedPair> pairs = pairs_at(error);
    for (const PlacedPair& pair : pairs) {
      run_pair(pair, random.pose(kReach_mm), std::span(all).subspan(first, count),
               std::span(points).subspan(first, count), rounds);
    }
    for (std::size_t i = first; i < first + count; ++i) {
      points[i].mean_us /= static_cast<double>(pairs.size());
    }
    first += count;
  }
  std::ranges::stable_sort(points, {}, [&](const ErrorPoint& point) {
    return std::ranges::find(order, point.method) - order.begin();
  });
  return points;
}

std::string tolerance_text(double tolerance_mm) {
  return tolerance_mm > 0.0 ? text(tolerance_mm) : "none";
}

std::string wrong_text(const ErrorPoint& p) {
  return std::to_string(p.wrong) + " of " + std::to_string(p.judged);
}

}  // namespace

std::vector<ErrorPoint> run_error_study(const Plan& plan) {
  const std::size_t poses = std::max<std::size_t>(plan.poses / 4, 24);
  return run_settings(settings(), plan.rounds, [&](double facet_error_mm) {
    std::vector<PlacedPair> result;
    for (const KnownPair& pair : known_pairs({.facet_error_mm = facet_error_mm})) {
      result.push_back(on_its_path(pair, poses));
    }
    return result;
  });
}

std::vector<ErrorPoint> run_solid_study(const Plan& plan) {
  std::vector<Setting> chosen = settings();
  std::erase_if(chosen, [](const Setting& s) { return s.method == kExactByTolerance; });
  const SolidPairs pairs(std::max<std::size_t>(plan.poses / 40, 3));
  return run_settings(std::move(chosen), plan.rounds,
                      [&](double facet_error_mm) { return pairs.faceted(facet_error_mm); });
}

bool has_wrong_exact_verdict(const std::vector<ErrorPoint>& points) {
  return std::ranges::any_of(points, [](const ErrorPoint& p) {
    return (p.method == kExact || p.method == kExactByTolerance) &&
           p.off_threshold_mm > kBand * p.tolerance_mm;
  });
}

Table error_table(const std::vector<ErrorPoint>& points) {
  Table table{
      "Run time against error",
      "Pairs whose gap or depth is known exactly (a pin in its hole, cylinders on a plane, beside "
      "and across a post, a ball on a plane, a cone in its countersink, a block and a drilled "
      "riser on a plane) go from 1 mm apart to 1 mm deep and back, turning, in random places. "
      "Facet error and tolerance in mm; mean time of a check in microseconds, and of the pair that "
      "took longest; wrong answers to \"is there interference?\"; the largest gap called "
      "interference and the largest depth called none, in mm; the larger of the two measured from "
      "the method's own threshold (dowel's is its tolerance, the others' is 0), with the pair; the "
      "largest error of the gap or depth that the method measures, in mm.",
      {"method", "facet error", "tolerance", "time", "slowest", "wrong", "gap hit", "depth missed",
       "off its threshold", "on", "measure off by"},
      {}};
  for (const ErrorPoint& p : points) {
    table.rows.push_back({p.method, text(p.facet_error_mm), tolerance_text(p.tolerance_mm),
                          text(p.mean_us), text(p.slowest_us) + " (" + p.slowest_on + ")",
                          wrong_text(p), text(p.gap_hit_mm), text(p.depth_missed_mm),
                          text(p.off_threshold_mm), p.off_on,
                          p.measured_off_mm > 0.0 ? text(p.measured_off_mm) : "–"});
  }
  return table;
}

Table solid_table(const std::vector<ErrorPoint>& points) {
  Table table{
      "Run time against error, judged by OpenCascade",
      "Pairs of exact solids as fixtures have them (drilled and slotted plates, pins, nuts, "
      "straps, "
      "cones, tori, rounded blocks) from 1 mm apart to 1 mm moved into each other along the "
      "shortest way; the truth is OpenCascade's distance, and the largest ball found in its "
      "Boolean's volume. Columns as in the table before.",
      {"method", "facet error", "tolerance", "time", "wrong", "gap hit", "depth missed",
       "off its threshold", "on"},
      {}};
  for (const ErrorPoint& p : points) {
    table.rows.push_back({p.method, text(p.facet_error_mm), tolerance_text(p.tolerance_mm),
                          text(p.mean_us), wrong_text(p), text(p.gap_hit_mm),
                          text(p.depth_missed_mm), text(p.off_threshold_mm), p.off_on});
  }
  return table;
}

Chart error_chart(const std::vector<ErrorPoint>& points) {
  Chart chart;
  chart.title = "What being right costs: run time against error";
  chart.subtitle =
      "Along a curve: facet error 1 to 0.005 mm; of \"by tolerance\": tolerance 0.1 to 10⁻⁶ mm";
  chart.x.label = "largest gap or depth that was judged wrong, mm";
  chart.y.label = "mean time of a check, µs";
  std::vector<Mark> all;
  for (const ErrorPoint& p : points) {
    if (chart.series.empty() || chart.series.back().name != p.method) {
      chart.series.push_back({p.method, {}, SeriesStyle::Line});
    }
    // Nothing wrong: no further off than the smallest gap that was asked about.
    chart.series.back().marks.push_back({std::max(p.off_mm(), kLeastGap_mm), p.mean_us, {}, 0.0});
    all.push_back(chart.series.back().marks.back());
  }
  for (Series& series : chart.series) {
    std::ranges::sort(series.marks, std::ranges::greater(), &Mark::x);
  }
  // From the largest error on: what is not slower than anything as right.
  std::ranges::sort(
      all, [](const Mark& a, const Mark& b) { return a.x != b.x ? a.x < b.x : a.y < b.y; });
  Series front{"Pareto front", {}, SeriesStyle::Front};
  for (const Mark& mark : all) {
    if (front.marks.empty() || mark.y < front.marks.back().y) front.marks.push_back(mark);
  }
  chart.series.push_back(front);
  return chart;
}

}  // namespace dowel::bench
