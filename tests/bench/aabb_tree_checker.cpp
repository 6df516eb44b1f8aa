#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "dowel/collision/layered_projection.h"
#include "methods.h"

namespace dowel::bench {

namespace {

constexpr double kRounding_mm = 1.0e-9;  // of placed boxes and triangles, generously

using Corners = std::array<Eigen::Vector3d, 3>;

/// A box along the axes of the element's frame. The first child follows its parent in the array.
struct Node {
  Eigen::Vector3d center;
  Eigen::Vector3d half_extents_mm;
  std::uint32_t second_child = 0;  ///< 0: a leaf
  std::uint32_t triangle = 0;      ///< of a leaf
};

/// Binary, one triangle a leaf. A node's triangles go to either side of the middle of its box's
/// longest edge, by the centres of their boxes; half of them where all lie on one side.
class Tree {
 public:
  explicit Tree(std::shared_ptr<const FacetedSolid> solid) : solid_(std::move(solid)) {
    const auto count = static_cast<std::uint32_t>(solid_->triangles.size());
    boxes_.reserve(count);
    for (std::uint32_t t = 0; t < count; ++t) boxes_.push_back(bounds(solid_->corners(t)));
    std::vector<std::uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0U);
    nodes_.reserve(2 * static_cast<std::size_t>(count) - 1);
    build(order);
    boxes_ = {};
  }

  const Node& node(std::uint32_t index) const { return nodes_[index]; }
  Corners corners(const Node& leaf) const { return solid_->corners(leaf.triangle); }

 private:
  void build(std::span<std::uint32_t> triangles) {
    Aabb box;
    for (const std::uint32_t t : triangles) box.extend(boxes_[t]);
    const std::size_t place = nodes_.size();
    nodes_.push_back({box.center(), 0.5 * box.padded(kRounding_mm).size(), 0, triangles.front()});
    if (triangles.size() == 1) return;
    Eigen::Index axis = 0;
    box.size().maxCoeff(&axis);
    const auto middle = std::partition(triangles.begin(), triangles.end(), [&](std::uint32_t t) {
      return boxes_[t].center()[axis] < box.center()[axis];
    });
    auto left_count = static_cast<std::size_t>(middle - triangles.begin());
    if (left_count == 0 || left_count == triangles.size()) left_count = triangles.size() / 2;
    build(triangles.first(left_count));
    nodes_[place].second_child = static_cast<std::uint32_t>(nodes_.size());
    build(triangles.subspan(left_count));
  }

  std::shared_ptr<const FacetedSolid> solid_;
  std::vector<Aabb> boxes_;  // of triangles, while the tree is built
  std::vector<Node> nodes_;
};

bool is_separating(const Eigen::Vector3d& axis, const Corners& a, const Corners& b) {
  const auto [a_low, a_high] = std::minmax({axis.dot(a[0]), axis.dot(a[1]), axis.dot(a[2])});
  const auto [b_low, b_high] = std::minmax({axis.dot(b[0]), axis.dot(b[1]), axis.dot(b[2])});
  return a_high < b_low || b_high < a_low;
}

std::array<Eigen::Vector3d, 3> edges(const Corners& corners) {
  return {corners[1] - corners[0], corners[2] - corners[1], corners[0] - corners[2]};
}

/// A touch counts. Off by the rounding of the coordinates: whatever an axis has become by rounding,
/// it separates what is apart along it. The two normals, an edge of each, and, for triangles of one
/// plane, the normals of edges in it.
bool triangles_meet(const Corners& a, const Corners& b) {
  const std::array edges_a = edges(a);
  const std::array edges_b = edges(b);
  const Eigen::Vector3d normal_a = edges_a[0].cross(edges_a[1]);
  if (is_separating(normal_a, a, b)) return false;
  const Eigen::Vector3d normal_b = edges_b[0].cross(edges_b[1]);
  if (is_separating(normal_b, a, b)) return false;
  for (const Eigen::Vector3d& edge_a : edges_a) {
    for (const Eigen::Vector3d& edge_b : edges_b) {
      if (is_separating(edge_a.cross(edge_b), a, b)) return false;
    }
  }
  for (std::size_t i = 0; i < 3; ++i) {
    if (is_separating(normal_a.cross(edges_a[i]), a, b)) return false;
    if (is_separating(normal_b.cross(edges_b[i]), a, b)) return false;
  }
  return true;
}

/// The walk of one tree against another, in the frame of the first.
class Walk {
 public:
  Walk(const Tree& a, const Tree& b, const Pose& X_AB, Checker::Counters& counters)
      : a_(a),
        b_(b),
        turn_(X_AB.rotation_matrix()),
        shares_(turn_.cwiseAbs()),
        shift_(X_AB.translation()),
        counters_(counters) {}

