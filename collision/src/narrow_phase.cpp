#include "narrow_phase.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "dowel/collision/axis_profile.h"
#include "dowel/collision/box_separation.h"
#include "exact_face.h"
#include "facet_pairs.h"
#include "kept_off.h"
#include "triangle_pair.h"
#include "witness.h"

namespace dowel {
namespace {

/// A share of the tolerance that certificates keep for rounding.
constexpr double kSafety = 1.0e-6;

/// Fractions of a crossing segment at which a witness is sought.
constexpr std::array<double, 3> kFractions{0.5, 0.02, 0.98};

/// How far a witness may lie from its start, in tolerances; and, as the deepest place behind curved
/// facets may be anywhere along them, the length of the shorter one more.
constexpr double kReachTolerances = 64.0;

/// Alternating projections between two exact faces before their gap is taken as it stands, and the
/// share of the tolerance below which another one gains nothing.
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

/// Collects the evidence on one pair.
class Judge {
 public:
  Judge(const ModelPair& pair, const QueryOptions& options, PairMemory& memory,
        NarrowScratch& scratch, QueryCounters& counters)
      : pair_(pair),
        X_AB_(pair.X_BA.inverse()),
        placement_(pair.X_BA),
        options_(options),
        memory_(memory),
        scratch_(scratch),
        counters_(counters),
        erosion_mm_(0.5 * options.tolerance_mm) {}

  /// What was found out at the last pose, tested at this one. False where that decides nothing.
  bool recall() {
    if (knows_ball()) return true;
    bool is_free = false;
    if (memory_.shaft != PairMemory::kNone) {
      is_free = take_fit(memory_.shaft_is_in_a, memory_.shaft, memory_.bore);
      if (is_decided_) return true;
    }
    if (memory_.contact_a == PairMemory::kNone) return false;
    return (is_free || are_still_shallow()) && still_touches();
  }

  PairVerdict decide() {
    const bool are_shallow = boxes_are_shallow();
    if (are_shallow && still_touches()) return result_;
    const bool is_free = shaft_fits() || are_shallow;
    if (is_decided_) return result_;
    const bool crossed = memory_.crossing_a != PairMemory::kNone;
    if (!is_free) {
      // Where bodies are deep in each other, a deep point tells so at once. Where facets crossed
      // before, others are likely to do so now.
      look_for_containment();
      if (is_interference()) return result_;
      if (crossed) look_for_interference();
      if (is_interference()) return result_;
      memory_.crossing_a = PairMemory::kNone;
    }
    if (are_shallow || !still_touches()) look_for_contact();
    if (!is_free && is_suspect_ && !crossed) look_for_interference();
    return result_;
  }

  const PairVerdict& result() const { return result_; }

  /// The same by looking at all pairs of facets, without knowing of anything that forbids one or
  /// the other.
  PairVerdict decide_by_brute_force() {
    double apart = std::numeric_limits<double>::infinity();
    for_each_pair([&](std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
      return !faces_lie_on_each_other(i, a_B, j) && !touches(i, a_B, j, apart);
    });
    if (is_suspect_) {
      for_each_pair([&](std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
        return !crosses(i, a_B, j);
      });
    }
    if (result_.verdict != Verdict::Interference) look_for_containment();
    if (result_.verdict == Verdict::Clear) result_.gap_mm = std::max(apart, options_.tolerance_mm);
    return result_;
  }

 private:
  // What forbids interference.

  bool boxes_are_shallow() {
    const Obb obb_a_B = transformed(pair_.X_BA, pair_.obb_a);
    const double overlap = -options_.tolerance_mm * (1.0 - kSafety);
    const BoxSeparation boxes = separate(obb_a_B, pair_.obb_b, overlap, memory_.shallow_plane);
    memory_.shallow_plane = static_cast<std::int8_t>(boxes.plane);
    return boxes.plane >= 0;
  }

  bool are_still_shallow() const {
    return memory_.shallow_plane >= 0 &&
           gap_along(transformed(pair_.X_BA, pair_.obb_a), pair_.obb_b, memory_.shallow_plane) >
               -options_.tolerance_mm * (1.0 - kSafety);
  }

