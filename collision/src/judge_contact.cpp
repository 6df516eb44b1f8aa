// Whether two bodies touch.

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "exact_face.h"
#include "judge.h"
#include "triangle_pair.h"

namespace dowel {
namespace {

/// Alternating projections between two exact faces before their gap is taken as it stands, and the
/// share of the tolerance below which another one gains nothing. They are led on as in Walker, Ni,
/// "Anderson Acceleration for Fixed-Point Iterations", 2011, with a memory of one step.
constexpr int kProjections = 16;
constexpr double kProjectionGain = 1.0e-3;

/// Cosine above which two facets are parallel enough to look for what they have in common.
constexpr double kOpposite = 0.999;

/// Seats are tried on planes that are this many tolerances apart at their origins at most: planes
/// that are not quite parallel may be closer elsewhere.
constexpr double kSeatApart = 4.0;

/// Slack of the cones of normals for that angle and for single precision.
constexpr double kConeSlack = 0.06;

/// A point in the middle of what two facets in one plane have in common; nothing where that is no
/// area.
std::optional<Eigen::Vector3d> middle_of_overlap(const Corners& a, const Corners& b,
                                                 const Eigen::Vector3d& normal_b) {
  std::array<Eigen::Vector3d, 9> polygon{a[0], a[1], a[2]};
  std::size_t count = 3;
  for (std::size_t edge = 0; edge < 3 && count > 2; ++edge) {
    const Eigen::Vector3d inward = normal_b.cross(b[(edge + 1) % 3] - b[edge]);
    std::array<Eigen::Vector3d, 9> kept;
    std::size_t n = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const Eigen::Vector3d& p = polygon[i];
      const Eigen::Vector3d& q = polygon[(i + 1) % count];
      const double dp = inward.dot(p - b[edge]);
      const double dq = inward.dot(q - b[edge]);
      if (dp >= 0.0) kept[n++] = p;
      if ((dp < 0.0) != (dq < 0.0)) kept[n++] = p + dp / (dp - dq) * (q - p);
    }
    polygon = kept;
    count = n;
  }
  if (count < 3) return std::nullopt;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < count; ++i) sum += polygon[i];
  return sum / static_cast<double>(count);
}

}  // namespace

void Judge::touch(double gap_mm, const Eigen::Vector3d& place_B) {
  result_.verdict = Verdict::Contact;
  result_.gap_mm = gap_mm;
  result_.witness_W = place_B;
}

bool Judge::still_touches() {
  if (memory_.contact_a == PairMemory::kNone) return false;
  if (memory_.has_contact_place ? touches_at_place() : touches_again()) return true;
  memory_.contact_a = PairMemory::kNone;
  return false;
}

bool Judge::touches_at_place() {
  const auto in_B = [this](const Eigen::Vector3d& p_A) { return placement_ * p_A; };
  const auto in_A = [this](const Eigen::Vector3d& p_B) { return X_AB_ * p_B; };
  if (contact_.holds(in_B, in_A)) return true;
  if (options_.holes == HoleMode::Paper) return false;
  const std::uint32_t i = memory_.contact_a;
  const std::uint32_t j = memory_.contact_b;
  const Eigen::Vector3d on_a_A = memory_.contact_A;
  const Eigen::Vector3d on_a_B = in_B(on_a_A);
  const auto near_b = pair_.b.nearest_within(on_a_B, options_.tolerance_mm);
  if (near_b && contact_.touches_at(i, on_a_A, on_a_B, {near_b->triangle})) return true;
  const Eigen::Vector3d on_b_B = memory_.contact_B;
  const Eigen::Vector3d on_b_A = in_A(on_b_B);
  const auto near_a = pair_.a.nearest_within(on_b_A, options_.tolerance_mm);
  if (near_a && contact_.touched_at({near_a->triangle}, on_b_A, j, on_b_B, in_B)) return true;
  return faces_lie_on_each_other(i, placement_ * pair_.a.triangles()[i], j);
}

bool Judge::touches_again() {
  const PlacedTriangle a_B = placement_ * pair_.a.triangles()[memory_.contact_a];
  double ignored = 0.0;
  const auto near = near_facets(memory_.contact_a, a_B, memory_.contact_b, ignored);
  return near && touches(*near);
}

bool Judge::seat_touches() {
  if (options_.holes == HoleMode::Paper || leaves_out(Skip::Seats)) return false;
  const auto in_B = [this](const Eigen::Vector3d& p_A) { return placement_ * p_A; };
  for (const SeatPlane& a : pair_.a.seat_planes()) {
    const Eigen::Vector3d normal_B = placement_.rotation * a.plane.normal;
    const Eigen::Vector3d origin_B = placement_ * a.plane.origin;
    for (const SeatPlane& b : pair_.b.seat_planes()) {
      if (normal_B.dot(b.plane.normal) > -kOpposite) continue;
      const double apart = std::abs(b.plane.normal.dot(origin_B - b.plane.origin));
      if (apart > kSeatApart * options_.tolerance_mm) continue;
      for (const Seat& seat : pair_.a.seats(a)) {
        const Eigen::Vector3d on_a_B = in_B(seat.point);
        const auto near = pair_.b.nearest_within(on_a_B, options_.tolerance_mm);
        if (near && contact_.touches_at(seat.triangle, seat.point, on_a_B, {near->triangle})) {
          return true;
        }
      }
      for (const Seat& seat : pair_.b.seats(b)) {
        const Eigen::Vector3d on_b_A = X_AB_ * seat.point;
        const auto near = pair_.a.nearest_within(on_b_A, options_.tolerance_mm);
        if (near &&
            contact_.touched_at({near->triangle}, on_b_A, seat.triangle, seat.point, in_B)) {
          return true;
        }
      }
    }
  }
  return false;
}

