#include <algorithm>
#include <map>
#include <vector>

#include "dowel/collision/model.h"
#include "dowel/collision/scene.h"
#include "methods.h"

namespace dowel::bench {

namespace {

class DowelChecker : public Checker {
 public:
  explicit DowelChecker(const DowelMode& mode)
      : options_{.tolerance_mm = mode.tolerance_mm,
                 .holes = mode.holes,
                 .first_only = mode.first_only,
                 .without = mode.without},
        mode_(mode) {}

  void prepare(const ElementPtr& element) override { (void)shared(element)->model(); }

  void add(const Placed& placed) override {
    bodies_.push_back(scene_.add(shared(placed.element), placed.X_WE));
  }

  void remove_last() override {
    scene_.remove(bodies_.back());
    bodies_.pop_back();
  }

  void set_moving(const ElementPtr& element) override {
    moving_ = scene_.add(shared(element), Pose());
  }

  Answer check(const Pose& X_WM) override {
    const Verdict verdict =
        mode_.uses_brute_force
            ? worst(scene_.check_brute_force({&moving_, 1}, {&X_WM, 1}, options_))
            : worst(scene_.check({&moving_, 1}, {&X_WM, 1}, options_));
    return {verdict == Verdict::Interference, verdict};
  }

  /// Of parts in contact or interference; of those that are clear only a bound is known.
  std::optional<double> measured_gap_mm(const Pose& X_WM) override {
    QueryOptions options = options_;
    options.measure_depth = true;
    std::optional<double> gap_mm;
    for (const auto& found : scene_.check({&moving_, 1}, {&X_WM, 1}, options)) {
      const double gap =
          found.pair.verdict == Verdict::Interference ? -found.pair.depth_mm : found.pair.gap_mm;
      gap_mm = std::min(gap_mm.value_or(gap), gap);
    }
    return gap_mm;
  }

  std::optional<Counters> take_counters() override {
    const QueryCounters& counters = scene_.counters();
    const Counters result{counters.box_tests, counters.triangle_tests, counters.uses};
    scene_.reset_counters();
    return result;
  }

 private:
  std::shared_ptr<const CollisionElement> shared(const ElementPtr& element) {
    auto& found = elements_[element.get()];
    if (found == nullptr) {
      const Aabb& box = element->box;
      std::shared_ptr<const FacetedSolid> solid = element->solid;
      if (mode_.knows_facets_alone) solid = by_facets_alone(*solid);
      found = std::make_shared<const CollisionElement>(
          Obb{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()},
          [solid] { return solid; }, element->hole_faces);
    }
    return found;
  }

  static std::shared_ptr<const FacetedSolid> by_facets_alone(FacetedSolid solid) {
    for (Face& face : solid.faces) {
      if (is_plane(face.surface)) continue;
      face.surface = OtherSurface{};
      face.reversed = false;
    }
    for (Edge& edge : solid.edges) {
      if (edge.curve == CurveKind::Circle) edge.curve = CurveKind::Other;
    }
    return std::make_shared<const FacetedSolid>(std::move(solid));
  }

  QueryOptions options_;
  DowelMode mode_;
  CollisionScene scene_;
  std::map<const Element*, std::shared_ptr<const CollisionElement>> elements_;
  std::vector<BodyId> bodies_;
  BodyId moving_;
};

}  // namespace

std::unique_ptr<Checker> make_dowel(const DowelMode& mode) {
  return std::make_unique<DowelChecker>(mode);
}

}  // namespace dowel::bench