  /// Looks for a shaft of one body in a bore of the other. May decide the pair.
  bool shaft_fits() {
    if (options_.holes == HoleMode::Paper) return false;
    if (memory_.shaft != PairMemory::kNone &&
        take_fit(memory_.shaft_is_in_a, memory_.shaft, memory_.bore)) {
      return true;
    }
    memory_.shaft = PairMemory::kNone;
    for (const bool shaft_is_in_a : {true, false}) {
      const CollisionModel& with_shaft = shaft_is_in_a ? pair_.a : pair_.b;
      const CollisionModel& with_bore = shaft_is_in_a ? pair_.b : pair_.a;
      const Pose& X_VS = shaft_is_in_a ? pair_.X_BA : X_AB_;
      const auto& shafts = with_shaft.profiles().shafts;
      const auto& bores = with_bore.profiles().bores;
      for (std::uint32_t s = 0; s < shafts.size(); ++s) {
        const Eigen::Vector3d origin = X_VS * shafts[s].origin;
        const Eigen::Vector3d direction = X_VS.rotation() * shafts[s].direction;
        for (std::uint32_t v = 0; v < bores.size(); ++v) {
          if (may_hold(origin, direction, bores[v]) && take_fit(shaft_is_in_a, s, v)) {
            memory_.shaft_is_in_a = shaft_is_in_a;
            memory_.shaft = s;
            memory_.bore = v;
            return true;
          }
        }
      }
    }
    return false;
  }

  /// Whether a shaft's axis passes the middle of the bore within its largest radius.
  static bool may_hold(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                       const AxisProfile& bore) {
    if (std::abs(direction.dot(bore.direction)) < 0.99) return false;
    const double middle = 0.5 * (bore.steps.front().from_mm + bore.steps.back().to_mm);
    const Eigen::Vector3d offset = bore.origin + middle * bore.direction - origin;
    double radius = 0.0;
    for (const ProfileStep& step : bore.steps) radius = std::max(radius, step.most_radius_mm());
    return (offset - direction.dot(offset) * direction).squaredNorm() <= radius * radius;
  }

  bool take_fit(bool shaft_is_in_a, std::uint32_t s, std::uint32_t v) {
    const AxisProfile& shaft = (shaft_is_in_a ? pair_.a : pair_.b).profiles().shafts[s];
    const AxisProfile& bore = (shaft_is_in_a ? pair_.b : pair_.a).profiles().bores[v];
    // Reliefs are given in B; a shaft of B in a bore of A sees them in A only where there are none.
    if (!shaft_is_in_a && !pair_.reliefs_B.empty()) return false;
    const Pose& X_VS = shaft_is_in_a ? pair_.X_BA : X_AB_;
    const Fit fitted = fit(shaft, bore, X_VS, options_.tolerance_mm * (1.0 - kSafety),
                           shaft_is_in_a ? pair_.reliefs_B : std::span<const ThreadRelief>());
    if (!fitted.is_free) return false;
    result_.method = Method::Exact;
    const Eigen::Vector3d place_B =
        shaft_is_in_a ? fitted.place_V : Eigen::Vector3d(pair_.X_BA * fitted.place_V);
    if (fitted.gap_mm > options_.tolerance_mm) {
      result_.gap_mm = fitted.gap_mm;
      is_decided_ = true;
    } else if (fitted.gap_is_met) {
      touch(std::max(fitted.gap_mm, 0.0), place_B);
      is_decided_ = true;
    }
    return true;
  }

  // Contact.

  void touch(double gap_mm, const Eigen::Vector3d& place_B) {
    result_.verdict = Verdict::Contact;
    result_.gap_mm = gap_mm;
    result_.witness_W = place_B;
  }

  /// Contact of facets `i` and `j`, at a place of either's face.
  void touch(std::uint32_t i, const Eigen::Vector3d& on_a_B, std::uint32_t j,
             const Eigen::Vector3d& on_b) {
    touch((on_a_B - on_b).norm(), 0.5 * (on_a_B + on_b));
    memory_.contact_a = i;
    memory_.contact_b = j;
    memory_.has_contact_place = true;
    memory_.contact_A = X_AB_ * on_a_B;
    memory_.contact_B = on_b;
  }

