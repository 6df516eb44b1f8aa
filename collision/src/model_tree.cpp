// The tree over an element's triangles.

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "dowel/collision/model.h"

namespace dowel {
namespace {

double half_area(const Aabb& box) {
  const Eigen::Vector3d size = box.size();
  return size.x() * size.y() + size.y() * size.z() + size.z() * size.x();
}

/// Sorts `order` along an axis and returns how many of it go to the left, for boxes that a query is
/// least likely to meet: each counts by its area and what is in it. No side gets less than a
/// quarter, so that the depth of the tree is bounded.
/// Source: MacDonald, Booth, "Heuristics for Ray Tracing Using Space Subdivision", 1990.
std::uint32_t best_split(std::span<std::uint32_t> order, const std::vector<Aabb>& boxes,
                         const std::vector<Eigen::Vector3d>& centers) {
  double least_cost = std::numeric_limits<double>::infinity();
  std::uint32_t best = 1;
  Eigen::Index best_axis = 0;
  const auto sort_along = [&](Eigen::Index axis) {
    std::ranges::sort(order, {}, [&](std::uint32_t t) { return std::pair(centers[t][axis], t); });
  };
  std::vector<double> right_cost(order.size());
  const std::size_t least = std::max<std::size_t>(1, order.size() / 4);
  for (Eigen::Index axis = 0; axis < 3; ++axis) {
    sort_along(axis);
    Aabb box;
    for (std::size_t i = order.size(); i-- > 1;) {
      box.extend(boxes[order[i]]);
      right_cost[i] = half_area(box) * static_cast<double>(order.size() - i);
    }
    box = Aabb();
    for (std::size_t i = 1; i <= order.size() - least; ++i) {
      box.extend(boxes[order[i - 1]]);
      if (i < least) continue;
      const double cost = half_area(box) * static_cast<double>(i) + right_cost[i];
      if (cost < least_cost) {
        least_cost = cost;
        best = static_cast<std::uint32_t>(i);
        best_axis = axis;
      }
    }
  }
  sort_along(best_axis);
  return best;
}

}  // namespace

void CollisionModel::build_tree(const std::vector<Eigen::Vector3d>& reaches) {
  struct Work {
    std::uint32_t node;
    std::uint32_t begin;
    std::uint32_t end;
  };
  const auto count = static_cast<std::uint32_t>(triangles_.size());
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  std::vector<Aabb> boxes(count);
  std::vector<Eigen::Vector3d> centers(count);
  for (std::uint32_t t = 0; t < count; ++t) {
    for (const Eigen::Vector3d& corner : triangles_[t].corners) boxes[t].extend(corner);
    centers[t] = boxes[t].center();
    boxes[t].min -= reaches[t];
    boxes[t].max += reaches[t];
  }
  nodes_.clear();
  nodes_.reserve(2 * count / kTrianglesPerLeaf + 1);
  nodes_.emplace_back();
  std::vector<Work> stack{{0, 0, count}};
  while (!stack.empty()) {
    const Work work = stack.back();
    stack.pop_back();
    Aabb box;
    for (std::uint32_t i = work.begin; i < work.end; ++i) box.extend(boxes[order[i]]);
    nodes_[work.node].min = box.min;
    nodes_[work.node].max = box.max;
    set_cone(nodes_[work.node], std::span(order).subspan(work.begin, work.end - work.begin));
    if (work.end - work.begin <= kTrianglesPerLeaf) {
      nodes_[work.node].first = work.begin;
      nodes_[work.node].count = work.end - work.begin;
      continue;
    }
    const std::uint32_t middle =
        work.begin +
        best_split(std::span(order).subspan(work.begin, work.end - work.begin), boxes, centers);
    const auto left = static_cast<std::uint32_t>(nodes_.size());
    nodes_[work.node].first = left;
    nodes_.emplace_back();
    nodes_.emplace_back();
    stack.push_back({left, work.begin, middle});
    stack.push_back({left + 1, middle, work.end});
  }
  std::vector<ModelTriangle> sorted_triangles;
  std::vector<std::uint32_t> sorted_components;
  sorted_triangles.reserve(count);
  sorted_components.reserve(count);
  for (const std::uint32_t t : order) {
    sorted_triangles.push_back(triangles_[t]);
    sorted_components.push_back(component_of_[t]);
  }
  std::vector<std::uint32_t> place(count);
  for (std::uint32_t i = 0; i < count; ++i) place[order[i]] = i;
  for (ModelTriangle& t : sorted_triangles) {
    for (std::uint32_t& beyond : t.beyond) beyond = place[beyond];
  }
  triangles_ = std::move(sorted_triangles);
  component_of_ = std::move(sorted_components);
  set_node_boxes();
}

void CollisionModel::set_node_boxes() {
  const Eigen::Vector3d root = 0.5 * (nodes_[0].min + nodes_[0].max);
  node_boxes_.clear();
  node_boxes_.reserve(nodes_.size());
  for (const BvhNode& node : nodes_) {
    NodeBox box;
    for (std::size_t lane = 0; lane < 3; ++lane) {
      const auto i = static_cast<Eigen::Index>(lane);
      const float center = static_cast<float>(0.5 * (node.min[i] + node.max[i]) - root[i]);
      const double middle = root[i] + static_cast<double>(center);
      const double half = std::max(node.max[i] - middle, middle - node.min[i]);
      box.center[lane] = center;
      box.half[lane] =
          std::nextafter(static_cast<float>(half), std::numeric_limits<float>::infinity());
    }
    node_boxes_.push_back(box);
  }
}

void CollisionModel::set_cone(BvhNode& node, std::span<const std::uint32_t> triangles) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (const std::uint32_t t : triangles) sum += triangles_[t].normal;
  if (!(sum.norm() > 0.0)) return;
  const Eigen::Vector3d axis = sum.normalized();
  double cosine = 1.0;
  for (const std::uint32_t t : triangles) cosine = std::min(cosine, axis.dot(triangles_[t].normal));
  if (!(cosine > 0.0)) return;
  node.normal = axis.cast<float>();
  node.cosine = static_cast<float>(cosine);
  node.sine = static_cast<float>(std::sqrt(std::max(0.0, 1.0 - cosine * cosine)));
}

}  // namespace dowel
