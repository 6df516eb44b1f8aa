#include <map>
#include <vector>

#include "checker.h"
#include "dowel/collision/model.h"
#include "dowel/collision/scene.h"

namespace dowel::bench {

namespace {

class DowelChecker : public Checker {
 public:
  explicit DowelChecker(const QueryOptions& options) : options_(options) {}

  void prepare(const ElementPtr& element) override { (void)shared(element)->model(); }

  void add(const Placed& placed) override { scene_.add(shared(placed.element), placed.X_WE); }

  void set_moving(const ElementPtr& element) override {
    moving_ = scene_.add(shared(element), Pose());
  }

  Answer check(const Pose& X_WM) override {
    Verdict worst = Verdict::Clear;
    for (const auto& found : scene_.check({&moving_, 1}, {&X_WM, 1}, options_)) {
      worst = std::max(worst, found.pair.verdict);
    }
    return {worst == Verdict::Interference, worst};
  }

  std::optional<Counters> take_counters() override {
    const Counters result{scene_.counters().box_tests, scene_.counters().triangle_tests};
    scene_.reset_counters();
    return result;
  }

 private:
  std::shared_ptr<const CollisionElement> shared(const ElementPtr& element) {
    auto& found = elements_[element.get()];
    if (found == nullptr) {
      const Aabb& box = element->box;
      found = std::make_shared<const CollisionElement>(
          Obb{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()},
          [element] { return element->solid; }, element->hole_faces);
    }
    return found;
  }

  QueryOptions options_;
  CollisionScene scene_;
  std::map<const Element*, std::shared_ptr<const CollisionElement>> elements_;
  BodyId moving_;
};

}  // namespace

std::unique_ptr<Checker> make_dowel() {
  return std::make_unique<DowelChecker>(QueryOptions{});
}

std::unique_ptr<Checker> make_dowel_first() {
  QueryOptions options;
  options.first_only = true;
  return std::make_unique<DowelChecker>(options);
}

std::unique_ptr<Checker> make_dowel_paper() {
  QueryOptions options;
  options.holes = HoleMode::Paper;
  return std::make_unique<DowelChecker>(options);
}

}  // namespace dowel::bench
