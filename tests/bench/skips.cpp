#include "skips.h"

#include <algorithm>
#include <array>
#include <limits>
#include <string>

#include "dowel/collision/box_separation.h"
#include "dowel/collision/silhouette.h"

namespace dowel::bench {

namespace {

/// Pairs by the layer that rejects them when each is asked in order.
enum Layer : std::uint8_t { Heights, Columns, Silhouettes, Type1, Type2, Type3, Left };

struct Skips {
  std::array<std::size_t, Left + 1> pairs{};
  std::size_t poses = 0;
  std::size_t moves_without_test = 0;
};

Obb box_of(const Element& element) {
  return {element.box.center(), Eigen::Matrix3d::Identity(), 0.5 * element.box.size()};
}

Layer rejected_by(const Obb& moving_W, const Aabb& bounds_W, const Silhouette& outline,
                  const Placed& other) {
  constexpr double kMargin_mm = kDefaultTolerance_mm;
  const Aabb grown = bounds_W.padded(kMargin_mm);
  if (grown.min.z() > other.box_W.max.z() || grown.max.z() < other.box_W.min.z()) return Heights;
  if (!grown.overlaps(other.box_W)) return Columns;
  const Obb other_W = transformed(other.X_WE, box_of(*other.element));
  if (are_apart(outline, silhouette(other_W), kMargin_mm)) return Silhouettes;
  const int plane = separate(moving_W, other_W, kMargin_mm).plane;
  if (plane < 0) return Left;
  if (plane < 3) return Type1;
  return plane < 6 ? Type2 : Type3;
}

void count_pairs(const Scenario& scene, const Motion& motion, Skips& skips) {
  for (const Pose& pose : motion.poses) {
    const Obb moving_W = transformed(pose, box_of(*scene.moving));
    const Aabb bounds_W = bounds(moving_W);
    const Silhouette outline = silhouette(moving_W);
    for (const Placed& other : scene.elements) {
      ++skips.pairs.at(rejected_by(moving_W, bounds_W, outline, other));
    }
  }
  skips.poses += motion.poses.size();
}

std::unique_ptr<Checker> checker_of(const Scenario& scene, const DowelMode& mode) {
  std::unique_ptr<Checker> checker = make_dowel(mode);
  for (const Placed& placed : scene.elements) checker->add(placed);
  checker->set_moving(scene.moving);
  checker->finish();
  return checker;
}

/// Moves at which dowel asks nothing at all, for it knows that nothing came near enough.
void count_untested(Checker& checker, const Motion& motion, Skips& skips) {
  checker.take_counters();
  for (const Pose& pose : motion.poses) {
    (void)checker.check(pose);
    const auto counters = checker.take_counters();
    if (counters && counters->box_tests == 0) ++skips.moves_without_test;
  }
}

/// A check in one of dowel's ways.
struct Way {
  std::string name;
  DowelMode mode;
  std::size_t most_poses = std::numeric_limits<std::size_t>::max();
};

constexpr SkipSet kRemembered = SkipSet(Skip::Way) | SkipSet(Skip::Memory);

/// As it is, without each of the skips, without what is remembered from move to move, without any
/// skip, and by brute force.
std::vector<Way> ways() {
  std::vector<Way> result{{"as it is", {}}};
  for (std::size_t i = 0; i < kSkipCount; ++i) {
    const auto skip = static_cast<Skip>(i);
    result.push_back({std::string(to_string(skip)), {.without = SkipSet(skip)}});
  }
  result.push_back({"way, memory", {.without = kRemembered}});
  result.push_back({"all of them", {.without = SkipSet::all()}, 200});
  result.push_back({"all facets", {.uses_brute_force = true}, 1});
  return result;
}

/// At equal steps, no more than `most`.
std::vector<std::size_t> chosen(std::size_t poses, std::size_t most) {
  std::vector<std::size_t> result(std::min(poses, most));
  for (std::size_t i = 0; i < result.size(); ++i) {
    result[i] = (2 * i + 1) * poses / (2 * result.size());
  }
  return result;
}

/// What a way takes, and where it says something else than dowel as it is.
struct Cost {
  double sum_us = 0.0;
  std::size_t poses = 0;
  std::size_t changed = 0;
  std::vector<Verdict> verdicts;
};

void measure(const Scenario& scene, const Motion& motion, const Way& way, std::size_t rounds,
             const std::vector<Verdict>& expected, Cost& cost) {
  const std::unique_ptr<Checker> checker = checker_of(scene, way.mode);
  const std::vector<std::size_t> places = chosen(motion.poses.size(), way.most_poses);
  std::vector<Pose> poses;
  for (const std::size_t place : places) poses.push_back(motion.poses[place]);
  cost.verdicts.clear();
  for (const Pose& pose : poses) cost.verdicts.push_back(*checker->check(pose).verdict);
  for (std::size_t i = 0; i < places.size() && !expected.empty(); ++i) {
    if (cost.verdicts[i] != expected[places[i]]) ++cost.changed;
  }
  Run run = blank_run(poses.size());
  const bool is_brute = way.mode.uses_brute_force;
  for (std::size_t round = 0; round < (is_brute ? 1 : rounds); ++round) {
    run_batch(*checker, poses, run);
  }
  cost.sum_us += run.batch_mean_us * static_cast<double>(poses.size());
  cost.poses += poses.size();
}

/// A row of what each way takes; `scenes` alike.
std::vector<std::string> worth_row(const std::vector<Scenario>& scenes, MotionKind kind,
                                   const Plan& plan) {
  const std::vector<Way> all = ways();
  std::vector<Cost> costs(all.size());
  for (const Scenario& scene : scenes) {
    const Motion motion = motion_of(scene, kind, plan.poses);
    std::vector<Verdict> expected;
    for (std::size_t i = 0; i < all.size(); ++i) {
      measure(scene, motion, all[i], plan.rounds, expected, costs[i]);
      if (i == 0) expected = costs[i].verdicts;
    }
  }
  std::vector<std::string> row{std::string(to_string(kind))};
  std::size_t changed = 0;
  for (const Cost& cost : costs) {
    row.push_back(text(cost.sum_us / static_cast<double>(cost.poses)));
    changed += cost.changed;
  }
  row.push_back(std::to_string(changed));
  return row;
}

/// How often each skip is used, of 1,000 moves.
std::vector<std::string> uses_row(const std::vector<Scenario>& scenes, MotionKind kind,
                                  const Plan& plan) {
  std::array<double, kSkipCount> uses{};
  double poses = 0.0;
  for (const Scenario& scene : scenes) {
    const Motion motion = motion_of(scene, kind, plan.poses);
    const std::unique_ptr<Checker> checker = checker_of(scene, {});
    for (const Pose& pose : motion.poses) (void)checker->check(pose);
    const auto counters = checker->take_counters();
    for (std::size_t i = 0; i < kSkipCount; ++i) {
      uses.at(i) += static_cast<double>(counters->skips.at(i));
    }
    poses += static_cast<double>(motion.poses.size());
  }
  std::vector<std::string> row{std::string(to_string(kind))};
  for (const double count : uses) row.push_back(text(1000.0 * count / poses));
  return row;
}

std::string share_of(std::size_t part, std::size_t whole) {
  return text(static_cast<double>(part) / static_cast<double>(std::max<std::size_t>(whole, 1)));
}

std::vector<std::string> row_of(std::string name, const Skips& skips) {
  std::vector<std::string> row{std::move(name)};
  for (const std::size_t pairs : skips.pairs) row.push_back(share_of(pairs, skips.poses));
  row.push_back(share_of(1000 * skips.moves_without_test, skips.poses));
  return row;
}

}  // namespace

std::vector<Table> run_skip_study(const Plan& plan) {
  Table counts{"Pairs that each layer rejects",
               "Of one move against all elements, means of all scenes and of the fields of the "
               "growth test, when every pair goes through "
               "the layers in order: other heights (layers); beside it in x or y (cells, "
               "intervals); silhouettes apart; a plane parallel to a face of the moving box (type "
               "1), of the other (2), to an edge of each (3); left to the narrow phase. Last "
               "column: of 1,000 moves those that dowel answers without any test, since the way "
               "gone is shorter than the known gap.",
               {"motion, field", "heights", "x, y", "silhouettes", "type 1", "type 2", "type 3",
                "left", "moves without test"},
               {}};
  Table uses{"How often each skip is used",
             "Of 1,000 moves, means of all scenes: pairs on which it decides; of shallow boxes and "
             "of planes that keep off, pairs whose search it makes shorter; of layers and "
             "silhouettes, each time that the elements near by are looked for. The names are those "
             "of the library (collision/verdict.h).",
             {"motion"},
             {}};
  Table worth{"What each skip is worth",
              "Mean microseconds of a check, all scenes: as it is; with one skip left out; without "
              "both that remember from move to move; without all of them (200 poses a scene); and "
              "by looking at all facets of all elements (one). None may change a verdict; last "
              "column: verdicts that did change.",
              {"motion"},
              {}};
  for (const Way& way : ways()) worth.columns.push_back(way.name);
  worth.columns.emplace_back("changed");
  for (std::size_t i = 0; i < kSkipCount; ++i) {
    uses.columns.emplace_back(to_string(static_cast<Skip>(i)));
  }
  const std::vector<Scenario> scenes = paper_scenarios();
  for (const MotionKind kind : plan.kinds) {
    Skips skips;
    for (const Scenario& scene : scenes) {
      const Motion motion = motion_of(scene, kind, plan.poses);
      count_pairs(scene, motion, skips);
      count_untested(*checker_of(scene, {}), motion, skips);
    }
    counts.rows.push_back(row_of(std::string(to_string(kind)), skips));
    uses.rows.push_back(uses_row(scenes, kind, plan));
    worth.rows.push_back(worth_row(scenes, kind, plan));
  }
  for (std::size_t count = 100; count <= (plan.poses < 500 ? 1'000U : 10'000U); count *= 10) {
    const Scenario field = field_of_elements(count);
    const Motion path{MotionKind::Near, field_path(field, plan.poses), {}};
    Skips skips;
    count_pairs(field, path, skips);
    count_untested(*checker_of(field, {}), path, skips);
    counts.rows.push_back(row_of(field.title, skips));
  }
  return {counts, uses, worth};
}

}  // namespace dowel::bench
