// Dragging: motions within what mates leave free, to the first touch and along what was met.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "allowed_motion.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"
#include "mate_graph.h"
#include "session_impl.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// A slide that meets more than this many things one after the other ends at the last.
constexpr int kMostMet = 16;

/// Way on which a direction is tried, in tolerances: far enough that a part which enters another
/// by as much as a microradian shows.
constexpr double kProbe = 100.0;

/// Steps of halving: from a right angle to a nanoradian, and from the way of a tolerance to less
/// than kMinTolerance_mm.
constexpr int kHalvings = 32;

/// A slide shorter than this share of the tolerance is none.
constexpr double kStandsStill = 1.0e-2;

DragMode drag_mode(const DragRequest& request, CheckMode mode) {
  if (request.mode) return *request.mode;
  switch (mode) {
    case CheckMode::Block:
      return DragMode::Block;
    case CheckMode::Warn:
      return DragMode::Warn;
    case CheckMode::Off:
      return DragMode::Off;
  }
  DOWEL_EXPECTS(false && "a known mode");
  return DragMode::Block;
}

/// Names the freedoms in a refusal: "slides along ...".
std::string told(const std::vector<Freedom>& freedoms) {
  if (freedoms.empty()) return "nothing";
  const auto is_slide = [](const Freedom& f) { return f.kind == Freedom::Kind::Slide; };
  const auto slides = std::ranges::count_if(freedoms, is_slide);
  const auto turns = static_cast<std::ptrdiff_t>(freedoms.size()) - slides;
  const auto counted = [](std::ptrdiff_t count, const char* noun) {
    return std::to_string(count) + " " + noun + (count == 1 ? "" : "s");
  };
  return counted(slides, "slide") + " and " + counted(turns, "turn");
}

/// Slides parts that move as one, from where they are.
class Slider {
 public:
  using Parts = std::vector<PlacedBodies::Part>;

  /// `parts_W`: where they are. `ways`: an orthonormal base of the slides that are free.
  Slider(PlacedBodies& bodies, Parts parts_W, std::vector<Vector3d> ways, double tolerance_mm)
      : bodies_(bodies),
        parts_W_(std::move(parts_W)),
        ways_(std::move(ways)),
        tolerance_mm_(tolerance_mm) {}

  const Vector3d& gone_mm() const { return gone_mm_; }
  const std::vector<Touch>& stopped_by() const { return stopped_by_; }

  /// As far as the way is free; true where that is all of it. What it stops at it touches, rather
  /// than enters by as much as the tolerance allows.
  bool go(const Vector3d& by_mm) {
    const PlacedBodies::Path path =
        bodies_.sweep(parts_W_, {shifted(gone_mm_), shifted(gone_mm_ + by_mm)}, tolerance_mm_);
    if (path.touches.empty()) {
      gone_mm_ += by_mm;
      return true;
    }
    stopped_by_ = path.touches;
    const double free_mm = (path.X_WU_free.translation() - gone_mm_).dot(by_mm.normalized());
    gone_mm_ += touching_mm(by_mm.normalized(), free_mm) * by_mm.normalized();
    return false;
  }

  /// The free direction nearest to `wish`, along what stopped it; nothing where none is.
  std::optional<Vector3d> along(const Vector3d& wish) const {
    const Vector3d ahead = wish.normalized();
    std::vector<Vector3d> sides;
    for (const Vector3d& way : ways_) {
      const Vector3d side = way - ahead.dot(way) * ahead;
      if (side.norm() > kRounding) sides.push_back(side.normalized());
    }
    std::optional<Vector3d> best;
    for (const Vector3d& aside : around(ahead, sides)) {
      const auto direction = first_free(ahead, aside);
      if (direction && (!best || direction->dot(ahead) > best->dot(ahead))) best = direction;
    }
    return best;
  }

 private:
  static Pose shifted(const Vector3d& by_mm) { return Pose::from_translation(by_mm); }

  bool is_free(const Vector3d& at_mm) const {
    Parts there = parts_W_;
    for (PlacedBodies::Part& part : there) part.pose = shifted(at_mm) * part.pose;
    return worst(bodies_.check(there, kMinTolerance_mm)) != Verdict::Interference;
  }

