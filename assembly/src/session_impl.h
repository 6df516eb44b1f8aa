#pragma once

// What the functions of a session share. Internal to Session.

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "dowel/assembly/session.h"
#include "dowel/kernel/error.h"
#include "linkage.h"
#include "placed_bodies.h"

namespace dowel {

[[noreturn]] inline void refuse(const std::string& message) {
  throw Error(ErrorCode::InvalidInput, message);
}

/// Throws Error{InvalidInput} where an instance would be beyond kMaxCoordinate_mm, or at NaN.
void expect_in_reach(const Pose& X_WI, const std::string& name);

/// A problem for the mate solver, and whose its bodies and mates are.
struct NamedProblem {
  MateProblem problem;
  std::vector<std::string> bodies;  ///< by order of placing
  std::vector<Mate> mates;          ///< by order of making

  std::size_t index(const std::string& name) const;
};

/// A direction in which a part may leave the others, and what gives it.
struct WayDirection {
  Eigen::Vector3d direction_W = Eigen::Vector3d::UnitZ();  ///< unit
  std::string along;
};

struct Session::Impl {
  /// An entry of the catalogue that the project may come to copy.
  struct Candidate {
    Element element;
    std::shared_ptr<const FacetedSolid> solid;           // on demand
    std::shared_ptr<const std::vector<std::byte>> brep;  // of a unit's; else the catalogue has it
  };

  explicit Impl(Project opened);

  const ProjectState& state() const { return project.state(); }

  std::vector<std::string> instance_names() const;
  const Instance& instance(std::string_view name) const;
  /// Throws Error{InvalidInput} where it, or what is fixed to it, is grounded.
  const Instance& movable(std::string_view name) const;
  const Element& element(std::string_view name);
  std::shared_ptr<const FacetedSolid> solid(std::string_view name);
  PlacedFeature feature(const FeatureName& name);

  /// Adds an instance to `next`, checked; a refused one is not added.
  MoveReport add(ProjectState& next, const Placement& placement);
  /// Makes `next`, with the copies of elements that it needs.
  void commit_placed(std::string_view command, const ProjectState& next);
  /// Adds to `next` the mates of `placed` with the part of `at`, and returns them.
  std::vector<Mate> mate_in_place(ProjectState& next, const Instance& placed,
                                  const FeatureName& at);

  /// Pairs of `name`, were it at X_WI.
  std::vector<Touch> check(const std::string& name, const Pose& X_WI);

  /// The mate with its features and its joints, with the instances placed as in `in`.
  MateFeatures features(const Mate& mate);
  std::vector<Joint> joints(const Mate& mate, const ProjectState& in);
  MateResidual residual(const Mate& mate, const ProjectState& in);
  bool holds(const Mate& mate, const ProjectState& in);

  /// The mates that act on any of `free`, with all parts that they are on; other parts are held.
  NamedProblem problem(const ProjectState& in, const std::set<std::string>& free);
  /// The mate that a request asks for, with the sense that is nearest, and where it alone would put
  /// the moving part.
  std::pair<Mate, Pose> requested(const MateRequest& request);
  /// Puts the parts where `mate` and those they have hold; what is in the way, or nothing.
  std::optional<MateConflict> place_all(ProjectState& next, const Mate& mate);
  MateConflict explain(const NamedProblem& named, const MateSolution& solution, const Mate& mate);

  /// Checks and makes the mate `number` of `next`, or refuses it.
  MoveReport finish_mate(MoveReport report, ProjectState next, std::uint32_t number,
                         std::string_view command);
  /// Pairs of all of `moved`, each once, with everything placed as in `next`.
  std::vector<Touch> check_all_of(const ProjectState& next, const std::vector<std::string>& moved);

  /// Takes the mates of `name` that do not hold out of `next`, and returns them.
  std::vector<Mate> drop_broken(ProjectState& next, const std::string& name);

