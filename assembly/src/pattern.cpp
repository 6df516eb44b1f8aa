#include "dowel/assembly/pattern.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "dowel/assembly/mate.h"
#include "dowel/assembly/thread.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// Cosines and sines this near to 0 and 1 are those, so that a quarter turn is one to the bit.
constexpr double kQuarterTurn = 1.0e-12;

bool is_parallel(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return a.cross(b).norm() <= kCoaxial_rad;
}

/// A point of a plane with the name of the hole that is there.
struct Node {
  std::string name;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
};

/// Holes that open in the plane of `at` in its sense, in a frame on `at` with z out of it.
std::vector<Node> nodes_around(const Element& part, const Feature& at, const Pose& X_BN) {
  std::vector<Node> nodes;
  for (const Feature& hole : part.features) {
    if (hole.kind != FeatureKind::Hole || hole.direction.dot(at.direction) < 0.0 ||
        !is_parallel(hole.direction, at.direction)) {
      continue;
    }
    const Eigen::Vector3d point = X_BN.inverse() * hole.origin;
    if (std::abs(point.z()) <= kCoaxial_mm) nodes.push_back({hole.name, point.head<2>()});
  }
  return nodes;
}

double snapped(double value) {
  for (const double exact : {-1.0, 0.0, 1.0}) {
    if (std::abs(value - exact) <= kQuarterTurn) return exact;
  }
  return value;
}

/// Turn of the plane that takes direction `from` to that of `to`, in [0, 2 pi).
double turn_between(const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  const double turn =
      std::atan2(from.x() * to.y() - from.y() * to.x(), from.x() * to.x() + from.y() * to.y());
  const double positive = turn < 0.0 ? turn + 2.0 * std::numbers::pi : turn;
  return positive >= 2.0 * std::numbers::pi - kParallel_rad ? 0.0 : positive;
}

/// Standing on the frame N of a node: bottom on its plane, `foot` on its origin, turned.
Pose standing_on_node(const Feature& bottom, const Eigen::Vector2d& foot, double turn_rad) {
  const double c = snapped(std::cos(turn_rad));
  const double s = snapped(std::sin(turn_rad));
  Eigen::Matrix3d turn;
  turn << c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0;
  const Pose X_NT = Pose::from_matrix(turn, Eigen::Vector3d::Zero());
  return X_NT * Pose::from_translation({-foot.x(), -foot.y(), -bottom.origin.z()});
}

/// The nodes on which the feet are, in their order; empty where one is on none.
std::vector<FeaturePair> pairs_on_nodes(const std::vector<Node>& feet, const Pose& X_NE,
                                        const std::vector<Node>& nodes) {
  std::vector<FeaturePair> pairs;
  for (const Node& foot : feet) {
    const Eigen::Vector2d at = (X_NE * Eigen::Vector3d(foot.at.x(), foot.at.y(), 0.0)).head<2>();
    const auto node = std::ranges::find_if(
        nodes, [&](const Node& other) { return (other.at - at).norm() <= kCoaxial_mm; });
    if (node == nodes.end()) return {};
    pairs.push_back({foot.name, node->name});
  }
  return pairs;
}

bool can_mate(const Feature& moving, const Feature& fixed) {
  using enum FeatureKind;
  return (moving.kind == Shaft && fixed.kind == Hole) ||
         (moving.kind == Hole && (fixed.kind == Hole || fixed.kind == Shaft));
}

bool is_inserted(const Feature& moving, const Pose& X_BE, const Feature& fixed) {
  if (!can_mate(moving, fixed)) return false;
  // Most pairs of a grid fall here, before anything is computed of them.
  const Eigen::Vector3d off = X_BE * moving.origin - fixed.origin;
  if ((off - off.dot(fixed.direction) * fixed.direction).norm() > 2.0 * kCoaxial_mm) return false;
  const PlacedFeature moving_B{&moving, X_BE};
  const PlacedFeature fixed_B{&fixed, Pose()};
  const MateResidual residual = mate_residual(moving_B, fixed_B, {}, {});
  if (residual.axis_mm > kCoaxial_mm || residual.angle_rad > kCoaxial_rad ||
      std::abs(residual.along_mm) > kCoaxial_mm) {
    return false;
  }
  if (moving.kind == fixed.kind) return true;
  const bool shaft_moves = moving.kind == FeatureKind::Shaft;
  const PlacedFeature& shaft = shaft_moves ? moving_B : fixed_B;
  const PlacedFeature& hole = shaft_moves ? fixed_B : moving_B;
  return fit_on_axis(*shaft.feature, shaft.X_WI, *hole.feature, hole.X_WI).obstacle == nullptr;
}

}  // namespace

const Feature* bottom_face(const Element& element) {
  const Feature* best = nullptr;
  for (const Feature& face : element.features) {
    if (face.kind != FeatureKind::Face || face.direction.z() > 0.0 ||
        face.direction.head<2>().norm() > kCoaxial_rad) {
      continue;
    }
    if (best == nullptr) {
      best = &face;
      continue;
    }
    const double below_mm = best->origin.z() - face.origin.z();
    if (below_mm > kCoincident_mm ||
        (below_mm > -kCoincident_mm && face.area_mm2 > best->area_mm2)) {
      best = &face;
    }
  }
  return best;
}

