// Whether a ball of the tolerance fits into two bodies at once.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "judge.h"
#include "triangle_pair.h"

namespace dowel {
namespace {

/// Fractions of a crossing segment at which a witness is sought.
constexpr std::array<double, 3> kFractions{0.5, 0.02, 0.98};

/// How far a witness may lie from its start, in tolerances; and, as the deepest place behind curved
/// facets may be anywhere along them, the length of the shorter one and what they stand off more.
constexpr double kReachTolerances = 64.0;

/// Facets further off their faces than this, in tolerances, say little of where these meet.
constexpr double kCoarseTolerances = 16.0;

/// A pose at which cores are asked in vain costs as much as some tens that find the ball again.
constexpr int kMostPosesWithoutCores = 31;

double longest_edge(const Corners& corners) {
  return std::sqrt(
      std::max({(corners[1] - corners[0]).squaredNorm(), (corners[2] - corners[1]).squaredNorm(),
                (corners[0] - corners[2]).squaredNorm()}));
}

Corners shifted(const Corners& corners, const Eigen::Vector3d& by) {
  return {corners[0] + by, corners[1] + by, corners[2] + by};
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
  if (cores_were_asked_) return false;
  cores_were_asked_ = true;
  if (leaves_out(Skip::Cores)) return false;
  if (!pair_.reliefs_B.empty() || options_.holes == HoleMode::Paper) return false;
  const auto overlap = find_overlap(pair_.a.cores(), pair_.b.cores(), pair_.X_BA, erosion_mm_);
  memory_.poses_without_cores =
      overlap ? 0 : std::min(2 * memory_.poses_without_cores + 1, kMostPosesWithoutCores);
  memory_.poses_until_cores = memory_.poses_without_cores;
  return overlap && take_overlap(*overlap);
}

bool Judge::take_overlap(const CoreOverlap& overlap) {
  memory_.core_a = overlap.core_a;
  memory_.core_b = overlap.core_b;
  memory_.in_cores_A = X_AB_ * overlap.point_B;
  if (options_.measure_depth) {
    return try_witness(Witness{overlap.point_B, overlap.depth_a_mm, overlap.depth_b_mm});
  }
  // Cores keep clear of what their faces may be off.
  tell_interference(std::min(overlap.depth_a_mm, overlap.depth_b_mm), overlap.point_B, 0.0);
  return true;
}

bool Judge::knows_ball() {
  if (memory_.ball_depth_a_mm <= 0.0) return false;
  const Eigen::Vector3d ball_B = pair_.X_BA * memory_.ball_A;
  double depth_b = memory_.ball_depth_b_mm - (ball_B - memory_.ball_B).norm();
  const bool is_plain = !options_.measure_depth && pair_.reliefs_B.empty();
  if (depth_b < erosion_mm_ || !is_plain) {
    const bool is_time = memory_.poses_until_cores == 0;
    if (!is_time) --memory_.poses_until_cores;
    if ((is_time || !is_plain) && cores_overlap()) return true;
  }
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
  tell_interference(std::min(memory_.ball_depth_a_mm, depth_b), ball_B, unknown_mm());
  return true;
}

bool Judge::still_crosses() {
  if (memory_.crossing_a == PairMemory::kNone) return false;
  const PlacedTriangle a_B = placement_ * pair_.a.triangles()[memory_.crossing_a];
  double ignored = 0.0;
  const auto near = near_facets(memory_.crossing_a, a_B, memory_.crossing_b, ignored);
  if (near && crosses(*near, a_B)) return true;
  memory_.crossing_a = PairMemory::kNone;
  return false;
}

std::optional<Segment> Judge::eroded_crossing(const PlacedTriangle& a_B,
                                              const ModelTriangle& b) const {
  return crossing_segment(shifted(a_B.corners_B, -erosion_mm_ * a_B.normal_B), a_B.normal_B,
                          shifted(b.corners, -erosion_mm_ * b.normal), b.normal);
}

bool Judge::crosses_in_the_middle(std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j,
                                  int& tries) {
  const ModelTriangle& a = pair_.a.triangles()[i];
  const ModelTriangle& b = pair_.b.triangles()[j];
  const auto crossing = eroded_crossing(a_B, b);
  if (!crossing) return false;
  --tries;
  note_method(i, j);
  return try_start(0.5 * (crossing->start + crossing->end), i, j, reach_mm(a, b));
}

bool Judge::crosses(const NarrowScratch::FacetPair& near, const PlacedTriangle& a_B) {
  const ModelTriangle& a = pair_.a.triangles()[near.a];
  const ModelTriangle& b = pair_.b.triangles()[near.b];
  const double reach = reach_mm(a, b);
  if (const auto crossing = eroded_crossing(a_B, b)) {
    for (const double fraction : kFractions) {
      const Eigen::Vector3d start = crossing->start + fraction * (crossing->end - crossing->start);
      if (try_start(start, near.a, near.b, reach)) return true;
    }
  }
  if (near.is_flat) return false;
  const Eigen::Vector3d middle = 0.5 * (near.on_a_B + near.on_b);
  if (no_witness_from_.knows(a.face, b.face, middle)) return false;
  if (try_start(middle, near.a, near.b, reach)) return true;
  // Where facets are this far off their faces, so may be the middle between them.
  if (a.slack_mm + b.slack_mm > kCoarseTolerances * options_.tolerance_mm) {
    const auto gap = gap_between_faces(near.a, near.b, near.on_b);
    if (gap && try_start(0.5 * (gap->on_a_B + gap->on_b), near.a, near.b, reach)) return true;
  }
  no_witness_from_.add(a.face, b.face, middle);
  return false;
}

double Judge::reach_mm(const ModelTriangle& a, const ModelTriangle& b) const {
  double length_mm = std::numeric_limits<double>::infinity();
  if (a.slack_mm > 0.0) length_mm = longest_edge(a.corners);
  if (b.slack_mm > 0.0) length_mm = std::min(length_mm, longest_edge(b.corners));
  if (!std::isfinite(length_mm)) length_mm = 0.0;  // flat, with straight edges
  return kReachTolerances * options_.tolerance_mm + length_mm + a.slack_mm + b.slack_mm;
}

bool Judge::try_start(const Eigen::Vector3d& start_B, std::uint32_t i, std::uint32_t j,
                      double reach) {
  if (!try_witness(find_witness(pair_, start_B, i, j, erosion_mm_, reach))) return false;
  memory_.crossing_a = i;
  memory_.crossing_b = j;
  return true;
}

bool Judge::try_witness(const std::optional<Witness>& witness) {
  if (!witness) return false;
  const Witness found = deepen(pair_, *witness, options_.measure_depth);
  tell_interference(std::min(found.depth_a_mm, found.depth_b_mm), found.point_B, unknown_mm());
  memory_.ball_A = X_AB_ * found.point_B;
  memory_.ball_B = found.point_B;
  memory_.ball_depth_a_mm = found.depth_a_mm;
  memory_.ball_depth_b_mm = found.depth_b_mm;
  return true;
}

void Judge::tell_interference(double radius_mm, const Eigen::Vector3d& center_B, double bound_mm) {
  if (result_.method == Method::Boxes) {
    result_.method = bound_mm > 0.0 ? Method::Facets : Method::Exact;
  }
  result_.bound_mm = std::max(result_.bound_mm, bound_mm);
  result_.verdict = Verdict::Interference;
  result_.depth_mm = 2.0 * radius_mm;
  result_.gap_mm = 0.0;
  result_.witness_W = center_B;
}

double Judge::unknown_mm() const {
  return pair_.a.max_unknown_mm() + pair_.b.max_unknown_mm();
}

bool Judge::is_deep_at(const Eigen::Vector3d& place_B) {
  const double reach = kReachTolerances * options_.tolerance_mm;
  return try_witness(find_witness(pair_, place_B, erosion_mm_, reach));
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
