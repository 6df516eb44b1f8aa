// First interference of a motion, by steps that cannot jump over one.

#include <algorithm>
#include <cmath>

#include "dowel/collision/box_separation.h"
#include "dowel/kernel/check.h"
#include "scene_impl.h"

namespace dowel {
namespace {

/// A step in contact, in tolerances: the depth grows by no more than the way gone, so that an
/// interference is met before it is this much deeper than the tolerance.
constexpr double kContactStep = 0.5;

/// Accuracy of the time of impact, in tolerances of way.
constexpr double kImpactAccuracy = 0.125;

/// The motion of one moving body.
struct BodyMotion {
  const Pose& from;
  const Pose& to;
  const Pose& X_UB;
  double speed_mm;  ///< no point of the body goes further than this over the whole motion

  BodyMotion(const Pose& start, const Pose& end, const Pose& in_unit, const Obb& obb_B)
      : from(start), to(end), X_UB(in_unit), speed_mm(0.0) {
    double radius = 0.0;
    for (const Eigen::Vector3d& corner : obb_B.corners()) {
      radius = std::max(radius, (X_UB * corner).norm());
    }
    const double angle = start.rotation().angularDistance(end.rotation());
    speed_mm = (end.translation() - start.translation()).norm() + angle * radius;
  }
  Pose at(double time) const { return interpolate(from, to, time) * X_UB; }
};

}  // namespace

SweepResult CollisionScene::sweep(std::span<const BodyId> moving, std::span<const Pose> X_UB,
                                  const Pose& from, const Pose& to, const QueryOptions& options) {
  DOWEL_EXPECTS(moving.size() == X_UB.size());
  DOWEL_EXPECTS(options.tolerance_mm >= kMinTolerance_mm);
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
    const double bulge =
        from.rotation().angularDistance(to.rotation()) == 0.0 ? 0.0 : 0.5 * motion.speed_mm;
    impl_->projection.query(swept.padded(options.tolerance_mm + bulge), candidates);
    for (const std::uint32_t other : candidates) {
      if (impl_->bodies[other].is_moving) continue;
      const BodyId with{other};
      const Obb& obb_W = impl_->bodies[other].obb_W;
      PairMemory memory;
      const auto judge_at = [&](double time) {
        return impl_->judge_bodies(moving[i], motion.at(time), with, options, memory);
      };
      double time = 0.0;
      double free_time = 0.0;
      bool touches = false;
      PairVerdict contact;
      while (time <= result.time_of_impact) {
        const Obb moving_obb = transformed(motion.at(time), element.obb());
        ++impl_->counters.box_tests;
        const BoxSeparation boxes = separate(moving_obb, obb_W, options.tolerance_mm);
        double step_mm = boxes.gap_mm;
        if (boxes.plane < 0) {
          const Pose X_BA = impl_->bodies[other].X_WB.inverse() * motion.at(time);
          const ModelPair pair{element.model(),
                               impl_->bodies[other].element->model(),
                               element.obb(),
                               impl_->bodies[other].element->obb(),
                               X_BA,
                               {}};
          const double left_mm = (result.time_of_impact - time) * motion.speed_mm;
          step_mm = gap_lower_bound_mm(pair, options.holes, left_mm + 2.0 * options.tolerance_mm,
                                       impl_->scratch, impl_->counters);
          // Far from touching: only containment is left, which cannot begin without crossing.
          if (step_mm <= options.tolerance_mm || time == 0.0) {
            const PairVerdict verdict = judge_at(time);
            if (verdict.verdict == Verdict::Interference) {
              // Halve between the last free time and now.
              double hit = time;
              PairVerdict at_hit = verdict;
              while ((hit - free_time) * motion.speed_mm > kImpactAccuracy * options.tolerance_mm) {
                const double middle = 0.5 * (free_time + hit);
                const PairVerdict there = judge_at(middle);
                if (there.verdict == Verdict::Interference) {
                  hit = middle;
                  at_hit = there;
                } else {
                  free_time = middle;
                }
              }
              if (hit < result.time_of_impact || result.verdict != Verdict::Interference) {
                result.verdict = Verdict::Interference;
                result.time_of_impact = hit;
                result.free_pose = interpolate(from, to, free_time);
                result.pairs.clear();
              }
              result.pairs.push_back({moving[i], with, at_hit});
              break;
            }
            if (verdict.verdict == Verdict::Contact && !touches) {
              touches = true;
              contact = verdict;
            }
            step_mm = std::max(step_mm, kContactStep * options.tolerance_mm);
          }
        }
        free_time = time;
        if (time >= result.time_of_impact || motion.speed_mm == 0.0) break;
        time = std::min(time + step_mm / motion.speed_mm, result.time_of_impact);
      }
      if (touches) touched.push_back({moving[i], with, contact});
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