  /// Whether the facets that were in contact still are: at the same place of either, if not, at
  /// another one, or the same place of a body at another facet of the other one.
  bool still_touches() {
    if (memory_.contact_a == PairMemory::kNone) return false;
    const std::uint32_t i = memory_.contact_a;
    const std::uint32_t j = memory_.contact_b;
    const Eigen::Vector3d on_a_B = placement_ * memory_.contact_A;
    const Eigen::Vector3d on_b_A = X_AB_ * memory_.contact_B;
    if (memory_.has_contact_place && (touches_at(i, on_a_B, j) || touched_at(i, on_b_A, j))) {
      return true;
    }
    const PlacedTriangle a_B = placement_ * pair_.a.triangles()[i];
    if (faces_lie_on_each_other(i, a_B, j)) return true;
    if (double ignored = 0.0; !memory_.has_contact_place && touches(i, a_B, j, ignored))
      return true;
    if (memory_.has_contact_place && options_.holes == HoleMode::Exact) {
      const double reach_mm = options_.tolerance_mm;
      if (const auto near = pair_.b.nearest_within(on_a_B, reach_mm)) {
        if (touches_at(i, on_a_B, near->triangle)) return true;
      }
      if (const auto near = pair_.a.nearest_within(on_b_A, reach_mm)) {
        if (touched_at(near->triangle, on_b_A, j)) return true;
      }
    }
    memory_.contact_a = PairMemory::kNone;
    return false;
  }

  /// Whether a place of A's facet `i` is within the tolerance of what facet `j` of B stands for.
  bool touches_at(std::uint32_t i, const Eigen::Vector3d& on_a_B, std::uint32_t j) {
    ++counters_.triangle_tests;
    const FacePoint near = nearest_on_patch(pair_.b, j, on_a_B);
    if (near.distance_squared_mm2 > options_.tolerance_mm * options_.tolerance_mm) return false;
    note_method(i, j);
    is_suspect_ = true;
    touch(i, on_a_B, j, near.point);
    return true;
  }

  /// The same for a place of B.
  bool touched_at(std::uint32_t i, const Eigen::Vector3d& on_b_A, std::uint32_t j) {
    ++counters_.triangle_tests;
    const FacePoint near = nearest_on_patch(pair_.a, i, on_b_A);
    if (near.distance_squared_mm2 > options_.tolerance_mm * options_.tolerance_mm) return false;
    note_method(i, j);
    is_suspect_ = true;
    touch(i, placement_ * near.point, j, pair_.X_BA * on_b_A);
    return true;
  }

  /// Looks for facets within the tolerance: first, at little cost, flat ones that face each other,
  /// as in most contacts, then all.
  void look_for_contact() {
    if (seat_touches()) return;
    visit_near([&](const BvhNode& a, const BvhNode& b) { return may_face(a, b); },
               [&](std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
                 return faces_lie_on_each_other(i, a_B, j);
               });
    if (result_.verdict == Verdict::Contact) return;
    double apart = std::numeric_limits<double>::infinity();
    const double pruned = visit_near([](const BvhNode&, const BvhNode&) { return true; },
                                     [&](std::uint32_t i, const PlacedTriangle& a_B,
                                         std::uint32_t j) { return touches(i, a_B, j, apart); });
    if (result_.verdict == Verdict::Clear) {
      result_.gap_mm = std::max(std::min(apart, pruned), options_.tolerance_mm);
    }
  }

  /// Whether a seat of one body is in contact on a plane of the other one.
  bool seat_touches() {
    if (options_.holes == HoleMode::Paper) return false;
    for (const SeatPlane& a : pair_.a.seat_planes()) {
      const Eigen::Vector3d normal_B = placement_.rotation * a.plane.normal;
      const Eigen::Vector3d origin_B = placement_ * a.plane.origin;
      for (const SeatPlane& b : pair_.b.seat_planes()) {
        if (normal_B.dot(b.plane.normal) > -kOpposite) continue;
        const double apart = std::abs(b.plane.normal.dot(origin_B - b.plane.origin));
        if (apart > kSeatApart * options_.tolerance_mm) continue;
        for (const Seat& seat : pair_.a.seats(a)) {
          const Eigen::Vector3d on_a_B = placement_ * seat.point;
          const auto near = pair_.b.nearest_within(on_a_B, options_.tolerance_mm);
          if (near && touches_at(seat.triangle, on_a_B, near->triangle)) return true;
        }
        for (const Seat& seat : pair_.b.seats(b)) {
          const Eigen::Vector3d on_b_A = X_AB_ * seat.point;
          const auto near = pair_.a.nearest_within(on_b_A, options_.tolerance_mm);
          if (near && touched_at(near->triangle, on_b_A, seat.triangle)) return true;
        }
      }
    }
    return false;
  }

  /// Whether facets of two nodes may face each other.
  bool may_face(const BvhNode& a, const BvhNode& b) const {
    const Eigen::Vector3d normal_B = placement_.rotation * a.normal.cast<double>();
    const double opposite = -normal_B.dot(b.normal.cast<double>());
    const double cosine = a.cosine * b.cosine - a.sine * b.sine;  // of both spreads together
    return a.cosine <= 0.0F || b.cosine <= 0.0F || opposite >= cosine - kConeSlack;
  }

