#include "narrow_phase.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "exact_face.h"
#include "triangle_pair.h"
#include "witness.h"

namespace dowel {
namespace {

/// Fractions of a crossing segment at which a witness is sought.
constexpr std::array<double, 3> kFractions{0.5, 0.02, 0.98};

/// How far a witness may lie from its start, in tolerances and in slacks.
constexpr double kReachTolerances = 64.0;
constexpr double kReachSlacks = 16.0;

/// Alternating projections between two exact faces before their gap is taken as it stands.
constexpr int kProjections = 16;

/// Boxes of a tree of A, in the frame of A, against boxes of B in the frame of B.
class NodeSeparation {
 public:
  explicit NodeSeparation(const Pose& X_BA)
      : R_(X_BA.rotation_matrix()), abs_R_(R_.cwiseAbs()), translation_(X_BA.translation()) {}

  /// Lower bound of the boxes' distance, from the planes of types 1 and 2; negative: they may meet.
  double gap_mm(const BvhNode& a, const BvhNode& b) const {
    const Eigen::Vector3d half_a = 0.5 * (a.max - a.min);
    const Eigen::Vector3d half_b = 0.5 * (b.max - b.min);
    const Eigen::Vector3d offset_B =
        R_ * (0.5 * (a.max + a.min)) + translation_ - 0.5 * (b.max + b.min);
    const double along_b = (offset_B.cwiseAbs() - half_b - abs_R_ * half_a).maxCoeff();
    const double along_a =
        ((R_.transpose() * offset_B).cwiseAbs() - half_a - abs_R_.transpose() * half_b).maxCoeff();
    return std::max(along_a, along_b);
  }

 private:
  Eigen::Matrix3d R_;
  Eigen::Matrix3d abs_R_;
  Eigen::Vector3d translation_;
};

double size_squared(const BvhNode& node) {
  return (node.max - node.min).squaredNorm();
}

/// Calls `visit(leaf of A, leaf of B)` for all pairs whose boxes `wanted(gap_mm)`; stops where it
/// returns false. The nearer pair of children comes first.
template <class Wanted, class Visit>
void for_each_leaf_pair(const ModelPair& pair, NarrowScratch& scratch, QueryCounters& counters,
                        const Wanted& wanted, const Visit& visit) {
  const NodeSeparation separation(pair.X_BA);
  const auto nodes_a = pair.a.nodes();
  const auto nodes_b = pair.b.nodes();
  scratch.stack.clear();
  scratch.stack.push_back({0, 0});
  while (!scratch.stack.empty()) {
    const auto [a, b] = scratch.stack.back();
    scratch.stack.pop_back();
    const BvhNode& node_a = nodes_a[a];
    const BvhNode& node_b = nodes_b[b];
    ++counters.box_tests;
    if (!wanted(separation.gap_mm(node_a, node_b))) continue;
    if (node_a.is_leaf() && node_b.is_leaf()) {
      if (!visit(node_a, node_b)) return;
      continue;
    }
    const bool split_a =
        node_b.is_leaf() || (!node_a.is_leaf() && size_squared(node_a) > size_squared(node_b));
    NarrowScratch::NodePair near{split_a ? node_a.first : a, split_a ? b : node_b.first};
    NarrowScratch::NodePair far{split_a ? node_a.first + 1 : a, split_a ? b : node_b.first + 1};
    if (separation.gap_mm(nodes_a[far.a], nodes_b[far.b]) <
        separation.gap_mm(nodes_a[near.a], nodes_b[near.b])) {
      std::swap(near, far);
    }
    scratch.stack.push_back(far);
    scratch.stack.push_back(near);
  }
}

/// A facet of A as B sees it.
struct PlacedTriangle {
  Corners corners_B;
  Eigen::Vector3d normal_B;
};

PlacedTriangle placed(const Pose& X_BA, const ModelTriangle& t) {
  return {{X_BA * t.corners[0], X_BA * t.corners[1], X_BA * t.corners[2]},
          X_BA.rotation() * t.normal};
}

/// True where all corners lie on one side of the plane, further than `margin_mm` from it.
bool beyond_plane(const Corners& corners, const Eigen::Vector3d& normal,
                  const Eigen::Vector3d& origin, double margin_mm) {
  const double d0 = normal.dot(corners[0] - origin);
  const double d1 = normal.dot(corners[1] - origin);
  const double d2 = normal.dot(corners[2] - origin);
  return std::min({d0, d1, d2}) > margin_mm || std::max({d0, d1, d2}) < -margin_mm;
}

Corners shifted(const Corners& corners, const Eigen::Vector3d& by) {
  return {corners[0] + by, corners[1] + by, corners[2] + by};
}

/// Collects the evidence on one pair.
class Judge {
 public:
  Judge(const ModelPair& pair, const QueryOptions& options, QueryCounters& counters)
      : pair_(pair),
        X_AB_(pair.X_BA.inverse()),
        options_(options),
        counters_(counters),
        erosion_mm_(0.5 * options.tolerance_mm) {
    result_.gap_mm = options.tolerance_mm;
  }

