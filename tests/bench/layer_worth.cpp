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
#include "narrow_phase.h"

namespace dowel::bench {

namespace {

/// The layers that a check goes through.
struct Layers {
  const char* name = "";
  bool has_cells = true;  ///< layers, cells, intervals; else every element is a candidate
  bool has_silhouettes = true;
  bool has_planes = true;  ///< of the three types, between boxes
};

constexpr std::array<Layers, 5> kWays{{{"all layers"},
                                       {"no layers and cells", false},
                                       {"no silhouettes", true, false},
                                       {"no planes", true, true, false},
                                       {"narrow phase alone", false, false, false}}};

/// dowel's check put together from its layers, with nothing remembered from one to the next.
class PlainCheck {
 public:
  PlainCheck(const Scenario& scene, const Layers& layers) : layers_(layers) {
    for (const Placed& placed : scene.elements) {
      const Element& element = *placed.element;
      cells_.insert(static_cast<std::uint32_t>(bodies_.size()), placed.box_W);
      bodies_.push_back({box(element), transformed(placed.X_WE, box(element)),
                         placed.X_WE.inverse(), &model(placed.element)});
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
      const Body& other = bodies_[i];
      if (layers_.has_silhouettes &&
          are_apart(outline, silhouette(other.box_W), options_.tolerance_mm)) {
        continue;
      }
      if (layers_.has_planes && separate(moving_W, other.box_W, options_.tolerance_mm).plane >= 0) {
        continue;
      }
      const ModelPair pair{*moving_, *other.model, moving_box_, other.box_B, other.X_BW * X_WM, {}};
      PairMemory nothing;
      ++narrow_;
      worst = std::max(worst, judge(pair, options_, nothing, scratch_, counters_).verdict);
    }
    return worst;
  }

  /// Pairs that the narrow phase has judged.
  std::size_t narrow() const { return narrow_; }

 private:
  struct Body {
    Obb box_B;
    Obb box_W;
    Pose X_BW;
    const CollisionModel* model;
  };

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
  std::size_t narrow_ = 0;
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
  result.narrow = static_cast<double>(plain.narrow()) / (count * static_cast<double>(rounds));
  return result;
}

}  // namespace

Table layer_worth(const Plan& plan) {
  Table table{
      "What each layer is worth",
      "dowel's check put together from its layers, nothing remembered, with one of them left out: "
      "mean microseconds of a check / pairs that come to the narrow phase, scene (a). Left out "
      "layers change no verdict; last column: verdicts that did change.",
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

}  // namespace dowel::bench