  /// Calls `found(i, facet i of A in B, j)` for facets of wanted nodes whose boxes are within the
  /// tolerance, until it returns true. Returns a lower bound of the distance of those that were
  /// left out.
  template <class WantedNodes, class Found>
  double visit_near(const WantedNodes& wanted_nodes, const Found& found) {
    double left_out = std::numeric_limits<double>::infinity();
    for_each_leaf_pair(
        pair_, scratch_, counters_, wanted_nodes,
        [&](double gap_mm) {
          if (gap_mm > options_.tolerance_mm) left_out = std::min(left_out, gap_mm);
          return gap_mm <= options_.tolerance_mm;
        },
        [&](const BvhNode& leaf_a, const BvhNode& leaf_b) {
          return for_each_near_pair(
              pair_, placement_, leaf_a, leaf_b, options_.tolerance_mm, left_out,
              [this](const ModelTriangle& t) { return takes_part(t); },
              [&](std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
                return !found(i, a_B, j);
              });
        });
    return left_out;
  }

  bool takes_part(const ModelTriangle& t) const {
    return options_.holes == HoleMode::Exact || !t.is_hole;
  }

  /// Calls `visit(i, facet i of A in B, j)` for all facets until it returns false.
  template <class Visit>
  void for_each_pair(const Visit& visit) const {
    for (std::uint32_t i = 0; i < pair_.a.triangles().size(); ++i) {
      const ModelTriangle& a = pair_.a.triangles()[i];
      if (!takes_part(a)) continue;
      const PlacedTriangle a_B = placement_ * a;
      for (std::uint32_t j = 0; j < pair_.b.triangles().size(); ++j) {
        if (takes_part(pair_.b.triangles()[j]) && !visit(i, a_B, j)) return;
      }
    }
  }

  /// Whether two flat facets that face each other within the tolerance have an area in common.
  bool faces_lie_on_each_other(std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
    const ModelTriangle& a = pair_.a.triangles()[i];
    const ModelTriangle& b = pair_.b.triangles()[j];
    if (a_B.normal_B.dot(b.normal) > -kOpposite) return false;
    ++counters_.triangle_tests;
    if (apart_by_planes(a, a_B, b) > options_.tolerance_mm ||
        box_gap(a_B.corners_B, b.corners) > options_.tolerance_mm) {
      return false;
    }
    const auto middle = middle_of_overlap(a_B.corners_B, b.corners, b.normal);
    if (!middle || !is_between_faces(i, j, *middle)) return false;
    note_method(i, j);
    is_suspect_ = true;
    return true;
  }

  /// Whether the exact faces behind two facets come within the tolerance there. Else lowers `apart`
  /// to a bound of their distance.
  bool touches(std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j, double& apart) {
    const ModelTriangle& a = pair_.a.triangles()[i];
    const ModelTriangle& b = pair_.b.triangles()[j];
    ++counters_.triangle_tests;
    const double slack = a.slack_mm + b.slack_mm;
    const double margin = options_.tolerance_mm + slack;
    const double between = apart_by_planes(a, a_B, b);
    if (between > options_.tolerance_mm) {
      apart = std::min(apart, between);
      return false;
    }
    if (const double gap = box_gap(a_B.corners_B, b.corners); gap > margin) {
      apart = std::min(apart, gap - slack);
      return false;
    }
    note_method(i, j);
    if (const double gap = std::max(beyond_edges(b.corners, b.normal, a_B.corners_B),
                                    beyond_edges(a_B.corners_B, a_B.normal_B, b.corners));
        gap > margin) {
      apart = std::min(apart, gap - slack);
      return false;
    }
    const ClosestPair closest = closest_points(a_B.corners_B, a_B.normal_B, b.corners, b.normal);
    const double gap = std::sqrt(closest.distance_squared_mm2);
    if (gap > margin) {
      apart = std::min(apart, gap - slack);
      return false;
    }
    is_suspect_ = true;
    if (slack == 0.0) {
      touch(i, closest.on_a, j, closest.on_b);
      return true;
    }
    if (is_between_faces(i, j, closest.on_b)) return true;
    const Eigen::Vector3d middle = 0.5 * (closest.on_a + closest.on_b);
    if (const auto place = find_touch(pair_, middle, i, j, options_.tolerance_mm, reach_mm(a, b))) {
      touch(std::max(0.0, -place->depth_a_mm) + std::max(0.0, -place->depth_b_mm), place->point_B);
      memory_.contact_a = i;
      memory_.contact_b = j;
      memory_.has_contact_place = false;
      return true;
    }
    apart = options_.tolerance_mm;
    return false;
  }

