// First interference of a motion, by steps that cannot jump over one.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "dowel/collision/axis_profile.h"
#include "dowel/collision/box_separation.h"
#include "dowel/kernel/check.h"
#include "kept_off.h"
#include "scene_impl.h"

namespace dowel {
namespace {

/// A step in contact, in tolerances: the depth grows by no more than the way gone, so that an
/// interference is met before it is this much deeper than the tolerance.
constexpr double kContactStep = 0.5;

/// A step that is this small a share of the way left is worth a look at what cannot interfere on
/// it.
constexpr double kShortStep = 1.0 / 16.0;

/// Accuracy of the time of impact, in tolerances of way.
constexpr double kImpactAccuracy = 0.125;

/// A shaft whose axis leaves its own line by less than this moves along it.
constexpr double kAlongAxis_mm = 1.0e-9;

/// Angles below this are none.
constexpr double kNoTurn_rad = 1.0e-12;

/// The motion of one body.
class BodyMotion {
 public:
  BodyMotion(const Pose& start, const Pose& end, const Pose& in_unit, const Obb& obb_B)
      : from_(start), to_(end), X_UB_(in_unit) {
    const Eigen::Quaterniond turn = end.rotation() * start.rotation().conjugate();
    const Eigen::AngleAxisd angle_axis(turn.w() < 0.0 ? Eigen::Quaterniond(-turn.coeffs()) : turn);
    angle_rad_ = angle_axis.angle();
    axis_W_ = angle_axis.axis();
    way_W_ = end.translation() - start.translation();
    double radius = 0.0;  // of the box about the axis of the turn
    for (const Eigen::Vector3d& corner : obb_B.corners()) {
      const Eigen::Vector3d p = start.rotation() * (X_UB_ * corner);
      radius = std::max(radius, (p - axis_W_ * axis_W_.dot(p)).norm());
    }
    speed_mm_ = way_W_.norm() + angle_rad_ * radius;
  }

  Pose at(double time) const { return interpolate(from_, to_, time) * X_UB_; }

  /// No point of the body goes further than this over the whole motion.
  double speed_mm() const { return speed_mm_; }
  double angle_rad() const { return angle_rad_; }
  bool is_turn() const { return angle_rad_ > kNoTurn_rad; }
  bool is_shift() const { return way_W_.norm() > 0.0; }
  const Eigen::Vector3d& axis_W() const { return axis_W_; }
  const Eigen::Vector3d& way_W() const { return way_W_; }

  /// Where the turn is about, if the unit's origin does not move.
  Eigen::Vector3d pivot_W(double time) const { return interpolate(from_, to_, time).translation(); }

  /// Lower bound of `direction . p` over the rest of the motion, for the place p of a point of the
  /// body: the least of the shift plus the least of the turn.
  double least_along(const Eigen::Vector3d& direction_W, const Eigen::Vector3d& point_B,
                     double time) const {
    const Pose X_WU = interpolate(from_, to_, time);
    const Eigen::Vector3d arm = X_WU.rotation() * (X_UB_ * point_B);
    const double left = 1.0 - time;
    return direction_W.dot(X_WU.translation()) + std::min(0.0, left * direction_W.dot(way_W_)) +
           least_of_turn(direction_W, arm, left * angle_rad_);
  }

  /// The least of `direction . arm` while the arm turns by up to `angle`.
  double least_of_turn(const Eigen::Vector3d& direction_W, const Eigen::Vector3d& arm_W,
                       double angle) const {
    const double along = direction_W.dot(axis_W_) * axis_W_.dot(arm_W);
    const double cosine_part = direction_W.dot(arm_W) - along;
    const double sine_part = direction_W.dot(axis_W_.cross(arm_W));
    // along + cosine_part cos(phi) + sine_part sin(phi), with its least at phase + pi
    double least =
        std::min(cosine_part, cosine_part * std::cos(angle) + sine_part * std::sin(angle));
    const double phase = std::atan2(-sine_part, -cosine_part);
    const double lowest_at = phase < 0.0 ? phase + 2.0 * std::numbers::pi : phase;
    if (lowest_at <= angle) least = -std::hypot(cosine_part, sine_part);
    return along + least;
  }

