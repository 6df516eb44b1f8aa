#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "dowel/collision/model.h"
#include "dowel/collision/scene.h"
#include "narrow_phase.h"
#include "node_separation.h"
#include "triangle_pair.h"

// Which facets of two models come near each other: tree against tree, then leaf against leaf.
// Private to collision.

namespace dowel {

/// Calls `visit(leaf of A, leaf of B)` for all pairs of leaves of wanted nodes whose boxes are
/// `wanted(gap_mm)`; stops where it returns false. The nearer pair of children comes first.
template <class WantedNodes, class Wanted, class Visit>
void for_each_leaf_pair(const ModelPair& pair, NarrowScratch& scratch, QueryCounters& counters,
                        const WantedNodes& wanted_nodes, const Wanted& wanted, const Visit& visit) {
  const NodeSeparation separation(pair.a, pair.b, pair.X_BA);
  const auto nodes_a = pair.a.nodes();
  const auto nodes_b = pair.b.nodes();
  const auto boxes_a = pair.a.node_boxes();
  const auto boxes_b = pair.b.node_boxes();
  scratch.stack.clear();
  scratch.stack.push_back({0, 0, separation.gap_mm(boxes_a[0], boxes_b[0])});
  ++counters.box_tests;
  while (!scratch.stack.empty()) {
    const auto [a, b, gap_mm] = scratch.stack.back();
    scratch.stack.pop_back();
    if (!wanted(gap_mm)) continue;
    const BvhNode& node_a = nodes_a[a];
    const BvhNode& node_b = nodes_b[b];
    if (!wanted_nodes(node_a, node_b)) continue;
    if (node_a.is_leaf() && node_b.is_leaf()) {
      if (!visit(node_a, node_b)) return;
      continue;
    }
    const bool split_a = node_b.is_leaf() ||
                         (!node_a.is_leaf() && size_squared(boxes_a[a]) > size_squared(boxes_b[b]));
    NarrowScratch::NodePair near{split_a ? node_a.first : a, split_a ? b : node_b.first, 0.0};
    NarrowScratch::NodePair far{split_a ? node_a.first + 1 : a, split_a ? b : node_b.first + 1,
                                0.0};
    near.gap_mm = separation.gap_mm(boxes_a[near.a], boxes_b[near.b]);
    far.gap_mm = separation.gap_mm(boxes_a[far.a], boxes_b[far.b]);
    counters.box_tests += 2;
    if (far.gap_mm < near.gap_mm) std::swap(near, far);
    scratch.stack.push_back(far);
    scratch.stack.push_back(near);
  }
}

/// A facet of A as B sees it.
struct PlacedTriangle {
  Corners corners_B;
  Eigen::Vector3d normal_B;
};

/// A pose as matrix and vector, for many points.
struct Placement {
  explicit Placement(const Pose& X_BA)
      : rotation(X_BA.rotation_matrix()), translation(X_BA.translation()) {}
  Eigen::Vector3d operator*(const Eigen::Vector3d& p) const { return rotation * p + translation; }
  PlacedTriangle operator*(const ModelTriangle& t) const {
    return {{rotation * t.corners[0] + translation, rotation * t.corners[1] + translation,
             rotation * t.corners[2] + translation},
            rotation * t.normal};
  }
  Eigen::Matrix3d rotation;
  Eigen::Vector3d translation;
};

/// Distance of the boxes around two facets.
inline double box_gap(const Corners& a, const Corners& b) {
  const Eigen::Vector3d a_min = a[0].cwiseMin(a[1]).cwiseMin(a[2]);
  const Eigen::Vector3d a_max = a[0].cwiseMax(a[1]).cwiseMax(a[2]);
  const Eigen::Vector3d b_min = b[0].cwiseMin(b[1]).cwiseMin(b[2]);
  const Eigen::Vector3d b_max = b[0].cwiseMax(b[1]).cwiseMax(b[2]);
  return (a_min - b_max).cwiseMax(b_min - a_max).maxCoeff();
}

/// Distance of the box around a facet from that of a node.
inline double box_gap(const Corners& a, const BvhNode& node) {
  const Eigen::Vector3d a_min = a[0].cwiseMin(a[1]).cwiseMin(a[2]);
  const Eigen::Vector3d a_max = a[0].cwiseMax(a[1]).cwiseMax(a[2]);
  return (a_min - node.max).cwiseMax(node.min - a_max).maxCoeff();
}

/// Lower bound of the distance of the corners from the plane; 0 where they lie on both sides.
inline double distance_from_plane(const Corners& corners, const Eigen::Vector3d& normal,
                                  const Eigen::Vector3d& origin) {
  const double d0 = normal.dot(corners[0] - origin);
  const double d1 = normal.dot(corners[1] - origin);
  const double d2 = normal.dot(corners[2] - origin);
  return std::max({std::min({d0, d1, d2}), -std::max({d0, d1, d2}), 0.0});
}

/// How far two facets are apart for certain, by the plane of either: each may stand off its face
/// along its normal, and the other along both. Negative: not apart.
inline double apart_by_planes(const ModelTriangle& a, const PlacedTriangle& a_B,
                              const ModelTriangle& b) {
  const double sine = a_B.normal_B.cross(b.normal).norm();
  const double of_a = a.normal_slack_mm + a.slack_mm * sine;
  const double of_b = b.normal_slack_mm + b.slack_mm * sine;
  const double by_b = distance_from_plane(a_B.corners_B, b.normal, b.corners[0]);
  const double by_a = distance_from_plane(b.corners, a_B.normal_B, a_B.corners_B[0]);
  return std::max(by_b - of_a - b.normal_slack_mm, by_a - of_b - a.normal_slack_mm);
}

/// How far `other` lies beyond one of the edges of a facet, along its plane; negative: beyond none.
inline double beyond_edges(const Corners& corners, const Eigen::Vector3d& normal,
                           const Corners& other) {
  double most = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d edge = corners[(i + 1) % 3] - corners[i];
    const Eigen::Vector3d outward = edge.cross(normal);
    const double least =
        std::min({outward.dot(other[0] - corners[i]), outward.dot(other[1] - corners[i]),
                  outward.dot(other[2] - corners[i])});
    if (least > 0.0) most = std::max(most, least / std::sqrt(edge.squaredNorm()));
  }
  return most;
}