bool Judge::may_face(const BvhNode& a, const BvhNode& b) const {
  const Eigen::Vector3d normal_B = placement_.rotation * a.normal.cast<double>();
  const double opposite = -normal_B.dot(b.normal.cast<double>());
  const double cosine = a.cosine * b.cosine - a.sine * b.sine;  // of both spreads together
  return a.cosine <= 0.0F || b.cosine <= 0.0F || opposite >= cosine - kConeSlack;
}

bool Judge::faces_lie_on_each_other(std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
  const ModelTriangle& a = pair_.a.triangles()[i];
  const ModelTriangle& b = pair_.b.triangles()[j];
  if (a_B.normal_B.dot(b.normal) > -kOpposite) return false;
  ++counters_.triangle_tests;
  if (apart_by_planes(a, a_B, b) > options_.tolerance_mm ||
      box_gap(a_B.corners_B, b.corners) > options_.tolerance_mm) {
    return false;
  }
  const auto middle = middle_of_overlap(a_B.corners_B, b.corners, b.normal);
  return middle && is_between_faces(i, j, *middle);
}

bool Judge::touches(const NarrowScratch::FacetPair& near) {
  if (near.is_flat) {
    contact_.touch(near.a, X_AB_ * near.on_a_B, near.on_a_B, near.b, near.on_b);
    return true;
  }
  if (is_between_faces(near.a, near.b, near.on_b)) return true;
  const ModelTriangle& a = pair_.a.triangles()[near.a];
  const ModelTriangle& b = pair_.b.triangles()[near.b];
  const Eigen::Vector3d middle = 0.5 * (near.on_a_B + near.on_b);
  if (no_touch_from_.knows(a.face, b.face, middle)) return false;
  if (const auto place =
          find_touch(pair_, middle, near.a, near.b, options_.tolerance_mm, reach_mm(a, b))) {
    touch(std::max(0.0, -place->depth_a_mm) + std::max(0.0, -place->depth_b_mm), place->point_B);
    memory_.contact_a = near.a;
    memory_.contact_b = near.b;
    memory_.has_contact_place = false;
    return true;
  }
  no_touch_from_.add(a.face, b.face, middle);
  return false;
}

bool Judge::is_between_faces(std::uint32_t i, std::uint32_t j, const Eigen::Vector3d& on_b) {
  const auto gap = gap_between_faces(i, j, on_b);
  if (!gap || gap->gap_mm > options_.tolerance_mm) return false;
  contact_.touch(i, gap->on_a_A, gap->on_a_B, j, gap->on_b);
  return true;
}

std::optional<Judge::FaceGap> Judge::gap_between_faces(std::uint32_t i, std::uint32_t j,
                                                       Eigen::Vector3d on_b) const {
  std::optional<FaceGap> least;
  Eigen::Vector3d last_way = Eigen::Vector3d::Zero();
  Eigen::Vector3d last_end = Eigen::Vector3d::Zero();
  for (int step = 0; step < kProjections; ++step) {
    const FacePoint near_a = nearest_on_patch(pair_.a, i, X_AB_ * on_b);
    const Eigen::Vector3d on_a = pair_.X_BA * near_a.point;
    const FacePoint near_b = nearest_on_patch(pair_.b, j, on_a);
    if (!std::isfinite(near_a.distance_squared_mm2 + near_b.distance_squared_mm2)) return least;
    const double gap = std::sqrt(near_b.distance_squared_mm2);
    const bool is_gain = !least || least->gap_mm - gap >= kProjectionGain * options_.tolerance_mm;
    if (!least || gap < least->gap_mm) least = FaceGap{near_a.point, on_a, near_b.point, gap};
    if (gap <= options_.tolerance_mm || (step > 1 && !is_gain)) break;
    // A wide rim near a plane goes a share of gap by radius of its way in each step: where the way
    // changes as it did in the last one, it ends here.
    const Eigen::Vector3d way = near_b.point - on_b;
    const Eigen::Vector3d change = way - last_way;
    on_b = near_b.point;
    if (step > 0 && !change.isZero(0.0)) {
      const double left = -way.dot(change) / change.squaredNorm();
      on_b = nearest_on_patch(pair_.b, j, on_b + left * (near_b.point - last_end)).point;
    }
    last_end = near_b.point;
    last_way = way;
  }
  return least;
}

}  // namespace dowel