 private:
  const Pose& from_;
  const Pose& to_;
  const Pose& X_UB_;
  double angle_rad_ = 0.0;
  Eigen::Vector3d axis_W_;
  Eigen::Vector3d way_W_;
  double speed_mm_ = 0.0;
};

}  // namespace

/// Follows one moving body past one placed body.
class CollisionScene::Impl::PairSweep {
 public:
  PairSweep(Impl& scene, BodyId moving, BodyId with, const BodyMotion& motion,
            const QueryOptions& options)
      : scene_(scene),
        moving_(moving),
        with_(with),
        motion_(motion),
        options_(options),
        a_(*scene.bodies[moving.value].element),
        b_(*scene.bodies[with.value].element),
        obb_b_W_(scene.bodies[with.value].obb_W()),
        X_BW_(scene.bodies[with.value].X_WB.inverse()) {}

  /// Follows the motion up to `until`; true where it meets an interference before.
  bool run(double until) {
    double time = 0.0;
    while (true) {
      double step_mm = 0.0;
      if (const double gap_mm = box_gap_mm(time); gap_mm > 0.0) {
        step_mm = gap_mm;
      } else {
        verdict_ = judge_at(time);
        if (verdict_.verdict == Verdict::Interference) {
          narrow_down(time);
          return true;
        }
        if (verdict_.verdict == Verdict::Contact) note_contact();
        if (verdict_.verdict == Verdict::Clear) step_mm = verdict_.gap_mm;
        // What slides close by stays behind a plane as what slides in contact does.
        if (step_mm < kShortStep * (until - time) * motion_.speed_mm()) {
          step_mm = std::max(step_mm, step_in_contact(time, until));
        }
      }
      free_time_ = time;
      if (time >= until || motion_.speed_mm() == 0.0) return false;
      time = std::min(time + step_mm / motion_.speed_mm(), until);
    }
  }

  double free_time() const { return free_time_; }
  double hit_time() const { return hit_time_; }
  /// At the hit.
  const PairVerdict& verdict() const { return verdict_; }
  /// First contact on the way.
  const std::optional<PairVerdict>& contact() const { return contact_; }

 private:
  PairVerdict judge_at(double time) {
    return scene_.judge_bodies(moving_, motion_.at(time), with_, options_, memory_);
  }

  void note_contact() {
    if (!contact_) contact_ = verdict_;
  }

  /// Distance of the boxes where it exceeds the tolerance; else not positive.
  double box_gap_mm(double time) {
    ++scene_.counters.box_tests;
    const BoxSeparation boxes =
        separate(transformed(motion_.at(time), a_.obb()), obb_b_W_, options_.tolerance_mm, plane_);
    plane_ = boxes.plane;
    return boxes.plane < 0 ? 0.0 : boxes.gap_mm;
  }

  /// How far the body may go from where it touches, or hardly does not, until an interference is
  /// possible.
  double step_in_contact(double time, double until) {
    const double left_mm = (until - time) * motion_.speed_mm();
    if (shaft_stays_in_bore(time)) return left_mm;
    const KeptOff a_off = planes_of_mover(time);
    const KeptOff b_off = planes_of_placed(time);
    double gap_mm = 0.0;
    if (!a_off.is_empty() || !b_off.is_empty()) {
      const Pose X_BA = X_BW_ * motion_.at(time);
      const ModelPair pair{a_.model(), b_.model(), a_.obb(), b_.obb(), X_BA, {}};
      gap_mm = gap_lower_bound_mm(pair, options_.holes, left_mm, a_off, b_off, scene_.scratch,
                                  scene_.counters);
    }
    return std::max(gap_mm, kContactStep * options_.tolerance_mm);
  }