  /// Up to `free_mm` along `direction`: where nothing is entered yet.
  double touching_mm(const Vector3d& direction, double free_mm) const {
    double near_mm = std::max(0.0, free_mm - 4.0 * tolerance_mm_);
    if (!is_free(gone_mm_ + near_mm * direction)) return free_mm;
    double far_mm = free_mm;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle_mm = std::midpoint(near_mm, far_mm);
      (is_free(gone_mm_ + middle_mm * direction) ? near_mm : far_mm) = middle_mm;
    }
    return near_mm;
  }

  /// Directions across `ahead` into which it may be turned aside: two in a plane, eight in space.
  static std::vector<Vector3d> around(const Vector3d& ahead, const std::vector<Vector3d>& sides) {
    if (sides.empty()) return {};
    const Vector3d& one = sides.front();
    const Vector3d other = ahead.cross(one);
    const bool is_space = std::ranges::any_of(
        sides, [&](const Vector3d& side) { return std::abs(side.dot(other)) > kParallel_rad; });
    if (!is_space) return {one, -one};
    std::vector<Vector3d> result;
    constexpr int kCount = 8;
    for (int i = 0; i < kCount; ++i) {
      const double angle_rad = 2.0 * std::numbers::pi * i / kCount;
      result.push_back(std::cos(angle_rad) * one + std::sin(angle_rad) * other);
    }
    return result;
  }

  /// `ahead` turned to `aside` as little as can be.
  std::optional<Vector3d> first_free(const Vector3d& ahead, const Vector3d& aside) const {
    const double probe_mm = kProbe * tolerance_mm_;
    const auto turned = [&](double angle_rad) {
      return Vector3d(std::cos(angle_rad) * ahead + std::sin(angle_rad) * aside);
    };
    double blocked_rad = 0.0;
    double free_rad = 0.5 * std::numbers::pi - kParallel_rad;
    if (!is_free(gone_mm_ + probe_mm * turned(free_rad))) return std::nullopt;
    for (int i = 0; i < kHalvings; ++i) {
      const double middle_rad = std::midpoint(blocked_rad, free_rad);
      const bool is_open = is_free(gone_mm_ + probe_mm * turned(middle_rad));
      (is_open ? free_rad : blocked_rad) = middle_rad;
    }
    return turned(free_rad);
  }

  PlacedBodies& bodies_;
  Parts parts_W_;
  std::vector<Vector3d> ways_;
  double tolerance_mm_;
  Vector3d gone_mm_ = Vector3d::Zero();
  std::vector<Touch> stopped_by_;
};

/// Goes on along what is met, by what of the rest of the way leads along it.
bool slide(Slider& slider, const Vector3d& by_mm, double tolerance_mm) {
  Vector3d rest_mm = by_mm;
  bool slid = false;
  for (int met = 0; met < kMostMet; ++met) {
    const Vector3d before_mm = slider.gone_mm();
    if (slider.go(rest_mm)) break;
    rest_mm -= slider.gone_mm() - before_mm;
    const auto along = slider.along(by_mm - slider.gone_mm());
    if (!along) break;
    rest_mm = along->dot(by_mm - slider.gone_mm()) * *along;
    if (rest_mm.norm() <= kStandsStill * tolerance_mm) break;
    slid = true;
  }
  return slid;
}

}  // namespace

std::string_view to_string(DragMode mode) {
  switch (mode) {
    case DragMode::Block:
      return "block";
    case DragMode::Slide:
      return "slide";
    case DragMode::Warn:
      return "warn";
    case DragMode::Off:
      return "off";
  }
  DOWEL_EXPECTS(false && "a known mode");
  return {};
}

