#include "dowel/assembly/session.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>

#include "dowel/assembly/names.h"
#include "dowel/assembly/suggest.h"
#include "dowel/assembly/thread.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "placed_bodies.h"
#include "project_rows.h"

namespace dowel {
namespace {

/// A turn is swept in legs of at most this angle, each well under the half turn at which the
/// shortest rotation changes its sense.
constexpr double kLargestLeg_rad = std::numbers::pi / 2.0;

[[noreturn]] void not_found(const std::string& message, std::string_view name,
                            const std::vector<std::string>& candidates) {
  throw Error(ErrorCode::NotFound, message + did_you_mean(similar_words(name, candidates)));
}

[[noreturn]] void refuse(const std::string& message) {
  throw Error(ErrorCode::InvalidInput, message);
}

/// The planar face that looks down (against z) and lies lowest, the larger of two at one height.
const Feature* bottom_of(const Element& element) {
  const Feature* best = nullptr;
  for (const Feature& face : element.features) {
    if (face.kind != FeatureKind::Face || face.direction.z() > 0.0 ||
        face.direction.head<2>().norm() > kCoaxial_rad) {
      continue;
    }
    if (best == nullptr) {
      best = &face;
      continue;
    }
    const double below_mm = best->origin.z() - face.origin.z();
    if (below_mm > kCoincident_mm ||
        (below_mm > -kCoincident_mm && face.area_mm2 > best->area_mm2)) {
      best = &face;
    }
  }
  return best;
}

void expect_in_reach(const Pose& X_WI, const std::string& name) {
  // Written so that NaN is refused.
  if (!(X_WI.translation().cwiseAbs().maxCoeff() <= kMaxCoordinate_mm)) {
    refuse(name + " would go beyond " + number_text(kMaxCoordinate_mm) + " mm from the origin");
  }
}

std::string stretch_text(const HoleSegment& segment) {
  return number_text(segment.diameter_mm) + " mm wide from " + number_text(segment.from_mm) +
         " to " + number_text(segment.to_mm) + " mm of depth";
}

}  // namespace

struct Session::Impl {
  /// An entry of the catalogue that the project may come to copy.
  struct Candidate {
    Element element;
    std::shared_ptr<const FacetedSolid> solid;  // on demand
  };

  Project project;
  std::shared_ptr<const Catalog> catalog;
  std::map<std::string, Candidate, std::less<>> candidates;
  PlacedBodies bodies;

  explicit Impl(Project opened)
      : project(std::move(opened)),
        bodies([this](const std::string& name) -> const Element& { return element(name); },
               [this](const std::string& name) { return solid(name); }) {}

  const ProjectState& state() const { return project.state(); }

  std::vector<std::string> instance_names() const {
    std::vector<std::string> names;
    for (const auto& [name, instance] : state().instances) names.push_back(name);
    return names;
  }

  const Instance& instance(std::string_view name) const {
    if (const Instance* found = state().find(name)) return *found;
    not_found("no instance is called \"" + std::string(name) + "\"", name, instance_names());
  }

  const Element& element(std::string_view name) {
    if (const Element* copy = project.find_element(name)) return *copy;
    const auto known = candidates.find(name);
    if (known != candidates.end()) return known->second.element;
    if (catalog != nullptr) {
      if (auto found = catalog->find(name)) {
        return candidates.emplace(std::string(name), Candidate{std::move(*found), nullptr})
            .first->second.element;
      }
    }
    const std::string message = "no element is called \"" + std::string(name) + "\"";
    if (catalog == nullptr) {
      not_found(message + " in the project, and no catalogue is open", name,
                project.element_names());
    }
    std::vector<std::string> suggestions = similar_words(name, project.element_names());
    for (std::string& similar : catalog->similar_names(name)) {
      if (std::ranges::find(suggestions, similar) == suggestions.end()) {
        suggestions.push_back(std::move(similar));
      }
    }
    throw Error(ErrorCode::NotFound, message + did_you_mean(suggestions));
  }

