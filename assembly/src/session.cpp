#include "dowel/assembly/session.h"

#include <algorithm>
#include <set>
#include <utility>

#include "dowel/assembly/names.h"
#include "dowel/assembly/suggest.h"
#include "dowel/assembly/thread.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "mate_graph.h"
#include "project_rows.h"
#include "session_impl.h"

namespace dowel {

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
  const Feature* bottom = bottom_face(impl_->element(element_name));
  if (bottom == nullptr) {
    refuse("element " + std::string(element_name) +
           " has no planar face that looks down to stand on; use `at` or `insert`");
  }
  return standing_pose(*bottom, on);
}

std::vector<PatternWay> Session::pattern(std::string_view element_name, const FeatureName& hole) {
  const PlacedFeature at = impl_->feature(hole);
  if (at.feature->kind != FeatureKind::Hole) {
    refuse(hole.text() + " is a " + std::string(to_string(at.feature->kind)) +
           ", expected a hole to stand on");
  }
  const Element& part = impl_->element(instance(hole.instance).element);
  return pattern_ways(impl_->element(element_name), part, *at.feature);
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
  std::optional<SeatFaces> seat;
  if (request.seat) {
    seat = SeatFaces{impl_->feature(request.seat->first).feature,
                     impl_->feature(request.seat->second)};
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
  mate.thread =
      Impl::expect_fit(request.moving, {moving.feature, placement.X_WA}, request.fixed, fixed);

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
  if (state().mode != CheckMode::Off) {
    impl_->bodies.follow(state());
    const auto unit = impl_->parts(unit_of(state(), before.name), before.name, before.X_WI);
    report.touches = impl_->check_parts(unit, placement.X_WA, state().tolerance_mm);
  }
  if (worst(report.touches) == Verdict::Interference) report.free_share = 0.0;
  return impl_->finish(std::move(report), before, std::move(next), command);
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
  next.design.forget(known);
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

void Session::set_design(const FixtureDesign& design, std::string_view command) {
  ProjectState next = state();
  next.design = design;
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
