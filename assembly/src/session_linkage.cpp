// Dragging parts of loops: what hangs together follows, each part on a way of its own.

#include <algorithm>
#include <cmath>

#include "allowed_motion.h"
#include "dowel/kernel/tolerance.h"
#include "mate_graph.h"
#include "session_impl.h"

namespace dowel {
namespace {

/// Steps of halving from the way of a step to less than a micrometre.
constexpr int kHalvings = 14;

/// The moving parts of a linkage against what stands still, and against each other. A scene of its
/// own for each part and each pair, in which one part moves.
class LinkageSweep {
 public:
  LinkageSweep(const PlacedBodies& bodies, const ProjectState& state,
               const std::vector<std::string>& names, const std::vector<std::size_t>& moving,
               const Configuration& start)
      : names_(names), tolerance_mm_(state.tolerance_mm) {
    ProjectState still = state;
    for (const std::size_t part : moving) still.instances.erase(names[part]);
    still.mates.clear();
    for (std::size_t i = 0; i < moving.size(); ++i) {
      ProjectState one = still;
      one.instances.emplace(names[moving[i]], *state.find(names[moving[i]]));
      add(bodies, one, moving[i], std::nullopt);
      for (std::size_t j = i + 1; j < moving.size(); ++j) {
        ProjectState two = state;
        two.mates.clear();
        std::erase_if(two.instances, [&](const auto& entry) {
          return entry.first != names[moving[i]] && entry.first != names[moving[j]];
        });
        add(bodies, two, moving[i], moving[j]);
      }
    }
    start_ = start;
  }

  /// How much of the way between two configurations is free, and what ends it.
  PlacedBodies::Path sweep(const Configuration& from, const Configuration& to) {
    PlacedBodies::Path first;
    for (Scene& scene : scenes_) {
      const Pose X_from = seen(scene, from);
      const Pose X_to = seen(scene, to);
      if (X_from == X_to) continue;
      PlacedBodies::Path path =
          scene.bodies.sweep({{names_[scene.moving], Pose()}}, {X_from, X_to}, tolerance_mm_);
      if (path.touches.empty() || path.free_share >= first.free_share) continue;
      first = std::move(path);
    }
    return first;
  }

  /// Whether nothing is entered where the parts are.
  bool is_free(const Configuration& at) {
    return std::ranges::all_of(scenes_, [&](Scene& scene) {
      const auto touches = scene.bodies.check(names_[scene.moving], seen(scene, at), tolerance_mm_);
      return worst(touches) != Verdict::Interference;
    });
  }

 private:
  struct Scene {
    PlacedBodies bodies;
    std::size_t moving;
    std::optional<std::size_t> with;  ///< the other moving part, which stands still here
  };

  void add(const PlacedBodies& bodies, const ProjectState& state, std::size_t moving,
           std::optional<std::size_t> with) {
    scenes_.push_back({bodies.empty_copy(), moving, with});
    scenes_.back().bodies.follow(state);
  }

  /// Where the moving part is, for one that goes with the other.
  Pose seen(const Scene& scene, const Configuration& at) const {
    if (!scene.with) return at[scene.moving];
    return start_[*scene.with] * at[*scene.with].inverse() * at[scene.moving];
  }