  /// Planes of the placed body that keep the moving box off for the rest of the motion.
  KeptOff planes_of_placed(double time) const {
    const Pose& X_WB = scene_.bodies[with_.value].X_WB;
    const auto corners = a_.obb().corners();
    return {b_.model(), options_.tolerance_mm, [&](const PlaneSurface& plane) {
              const Eigen::Vector3d normal_W = X_WB.rotation() * plane.normal;
              double least = std::numeric_limits<double>::infinity();
              for (const Eigen::Vector3d& corner : corners) {
                least = std::min(least, motion_.least_along(normal_W, corner, time));
              }
              return least - normal_W.dot(X_WB * plane.origin);
            }};
  }

  /// Planes of the moving body that keep the placed box off for the rest of the motion. Only for a
  /// shift: planes that turn and shift are not followed.
  KeptOff planes_of_mover(double time) const {
    if (motion_.is_turn()) return {};
    const Pose X_WA = motion_.at(time);
    return {a_.model(), options_.tolerance_mm, [&](const PlaneSurface& plane) {
              const Eigen::Vector3d normal_W = X_WA.rotation() * plane.normal;
              const double reach =
                  (obb_b_W_.axes.transpose() * normal_W).cwiseAbs().dot(obb_b_W_.half_extents_mm);
              const double now = normal_W.dot(obb_b_W_.center - X_WA * plane.origin) - reach;
              return now - std::max(0.0, (1.0 - time) * normal_W.dot(motion_.way_W()));
            }};
  }

  /// Whether the rest of the motion moves a shaft along and about the axis of the bore that it fits
  /// into, and all of its body finds room there.
  bool shaft_stays_in_bore(double time) const {
    if (memory_.shaft == PairMemory::kNone) return false;
    const CollisionElement& with_shaft = memory_.shaft_is_in_a ? a_ : b_;
    const CollisionElement& with_bore = memory_.shaft_is_in_a ? b_ : a_;
    const AxisProfile& shaft = with_shaft.model().profiles().shafts[memory_.shaft];
    const AxisProfile& bore = with_bore.model().profiles().bores[memory_.bore];
    const Pose X_BA = X_BW_ * motion_.at(time);
    const Pose X_BA_end = X_BW_ * motion_.at(1.0);
    const Pose X_VS = memory_.shaft_is_in_a ? X_BA : X_BA.inverse();
    const Pose X_VS_end = memory_.shaft_is_in_a ? X_BA_end : X_BA_end.inverse();
    const Eigen::Vector3d way = X_VS_end * shaft.origin - X_VS * shaft.origin;
    const double travel_mm = bore.direction.dot(way);
    const bool is_along = (way - travel_mm * bore.direction).norm() <= kAlongAxis_mm;
    if (!is_along || (motion_.is_turn() && !turns_about(shaft, time))) return false;
    const std::span<const ThreadRelief> reliefs_V =
        memory_.shaft_is_in_a ? scene_.reliefs_in(moving_, with_, X_BA)
                              : scene_.reliefs_in(with_, moving_, X_BA.inverse());
    return fit(shaft, bore, X_VS, options_.tolerance_mm, reliefs_V, travel_mm).is_free;
  }

  /// Whether the motion turns about the axis of a shaft, which then stays on its line. The turn is
  /// about the unit's origin, whose way is straight.
  bool turns_about(const AxisProfile& shaft, double time) const {
    const Pose X_WS = memory_.shaft_is_in_a ? motion_.at(time) : scene_.bodies[with_.value].X_WB;
    const Eigen::Vector3d direction_W = X_WS.rotation() * shaft.direction;
    if (direction_W.cross(motion_.axis_W()).norm() > kNoTurn_rad * 1e3) return false;
    const Eigen::Vector3d middle_W = motion_.pivot_W(time);
    const Eigen::Vector3d arm = X_WS * shaft.origin - middle_W;
    return (arm - direction_W.dot(arm) * direction_W).norm() <= kAlongAxis_mm;
  }