  /// Whether any triangles below two nodes meet; ends at the first that do. The longer box is left
  /// for its children.
  bool meet(std::uint32_t in_a, std::uint32_t in_b) {
    const Node& a = a_.node(in_a);
    const Node& b = b_.node(in_b);
    ++counters_.box_tests;
    if (are_apart(a, b)) return false;
    if (a.second_child == 0 && b.second_child == 0) {
      ++counters_.triangle_tests;
      return triangles_meet(a_.corners(a), in_frame_a(b_.corners(b)));
    }
    const bool is_b_longer = a.half_extents_mm.maxCoeff() < b.half_extents_mm.maxCoeff();
    if (a.second_child == 0 || (b.second_child != 0 && is_b_longer)) {
      return meet(in_a, in_b + 1) || meet(in_a, b.second_child);
    }
    return meet(in_a + 1, in_b) || meet(a.second_child, in_b);
  }

 private:
  /// By the six planes of faces.
  bool are_apart(const Node& a, const Node& b) const {
    const Eigen::Vector3d between_A = turn_ * b.center + shift_ - a.center;
    const Eigen::Vector3d reach_A = a.half_extents_mm + shares_ * b.half_extents_mm;
    if ((between_A.array().abs() > reach_A.array()).any()) return true;
    const Eigen::Vector3d between_B = turn_.transpose() * between_A;
    const Eigen::Vector3d reach_B = b.half_extents_mm + shares_.transpose() * a.half_extents_mm;
    return (between_B.array().abs() > reach_B.array()).any();
  }

  Corners in_frame_a(const Corners& corners) const {
    return {turn_ * corners[0] + shift_, turn_ * corners[1] + shift_, turn_ * corners[2] + shift_};
  }

  const Tree& a_;
  const Tree& b_;
  Eigen::Matrix3d turn_;
  Eigen::Matrix3d shares_;  // absolute values: of a box's half extents along the other's axes
  Eigen::Vector3d shift_;
  Checker::Counters& counters_;
};

/// SOLID's method for triangles: a tree of axis-aligned boxes for each distinct element, made once
/// in its own frame and turned with it, tree against tree up to the first triangles that meet. Box
/// against box by the six axes normal to faces alone ("SAT lite"): the nine normal to an edge of
/// each part too few pairs for what they cost. Over the elements, the layered projection that
/// dowel has. Nothing is remembered between moves.
/// Source: van den Bergen, "Efficient Collision Detection of Complex Deformable Models using AABB
/// Trees", 1997. Departs: triangles by separating axes, in double precision.
class AabbTreeChecker : public Checker {
 public:
  void prepare(const ElementPtr& element) override { (void)shared(element); }

  void add(const Placed& placed) override {
    model_.insert(static_cast<std::uint32_t>(bodies_.size()), placed.box_W);
    bodies_.push_back({&shared(placed.element), placed.X_WE});
  }

  void remove_last() override {
    bodies_.pop_back();
    model_.remove(static_cast<std::uint32_t>(bodies_.size()));
  }

  void set_moving(const ElementPtr& element) override {
    moving_ = &shared(element);
    const Aabb& box = element->box;
    moving_box_ = {box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()};
  }

  Answer check(const Pose& X_WM) override {
    model_.query(bounds(transformed(X_WM, moving_box_)).padded(kRounding_mm), found_);
    for (const std::uint32_t other : found_) {
      ++counters_.box_tests;
      const Body& body = bodies_[other];
      Walk walk(*body.tree, *moving_, body.X_WB.inverse() * X_WM, counters_);
      if (walk.meet(0, 0)) return {true, {}};
    }
    return {};
  }

  /// N_b: pairs of elements that the layers leave, and of nodes.
  std::optional<Counters> take_counters() override { return std::exchange(counters_, {}); }

 private:
  struct Body {
    const Tree* tree;
    Pose X_WB;
  };

  const Tree& shared(const ElementPtr& element) {
    return trees_.try_emplace(element.get(), element->solid).first->second;
  }

  std::map<const Element*, Tree> trees_;
  std::vector<Body> bodies_;
  LayeredProjection model_;
  std::vector<std::uint32_t> found_;
  const Tree* moving_ = nullptr;
  Obb moving_box_;
  Counters counters_;
};

}  // namespace

std::unique_ptr<Checker> make_aabb_tree() {
  return std::make_unique<AabbTreeChecker>();
}

}  // namespace dowel::bench