  std::vector<std::string> names_;
  double tolerance_mm_;
  Configuration start_;
  std::vector<Scene> scenes_;
};

/// Bodies that are not everywhere where they are at the start.
std::vector<std::size_t> moving_bodies(const LinkagePath& path) {
  const Configuration& start = path.steps.front();
  std::vector<std::size_t> moving;
  for (std::size_t body = 0; body < start.size(); ++body) {
    if (std::ranges::any_of(path.steps,
                            [&](const Configuration& at) { return !(at[body] == start[body]); })) {
      moving.push_back(body);
    }
  }
  return moving;
}

}  // namespace

NamedProblem Session::Impl::linkage_of(const std::string& name) {
  const PartNames group = hanging_together(state(), name);
  const bool has_ground = std::ranges::any_of(
      group, [&](const std::string& part) { return state().find(part)->grounded; });
  std::string held;
  for (const Instance* placed : state().in_order()) {
    if (has_ground || !held.empty() || placed->name == name) continue;
    if (group.contains(placed->name)) held = placed->name;
  }
  return problem(state(), free_parts(state(), group, held));
}

LinkagePath Session::Impl::linkage_way(const DragRequest& request, const NamedProblem& linkage) {
  LinkageDrive drive;
  drive.body = linkage.index(request.instance);
  drive.by_mm_W = request.by_mm_W;
  drive.turn_rad = request.turn_rad;
  const std::vector<Freedom> freedoms = freedoms_of(solve_mates(linkage.problem), drive.body);
  if (request.turn_rad == 0.0) {
    if (allowed_slide(freedoms, request.by_mm_W).norm() <= kCoincident_mm) {
      refuse_drag(request, freedoms);
    }
    return linkage_path(linkage.problem, drive);
  }
  const auto axis_W = turn_axis(request, freedoms);
  const Eigen::Vector3d point_W = instance(request.instance).X_WI.translation();
  if (!axis_W || !allowed_turn(freedoms, *axis_W, point_W)) refuse_drag(request, freedoms);
  drive.axis_W = *axis_W;
  return linkage_path(linkage.problem, drive);
}

void Session::Impl::stop_linkage(LinkagePath& path, const NamedProblem& linkage, DragMode mode,
                                 DragReport& report) {
  LinkageSweep sweep(bodies, state(), linkage.bodies, moving_bodies(path), path.steps.front());
  // Out of an interference there must be a way: then the end alone counts.
  if (!sweep.is_free(path.steps.front())) return;
  const auto count = static_cast<double>(path.steps.size() - 1);
  for (std::size_t step = 0; step + 1 < path.steps.size(); ++step) {
    const Configuration from = path.steps[step];
    const Configuration to = path.steps[step + 1];
    PlacedBodies::Path met = sweep.sweep(from, to);
    if (met.touches.empty()) continue;
    report.move.stopped_by = std::move(met.touches);
    report.move.free_share = (static_cast<double>(step) + met.free_share) / count;
    if (mode == DragMode::Warn) return;
    // A sweep may enter by what its own steps cannot tell from a touch.
    while (step > 0 && !sweep.is_free(path.steps[step])) --step;
    double free_share = 0.0;
    double met_share = 1.0;
    Configuration last_free = path.steps[step];
    for (int i = 0; i < kHalvings; ++i) {
      const double middle = 0.5 * (free_share + met_share);
      Configuration at =
          between_steps(linkage.problem, path.steps[step], path.steps[step + 1], middle);
      const bool is_free = sweep.is_free(at);
      (is_free ? free_share : met_share) = middle;
      if (is_free) last_free = std::move(at);
    }
    path.steps.resize(step + 1);
    path.steps.push_back(std::move(last_free));
    report.move.free_share = (static_cast<double>(step) + free_share) / count;
    return;
  }
}

DragReport Session::Impl::drag_linkage(const DragRequest& request, DragMode mode,
                                       std::string_view command) {
  const Instance before = instance(request.instance);
  const NamedProblem linkage = linkage_of(before.name);
  LinkagePath path = linkage_way(request, linkage);
  const std::size_t driven = linkage.index(before.name);
  DragReport report;
  report.asked_mm_W = request.by_mm_W;
  report.allowed_rad = path.turned_rad;
  report.is_linkage = true;
  if (request.turn_rad == 0.0) {
    report.allowed_mm_W =
        path.steps.back()[driven].translation() - path.steps.front()[driven].translation();
  }
  MoveReport& move = report.move;
  move.instance = before.name;
  move.checked = mode != DragMode::Off;
  bodies.follow(state());
  if (path.steps.size() > 1 && move.checked) stop_linkage(path, linkage, mode, report);

  ProjectState next = state();
  std::vector<std::string> moved;
  for (std::size_t i = 0; i < linkage.bodies.size(); ++i) {
    const Pose& X_WI = path.steps.back()[i];
    if (linkage.problem.bodies[i].held || X_WI == path.steps.front()[i]) continue;
    expect_in_reach(X_WI, linkage.bodies[i]);
    next.instances.at(linkage.bodies[i]).X_WI = settled(X_WI);
    moved.push_back(linkage.bodies[i]);
    if (i != driven) move.moved_along.push_back(linkage.bodies[i]);
  }
  if (move.checked) move.touches = check_all_of(next, moved);
  move.verdict = worst(move.touches);
  const bool is_stuck = moved.empty() && !move.stopped_by.empty();
  if (move.checked && mode != DragMode::Warn &&
      (is_stuck || move.verdict == Verdict::Interference)) {
    move.refused = true;
    move.free_share = 0.0;
    if (is_stuck) move.touches = move.stopped_by;
    move.verdict = worst(move.touches);
    move.moved_along.clear();
    move.X_WI = before.X_WI;
    move.X_WI_free = before.X_WI;
    return report;
  }
  if (moved.empty()) {
    refuse("the mates of " + before.name + " end there: it cannot go on in that sense");
  }
  commit(command, next);
  move.X_WI = instance(before.name).X_WI;
  move.X_WI_free = move.X_WI;
  return report;
}

}  // namespace dowel