  /// The copy of `name` to commit with, where the project has none yet.
  std::vector<ProjectElement> missing_copy(const std::string& name);
  void commit(std::string_view command, const ProjectState& next,
              const std::vector<ProjectElement>& copies = {});

  /// Blocks or makes the move of `before` to `report.X_WI`, as the mode and the report say.
  MoveReport finish(MoveReport report, const Instance& before, ProjectState next,
                    std::string_view command);
  /// Moves the unit of `name` by way of the frames `X_WU`, so that the instance ends at `X_WI`.
  MoveReport travel(std::string_view name, const std::vector<Pose>& X_WU, const Pose& X_WI,
                    std::string_view command);
  /// The parts of a group where they are, seen from U; the one called `first` first.
  std::vector<PlacedBodies::Part> parts(const std::set<std::string>& group,
                                        const std::string& first, const Pose& X_WU);
  /// What the mates leave `group` free to do as one, told for where `name` is.
  std::vector<Freedom> group_freedoms(const std::set<std::string>& group, const std::string& name);
  /// Pairs of a group, were U at X_WU.
  std::vector<Touch> check_parts(const std::vector<PlacedBodies::Part>& parts_U, const Pose& X_WU,
                                 double tolerance_mm);

  /// The way of a drag, as frames; fills in what the mates leave of it. Nothing where they leave
  /// nothing as long as all other parts stay.
  std::optional<std::vector<Pose>> drag_frames(const DragRequest& request,
                                               const std::vector<Freedom>& freedoms,
                                               DragReport& report);
  /// The axis of a turn: that asked for, else the only one; nothing where none is free. Throws
  /// Error{InvalidInput} where there are several.
  std::optional<Eigen::Vector3d> turn_axis(const DragRequest& request,
                                           const std::vector<Freedom>& freedoms);
  [[noreturn]] void refuse_drag(const DragRequest& request, const std::vector<Freedom>& freedoms);
  /// Whether all mates that hold go on holding where the parts are moved so.
  bool keeps_mates(const std::vector<PlacedBodies::Part>& parts_U, const Pose& X_WU);
  /// How far a drag gets; fills in what stopped it.
  Pose drag_end(const std::vector<PlacedBodies::Part>& parts_U, const std::vector<Pose>& X_WU,
                const std::vector<Freedom>& freedoms, DragMode mode, DragReport& report);
  /// The state with the parts there.
  ProjectState dragged(const std::vector<PlacedBodies::Part>& parts_U, const Pose& X_WU);

  /// All that hang together with a part, as bodies and mates.
  NamedProblem linkage_of(const std::string& name);
  LinkagePath linkage_way(const DragRequest& request, const NamedProblem& linkage);
  /// Ends the path where something is met.
  void stop_linkage(LinkagePath& path, const NamedProblem& linkage, DragMode mode,
                    DragReport& report);
  /// A drag in which the other parts do not stay.
  DragReport drag_linkage(const DragRequest& request, DragMode mode, std::string_view command);

  /// Along the mates of a group with others.
  std::vector<WayDirection> mate_directions(const ProjectState& in,
                                            const std::set<std::string>& group);
  /// Up from the base: what is grounded, else what was there first. Nothing where that is in the
  /// group.
  std::optional<WayDirection> base_direction(const ProjectState& in,
                                             const std::set<std::string>& group);
  /// Expects: `bodies` follow `in`.
  WayOut way_out(const ProjectState& in, const std::set<std::string>& group,
                 const WayDirection& direction);

  /// Says with numbers where a shaft is too thick for its hole; whether the two form a thread.
  static bool expect_fit(const FeatureName& moving_name, const PlacedFeature& moving,
                         const FeatureName& fixed_name, const PlacedFeature& fixed);

  Project project;
  std::shared_ptr<const Catalog> catalog;
  std::map<std::string, Candidate, std::less<>> candidates;
  PlacedBodies bodies;
};

}  // namespace dowel
