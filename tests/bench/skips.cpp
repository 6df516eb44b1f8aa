#include "skips.h"

#include <algorithm>
#include <array>
#include <string>

#include "dowel/collision/box_separation.h"
#include "dowel/collision/silhouette.h"
#include "layer_worth.h"

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
  const char* name = "";
  DowelMode mode;
  std::size_t most_poses = 0;
};

const std::array<Way, 4>& ways() {
  static const std::array<Way, 4> kWays{
      {{"as it is", {}, ~std::size_t{0}},
       {"nothing remembered", {.forgets = true}, ~std::size_t{0}},
       {"hole triangles dropped", {.holes = HoleMode::Paper}, ~std::size_t{0}},
       {"all facets of all elements", {.uses_brute_force = true}, 3}}};
  return kWays;
}

/// Mean time of a check; poses are those at equal steps, but for brute force all.
double mean_us(const Scenario& scene, const Motion& motion, const Way& way, std::size_t rounds) {
  const std::unique_ptr<Checker> checker = checker_of(scene, way.mode);
  std::vector<Pose> poses = motion.poses;
  if (poses.size() > way.most_poses) {
    for (std::size_t i = 0; i < way.most_poses; ++i) {
      poses[i] = poses[(2 * i + 1) * poses.size() / (2 * way.most_poses)];
    }
    poses.resize(way.most_poses);
    rounds = 1;
  }
  Run run = blank_run(poses.size());
  for (std::size_t round = 0; round < rounds; ++round) run_batch(*checker, poses, run);
  return run.batch_mean_us;
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
  Table worth{"What the skips are worth",
              "Microseconds of a check, mean of scene (a): as it is; with nothing remembered from "
              "move to move; with the triangles of holes dropped as in the paper; and by looking "
              "at all facets of all elements, without layers, boxes, trees or memory (three "
              "poses).",
              {"motion"},
              {}};
  for (const Way& way : ways()) worth.columns.emplace_back(way.name);
  const std::vector<Scenario> scenes = paper_scenarios();
  for (const MotionKind kind : plan.kinds) {
    Skips skips;
    std::vector<std::string> worth_row{std::string(to_string(kind))};
    for (const Scenario& scene : scenes) {
      const Motion motion = motion_of(scene, kind, plan.poses);
      count_pairs(scene, motion, skips);
      count_untested(*checker_of(scene, {}), motion, skips);
      if (&scene != &scenes.front()) continue;
      for (const Way& way : ways()) {
        worth_row.push_back(text(mean_us(scene, motion, way, plan.rounds)));
      }
    }
    worth.rows.push_back(std::move(worth_row));
    counts.rows.push_back(row_of(std::string(to_string(kind)), skips));
  }
  for (std::size_t count = 100; count <= (plan.poses < 500 ? 1'000U : 10'000U); count *= 10) {
    const Scenario field = field_of_elements(count);
    const Motion path{MotionKind::Near, field_path(field, plan.poses), {}};
    Skips skips;
    count_pairs(field, path, skips);
    count_untested(*checker_of(field, {}), path, skips);
    counts.rows.push_back(row_of(field.title, skips));
  }
  std::vector<Table> tables = layer_worth(plan);
  tables.insert(tables.begin(), std::move(counts));
  tables.push_back(std::move(worth));
  return tables;
}

}  // namespace dowel::bench