  /// False once interference is proven.
  bool look_at(const BvhNode& leaf_a, const BvhNode& leaf_b) {
    for (std::uint32_t i = leaf_a.first; i < leaf_a.first + leaf_a.count; ++i) {
      const ModelTriangle& a = pair_.a.triangles()[i];
      if (options_.holes == HoleMode::Paper && a.is_hole) continue;
      const PlacedTriangle a_B = placed(pair_.X_BA, a);
      for (std::uint32_t j = leaf_b.first; j < leaf_b.first + leaf_b.count; ++j) {
        if (options_.holes == HoleMode::Paper && pair_.b.triangles()[j].is_hole) continue;
        if (!look_at_triangles(i, a_B, j)) return false;
      }
    }
    return true;
  }

  /// Points stored deep in each solid, against the other.
  void look_for_containment() {
    for (const auto& inner : pair_.a.inner_points()) {
      if (try_inner_point(pair_.X_BA * inner.point, inner.depth_mm)) return;
    }
    for (const auto& inner : pair_.b.inner_points()) {
      if (try_inner_point(inner.point, inner.depth_mm)) return;
    }
  }

  PairVerdict result() {
    if (result_.verdict != Verdict::Contact) result_.gap_mm = 0.0;
    if (result_.verdict == Verdict::Clear) result_.gap_mm = options_.tolerance_mm;
    return result_;
  }

  bool proven() const { return result_.verdict == Verdict::Interference; }

 private:
  bool look_at_triangles(std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
    const ModelTriangle& a = pair_.a.triangles()[i];
    const ModelTriangle& b = pair_.b.triangles()[j];
    ++counters_.triangle_tests;
    const double slack = a.slack_mm + b.slack_mm;
    const double margin = options_.tolerance_mm + slack;
    if (beyond_plane(a_B.corners_B, b.normal, b.corners[0], margin) ||
        beyond_plane(b.corners, a_B.normal_B, a_B.corners_B[0], margin)) {
      return true;
    }
    note_method(a, b, slack);
    const double reach = kReachTolerances * options_.tolerance_mm + kReachSlacks * slack;
    const auto crossing =
        crossing_segment(shifted(a_B.corners_B, -erosion_mm_ * a_B.normal_B), a_B.normal_B,
                         shifted(b.corners, -erosion_mm_ * b.normal), b.normal);
    if (crossing) {
      for (const double fraction : kFractions) {
        const Eigen::Vector3d start =
            crossing->start + fraction * (crossing->end - crossing->start);
        if (try_start(start, i, j, reach)) return false;
      }
    }
    const bool needs_gap = result_.verdict == Verdict::Clear;
    if (!needs_gap && slack == 0.0) return true;
    const ClosestPair closest = closest_points(a_B.corners_B, a_B.normal_B, b.corners, b.normal);
    if (closest.distance_squared_mm2 > margin * margin) return true;
    if (slack > 0.0 && try_start(0.5 * (closest.on_a + closest.on_b), i, j, reach)) return false;
    if (needs_gap) look_for_contact(closest, slack);
    return true;
  }

  void note_method(const ModelTriangle& a, const ModelTriangle& b, double slack) {
    if (result_.method == Method::Boxes) result_.method = Method::Facets;
    if (slack > 0.0) result_.method = Method::Exact;
    const Face& face_a = pair_.a.face(a.face);
    const Face& face_b = pair_.b.face(b.face);
    const double unknown = (is_exact(face_a) ? 0.0 : face_a.facet_error_mm) +
                           (is_exact(face_b) ? 0.0 : face_b.facet_error_mm);
    result_.bound_mm = std::max(result_.bound_mm, unknown);
  }

  bool try_start(const Eigen::Vector3d& start_B, std::uint32_t i, std::uint32_t j, double reach) {
    const auto witness = find_witness(pair_, start_B, i, j, erosion_mm_, reach);
    if (witness) prove(*witness);
    return witness.has_value();
  }