  /// Projects to and fro between the exact faces behind two facets: both ends are real places of
  /// the boundary.
  bool is_between_faces(std::uint32_t i, std::uint32_t j, Eigen::Vector3d on_b) {
    double previous = std::numeric_limits<double>::infinity();
    for (int step = 0; step < kProjections; ++step) {
      const FacePoint near_a = nearest_on_patch(pair_.a, i, X_AB_ * on_b);
      const Eigen::Vector3d on_a = pair_.X_BA * near_a.point;
      const FacePoint near_b = nearest_on_patch(pair_.b, j, on_a);
      if (!std::isfinite(near_a.distance_squared_mm2 + near_b.distance_squared_mm2)) return false;
      on_b = near_b.point;
      const double gap = std::sqrt(near_b.distance_squared_mm2);
      if (gap <= options_.tolerance_mm) {
        touch(i, on_a, j, on_b);
        return true;
      }
      if (previous - gap < kProjectionGain * options_.tolerance_mm) return false;
      previous = gap;
    }
    return false;
  }

  // Interference.

  /// The ball that the last query found, moved with A, is still deep enough in both, or one close
  /// to it is.
  bool knows_ball() {
    if (memory_.ball_depth_a_mm <= 0.0) return false;
    const Eigen::Vector3d ball_B = pair_.X_BA * memory_.ball_A;
    double depth_b = memory_.ball_depth_b_mm - (ball_B - memory_.ball_B).norm();
    const bool is_plain = !options_.measure_depth && pair_.reliefs_B.empty();
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

  bool is_interference() const { return result_.verdict == Verdict::Interference; }

  void look_for_interference() {
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

  /// Whether a witness of interference is found from two facets.
  bool crosses(std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
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
        const Eigen::Vector3d start =
            crossing->start + fraction * (crossing->end - crossing->start);
        if (try_start(start, i, j, reach)) return true;
      }
    }
    if (slack == 0.0 || beyond_edges(b.corners, b.normal, a_B.corners_B) > margin ||
        beyond_edges(a_B.corners_B, a_B.normal_B, b.corners) > margin) {
      return false;
    }
    const ClosestPair closest = closest_points(a_B.corners_B, a_B.normal_B, b.corners, b.normal);
    return closest.distance_squared_mm2 <= margin * margin &&
           try_start(0.5 * (closest.on_a + closest.on_b), i, j, reach);
  }

  /// How far a witness may lie from its start.
  double reach_mm(const ModelTriangle& a, const ModelTriangle& b) const {
    double length_mm = std::numeric_limits<double>::infinity();
    if (a.slack_mm > 0.0) length_mm = longest_edge(a.corners);
    if (b.slack_mm > 0.0) length_mm = std::min(length_mm, longest_edge(b.corners));
    if (!std::isfinite(length_mm)) length_mm = 0.0;  // flat, with straight edges
    return kReachTolerances * options_.tolerance_mm + length_mm;
  }

  void note_method(std::uint32_t i, std::uint32_t j) {
    const ModelTriangle& a = pair_.a.triangles()[i];
    const ModelTriangle& b = pair_.b.triangles()[j];
    if (result_.method == Method::Boxes) result_.method = Method::Facets;
    if (a.slack_mm + b.slack_mm > 0.0) result_.method = Method::Exact;
    const Face& face_a = pair_.a.face(a.face);
    const Face& face_b = pair_.b.face(b.face);
    const double unknown = (is_exact(face_a) ? 0.0 : face_a.facet_error_mm) +
                           (is_exact(face_b) ? 0.0 : face_b.facet_error_mm);
    result_.bound_mm = std::max(result_.bound_mm, unknown);
  }

  bool try_start(const Eigen::Vector3d& start_B, std::uint32_t i, std::uint32_t j, double reach) {
    return try_witness(find_witness(pair_, start_B, i, j, erosion_mm_, reach));
  }