  std::shared_ptr<const FacetedSolid> solid(std::string_view name) {
    element(name);
    const auto candidate = candidates.find(name);
    if (candidate == candidates.end()) return project.solid(name);
    if (candidate->second.solid == nullptr) candidate->second.solid = catalog->solid(name);
    return candidate->second.solid;
  }

  PlacedFeature feature(const FeatureName& name) {
    const Instance& owner = instance(name.instance);
    const Element& description = element(owner.element);
    if (const Feature* found = description.find_feature(name.feature)) return {found, owner.X_WI};
    std::vector<std::string> names;
    for (const Feature& candidate : description.features) names.push_back(candidate.name);
    not_found(name.instance + " (" + owner.element + ") has no feature \"" + name.feature + "\"",
              name.feature, names);
  }

  const Instance& movable(std::string_view name) const {
    const Instance& found = instance(name);
    if (found.grounded) {
      refuse(found.name + " is grounded and does not move; use `ground " + found.name +
             " off` first");
    }
    return found;
  }

  std::vector<Touch> check(const std::string& name, const Pose& X_WI) {
    bodies.follow(state());
    return bodies.check(name, X_WI, state().tolerance_mm);
  }

  MateResidual residual(const Mate& mate, const ProjectState& in) {
    const auto placed = [&](const FeatureName& name) {
      PlacedFeature result = feature(name);
      result.X_WI = in.find(name.instance)->X_WI;
      return result;
    };
    std::optional<Seat> seat;
    if (mate.has_seat()) {
      seat = Seat{placed(mate.moving_face).feature, placed(mate.fixed_face)};
    }
    return mate_residual(placed(mate.moving), placed(mate.fixed), seat,
                         {.offset_mm = mate.offset_mm, .flip = mate.flip});
  }

  bool holds(const Mate& mate, const ProjectState& in) {
    const MateResidual off = residual(mate, in);
    return off.axis_mm <= kCoaxial_mm && off.angle_rad <= kCoaxial_rad &&
           std::abs(off.along_mm) <= kCoaxial_mm;
  }

  /// Takes the mates of `name` that do not hold out of `next`, and returns them.
  std::vector<Mate> drop_broken(ProjectState& next, const std::string& name) {
    std::vector<Mate> dropped;
    for (auto entry = next.mates.begin(); entry != next.mates.end();) {
      const Mate& mate = entry->second;
      const bool concerned = mate.moving.instance == name || mate.fixed.instance == name ||
                             mate.fixed_face.instance == name;
      if (concerned && !holds(mate, next)) {
        dropped.push_back(mate);
        entry = next.mates.erase(entry);
      } else {
        ++entry;
      }
    }
    return dropped;
  }

  /// The copy of `name` to commit with, where the project has none yet.
  std::vector<ProjectElement> missing_copy(const std::string& name) {
    if (project.find_element(name) != nullptr) return {};
    return {{element(name), solid(name), catalog->brep(name)}};
  }

  void commit(std::string_view command, const ProjectState& next,
              const std::vector<ProjectElement>& copies = {}) {
    project.commit(command, next, copies);
    for (const ProjectElement& copy : copies) candidates.erase(copy.element.name);
  }

  /// Blocks or makes the move of `name` to `report.X_WI`, as the mode and the report say.
  MoveReport finish(MoveReport report, const Instance& before, ProjectState next,
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
    next.instances.at(before.name).X_WI = settled(report.X_WI);
    report.dropped = drop_broken(next, before.name);
    commit(command, next);
    report.X_WI = instance(report.instance).X_WI;
    return report;
  }

