#include "layer_worth.h"

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <numeric>
#include <string>
#include <vector>

#include "dowel/collision/box_separation.h"
#include "dowel/collision/layered_projection.h"
#include "dowel/collision/model.h"
#include "dowel/collision/silhouette.h"
#include "judge.h"

namespace dowel::bench {

namespace {

/// The layers that a check goes through.
struct Layers {
  const char* name = "";
  bool has_cells = true;  ///< layers, cells, intervals; else every element is a candidate
  bool has_silhouettes = true;
  bool has_planes = true;  ///< of the three types, between boxes
  /// The narrow phase tries first what it found out of a pair at the last pose.
  bool remembers_pairs = false;
};

constexpr std::array<Layers, 6> kWays{{{"all layers"},
                                       {"no layers and cells", false},
                                       {"no silhouettes", true, false},
                                       {"no planes", true, true, false},
                                       {"narrow phase alone", false, false, false},
                                       {"pairs remembered", true, true, true, true}}};

/// What came to the narrow phase.
struct Narrow {
  std::size_t pairs = 0;
  std::size_t recalled = 0;               ///< answered by what was remembered alone
  std::array<std::size_t, 3> decided{};   ///< by Method
  std::array<std::size_t, 3> verdicts{};  ///< by Verdict
};

/// dowel's check put together from its layers. Of its memory, what is known of gaps is left out.
class PlainCheck {
 public:
  PlainCheck(const Scenario& scene, const Layers& layers) : layers_(layers) {
    for (const Placed& placed : scene.elements) {
      const Element& element = *placed.element;
      cells_.insert(static_cast<std::uint32_t>(bodies_.size()), placed.box_W);
      bodies_.push_back({box(element),
                         transformed(placed.X_WE, box(element)),
                         placed.X_WE.inverse(),
                         &model(placed.element),
                         {}});
    }
    everyone_.resize(bodies_.size());
    std::iota(everyone_.begin(), everyone_.end(), 0U);
    moving_ = &model(scene.moving);
    moving_box_ = box(*scene.moving);
  }

  Verdict check(const Pose& X_WM) {
    const Obb moving_W = transformed(X_WM, moving_box_);
    if (layers_.has_cells) cells_.query(bounds(moving_W).padded(options_.tolerance_mm), found_);
    const Silhouette outline = silhouette(moving_W);
    Verdict worst = Verdict::Clear;
    for (const std::uint32_t i : layers_.has_cells ? found_ : everyone_) {
      Body& other = bodies_[i];
      if (layers_.has_silhouettes &&
          are_apart(outline, silhouette(other.box_W), options_.tolerance_mm)) {
        continue;
      }
      if (layers_.has_planes && separate(moving_W, other.box_W, options_.tolerance_mm).plane >= 0) {
        continue;
      }
      const ModelPair pair{*moving_, *other.model, moving_box_, other.box_B, other.X_BW * X_WM, {}};
      worst = std::max(worst, judged(pair, other.memory).verdict);
    }
    return worst;
  }

  /// All that the narrow phase has judged.
  const Narrow& narrow() const { return narrow_; }

 private:
  struct Body {
    Obb box_B;
    Obb box_W;
    Pose X_BW;
    const CollisionModel* model;
    PairMemory memory;
  };

  PairVerdict judged(const ModelPair& pair, PairMemory& memory) {
    if (!layers_.remembers_pairs) memory = {};
    ++narrow_.pairs;
    Judge judge(pair, options_, memory, scratch_, counters_);
    if (judge.recall()) {
      ++narrow_.recalled;
    } else {
      judge.decide();
    }
    const PairVerdict& verdict = judge.result();
    ++narrow_.decided.at(static_cast<std::size_t>(verdict.method));
    ++narrow_.verdicts.at(static_cast<std::size_t>(verdict.verdict));
    return verdict;
  }

  static Obb box(const Element& element) {
    return {element.box.center(), Eigen::Matrix3d::Identity(), 0.5 * element.box.size()};
  }

  const CollisionModel& model(const ElementPtr& element) {
    auto& found = models_[element.get()];
    if (found == nullptr) {
      found = std::make_unique<CollisionModel>(element->solid, element->hole_faces);
    }
    return *found;
  }

