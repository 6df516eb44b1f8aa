// Mates of a session: made beside each other, taken out, and what they leave free.

#include <algorithm>
#include <cmath>

#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"
#include "mate_graph.h"
#include "session_impl.h"

namespace dowel {
namespace {

/// Poses nearer than this are one but for the rounding of the solver.
constexpr double kSamePose_mm = 1.0e-11;

bool is_same_place(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm() <= kSamePose_mm &&
         kMateArm_mm * a.rotation().angularDistance(b.rotation()) <= kSamePose_mm;
}

void expect_two_parts(const MateRequest& request) {
  const std::string& moving = request.moving.instance;
  if (request.fixed.instance == moving) {
    refuse(moving + " cannot be mated with itself: expected a feature of another instance");
  }
  if (!request.seat) return;
  if (request.seat->first.instance != moving) {
    refuse("a seat names a face of the part that moves first: expected " + moving + ".FACE, got " +
           request.seat->first.text());
  }
  if (request.seat->second.instance == moving) {
    refuse(moving + " cannot sit on itself: expected a face of another instance");
  }
}

bool is_bad(MateStatus status) {
  return status == MateStatus::Conflicting || status == MateStatus::NearlyRedundant;
}

}  // namespace

std::size_t NamedProblem::index(const std::string& name) const {
  return static_cast<std::size_t>(std::ranges::find(bodies, name) - bodies.begin());
}

NamedProblem Session::Impl::problem(const ProjectState& in, const std::set<std::string>& free) {
  NamedProblem named;
  std::set<std::string> parts = free;
  for (const auto& [number, mate] : in.mates) {
    const std::set<std::string> on = parts_of(mate);
    if (std::ranges::none_of(on, [&](const std::string& part) { return free.contains(part); })) {
      continue;
    }
    parts.insert(on.begin(), on.end());
    named.mates.push_back(mate);
  }
  for (const Instance* placed : in.in_order()) {
    if (!parts.contains(placed->name)) continue;
    named.bodies.push_back(placed->name);
    named.problem.bodies.push_back({placed->X_WI, !free.contains(placed->name)});
  }
  for (const Mate& mate : named.mates) {
    std::vector<Joint> asked = joints(mate, in);
    for (Joint& joint : asked) {
      joint.a = named.index(mate.moving.instance);
      joint.b = named.index(joint.b == 2 ? mate.fixed_face.instance : mate.fixed.instance);
    }
    named.problem.mates.push_back(std::move(asked));
  }
  return named;
}

std::pair<Mate, Pose> Session::Impl::requested(const MateRequest& request) {
  const Pose X_WA = movable(request.moving.instance).X_WI;
  expect_two_parts(request);
  const Pose X_WB = instance(request.fixed.instance).X_WI;
  Mate mate;
  mate.moving = request.moving;
  mate.fixed = request.fixed;
  mate.offset_mm = request.options.offset_mm;
  mate.number = state().mates.empty() ? 1 : state().mates.rbegin()->first + 1;
  if (!request.kind) {
    std::optional<SeatFaces> seat;
    if (request.seat) {
      mate.moving_face = request.seat->first;
      mate.fixed_face = request.seat->second;
      seat = SeatFaces{feature(mate.moving_face).feature, feature(mate.fixed_face)};
    }
    const MatePlacement placement =
        place_by_mate(feature(mate.moving), feature(mate.fixed), seat, request.options);
    mate.kind = placement.kind;
    mate.flip = request.options.flip;
    return {mate, placement.X_WA};
  }
  mate.kind = *request.kind;
  mate.angle_rad = request.angle_rad;
  if (mate.kind == MateKind::Fix) {
    mate.X_FM = settled(X_WB.inverse() * X_WA);
    expect_in_reach(*mate.X_FM, mate.moving.instance);
    return {mate, X_WA};
  }
  const Pose X_BA = X_WB.inverse() * X_WA;
  if (mate.kind == MateKind::Align || mate.kind == MateKind::KeyInSlot) {
    mate.flip = nearest_flip(features(mate), X_BA);
  }
  return {mate, place_by_joint(mate_joints(features(mate), X_BA).front(), X_WA, X_WB)};
}

MateConflict Session::Impl::explain(const NamedProblem& named, const MateSolution& solution,
                                    const Mate& mate) {
  /// More than this, and nobody would read the list.
  constexpr std::size_t kMostTried = 50;
  std::size_t bad = named.mates.size();
  for (std::size_t i = 0; i < named.mates.size(); ++i) {
    if (!is_bad(solution.mates[i].status)) continue;
    if (bad == named.mates.size() || named.mates[i].number == mate.number) bad = i;
  }
  DOWEL_EXPECTS(bad < named.mates.size());
  MateConflict conflict;
  conflict.mate = named.mates[bad];
  conflict.off_mm = solution.mates[bad].off_mm;
  conflict.off_rad = solution.mates[bad].off_rad;
  conflict.is_nearly_redundant = solution.mates[bad].status == MateStatus::NearlyRedundant;
  // What can be left out without mending the conflict is no part of it.
  MateProblem problem = named.problem;
  std::vector<Mate> against = named.mates;
  const auto leave_out = [&](std::size_t i) {
    problem.mates.erase(problem.mates.begin() + static_cast<std::ptrdiff_t>(i));
    against.erase(against.begin() + static_cast<std::ptrdiff_t>(i));
  };
  for (std::size_t i = 0; i < against.size() && against.size() <= kMostTried;) {
    const MateProblem all = problem;
    const std::vector<Mate> all_against = against;
    if (against[i].number == conflict.mate.number) {
      ++i;
      continue;
    }
    leave_out(i);
    const auto at = std::ranges::find(against, conflict.mate.number, &Mate::number);
    const auto index = static_cast<std::size_t>(at - against.begin());
    if (is_bad(solve_mates(problem).mates[index].status)) continue;
    problem = all;
    against = all_against;
    ++i;
  }
  std::erase_if(against, [&](const Mate& m) { return m.number == conflict.mate.number; });
  if (against.size() < kMostTried) conflict.against = std::move(against);
  return conflict;
}

std::optional<MateConflict> Session::Impl::place_all(ProjectState& next, const Mate& mate) {
  const std::string& moving = mate.moving.instance;
  NamedProblem named = problem(next, {moving});
  MateSolution solution = solve_mates(named.problem);
  if (!solution.is_sound()) {
    named = problem(next, free_parts(next, hanging_together(next, moving), mate.fixed.instance));
    solution = solve_mates(named.problem);
    if (!solution.is_sound()) return explain(named, solution, mate);
  }
  for (std::size_t i = 0; i < named.bodies.size(); ++i) {
    Instance& placed = next.instances.at(named.bodies[i]);
    if (is_same_place(placed.X_WI, solution.X_WB[i])) continue;
    expect_in_reach(solution.X_WB[i], placed.name);
    placed.X_WI = settled(solution.X_WB[i]);
  }
  return std::nullopt;
}

MoveReport Session::mate(const MateRequest& request, std::string_view command) {
  const auto [mate, X_WA] = impl_->requested(request);
  const Instance before = impl_->instance(mate.moving.instance);
  ProjectState next = state();
  std::erase_if(next.mates, [&, &made = mate](const auto& entry) {
    const Mate& old = entry.second;
    return old.moving == made.moving && old.fixed == made.fixed &&
           (old.kind == made.kind || !request.kind);
  });
  const auto [entry, is_new] = next.mates.emplace(mate.number, mate);
  DOWEL_EXPECTS(is_new);
  // Where it holds already the part stays to the bit, else it starts from where it would hold.
  const MateResidual off = impl_->residual(mate, next);
  const double off_mm = std::hypot(off.axis_mm, off.along_mm, kMateArm_mm * off.angle_rad);
  const bool is_turned = request.options.rotation_rad != 0.0;
  expect_in_reach(X_WA, before.name);
  if (off_mm > kSamePose_mm || is_turned) {
    next.instances.at(before.name).X_WI = settled(X_WA);
  }

  MoveReport report;
  report.instance = before.name;
  report.X_WI = X_WA;
  report.X_WI_free = X_WA;
  report.conflict = impl_->place_all(next, mate);
  if (report.conflict) {
    report.refused = true;
    report.X_WI = before.X_WI;
    return report;
  }
  return impl_->finish_mate(std::move(report), std::move(next), mate.number, command);
}

MoveReport Session::Impl::finish_mate(MoveReport report, ProjectState next, std::uint32_t number,
                                      std::string_view command) {
  Mate& mate = next.mates.at(number);
  const auto at = [&](const FeatureName& name) {
    return PlacedFeature{feature(name).feature, next.find(name.instance)->X_WI};
  };
  if (mate.kind != MateKind::Fix && mate.kind != MateKind::Angle) {
    mate.thread = expect_fit(mate.moving, at(mate.moving), mate.fixed, at(mate.fixed));
  }
  report.made = mate;
  std::vector<std::string> moved{report.instance};
  for (const Instance* placed : next.in_order()) {
    if (placed->name == report.instance || placed->X_WI == state().find(placed->name)->X_WI) {
      continue;
    }
    moved.push_back(placed->name);
    report.moved_along.push_back(placed->name);
  }
  report.checked = state().mode != CheckMode::Off;
  if (report.checked) report.touches = check_all_of(next, moved);
  report.verdict = worst(report.touches);
  report.X_WI = next.find(report.instance)->X_WI;
  report.X_WI_free = report.X_WI;
  if (report.verdict == Verdict::Interference) report.free_share = 0.0;
  report.refused = state().mode == CheckMode::Block && report.verdict == Verdict::Interference;
  if (report.refused) {
    report.X_WI = state().find(report.instance)->X_WI;
    report.made.reset();
    return report;
  }
  for (const std::string& name : moved) {
    for (Mate& dropped : drop_broken(next, name)) report.dropped.push_back(std::move(dropped));
  }
  commit(command, next);
  const std::set<std::string> group = hanging_together(state(), report.instance);
  const NamedProblem named =
      problem(state(), free_parts(state(), group, report.made->fixed.instance));
  const MateSolution solution = solve_mates(named.problem);
  for (std::size_t i = 0; i < named.mates.size(); ++i) {
    if (named.mates[i].number == number) {
      report.is_redundant = solution.mates[i].status == MateStatus::Redundant;
    }
  }
  return report;
}

std::vector<Touch> Session::Impl::check_all_of(const ProjectState& next,
                                               const std::vector<std::string>& moved) {
  bodies.follow(next);
  std::vector<Touch> touches;
  for (const std::string& name : moved) {
    for (const Touch& touch : bodies.check(name, next.find(name)->X_WI, next.tolerance_mm)) {
      const bool is_known = std::ranges::any_of(touches, [&](const Touch& other) {
        return other.instance == touch.with && other.with == touch.instance;
      });
      if (!is_known) touches.push_back(touch);
    }
  }
  return touches;
}

void Session::unmate(std::span<const std::uint32_t> numbers, std::string_view command) {
  ProjectState next = state();
  for (const std::uint32_t number : numbers) {
    const std::size_t erased = next.mates.erase(number);
    DOWEL_EXPECTS(erased == 1);
  }
  impl_->commit(command, next);
}

FreedomReport Session::freedoms(std::string_view name) {
  const Instance& instance = impl_->instance(name);
  FreedomReport report;
  const std::set<std::string> group = hanging_together(state(), instance.name);
  const bool has_ground = std::ranges::any_of(
      group, [&](const std::string& part) { return state().find(part)->grounded; });
  std::set<std::string> free = group;
  if (!has_ground && group.size() > 1) {
    for (const Instance* placed : state().in_order()) {
      if (!report.relative_to.empty() || placed->name == instance.name) continue;
      if (group.contains(placed->name)) report.relative_to = placed->name;
    }
  }
  free = free_parts(state(), group, report.relative_to);
  const NamedProblem named = impl_->problem(state(), free);
  const MateSolution solution = solve_mates(named.problem);
  if (!instance.grounded) {
    report.freedoms = freedoms_of(solution, named.index(instance.name));
  }
  for (std::size_t i = 0; i < named.mates.size(); ++i) {
    if (parts_of(named.mates[i]).contains(instance.name)) {
      report.mates.push_back({named.mates[i], solution.mates[i]});
    }
  }
  return report;
}

}  // namespace dowel