  /// Moves `name` to `X_WI` by way of the frames `X_WU`.
  MoveReport travel(std::string_view name, const std::vector<Pose>& X_WU, const Pose& X_WI,
                    std::string_view command) {
    const Instance before = movable(name);
    expect_in_reach(X_WI, before.name);
    MoveReport report;
    report.X_WI = X_WI;
    report.X_WI_free = X_WI;
    if (state().mode != CheckMode::Off) {
      // Out of an interference there must be a way: then the end alone counts.
      if (worst(check(before.name, before.X_WI)) != Verdict::Interference) {
        const PlacedBodies::Path path = bodies.sweep(before.name, X_WU, state().tolerance_mm);
        report.free_share = path.free_share;
        report.X_WI_free = path.X_WI_free;
        report.touches = path.touches;
      }
      if (report.touches.empty()) report.touches = check(before.name, X_WI);
    }
    return finish(std::move(report), before, state(), command);
  }

  /// Says with numbers where a shaft is too thick for its hole; whether the two form a thread.
  static bool expect_fit(MateKind kind, const InsertRequest& request, const PlacedFeature& moving,
                         const Pose& X_WI, const PlacedFeature& fixed) {
    if (kind != MateKind::ShaftInHole && kind != MateKind::HoleOverShaft) return false;
    const bool shaft_moves = kind == MateKind::ShaftInHole;
    const Feature& shaft = shaft_moves ? *moving.feature : *fixed.feature;
    const Feature& hole = shaft_moves ? *fixed.feature : *moving.feature;
    const AxisFit fit =
        fit_on_axis(shaft, shaft_moves ? X_WI : fixed.X_WI, hole, shaft_moves ? fixed.X_WI : X_WI);
    if (fit.obstacle != nullptr) {
      const FeatureName& shaft_name = shaft_moves ? request.moving : request.fixed;
      const FeatureName& hole_name = shaft_moves ? request.fixed : request.moving;
      refuse("shaft " + shaft_name.text() + " of diameter " + number_text(shaft.diameter_mm) +
             " mm does not go into hole " + hole_name.text() + ", which is " +
             stretch_text(*fit.obstacle));
    }
    return fit.thread;
  }
};

Session::Session(Project project) : impl_(std::make_unique<Impl>(std::move(project))) {}
Session::~Session() = default;

const Project& Session::project() const {
  return impl_->project;
}

void Session::use_catalog(std::shared_ptr<const Catalog> catalog) {
  // A placement that was refused has left its body behind.
  if (!impl_->candidates.empty()) impl_->bodies.follow(state());
  for (const auto& [name, candidate] : impl_->candidates) impl_->bodies.forget(name);
  impl_->candidates.clear();
  impl_->catalog = std::move(catalog);
}

const std::shared_ptr<const Catalog>& Session::catalog() const {
  return impl_->catalog;
}

const Instance& Session::instance(std::string_view name) const {
  return impl_->instance(name);
}

const Element& Session::element(std::string_view name) {
  return impl_->element(name);
}

std::shared_ptr<const FacetedSolid> Session::solid(std::string_view element_name) {
  return impl_->solid(element_name);
}

std::vector<std::string> Session::element_names() const {
  const std::vector<std::string> copies = impl_->project.element_names();
  std::set<std::string> names(copies.begin(), copies.end());
  if (impl_->catalog != nullptr) {
    const std::vector<std::string> entries = impl_->catalog->names();
    names.insert(entries.begin(), entries.end());
  }
  return {names.begin(), names.end()};
}

PlacedFeature Session::feature(const FeatureName& name) {
  return impl_->feature(name);
}

Pose Session::pose_at(const FeatureName& feature_name) {
  const PlacedFeature at = impl_->feature(feature_name);
  const bool into_material = at.feature->kind == FeatureKind::Hole;
  const Eigen::Vector3d out_W =
      into_material ? Eigen::Vector3d(-at.direction_W()) : at.direction_W();
  return upright_pose(at.origin_W(), out_W, at.X_WI);
}

Pose Session::pose_on(std::string_view element_name, const FeatureName& face) {
  const PlacedFeature on = impl_->feature(face);
  if (on.feature->kind != FeatureKind::Face) {
    refuse(face.text() + " is a " + std::string(to_string(on.feature->kind)) +
           ", expected a face to stand on");
  }
  const Feature* bottom = bottom_of(impl_->element(element_name));
  if (bottom == nullptr) {
    refuse("element " + std::string(element_name) +
           " has no planar face that looks down to stand on; use `at` or `insert`");
  }
  return standing_pose(*bottom, on);
}

MoveReport Session::place(std::string_view element_name, std::string_view name, const Pose& X_WI,
                          std::string_view command) {
  Instance placed;
  placed.element = impl_->element(element_name).name;
  const auto is_taken = [&](const std::string& n) { return state().find(n) != nullptr; };
  placed.name = name.empty() ? free_name(element_name, is_taken) : std::string(name);
  if (const auto defect = instance_name_defect(placed.name)) {
    refuse("instance name \"" + placed.name + "\" " + *defect);
  }
  if (is_taken(placed.name)) refuse("an instance is called \"" + placed.name + "\" already");
  expect_in_reach(X_WI, placed.name);
  placed.X_WI = settled(X_WI);
  for (const auto& [other_name, other] : state().instances) {
    placed.number = std::max(placed.number, other.number);
  }
  ++placed.number;

  ProjectState next = state();
  next.instances.emplace(placed.name, placed);
  MoveReport report;
  report.instance = placed.name;
  report.X_WI = placed.X_WI;
  report.X_WI_free = placed.X_WI;
  report.checked = state().mode != CheckMode::Off;
  if (report.checked) {
    impl_->bodies.follow(next);
    report.touches = impl_->bodies.check(placed.name, placed.X_WI, state().tolerance_mm);
    report.verdict = worst(report.touches);
    if (report.verdict == Verdict::Interference) report.free_share = 0.0;
    report.refused = state().mode == CheckMode::Block && report.verdict == Verdict::Interference;
  }
  if (!report.refused) {
    impl_->commit(command, next, impl_->missing_copy(placed.element));
  }
  return report;
}

MoveReport Session::insert(const InsertRequest& request, std::string_view command) {
  const Instance before = impl_->movable(request.moving.instance);
  if (request.fixed.instance == before.name) {
    refuse(before.name + " cannot go into itself: expected a feature of another instance");
  }
  if (request.seat) {
    if (request.seat->first.instance != before.name) {
      refuse("a seat names a face of the part that moves first: expected " + before.name +
             ".FACE, got " + request.seat->first.text());
    }
    if (request.seat->second.instance == before.name) {
      refuse(before.name + " cannot sit on itself: expected a face of another instance");
    }
  }
  const PlacedFeature moving = impl_->feature(request.moving);
  const PlacedFeature fixed = impl_->feature(request.fixed);
  std::optional<Seat> seat;
  if (request.seat) {
    seat = Seat{impl_->feature(request.seat->first).feature, impl_->feature(request.seat->second)};
  }
  const MatePlacement placement = place_by_mate(moving, fixed, seat, request.options);
  expect_in_reach(placement.X_WA, before.name);

  Mate mate;
  mate.kind = placement.kind;
  mate.moving = request.moving;
  mate.fixed = request.fixed;
  if (request.seat) {
    mate.moving_face = request.seat->first;
    mate.fixed_face = request.seat->second;
  }
  mate.offset_mm = request.options.offset_mm;
  mate.flip = request.options.flip;
  mate.thread = Impl::expect_fit(placement.kind, request, moving, placement.X_WA, fixed);

  ProjectState next = state();
  std::erase_if(next.mates, [&](const auto& entry) {
    return entry.second.moving == mate.moving && entry.second.fixed == mate.fixed;
  });
  mate.number = next.mates.empty() ? 1 : next.mates.rbegin()->first + 1;
  next.mates.emplace(mate.number, mate);

  MoveReport report;
  report.X_WI = placement.X_WA;
  report.X_WI_free = placement.X_WA;
  report.made = mate;
  if (state().mode != CheckMode::Off) report.touches = impl_->check(before.name, placement.X_WA);
  if (worst(report.touches) == Verdict::Interference) report.free_share = 0.0;
  return impl_->finish(std::move(report), before, std::move(next), command);
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
  const int legs = std::max(1, static_cast<int>(std::ceil(std::abs(angle_rad) / kLargestLeg_rad)));
  // A frame on the axis only turns, so that its straight path makes the part's path the arc. The
  // nearer it is to the part, the better the bound that a sweep has for the way of its points.
  const Eigen::Vector3d center_W = from * impl_->element(impl_->instance(name).element).obb.center;
  const Eigen::Vector3d pivot_W = point_W + axis_W.dot(center_W - point_W) * axis_W;
  std::vector<Pose> X_WU;
  for (int leg = 0; leg <= legs; ++leg) {
    X_WU.emplace_back(Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad * leg / legs, axis_W)),
                      pivot_W);
  }
  return impl_->travel(name, X_WU, Pose::about_axis(point_W, axis_W, angle_rad) * from, command);
}

