#include "fact_source.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "dowel/assembly/fit.h"
#include "fixture_result.h"

namespace dowel {
namespace {

/// Beyond so many parts that changed, all pairs at once are faster.
constexpr std::size_t kFewChanged = 8;

void sort_by_name(std::vector<Touch>& touches) {
  for (Touch& touch : touches) {
    if (touch.with < touch.instance) std::swap(touch.instance, touch.with);
  }
  std::ranges::sort(touches, {},
                    [](const Touch& touch) { return std::tie(touch.instance, touch.with); });
}

/// Names of instances that are in one of the two states alone, or differ.
std::set<std::string> changed_parts(const ProjectState& from, const ProjectState& to) {
  std::set<std::string> names;
  for (const auto& [name, instance] : from.instances) {
    const Instance* other = to.find(name);
    if (other == nullptr || other->element != instance.element || other->X_WI != instance.X_WI) {
      names.insert(name);
    }
  }
  for (const auto& [name, instance] : to.instances) {
    if (from.find(name) == nullptr) names.insert(name);
  }
  return names;
}

/// A shaft that is thicker than its hole, by the fits that both are stated to have.
bool is_press_fit(const AxisPair& pair) {
  const auto hole = tolerance_class_from(pair.hole->fit);
  const auto shaft = tolerance_class_from(pair.shaft->fit);
  const double nominal_mm = std::round(pair.bore_mm);
  if (!pair.is_coaxial || !hole || !shaft || !is_nominal_size(nominal_mm)) return false;
  // A transition fit is pressed in, too: on the average it has interference.
  const Fit fit{nominal_mm, *hole, *shaft};
  return fit.least_clearance_um() + fit.most_clearance_um() < 0.0;
}

}  // namespace

FactSource::FactSource(Session& session)
    : session_(session),
      bodies_([this](const std::string& name) -> const Element& { return session_.element(name); },
              [this](const std::string& name) { return solid(name); }) {}

std::shared_ptr<const FacetedSolid> FactSource::solid(const std::string& element) {
  auto& found = solids_[element];
  if (found == nullptr) found = session_.solid(element);
  return found;
}

unsigned FactSource::update() {
  const ProjectState& now = session_.state();
  unsigned changed = 0;
  if (!has_state_ || now.instances != state_.instances) changed |= kFromParts;
  if (!has_state_ || now.mates != state_.mates) changed |= kFromMates;
  if (!has_state_ || !(now.design == state_.design)) changed |= kFromDesign;
  if (!has_state_ || now.tolerance_mm != state_.tolerance_mm) changed |= kFromTolerance;
  has_state_ = true;
  if (changed == 0) return 0;
  state_ = now;
  // Features of elements are pointed to, and an element may be another after a removal.
  axes_.reset();
  holdings_.reset();
  fixtures_.reset();
  return changed;
}

const std::vector<Touch>& FactSource::updated(Pairs& pairs, double tolerance_mm) {
  bodies_.follow(state_);
  const bool is_new = !pairs.touches || pairs.tolerance_mm != tolerance_mm;
  const std::set<std::string> changed =
      is_new ? std::set<std::string>() : changed_parts(pairs.of, state_);
  if (!is_new && changed.empty()) return *pairs.touches;
  std::vector<Touch> found;
  if (is_new || changed.size() > kFewChanged) {
    pairs.touches.emplace();
    found = bodies_.check_all(tolerance_mm);
  } else {
    std::erase_if(*pairs.touches, [&](const Touch& touch) {
      return changed.contains(touch.instance) || changed.contains(touch.with);
    });
    for (const std::string& name : changed) {
      const Instance* instance = state_.find(name);
      if (instance == nullptr) continue;
      for (Touch& touch : bodies_.check(name, instance->X_WI, tolerance_mm)) {
        // Of two that changed, one is enough.
        if (changed.contains(touch.with) && touch.with < name) continue;
        found.push_back(std::move(touch));
      }
    }
  }
  sort_by_name(found);
  for (Touch& touch : found) {
    touch.pair = bodies_.pair(touch.instance, touch.with, tolerance_mm);
    pairs.touches->push_back(std::move(touch));
  }
  sort_by_name(*pairs.touches);
  pairs.of = state_;
  pairs.tolerance_mm = tolerance_mm;
  return *pairs.touches;
}

const std::vector<Touch>& FactSource::touches() {
  return updated(touching_, state_.tolerance_mm);
}

const std::vector<Touch>& FactSource::nearer_than(double gap_mm) {
  return updated(near_, gap_mm);
}

const std::vector<AxisPair>& FactSource::axes() {
  if (!axes_) {
    axes_ = axis_pairs(
        state_, [this](const Instance& instance) -> const Element& { return element(instance); });
  }
  return *axes_;
}

const std::vector<Holding>& FactSource::holdings() {
  if (holdings_) return *holdings_;
  std::set<std::tuple<std::string, std::string, std::string>> found;
  const auto hold = [&](const std::string& a, const std::string& b, const char* kind) {
    found.emplace(a, b, kind);
    found.emplace(b, a, kind);
  };
  std::set<std::string> screws;
  for (const AxisPair& pair : axes()) {
    if (!pair.is_thread) continue;
    hold(pair.shaft_instance, pair.hole_instance, "thread");
    screws.insert(pair.shaft_instance);
  }
  for (const AxisPair& pair : axes()) {
    if (pair.is_thread) continue;
    if (is_press_fit(pair)) hold(pair.shaft_instance, pair.hole_instance, "press");
    if (screws.contains(pair.shaft_instance)) {
      hold(pair.shaft_instance, pair.hole_instance, "screw");
    }
  }
  for (const auto& [number, mate] : state_.mates) {
    if (mate.kind == MateKind::Fix) hold(mate.moving.instance, mate.fixed.instance, "fix");
  }
  for (const FixtureModel& fixture : fixtures()) {
    for (const WorkpieceContact& contact : fixture.contacts) {
      if (contact.role == Role::Clamp) hold(fixture.workpiece, contact.instance, "clamp");
    }
  }
  holdings_.emplace();
  for (const auto& [held, by, kind] : found) holdings_->push_back({held, by, kind});
  return *holdings_;
}

const std::vector<FixtureModel>& FactSource::fixtures() {
  if (fixtures_) return *fixtures_;
  const FixtureInput input{
      state_, [this](const std::string& name) -> const Element& { return session_.element(name); },
      [this](const std::string& name) { return solid(name); },
      [this](const Touch& touch) -> const std::vector<ContactPatch>& {
        return shared_planes(touch);
      },
      touches()};
  fixtures_.emplace();
  for (const Instance* workpiece : workpieces(input)) {
    fixtures_->push_back(fixture_model(input, *workpiece));
  }
  return *fixtures_;
}

const std::vector<LintFinding>& FactSource::data_faults(const std::string& element) {
  const auto [entry, is_new] = data_faults_.try_emplace(element);
  if (is_new) entry->second = lint(session_.element(element), *solid(element));
  return entry->second;
}

const std::vector<ContactPatch>& FactSource::shared_planes(const Touch& touch) {
  const Instance& a = *state_.find(touch.instance);
  const Instance& b = *state_.find(touch.with);
  SharedPlanes& known = shared_planes_[{a.name, b.name}];
  if (known.a == a && known.b == b && known.tolerance_mm == state_.tolerance_mm) {
    return known.patches;
  }
  known = {
      a, b, state_.tolerance_mm,
      plane_patches(*solid(a.element), a.X_WI, *solid(b.element), b.X_WI, state_.tolerance_mm)};
  return known.patches;
}

const std::vector<UnloadAnalysis>& FactSource::unloadings() {
  // The rest of the design does not matter.
  if (unloadings_ && unloaded_.instances == state_.instances &&
      unloaded_.tolerance_mm == state_.tolerance_mm &&
      unloaded_.design.roles == state_.design.roles &&
      unloaded_.design.limit("lift_mm") == state_.design.limit("lift_mm")) {
    return *unloadings_;
  }
  unloadings_.emplace();
  for (const FixtureModel& model : fixtures()) {
    unloadings_->push_back(analyse_unloading(model, *this));
  }
  unloaded_ = state_;
  return *unloadings_;
}

}  // namespace dowel
