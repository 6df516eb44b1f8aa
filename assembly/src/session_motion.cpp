// Moves of a session: parts, and what is fixed to them, on swept ways.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "allowed_motion.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"
#include "mate_graph.h"
#include "session_impl.h"

namespace dowel {

std::vector<PlacedBodies::Part> Session::Impl::parts(const std::set<std::string>& group,
                                                     const std::string& first, const Pose& X_WU) {
  const Pose X_UW = X_WU.inverse();
  std::vector<PlacedBodies::Part> result{{first, X_UW * state().find(first)->X_WI}};
  // The frame is often the part's own: then it ends to the bit where it is sent.
  if (state().find(first)->X_WI == X_WU) result.front().pose = Pose();
  for (const Instance* placed : state().in_order()) {
    if (placed->name == first || !group.contains(placed->name)) continue;
    result.push_back({placed->name, X_UW * placed->X_WI});
  }
  return result;
}

std::vector<Touch> Session::Impl::check_parts(const std::vector<PlacedBodies::Part>& parts_U,
                                              const Pose& X_WU, double tolerance_mm) {
  std::vector<PlacedBodies::Part> parts_W = parts_U;
  for (PlacedBodies::Part& part : parts_W) part.pose = X_WU * part.pose;
  return bodies.check(parts_W, tolerance_mm);
}

MoveReport Session::Impl::finish(MoveReport report, const Instance& before, ProjectState next,
                                 std::string_view command) {
  report.instance = before.name;
  report.checked = state().mode != CheckMode::Off;
  report.verdict = worst(report.touches);
  report.refused = state().mode == CheckMode::Block && report.verdict == Verdict::Interference;
  if (report.refused) {
    report.X_WI = before.X_WI;
    report.made.reset();
    return report;
  }
  const auto unit = parts(unit_of(state(), before.name), before.name, before.X_WI);
  for (const PlacedBodies::Part& part : unit) {
    const Pose X_WI = report.X_WI * part.pose;
    expect_in_reach(X_WI, part.name);
    next.instances.at(part.name).X_WI = settled(X_WI);
    if (part.name != before.name) report.moved_along.push_back(part.name);
  }
  for (const PlacedBodies::Part& part : unit) {
    for (Mate& mate : drop_broken(next, part.name)) report.dropped.push_back(std::move(mate));
  }
  commit(command, next);
  report.X_WI = instance(report.instance).X_WI;
  return report;
}

MoveReport Session::Impl::travel(std::string_view name, const std::vector<Pose>& X_WU,
                                 const Pose& X_WI, std::string_view command) {
  const Instance before = movable(name);
  expect_in_reach(X_WI, before.name);
  MoveReport report;
  report.X_WI = X_WI;
  report.X_WI_free = X_WI;
  if (state().mode != CheckMode::Off) {
    const double tolerance_mm = state().tolerance_mm;
    const auto unit = parts(unit_of(state(), before.name), before.name, before.X_WI);
    bodies.follow(state());
    // Out of an interference there must be a way: then the end alone counts.
    if (worst(check_parts(unit, before.X_WI, tolerance_mm)) != Verdict::Interference) {
      const auto unit_U = parts(unit_of(state(), before.name), before.name, X_WU.front());
      const PlacedBodies::Path path = bodies.sweep(unit_U, X_WU, tolerance_mm);
      report.free_share = path.free_share;
      if (path.free_share < 1.0) report.X_WI_free = path.X_WU_free * unit_U.front().pose;
      report.touches = path.touches;
    }
    if (report.touches.empty()) report.touches = check_parts(unit, X_WI, tolerance_mm);
  }
  return finish(std::move(report), before, state(), command);
}

MoveReport Session::move(std::string_view name, const Eigen::Vector3d& to_W,
                         std::string_view command) {
  DOWEL_EXPECTS(to_W.allFinite());
  const Pose from = impl_->movable(name).X_WI;
  const Pose to(from.rotation(), to_W);
  return impl_->travel(name, {from, to}, to, command);
}

MoveReport Session::rotate(std::string_view name, const Eigen::Vector3d& point_W,
                           const Eigen::Vector3d& axis_W, double angle_rad,
                           std::string_view command) {
  DOWEL_EXPECTS(std::abs(angle_rad) <= 2.0 * std::numbers::pi + kParallel_rad);
  const Pose from = impl_->movable(name).X_WI;
  const Eigen::Vector3d center_W = from * impl_->element(impl_->instance(name).element).obb.center;
  return impl_->travel(name, screw_path({point_W, axis_W, 0.0}, angle_rad, center_W),
                       Pose::about_axis(point_W, axis_W, angle_rad) * from, command);
}

}  // namespace dowel