  /// Halves between the last free time and an interference.
  void narrow_down(double hit_time) {
    hit_time_ = hit_time;
    while ((hit_time_ - free_time_) * motion_.speed_mm() >
           kImpactAccuracy * options_.tolerance_mm) {
      const double middle = 0.5 * (free_time_ + hit_time_);
      const PairVerdict there = judge_at(middle);
      if (there.verdict == Verdict::Interference) {
        hit_time_ = middle;
        verdict_ = there;
      } else {
        free_time_ = middle;
      }
    }
    // At the edge a witness may be found from one start and not from another: the free pose has to
    // be free for who asks there afresh.
    for (double back_mm = kImpactAccuracy * options_.tolerance_mm; free_time_ > 0.0; back_mm *= 2) {
      PairMemory nothing;
      const PairVerdict there =
          scene_.judge_bodies(moving_, motion_.at(free_time_), with_, options_, nothing);
      if (there.verdict != Verdict::Interference) break;
      hit_time_ = free_time_;
      verdict_ = there;
      free_time_ = std::max(0.0, free_time_ - back_mm / motion_.speed_mm());
    }
  }

  Impl& scene_;
  BodyId moving_;
  BodyId with_;
  const BodyMotion& motion_;
  const QueryOptions& options_;
  const CollisionElement& a_;
  const CollisionElement& b_;
  Obb obb_b_W_;
  Pose X_BW_;
  PairMemory memory_;
  int plane_ = -1;
  double free_time_ = 0.0;
  double hit_time_ = 1.0;
  PairVerdict verdict_;
  std::optional<PairVerdict> contact_;
};

SweepResult CollisionScene::sweep(std::span<const BodyId> moving, std::span<const Pose> X_UB,
                                  const Pose& from, const Pose& to, const QueryOptions& options) {
  DOWEL_EXPECTS(moving.size() == X_UB.size());
  expect_valid(options);
  for (const Pose& X_WU : {from, to}) expect_valid_place(X_WU);
  for (const Pose& in_unit : X_UB) expect_valid_place(in_unit);
  SweepResult result;
  std::vector<BodyVerdict> touched;
  const Impl::MovingMark mark(*impl_, moving);
  std::vector<std::uint32_t> candidates;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const CollisionElement& element = *impl_->body(moving[i]).element;
    const BodyMotion motion(from, to, X_UB[i], element.obb());
    // The way of any point stays within half of it of one of the ends.
    Aabb swept = bounds(transformed(motion.at(0.0), element.obb()));
    swept.extend(bounds(transformed(motion.at(1.0), element.obb())));
    const double bulge = motion.is_turn() ? 0.5 * motion.speed_mm() : 0.0;
    impl_->projection.query(swept.padded(options.tolerance_mm + bulge), candidates);
    for (const std::uint32_t other : candidates) {
      if (impl_->bodies[other].is_moving) continue;
      Impl::PairSweep pair(*impl_, moving[i], BodyId{other}, motion, options);
      if (pair.run(result.time_of_impact)) {
        if (pair.hit_time() < result.time_of_impact || result.verdict != Verdict::Interference) {
          result.verdict = Verdict::Interference;
          result.time_of_impact = pair.hit_time();
          result.free_pose = interpolate(from, to, pair.free_time());
          result.pairs.clear();
        }
        result.pairs.push_back({moving[i], BodyId{other}, pair.verdict()});
      } else if (pair.contact()) {
        touched.push_back({moving[i], BodyId{other}, *pair.contact()});
      }
    }
  }
  if (result.verdict != Verdict::Interference) {
    result.free_pose = to;
    result.pairs = std::move(touched);
    result.verdict = worst(result.pairs);
  }
  std::ranges::sort(result.pairs, {}, [](const BodyVerdict& verdict) {
    return std::pair(verdict.moving, verdict.with);
  });
  return result;
}

}  // namespace dowel
