#include "session_impl.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "dowel/assembly/suggest.h"
#include "dowel/assembly/thread.h"
#include "dowel/kernel/check.h"
#include "mate_graph.h"
#include "project_rows.h"

namespace dowel {
namespace {

[[noreturn]] void not_found(const std::string& message, std::string_view name,
                            const std::vector<std::string>& candidates) {
  throw Error(ErrorCode::NotFound, message + did_you_mean(similar_words(name, candidates)));
}

std::string stretch_text(const HoleSegment& segment) {
  return number_text(segment.diameter_mm) + " mm wide from " + number_text(segment.from_mm) +
         " to " + number_text(segment.to_mm) + " mm of depth";
}

}  // namespace

void expect_in_reach(const Pose& X_WI, const std::string& name) {
  // Written so that NaN is refused.
  if (!(X_WI.translation().cwiseAbs().maxCoeff() <= kMaxCoordinate_mm)) {
    refuse(name + " would go beyond " + number_text(kMaxCoordinate_mm) + " mm from the origin");
  }
}

Session::Impl::Impl(Project opened)
    : project(std::move(opened)),
      bodies([this](const std::string& name) -> const Element& { return element(name); },
             [this](const std::string& name) { return solid(name); }) {}

std::vector<std::string> Session::Impl::instance_names() const {
  std::vector<std::string> names;
  for (const auto& [name, instance] : state().instances) names.push_back(name);
  return names;
}

const Instance& Session::Impl::instance(std::string_view name) const {
  if (const Instance* found = state().find(name)) return *found;
  not_found("no instance is called \"" + std::string(name) + "\"", name, instance_names());
}

const Instance& Session::Impl::movable(std::string_view name) const {
  const Instance& found = instance(name);
  for (const std::string& part : unit_of(state(), found.name)) {
    if (!state().find(part)->grounded) continue;
    refuse((part == found.name ? part : found.name + " is fixed to " + part + ", which") +
           " is grounded and does not move; use `ground " + part + " off` first");
  }
  return found;
}

const Element& Session::Impl::element(std::string_view name) {
  if (const Element* copy = project.find_element(name)) return *copy;
  const auto known = candidates.find(name);
  if (known != candidates.end()) return known->second.element;
  if (catalog != nullptr) {
    if (auto found = catalog->find(name)) {
      return candidates.emplace(std::string(name), Candidate{std::move(*found), nullptr, nullptr})
          .first->second.element;
    }
  }
  const std::string message = "no element is called \"" + std::string(name) + "\"";
  if (catalog == nullptr) {
    not_found(message + " in the project, and no catalogue is open", name, project.element_names());
  }
  std::vector<std::string> suggestions = similar_words(name, project.element_names());
  for (std::string& similar : catalog->similar_names(name)) {
    if (std::ranges::find(suggestions, similar) == suggestions.end()) {
      suggestions.push_back(std::move(similar));
    }
  }
  throw Error(ErrorCode::NotFound, message + did_you_mean(suggestions));
}

std::shared_ptr<const FacetedSolid> Session::Impl::solid(std::string_view name) {
  element(name);
  const auto candidate = candidates.find(name);
  if (candidate == candidates.end()) return project.solid(name);
  if (candidate->second.solid == nullptr) candidate->second.solid = catalog->solid(name);
  return candidate->second.solid;
}

PlacedFeature Session::Impl::feature(const FeatureName& name) {
  const Instance& owner = instance(name.instance);
  const Element& description = element(owner.element);
  if (const Feature* found = description.find_feature(name.feature)) return {found, owner.X_WI};
  std::vector<std::string> names;
  for (const Feature& candidate : description.features) names.push_back(candidate.name);
  not_found(name.instance + " (" + owner.element + ") has no feature \"" + name.feature + "\"",
            name.feature, names);
}

std::vector<Touch> Session::Impl::check(const std::string& name, const Pose& X_WI) {
  bodies.follow(state());
  return bodies.check(name, X_WI, state().tolerance_mm);
}

MateFeatures Session::Impl::features(const Mate& mate) {
  const auto find = [&](const FeatureName& name) { return feature(name).feature; };
  MateFeatures result;
  result.kind = mate.kind;
  result.offset_mm = mate.offset_mm;
  result.angle_rad = mate.angle_rad;
  result.flip = mate.flip;
  if (mate.kind == MateKind::Fix) {
    result.X_BA_held = mate.X_FM.value_or(Pose());
    return result;
  }
  result.moving_element = &element(instance(mate.moving.instance).element);
  result.moving = find(mate.moving);
  result.fixed = find(mate.fixed);
  if (mate.has_seat()) {
    result.moving_face = find(mate.moving_face);
    result.fixed_face = find(mate.fixed_face);
  }
  return result;
}

std::vector<Joint> Session::Impl::joints(const Mate& mate, const ProjectState& in) {
  const Pose& X_WM = in.find(mate.moving.instance)->X_WI;
  const Pose& X_WF = in.find(mate.fixed.instance)->X_WI;
  return mate_joints(features(mate), X_WF.inverse() * X_WM);
}

MateResidual Session::Impl::residual(const Mate& mate, const ProjectState& in) {
  const Pose& X_WF = in.find(mate.fixed.instance)->X_WI;
  return mate_residual(joints(mate, in), in.find(mate.moving.instance)->X_WI, X_WF,
                       mate.has_seat() ? in.find(mate.fixed_face.instance)->X_WI : X_WF);
}

bool Session::Impl::holds(const Mate& mate, const ProjectState& in) {
  const MateResidual off = residual(mate, in);
  return off.axis_mm <= kCoaxial_mm && off.angle_rad <= kCoaxial_rad &&
         std::abs(off.along_mm) <= kCoaxial_mm;
}

std::vector<Mate> Session::Impl::drop_broken(ProjectState& next, const std::string& name) {
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

std::vector<ProjectElement> Session::Impl::missing_copy(const std::string& name) {
  if (project.find_element(name) != nullptr) return {};
  const Element& copied = element(name);
  const auto& brep = candidates.at(name).brep;
  return {{copied, solid(name), brep != nullptr ? *brep : catalog->brep(name)}};
}

void Session::Impl::commit(std::string_view command, const ProjectState& next,
                           const std::vector<ProjectElement>& copies) {
  project.commit(command, next, copies);
  for (const ProjectElement& copy : copies) candidates.erase(copy.element.name);
}

bool Session::Impl::expect_fit(const FeatureName& moving_name, const PlacedFeature& moving,
                               const FeatureName& fixed_name, const PlacedFeature& fixed) {
  using enum FeatureKind;
  const bool shaft_moves = moving.feature->kind == Shaft && fixed.feature->kind == Hole;
  if (!shaft_moves && !(moving.feature->kind == Hole && fixed.feature->kind == Shaft)) return false;
  const PlacedFeature& shaft = shaft_moves ? moving : fixed;
  const PlacedFeature& hole = shaft_moves ? fixed : moving;
  const AxisFit fit = fit_on_axis(*shaft.feature, shaft.X_WI, *hole.feature, hole.X_WI);
  if (fit.obstacle != nullptr) {
    const FeatureName& shaft_name = shaft_moves ? moving_name : fixed_name;
    const FeatureName& hole_name = shaft_moves ? fixed_name : moving_name;
    refuse("shaft " + shaft_name.text() + " of diameter " +
           number_text(shaft.feature->diameter_mm) + " mm does not go into hole " +
           hole_name.text() + ", which is " + stretch_text(*fit.obstacle));
  }
  return fit.thread;
}

}  // namespace dowel