  Layers layers_;
  QueryOptions options_;
  std::map<const Element*, std::unique_ptr<CollisionModel>> models_;
  std::vector<Body> bodies_;
  LayeredProjection cells_;
  std::vector<std::uint32_t> everyone_;
  std::vector<std::uint32_t> found_;
  const CollisionModel* moving_ = nullptr;
  Obb moving_box_;
  NarrowScratch scratch_;
  QueryCounters counters_;
  Narrow narrow_;
};

struct Cost {
  double mean_us = 0.0;
  double narrow = 0.0;  ///< pairs that come to the narrow phase, of one move
  std::vector<Verdict> verdicts;
};

Cost cost(const Scenario& scene, const Motion& motion, const Layers& layers, std::size_t rounds) {
  PlainCheck plain(scene, layers);
  Cost result;
  const auto count = static_cast<double>(motion.poses.size());
  double best_us = std::numeric_limits<double>::infinity();
  for (std::size_t round = 0; round < rounds; ++round) {
    result.verdicts.clear();
    const double start_us = processor_us();
    for (const Pose& pose : motion.poses) result.verdicts.push_back(plain.check(pose));
    best_us = std::min(best_us, processor_us() - start_us);
  }
  result.mean_us = best_us / count;
  result.narrow = static_cast<double>(plain.narrow().pairs) / (count * static_cast<double>(rounds));
  return result;
}

Table worth(const Plan& plan) {
  Table table{
      "What each layer is worth",
      "dowel's check put together from its layers, nothing remembered, with one of them left out, "
      "and "
      "with what the narrow phase remembers of pairs: mean microseconds of a check / pairs that "
      "come to the narrow phase, scene (a). None of this may change a verdict; last column: "
      "verdicts that did change.",
      {"motion"},
      {}};
  for (const Layers& layers : kWays) table.columns.emplace_back(layers.name);
  table.columns.emplace_back("changed");
  const Scenario scene = paper_scenarios().front();
  for (const MotionKind kind : plan.kinds) {
    const Motion motion = motion_of(scene, kind, plan.poses);
    std::vector<std::string> row{std::string(to_string(kind))};
    std::vector<Verdict> expected;
    std::size_t changed = 0;
    for (const Layers& layers : kWays) {
      const Cost found = cost(scene, motion, layers, plan.rounds);
      row.push_back(text(found.mean_us, found.narrow));
      if (expected.empty()) expected = found.verdicts;
      for (std::size_t i = 0; i < expected.size(); ++i) {
        if (found.verdicts[i] != expected[i]) ++changed;
      }
    }
    row.push_back(std::to_string(changed));
    table.rows.push_back(std::move(row));
  }
  return table;
}

Table narrow_phase(const Plan& plan) {
  Table table{"Pairs in the narrow phase",
              "Of 1,000 moves, means of all scenes, as it remembers pairs: pairs that come to it; "
              "of these, "
              "answered by what was remembered of the pair alone; decided by the elements' boxes, "
              "by facets, "
              "on the exact solids; clear, contact, interference.",
              {"motion", "pairs", "recalled", "boxes", "facets", "exact solids", "clear", "contact",
               "interference"},
              {}};
  const std::vector<Scenario> scenes = paper_scenarios();
  for (const MotionKind kind : plan.kinds) {
    std::array<std::size_t, 8> sums{};
    std::size_t poses = 0;
    for (const Scenario& scene : scenes) {
      const Motion motion = motion_of(scene, kind, plan.poses);
      PlainCheck plain(scene, kWays.back());
      for (const Pose& pose : motion.poses) (void)plain.check(pose);
      poses += motion.poses.size();
      const Narrow& n = plain.narrow();
      const std::array counts{n.pairs,      n.recalled,    n.decided[0],  n.decided[1],
                              n.decided[2], n.verdicts[0], n.verdicts[1], n.verdicts[2]};
      for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += counts[i];
    }
    std::vector<std::string> row{std::string(to_string(kind))};
    for (const std::size_t sum : sums) {
      row.push_back(text(1000.0 * static_cast<double>(sum) / static_cast<double>(poses)));
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

}  // namespace

std::vector<Table> layer_worth(const Plan& plan) {
  return {worth(plan), narrow_phase(plan)};
}

}  // namespace dowel::bench