std::vector<Mate> Session::remove(std::string_view name, std::string_view command) {
  const std::string known = impl_->instance(name).name;
  ProjectState next = state();
  std::vector<Mate> gone;
  for (const auto& [number, mate] : state().mates) {
    if (mate.moving.instance == known || mate.fixed.instance == known ||
        mate.fixed_face.instance == known) {
      gone.push_back(mate);
      next.mates.erase(number);
    }
  }
  next.instances.erase(known);
  impl_->commit(command, next);
  return gone;
}

void Session::set_grounded(std::string_view name, bool grounded, std::string_view command) {
  ProjectState next = state();
  next.instances.at(impl_->instance(name).name).grounded = grounded;
  impl_->commit(command, next);
}

void Session::set_mode(CheckMode mode, std::string_view command) {
  ProjectState next = state();
  next.mode = mode;
  impl_->commit(command, next);
}

void Session::set_tolerance(double tolerance_mm, std::string_view command) {
  if (!is_tolerance(tolerance_mm)) {
    refuse("tolerance " + number_text(tolerance_mm) + " mm is out of range: expected " +
           number_text(kMinTolerance_mm) + " to " + number_text(kMaxTolerance_mm) + " mm");
  }
  ProjectState next = state();
  next.tolerance_mm = tolerance_mm;
  impl_->commit(command, next);
}