std::vector<Freedom> Session::Impl::group_freedoms(const std::set<std::string>& group,
                                                   const std::string& name) {
  const NamedProblem named = problem(state(), group);
  const Pose X_WG = state().find(name)->X_WI;
  // One body for the group, and the others as they are.
  MateProblem as_one;
  as_one.bodies.push_back({X_WG, false});
  std::vector<std::size_t> place(named.bodies.size(), 0);
  for (std::size_t i = 0; i < named.bodies.size(); ++i) {
    if (group.contains(named.bodies[i])) continue;
    place[i] = as_one.bodies.size();
    as_one.bodies.push_back({named.problem.bodies[i].X_WB, true});
  }
  const auto in_group = [&](std::size_t body) {
    return X_WG.inverse() * named.problem.bodies[body].X_WB;
  };
  for (const std::vector<Joint>& mate : named.problem.mates) {
    std::vector<Joint> joints;
    for (Joint joint : mate) {
      if (place[joint.a] == place[joint.b]) continue;
      if (place[joint.a] == 0) joint.X_AF = in_group(joint.a) * joint.X_AF;
      if (place[joint.b] == 0) joint.X_BG = in_group(joint.b) * joint.X_BG;
      joint.a = place[joint.a];
      joint.b = place[joint.b];
      joints.push_back(joint);
    }
    if (!joints.empty()) as_one.mates.push_back(std::move(joints));
  }
  return freedoms_of(solve_mates(as_one), 0);
}

void Session::Impl::refuse_drag(const DragRequest& request, const std::vector<Freedom>& freedoms) {
  refuse(request.instance + " cannot " + (request.turn_rad == 0.0 ? "slide" : "turn") +
         " like that: its mates leave it " + told(freedoms) + "; see `freedoms " +
         request.instance + "`");
}

std::optional<Vector3d> Session::Impl::turn_axis(const DragRequest& request,
                                                 const std::vector<Freedom>& freedoms) {
  std::optional<Vector3d> axis_W = request.axis_W;
  for (const Freedom& freedom : freedoms) {
    if (request.axis_W || freedom.kind != Freedom::Kind::Turn) continue;
    if (axis_W) {
      refuse(request.instance + " can turn about more than one axis: name one with `about`");
    }
    axis_W = freedom.axis_W;
  }
  return axis_W;
}

std::optional<std::vector<Pose>> Session::Impl::drag_frames(const DragRequest& request,
                                                            const std::vector<Freedom>& freedoms,
                                                            DragReport& report) {
  const Instance& before = instance(request.instance);
  if (request.turn_rad == 0.0) {
    report.allowed_mm_W = allowed_slide(freedoms, request.by_mm_W);
    if (report.allowed_mm_W.norm() <= kCoincident_mm) return std::nullopt;
    return std::vector<Pose>{Pose(), Pose::from_translation(report.allowed_mm_W)};
  }
  const Vector3d point_W = request.point_W.value_or(before.X_WI.translation());
  const auto axis_W = turn_axis(request, freedoms);
  const auto screw = axis_W ? allowed_turn(freedoms, *axis_W, point_W) : std::nullopt;
  if (!screw) return std::nullopt;
  report.allowed_rad = request.turn_rad;
  return screw_path(*screw, request.turn_rad, before.X_WI * element(before.element).obb.center);
}

Pose Session::Impl::drag_end(const std::vector<PlacedBodies::Part>& parts_U,
                             const std::vector<Pose>& X_WU, const std::vector<Freedom>& freedoms,
                             DragMode mode, DragReport& report) {
  MoveReport& move = report.move;
  const double tolerance_mm = state().tolerance_mm;
  const double way_mm = report.allowed_mm_W.norm();
  if (mode == DragMode::Warn || way_mm == 0.0) {
    const PlacedBodies::Path path = bodies.sweep(parts_U, X_WU, tolerance_mm);
    move.free_share = path.free_share;
    move.stopped_by = path.touches;
    return mode == DragMode::Warn ? X_WU.back() : path.X_WU_free;
  }
  std::vector<Vector3d> ways;
  for (const Freedom& freedom : freedoms) {
    if (freedom.kind == Freedom::Kind::Slide) ways.push_back(freedom.axis_W);
  }
  Slider slider(bodies, parts_U, std::move(ways), tolerance_mm);
  if (mode == DragMode::Slide) {
    report.slid = slide(slider, report.allowed_mm_W, tolerance_mm);
  } else {
    slider.go(report.allowed_mm_W);
  }
  move.stopped_by = slider.stopped_by();
  if (!move.stopped_by.empty()) move.free_share = std::min(1.0, slider.gone_mm().norm() / way_mm);
  return Pose::from_translation(slider.gone_mm());
}