  bool try_witness(const std::optional<Witness>& witness) {
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

  /// Points stored deep in each solid, against the other.
  void look_for_containment() {
    for (const auto& inner : pair_.a.inner_points()) {
      if (try_inner_point(pair_.X_BA * inner.point, inner.depth_mm)) return;
    }
    for (const auto& inner : pair_.b.inner_points()) {
      if (try_inner_point(inner.point, inner.depth_mm)) return;
    }
  }

  bool try_inner_point(const Eigen::Vector3d& point_B, double depth_mm) {
    if (depth_mm < erosion_mm_ || !in_box(pair_.b, point_B) || !in_box(pair_.a, X_AB_ * point_B)) {
      return false;
    }
    return try_witness(test_witness(pair_, point_B, erosion_mm_));
  }

  static bool in_box(const CollisionModel& model, const Eigen::Vector3d& point) {
    const BvhNode& root = model.nodes()[0];
    return (root.min.array() <= point.array()).all() && (point.array() <= root.max.array()).all();
  }

  const ModelPair& pair_;
  Pose X_AB_;
  Placement placement_;
  const QueryOptions& options_;
  PairMemory& memory_;
  NarrowScratch& scratch_;
  QueryCounters& counters_;
  double erosion_mm_;
  bool is_decided_ = false;
  bool is_suspect_ = false;  // facets came within the tolerance and what their faces stand off them
  PairVerdict result_;
};

/// Lower bound of the distance of what two facets stand for; `limit_mm` where it is no less.
double gap_below(double limit_mm, const ModelTriangle& a, const PlacedTriangle& a_B,
                 const ModelTriangle& b) {
  const double slack = a.slack_mm + b.slack_mm;
  const double reach = limit_mm + slack;
  if (apart_by_planes(a, a_B, b) > limit_mm || box_gap(a_B.corners_B, b.corners) > reach ||
      beyond_edges(b.corners, b.normal, a_B.corners_B) > reach ||
      beyond_edges(a_B.corners_B, a_B.normal_B, b.corners) > reach) {
    return limit_mm;
  }
  const ClosestPair closest = closest_points(a_B.corners_B, a_B.normal_B, b.corners, b.normal);
  return std::sqrt(closest.distance_squared_mm2) - slack;
}

}  // namespace

PairVerdict judge(const ModelPair& pair, const QueryOptions& options, PairMemory& memory,
                  NarrowScratch& scratch, QueryCounters& counters) {
  Judge judge(pair, options, memory, scratch, counters);
  return judge.recall() ? judge.result() : judge_afresh(pair, options, memory, scratch, counters);
}

std::optional<PairVerdict> recall(const ModelPair& pair, const QueryOptions& options,
                                  PairMemory& memory, NarrowScratch& scratch,
                                  QueryCounters& counters) {
  Judge judge(pair, options, memory, scratch, counters);
  if (!judge.recall()) return std::nullopt;
  return judge.result();
}

PairVerdict judge_afresh(const ModelPair& pair, const QueryOptions& options, PairMemory& memory,
                         NarrowScratch& scratch, QueryCounters& counters) {
  return Judge(pair, options, memory, scratch, counters).decide();
}

PairVerdict judge_by_brute_force(const ModelPair& pair, const QueryOptions& options,
                                 NarrowScratch& scratch, QueryCounters& counters) {
  PairMemory memory;
  return Judge(pair, options, memory, scratch, counters).decide_by_brute_force();
}

double gap_lower_bound_mm(const ModelPair& pair, HoleMode holes, double cap_mm,
                          const KeptOff& kept_off_a, const KeptOff& kept_off_b,
                          NarrowScratch& scratch, QueryCounters& counters) {
  double best = cap_mm;
  const Placement placement(pair.X_BA);
  for_each_leaf_pair(
      pair, scratch, counters,
      [&](const BvhNode& a, const BvhNode& b) {
        return !kept_off_a.contains(a) && !kept_off_b.contains(b);
      },
      [&](double gap) { return gap < best && best > 0.0; },
      [&](const BvhNode& leaf_a, const BvhNode& leaf_b) {
        double left_out = std::numeric_limits<double>::infinity();  // is no less than best
        for_each_near_pair(
            pair, placement, leaf_a, leaf_b, best, left_out,
            [&](const ModelTriangle& t) { return holes == HoleMode::Exact || !t.is_hole; },
            [&](std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
              ++counters.triangle_tests;
              best = std::min(best,
                              gap_below(best, pair.a.triangles()[i], a_B, pair.b.triangles()[j]));
              return true;
            });
        return best > 0.0;
      });
  return std::max(best, 0.0);
}

}  // namespace dowel