/// How far a box is from a plane; negative: it may meet it. `half_N`: half its edges, in its own
/// frame N; `normal_N`: the plane's normal there.
inline double box_from_plane(const Eigen::Vector3d& center, const Eigen::Vector3d& half_N,
                             const Eigen::Vector3d& normal, const Eigen::Vector3d& normal_N,
                             const Eigen::Vector3d& origin) {
  return std::abs(normal.dot(center - origin)) - normal_N.cwiseAbs().dot(half_N);
}

/// Calls `visit(i, facet i of A in B, j)` for the facets of two leaves, but for those that their
/// plane, or the box around them, keeps more than `margin_mm` from the whole other leaf; stops and
/// returns false where `visit` does. Lowers `apart` to a bound of the distance of those left out.
template <class Wanted, class Visit>
bool for_each_near_pair(const ModelPair& pair, const Placement& X_BA, const BvhNode& leaf_a,
                        const BvhNode& leaf_b, double margin_mm, double& apart,
                        const Wanted& wanted, const Visit& visit) {
  const Eigen::Vector3d half_a = 0.5 * (leaf_a.max - leaf_a.min);
  const Eigen::Vector3d half_b = 0.5 * (leaf_b.max - leaf_b.min);
  const Eigen::Vector3d center_a_B = X_BA * Eigen::Vector3d(0.5 * (leaf_a.max + leaf_a.min));
  const Eigen::Vector3d center_b = 0.5 * (leaf_b.max + leaf_b.min);
  const auto is_out = [&](double gap) {
    if (gap <= margin_mm) return false;
    apart = std::min(apart, gap);
    return true;
  };
  std::array<std::uint32_t, CollisionModel::kTrianglesPerLeaf> near_b{};
  std::size_t count = 0;
  for (std::uint32_t j = leaf_b.first; j < leaf_b.first + leaf_b.count; ++j) {
    const ModelTriangle& b = pair.b.triangles()[j];
    if (!wanted(b) || is_out(box_from_plane(center_a_B, half_a, b.normal,
                                            X_BA.rotation.transpose() * b.normal, b.corners[0]) -
                             b.normal_slack_mm)) {
      continue;
    }
    near_b[count++] = j;
  }
  if (count == 0) return true;
  for (std::uint32_t i = leaf_a.first; i < leaf_a.first + leaf_a.count; ++i) {
    const ModelTriangle& a = pair.a.triangles()[i];
    if (!wanted(a)) continue;
    const PlacedTriangle a_B = X_BA * a;
    if (is_out(box_from_plane(center_b, half_b, a_B.normal_B, a_B.normal_B, a_B.corners_B[0]) -
               a.normal_slack_mm) ||
        is_out(box_gap(a_B.corners_B, leaf_b) - a.slack_mm)) {
      continue;
    }
    for (std::size_t n = 0; n < count; ++n) {
      if (!visit(i, a_B, near_b[n])) return false;
    }
  }
  return true;
}

}  // namespace dowel
