#include <algorithm>
#include <map>
#include <utility>
#include <vector>

#include "dowel/collision/box_separation.h"
#include "dowel/collision/layered_projection.h"
#include "methods.h"
#include "triangle_pair.h"

namespace dowel::bench {

namespace {

/// The method of Peng et al. 2009 as published: layers, cells and intervals, boxes by separation
/// planes, then all pairs of polygons of the two elements but those of holes (section 6: "m x n
/// times polygon intersection checking"), up to the first that cross. No tree, no memory of the
/// last move, no tolerance. The last separating plane is not kept either.
class PublishedChecker : public Checker {
  struct Facet {
    Corners corners;
    Eigen::Vector3d normal;
  };
  using Facets = std::vector<Facet>;

 public:
  void prepare(const ElementPtr& element) override { (void)facets(element); }

  void add(const Placed& placed) override {
    model_.insert(static_cast<std::uint32_t>(placed_.size()), placed.box_W);
    placed_.push_back(
        {&facets(placed.element), transformed(placed.X_WE, box(*placed.element)), placed.X_WE});
  }

  void remove_last() override {
    placed_.pop_back();
    model_.remove(static_cast<std::uint32_t>(placed_.size()));
  }

  void set_moving(const ElementPtr& element) override {
    moving_ = &facets(element);
    moving_box_ = box(*element);
  }

  Answer check(const Pose& X_WM) override {
    const Obb box_W = transformed(X_WM, moving_box_);
    model_.query(bounds(box_W), found_);
    for (const std::uint32_t other : found_) {
      ++counters_.box_tests;
      if (separate(box_W, placed_[other].box_W, 0.0).plane >= 0) continue;
      if (cross(placed_[other], X_WM)) return {true, {}};
    }
    return {};
  }

  std::optional<Counters> take_counters() override { return std::exchange(counters_, {}); }

 private:
  struct Body {
    const Facets* facets;
    Obb box_W;
    Pose X_WB;
  };

  static Obb box(const Element& element) {
    return {element.box.center(), Eigen::Matrix3d::Identity(), 0.5 * element.box.size()};
  }

  bool cross(const Body& body, const Pose& X_WM) {
    const Pose X_BM = body.X_WB.inverse() * X_WM;
    const Eigen::Matrix3d turn = X_BM.rotation_matrix();
    for (const Facet& facet : *moving_) {
      Corners corners;
      std::ranges::transform(facet.corners, corners.begin(), [&](const Eigen::Vector3d& p) {
        return Eigen::Vector3d(turn * p + X_BM.translation());
      });
      const Eigen::Vector3d normal = turn * facet.normal;
      for (const Facet& other : *body.facets) {
        ++counters_.triangle_tests;
        if (crossing_segment(corners, normal, other.corners, other.normal)) return true;
      }
    }
    return false;
  }

  /// Those that are no wall of a hole.
  const Facets& facets(const ElementPtr& element) {
    const auto [entry, is_new] = facets_.try_emplace(element.get());
    if (!is_new) return entry->second;
    const FacetedSolid& solid = *element->solid;
    for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
      if (std::ranges::count(element->hole_faces, solid.face_of[t]) > 0) continue;
      const Corners corners = solid.corners(t);
      const Eigen::Vector3d normal =
          (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
      entry->second.push_back({corners, normal});
    }
    return entry->second;
  }

  std::map<const Element*, Facets> facets_;
  std::vector<Body> placed_;
  LayeredProjection model_;
  std::vector<std::uint32_t> found_;
  const Facets* moving_ = nullptr;
  Obb moving_box_;
  Counters counters_;
};

}  // namespace

std::unique_ptr<Checker> make_published() {
  return std::make_unique<PublishedChecker>();
}

}  // namespace dowel::bench