std::vector<std::string> Session::undo(std::size_t count) {
  return impl_->project.undo(count);
}

std::vector<std::string> Session::redo(std::size_t count) {
  return impl_->project.redo(count);
}

void Session::save(const std::filesystem::path& file) {
  impl_->project.save_copy(file);
  if (impl_->project.file().empty()) impl_->project = Project::open(file);
}

std::vector<Touch> Session::check_all() {
  impl_->bodies.follow(state());
  return impl_->bodies.check_all(state().tolerance_mm);
}

std::vector<BomRow> Session::bill_of_materials() {
  std::map<std::string, BomRow> rows;
  for (const Instance* instance : state().in_order()) {
    BomRow& row = rows[instance->element];
    ++row.count;
    row.element = instance->element;
    row.instances.push_back(instance->name);
  }
  std::vector<BomRow> result;
  for (auto& [name, row] : rows) {
    row.family = impl_->element(name).family;
    result.push_back(std::move(row));
  }
  return result;
}

MateResidual Session::residual(const Mate& mate) {
  return impl_->residual(mate, state());
}

Verdict worst(std::span<const Touch> touches) {
  Verdict result = Verdict::Clear;
  for (const Touch& touch : touches) result = std::max(result, touch.pair.verdict);
  return result;
}

}  // namespace dowel