std::vector<const Feature*> feet_of(const Element& element) {
  const Feature* bottom = bottom_face(element);
  std::vector<const Feature*> feet;
  if (bottom == nullptr) return feet;
  for (const Feature& feature : element.features) {
    const bool is_hole = feature.kind == FeatureKind::Hole;
    if ((!is_hole && feature.kind != FeatureKind::Shaft) ||
        !is_parallel(feature.direction, bottom->direction)) {
      continue;
    }
    if (is_hole && likely_thread_of_hole(feature.diameter_mm) != nullptr) continue;
    const double start_mm = feature.origin.z() - bottom->origin.z();
    const double end_mm = start_mm + feature.depth_mm * feature.direction.z();
    const bool starts_there = std::abs(start_mm) <= kCoaxial_mm;
    const bool ends_there = std::abs(end_mm) <= kCoaxial_mm && feature.through;
    if (starts_there || (is_hole && ends_there)) feet.push_back(&feature);
  }
  return feet;
}

namespace {

/// The ways in which all of `feet` are on nodes, one of them on the origin of N.
std::vector<PatternWay> ways_with(const std::vector<Node>& feet, const std::vector<Node>& nodes,
                                  const Feature& bottom, const Pose& X_BN) {
  std::vector<PatternWay> ways;
  const auto add = [&](const Node& foot, double turn_rad) {
    const Pose X_NE = standing_on_node(bottom, foot.at, turn_rad);
    std::vector<FeaturePair> pairs = pairs_on_nodes(feet, X_NE, nodes);
    if (!pairs.empty()) ways.push_back({X_BN * X_NE, turn_rad, std::move(pairs)});
  };
  for (const Node& foot : feet) {
    if (feet.size() == 1) add(foot, 0.0);
    const Node* farthest = &foot;
    for (const Node& other : feet) {
      if ((other.at - foot.at).norm() > (farthest->at - foot.at).norm()) farthest = &other;
    }
    const Eigen::Vector2d arm = farthest->at - foot.at;
    for (const Node& node : nodes) {
      if (arm.norm() <= kCoaxial_mm || std::abs(node.at.norm() - arm.norm()) > kCoaxial_mm)
        continue;
      add(foot, turn_between(arm, node.at));
    }
  }
  return ways;
}

}  // namespace

std::vector<PatternWay> pattern_ways(const Element& element, const Element& part,
                                     const Feature& at) {
  const Feature* bottom = bottom_face(element);
  if (bottom == nullptr || at.kind != FeatureKind::Hole) return {};
  std::vector<Node> feet;
  std::vector<Node> plain_feet;
  for (const Feature* foot : feet_of(element)) {
    feet.push_back({foot->name, foot->origin.head<2>()});
    if (thread_of_core_hole(foot->diameter_mm) == nullptr) plain_feet.push_back(feet.back());
  }
  const Pose X_BN = upright_pose(at.origin, -at.direction, Pose());
  const std::vector<Node> nodes = nodes_around(part, at, X_BN);
  std::vector<PatternWay> ways = ways_with(feet, nodes, *bottom, X_BN);
  if (ways.empty()) ways = ways_with(plain_feet, nodes, *bottom, X_BN);
  const auto order_of = [&](const PatternWay& way) {
    const auto on_at = std::ranges::find(way.pairs, at.name, &FeaturePair::fixed);
    return std::pair(std::round(way.turn_rad / kParallel_rad), on_at - way.pairs.begin());
  };
  std::ranges::stable_sort(ways, {}, order_of);
  return ways;
}

std::vector<FeaturePair> matching_pairs(const Element& element, const Pose& X_BE,
                                        const Element& part) {
  std::vector<FeaturePair> pairs;
  for (const Feature& moving : element.features) {
    for (const Feature& fixed : part.features) {
      if (is_inserted(moving, X_BE, fixed)) pairs.push_back({moving.name, fixed.name});
    }
  }
  return pairs;
}

std::vector<FeaturePair> holding_pairs(const std::vector<FeaturePair>& pairs,
                                       const Element& element, const std::string& first_fixed) {
  if (pairs.empty()) return {};
  const auto wanted = std::ranges::find(pairs, first_fixed, &FeaturePair::fixed);
  const FeaturePair& first = wanted != pairs.end() ? *wanted : pairs.front();
  const Feature& first_feature = *element.find_feature(first.moving);
  const FeaturePair* farthest = nullptr;
  double most_mm = kCoaxial_mm;
  for (const FeaturePair& pair : pairs) {
    const Eigen::Vector3d off = element.find_feature(pair.moving)->origin - first_feature.origin;
    const double apart_mm = off.cross(first_feature.direction).norm();
    if (apart_mm <= most_mm) continue;
    most_mm = apart_mm;
    farthest = &pair;
  }
  std::vector<FeaturePair> holding{first};
  if (farthest != nullptr) holding.push_back(*farthest);
  return holding;
}

}  // namespace dowel
