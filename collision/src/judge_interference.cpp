// Whether a ball of the tolerance fits into two bodies at once.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "judge.h"
#include "kept_off.h"
#include "triangle_pair.h"

namespace dowel {
namespace {

/// Fractions of a crossing segment at which a witness is sought.
constexpr std::array<double, 3> kFractions{0.5, 0.02, 0.98};

/// How far a witness may lie from its start, in tolerances; and, as the deepest place behind curved
/// facets may be anywhere along them, the length of the shorter one more.
constexpr double kReachTolerances = 64.0;

double longest_edge(const Corners& corners) {
  return std::sqrt(
      std::max({(corners[1] - corners[0]).squaredNorm(), (corners[2] - corners[1]).squaredNorm(),
                (corners[0] - corners[2]).squaredNorm()}));
}

Corners shifted(const Corners& corners, const Eigen::Vector3d& by) {
  return {corners[0] + by, corners[1] + by, corners[2] + by};
}

/// Lower bound of a box's height before a plane that is placed beside it.
double height_of(const Obb& box, const Pose& X_OP, const PlaneSurface& plane) {
  const Eigen::Vector3d normal_O = X_OP.rotation() * plane.normal;
  const double reach = (box.axes.transpose() * normal_O).cwiseAbs().dot(box.half_extents_mm);
  return normal_O.dot(box.center - X_OP * plane.origin) - reach;
}

}  // namespace

bool Judge::knows_cores() {
  if (memory_.core_a == PairMemory::kNone) return false;
  if (pair_.reliefs_B.empty()) {
    const auto overlap =
        overlap_of(pair_.a.cores(), memory_.core_a, pair_.b.cores(), memory_.core_b, pair_.X_BA,
                   erosion_mm_, pair_.X_BA * memory_.in_cores_A);
    if (overlap) return take_overlap(*overlap);
  }
  memory_.core_a = PairMemory::kNone;
  return cores_overlap();
}

bool Judge::cores_overlap() {
  if (!pair_.reliefs_B.empty() || options_.holes == HoleMode::Paper) return false;
  const auto overlap = find_overlap(pair_.a.cores(), pair_.b.cores(), pair_.X_BA, erosion_mm_);
  return overlap && take_overlap(*overlap);
}

bool Judge::take_overlap(const CoreOverlap& overlap) {
  memory_.core_a = overlap.core_a;
  memory_.core_b = overlap.core_b;
  memory_.in_cores_A = X_AB_ * overlap.point_B;
  if (options_.measure_depth) {
    return try_witness(Witness{overlap.point_B, overlap.depth_a_mm, overlap.depth_b_mm});
  }
  result_.method = Method::Exact;
  result_.verdict = Verdict::Interference;
  result_.depth_mm = 2.0 * std::min(overlap.depth_a_mm, overlap.depth_b_mm);
  result_.gap_mm = 0.0;
  result_.witness_W = overlap.point_B;
  return true;
}

bool Judge::knows_ball() {
  if (memory_.ball_depth_a_mm <= 0.0) return false;
  const Eigen::Vector3d ball_B = pair_.X_BA * memory_.ball_A;
  double depth_b = memory_.ball_depth_b_mm - (ball_B - memory_.ball_B).norm();
  const bool is_plain = !options_.measure_depth && pair_.reliefs_B.empty();
  if ((depth_b < erosion_mm_ || !is_plain) && cores_overlap()) return true;
  if (depth_b < erosion_mm_ && is_plain) {
    // The same point of A may be deep in B at another place.
    const NearestPoint near = pair_.b.nearest(ball_B);
    if (near.inside && near.distance_mm >= erosion_mm_) {
      depth_b = near.distance_mm;
      memory_.ball_B = ball_B;
      memory_.ball_depth_b_mm = depth_b;
    }
  }
  if (depth_b < erosion_mm_ || !is_plain) {
    const double reach = kReachTolerances * options_.tolerance_mm;
    if (try_witness(find_witness(pair_, ball_B, erosion_mm_, reach))) return true;
    memory_.ball_depth_a_mm = 0.0;
    return false;
  }
  const double depth = std::min(memory_.ball_depth_a_mm, depth_b);
  result_.method = Method::Exact;
  result_.verdict = Verdict::Interference;
  result_.depth_mm = 2.0 * depth;
  result_.gap_mm = 0.0;
  result_.witness_W = ball_B;
  return true;
}

void Judge::look_for_interference() {
  if (memory_.crossing_a != PairMemory::kNone &&
      crosses(memory_.crossing_a, placement_ * pair_.a.triangles()[memory_.crossing_a],
              memory_.crossing_b)) {
    return;
  }
  const KeptOff kept_off_a(pair_.a, options_.tolerance_mm, [&](const PlaneSurface& plane) {
    return height_of(pair_.obb_b, pair_.X_BA, plane);
  });
  const KeptOff kept_off_b(pair_.b, options_.tolerance_mm, [&](const PlaneSurface& plane) {
    return height_of(pair_.obb_a, X_AB_, plane);
  });
  for_each_leaf_pair(
      pair_, scratch_, counters_,
      [&](const BvhNode& a, const BvhNode& b) {
        return !kept_off_a.contains(a) && !kept_off_b.contains(b);
      },
      [&](double gap_mm) { return gap_mm <= options_.tolerance_mm; },
      [&](const BvhNode& leaf_a, const BvhNode& leaf_b) {
        double ignored = 0.0;
        return for_each_near_pair(
            pair_, placement_, leaf_a, leaf_b, options_.tolerance_mm, ignored,
            [this](const ModelTriangle& t) { return takes_part(t); },
            [&](std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
              if (!crosses(i, a_B, j)) return true;
              memory_.crossing_a = i;
              memory_.crossing_b = j;
              return false;
            });
      });
}

bool Judge::crosses(std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
  const ModelTriangle& a = pair_.a.triangles()[i];
  const ModelTriangle& b = pair_.b.triangles()[j];
  ++counters_.triangle_tests;
  const double slack = a.slack_mm + b.slack_mm;
  const double margin = options_.tolerance_mm + slack;
  if (apart_by_planes(a, a_B, b) > options_.tolerance_mm ||
      box_gap(a_B.corners_B, b.corners) > margin) {
    return false;
  }
  note_method(i, j);
  const double reach = reach_mm(a, b);
  const auto crossing =
      crossing_segment(shifted(a_B.corners_B, -erosion_mm_ * a_B.normal_B), a_B.normal_B,
                       shifted(b.corners, -erosion_mm_ * b.normal), b.normal);
  if (crossing) {
    for (const double fraction : kFractions) {
      const Eigen::Vector3d start = crossing->start + fraction * (crossing->end - crossing->start);
      if (try_start(start, i, j, reach)) return true;
    }
  }
  if (slack == 0.0 || beyond_edges(b.corners, b.normal, a_B.corners_B) > margin ||
      beyond_edges(a_B.corners_B, a_B.normal_B, b.corners) > margin) {
    return false;
  }
  const ClosestPair closest = closest_points(a_B.corners_B, a_B.normal_B, b.corners, b.normal);
  if (closest.distance_squared_mm2 > margin * margin) return false;
  const Eigen::Vector3d middle = 0.5 * (closest.on_a + closest.on_b);
  if (no_witness_from_.knows(a.face, b.face, middle)) return false;
  if (try_start(middle, i, j, reach)) return true;
  no_witness_from_.add(a.face, b.face, middle);
  return false;
}

double Judge::reach_mm(const ModelTriangle& a, const ModelTriangle& b) const {
  double length_mm = std::numeric_limits<double>::infinity();
  if (a.slack_mm > 0.0) length_mm = longest_edge(a.corners);
  if (b.slack_mm > 0.0) length_mm = std::min(length_mm, longest_edge(b.corners));
  if (!std::isfinite(length_mm)) length_mm = 0.0;  // flat, with straight edges
  return kReachTolerances * options_.tolerance_mm + length_mm;
}

bool Judge::try_start(const Eigen::Vector3d& start_B, std::uint32_t i, std::uint32_t j,
                      double reach) {
  return try_witness(find_witness(pair_, start_B, i, j, erosion_mm_, reach));
}

bool Judge::try_witness(const std::optional<Witness>& witness) {
  if (!witness) return false;
  const Witness found = deepen(pair_, *witness, options_.measure_depth);
  if (result_.method == Method::Boxes) result_.method = Method::Exact;
  result_.verdict = Verdict::Interference;
  result_.depth_mm = 2.0 * std::min(found.depth_a_mm, found.depth_b_mm);
  result_.gap_mm = 0.0;
  result_.witness_W = found.point_B;
  memory_.ball_A = X_AB_ * found.point_B;
  memory_.ball_B = found.point_B;
  memory_.ball_depth_a_mm = found.depth_a_mm;
  memory_.ball_depth_b_mm = found.depth_b_mm;
  return true;
}

void Judge::look_for_containment() {
  for (const auto& inner : pair_.a.inner_points()) {
    if (try_inner_point(pair_.X_BA * inner.point, inner.depth_mm)) return;
  }
  for (const auto& inner : pair_.b.inner_points()) {
    if (try_inner_point(inner.point, inner.depth_mm)) return;
  }
}

bool Judge::try_inner_point(const Eigen::Vector3d& point_B, double depth_mm) {
  if (depth_mm < erosion_mm_ || !in_box(pair_.b, point_B) || !in_box(pair_.a, X_AB_ * point_B)) {
    return false;
  }
  return try_witness(test_witness(pair_, point_B, erosion_mm_));
}

bool Judge::in_box(const CollisionModel& model, const Eigen::Vector3d& point) {
  const BvhNode& root = model.nodes()[0];
  return (root.min.array() <= point.array()).all() && (point.array() <= root.max.array()).all();
}

}  // namespace dowel