  bool try_inner_point(const Eigen::Vector3d& point_B, double depth_mm) {
    if (depth_mm < erosion_mm_ || !in_box(pair_.b, point_B) || !in_box(pair_.a, X_AB_ * point_B)) {
      return false;
    }
    const auto witness = test_witness(pair_, point_B, erosion_mm_);
    if (witness) prove(*witness);
    return witness.has_value();
  }

  static bool in_box(const CollisionModel& model, const Eigen::Vector3d& point) {
    const BvhNode& root = model.nodes()[0];
    return (root.min.array() <= point.array()).all() && (point.array() <= root.max.array()).all();
  }

  void prove(const Witness& witness) {
    const Witness deeper = options_.measure_depth ? deepen(pair_, witness) : witness;
    if (result_.method == Method::Boxes) result_.method = Method::Exact;
    result_.verdict = Verdict::Interference;
    result_.depth_mm = 2.0 * deeper.depth_mm;
    result_.witness_W = deeper.point_B;
  }

  void look_for_contact(const ClosestPair& closest, double slack) {
    const double tolerance = options_.tolerance_mm;
    double gap = std::sqrt(closest.distance_squared_mm2);
    Eigen::Vector3d middle = 0.5 * (closest.on_a + closest.on_b);
    if (slack > 0.0) {
      // Project to and fro between the exact solids: both ends are real places of the boundary.
      Eigen::Vector3d on_b = closest.on_b;
      double previous = std::numeric_limits<double>::infinity();
      for (int step = 0; step < kProjections; ++step) {
        const NearestPoint near_a = pair_.a.nearest(X_AB_ * on_b);
        const Eigen::Vector3d on_a = pair_.X_BA * near_a.point;
        const NearestPoint near_b = pair_.b.nearest(on_a);
        on_b = near_b.point;
        gap = near_b.inside ? 0.0 : near_b.distance_mm;
        middle = 0.5 * (on_a + on_b);
        if (gap <= tolerance || previous - gap < 1e-3 * tolerance) break;
        previous = gap;
      }
    }
    if (gap > tolerance) return;
    result_.verdict = Verdict::Contact;
    result_.gap_mm = gap;
    result_.witness_W = middle;
  }

  const ModelPair& pair_;
  Pose X_AB_;
  const QueryOptions& options_;
  QueryCounters& counters_;
  double erosion_mm_;
  PairVerdict result_;
};

}  // namespace

PairVerdict judge(const ModelPair& pair, const QueryOptions& options, NarrowScratch& scratch,
                  QueryCounters& counters) {
  Judge judge(pair, options, counters);
  for_each_leaf_pair(
      pair, scratch, counters, [&](double gap) { return gap <= options.tolerance_mm; },
      [&](const BvhNode& a, const BvhNode& b) { return judge.look_at(a, b); });
  if (!judge.proven()) judge.look_for_containment();
  return judge.result();
}

double gap_lower_bound_mm(const ModelPair& pair, HoleMode holes, double cap_mm,
                          NarrowScratch& scratch, QueryCounters& counters) {
  double best = cap_mm;
  for_each_leaf_pair(
      pair, scratch, counters, [&](double gap) { return gap < best && best > 0.0; },
      [&](const BvhNode& leaf_a, const BvhNode& leaf_b) {
        for (const ModelTriangle& a : pair.a.triangles().subspan(leaf_a.first, leaf_a.count)) {
          if (holes == HoleMode::Paper && a.is_hole) continue;
          const PlacedTriangle a_B = placed(pair.X_BA, a);
          for (const ModelTriangle& b : pair.b.triangles().subspan(leaf_b.first, leaf_b.count)) {
            if (holes == HoleMode::Paper && b.is_hole) continue;
            ++counters.triangle_tests;
            const double margin = best + a.slack_mm + b.slack_mm;
            if (beyond_plane(a_B.corners_B, b.normal, b.corners[0], margin) ||
                beyond_plane(b.corners, a_B.normal_B, a_B.corners_B[0], margin)) {
              continue;
            }
            const ClosestPair closest =
                closest_points(a_B.corners_B, a_B.normal_B, b.corners, b.normal);
            best =
                std::min(best, std::sqrt(closest.distance_squared_mm2) - a.slack_mm - b.slack_mm);
          }
        }
        return best > 0.0;
      });
  return std::max(best, 0.0);
}

}  // namespace dowel