ProjectState Session::Impl::dragged(const std::vector<PlacedBodies::Part>& parts_U,
                                    const Pose& X_WU) {
  ProjectState next = state();
  for (const PlacedBodies::Part& part : parts_U) {
    const Pose X_WI = X_WU * part.pose;
    expect_in_reach(X_WI, part.name);
    next.instances.at(part.name).X_WI = settled(X_WI);
  }
  return next;
}

bool Session::Impl::keeps_mates(const std::vector<PlacedBodies::Part>& parts_U, const Pose& X_WU) {
  const ProjectState next = dragged(parts_U, X_WU);
  PartNames moved;
  for (const PlacedBodies::Part& part : parts_U) moved.insert(part.name);
  return std::ranges::all_of(state().mates, [&](const auto& entry) {
    const PartNames on = parts_of(entry.second);
    const bool may_change =
        std::ranges::any_of(on, [&](const std::string& part) { return moved.contains(part); });
    return !may_change || !holds(entry.second, state()) || holds(entry.second, next);
  });
}

DragReport Session::drag(const DragRequest& request, std::string_view command) {
  const Instance before = impl_->movable(request.instance);
  const PartNames group = sub_assembly_of(state(), before.name);
  const std::vector<Freedom> freedoms = impl_->group_freedoms(group, before.name);
  const DragMode mode = drag_mode(request, state().mode);
  DragReport report;
  report.asked_mm_W = request.by_mm_W;
  const auto frames = impl_->drag_frames(request, freedoms, report);
  if (!frames) {
    if (!is_in_loop(state(), group)) impl_->refuse_drag(request, freedoms);
    return impl_->drag_linkage(request, mode, command);
  }
  const std::vector<Pose>& X_WU = *frames;

  MoveReport& move = report.move;
  move.instance = before.name;
  move.checked = mode != DragMode::Off;
  impl_->bodies.follow(state());
  const auto parts_U = impl_->parts(group, before.name, X_WU.front());
  expect_in_reach(X_WU.back() * parts_U.front().pose, before.name);
  if (!impl_->keeps_mates(parts_U, X_WU.back())) {
    return impl_->drag_linkage(request, mode, command);
  }
  Pose X_WU_end = X_WU.back();
  const auto touches_at = [&](const Pose& at) {
    return impl_->check_parts(parts_U, at, state().tolerance_mm);
  };
  // Out of an interference there must be a way: then the end alone counts.
  if (move.checked && worst(touches_at(X_WU.front())) != Verdict::Interference) {
    X_WU_end = impl_->drag_end(parts_U, X_WU, freedoms, mode, report);
  }
  if (move.checked) move.touches = touches_at(X_WU_end);
  move.verdict = worst(move.touches);
  const bool is_stuck =
      !move.stopped_by.empty() &&
      move.free_share * report.allowed_mm_W.norm() <= kStandsStill * state().tolerance_mm &&
      (request.turn_rad == 0.0 || move.free_share == 0.0);
  if (move.checked && mode != DragMode::Warn &&
      (is_stuck || move.verdict == Verdict::Interference)) {
    move.refused = true;
    move.free_share = 0.0;
    if (is_stuck) move.touches = move.stopped_by;
    move.verdict = worst(move.touches);
    move.X_WI = before.X_WI;
    move.X_WI_free = before.X_WI;
    return report;
  }
  impl_->commit(command, impl_->dragged(parts_U, X_WU_end));
  for (std::size_t i = 1; i < parts_U.size(); ++i) move.moved_along.push_back(parts_U[i].name);
  move.X_WI = instance(before.name).X_WI;
  move.X_WI_free = move.X_WI;
  return report;
}

}  // namespace dowel
