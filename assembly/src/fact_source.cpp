#include "fact_source.h"

#include <algorithm>
#include <set>
#include <tuple>

#include "dowel/assembly/fit.h"
#include "dowel/kernel/tolerance.h"
#include "fixture_result.h"
#include "instance_boxes.h"

namespace dowel {
namespace {

std::tuple<const std::string&, const std::string&> names_of(const Touch& touch) {
  return std::tie(touch.instance, touch.with);
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
  if (!has_state_ || now.instances != state_.instances) changed |= FromParts;
  if (!has_state_ || now.mates != state_.mates) changed |= FromMates;
  if (!has_state_ || !(now.design == state_.design)) changed |= FromDesign;
  if (!has_state_ || now.tolerance_mm != state_.tolerance_mm) changed |= FromTolerance;
  has_state_ = true;
  if (changed == 0) return 0;
  state_ = now;
  // Features of elements are pointed to, and an element may be another after a removal.
  axes_.reset();
  slots_.reset();
  wrenches_.reset();
  holdings_.reset();
  fixtures_.reset();
  return changed;
}

void FactSource::update_pairs(Pairs& pairs, double gap_mm, const std::vector<Touch>* but) {
  bodies_.follow(state_);
  const bool is_new =
      !pairs.touches || pairs.gap_mm != gap_mm || pairs.of.tolerance_mm != state_.tolerance_mm;
  const std::set<std::string> changed =
      is_new ? std::set<std::string>() : changed_parts(pairs.of, state_);
  if (!is_new && changed.empty()) return;
  if (is_new) pairs.touches.emplace();
  // What two parts that stay where they are do to each other stays, too.
  std::erase_if(*pairs.touches, [&](const Touch& touch) {
    return changed.contains(touch.instance) || changed.contains(touch.with);
  });
  const auto element_of = [this](const Instance& instance) -> const Element& {
    return element(instance);
  };
  for (const auto& [a, b] : near_pairs(state_, element_of, gap_mm, is_new ? nullptr : &changed)) {
    if (but != nullptr &&
        std::ranges::binary_search(*but, std::tie(a->name, b->name), {}, names_of)) {
      continue;
    }
    PairVerdict pair = bodies_.pair(a->name, b->name, gap_mm);
    if (but != nullptr) pair = nearest(a->name, b->name, pair);
    if (pair.verdict != Verdict::Clear) pairs.touches->push_back({a->name, b->name, pair});
  }
  std::ranges::sort(*pairs.touches, {}, names_of);
  pairs.of = state_;
  pairs.gap_mm = gap_mm;
}

const std::vector<Touch>& FactSource::touches() {
  update_pairs(touching_, state_.tolerance_mm, nullptr);
  return *touching_.touches;
}

const std::vector<Touch>& FactSource::nearer_than(double gap_mm) {
  update_pairs(near_, gap_mm, &touches());
  return *near_.touches;
}

const std::vector<AxisPair>& FactSource::axes() {
  if (!axes_) {
    axes_ = axis_pairs(
        state_, [this](const Instance& instance) -> const Element& { return element(instance); });
  }
  return *axes_;
}

const std::vector<SlotPair>& FactSource::slots() {
  if (!slots_) {
    slots_ = slot_pairs(
        state_, [this](const Instance& instance) -> const Element& { return element(instance); },
        [this](const std::string& name) { return solid(name); });
  }
  return *slots_;
}

const std::vector<Holding>& FactSource::holdings() {
  if (holdings_) return *holdings_;
  std::set<std::tuple<std::string, std::string, std::string>> found;
  const auto hold = [&](const std::string& a, const std::string& b, const char* kind) {
    found.emplace(a, b, kind);
    found.emplace(b, a, kind);
  };
  std::set<std::string> screws;
  std::set<std::string> threaded;
  for (const AxisPair& pair : axes()) {
    if (!pair.is_thread) continue;
    hold(pair.shaft_instance, pair.hole_instance, "thread");
    screws.insert(pair.shaft_instance);
    threaded.insert({pair.shaft_instance, pair.hole_instance});
  }
  for (const AxisPair& pair : axes()) {
    if (pair.is_thread) continue;
    if (is_press_fit(pair)) hold(pair.shaft_instance, pair.hole_instance, "press");
    if (screws.contains(pair.shaft_instance)) {
      hold(pair.shaft_instance, pair.hole_instance, "screw");
    }
  }
  for (const SlotPair& pair : slots()) {
    // Pulled up by its screw or nut, its foot is under the throat.
    if (threaded.contains(pair.instance) && pair.shoulder_mm &&
        *pair.shoulder_mm <= std::max(kCoaxial_mm, state_.tolerance_mm)) {
      hold(pair.instance, pair.slot_instance, "tee");
    }
  }
  for (const auto& [key, part] : keyed_parts(state_, slots())) {
    // A key is caught between two slots; it holds neither of the parts.
    found.emplace(key, part, "key");
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

PairVerdict FactSource::pair(const std::string& a, const std::string& b, double tolerance_mm) {
  bodies_.follow(state_);
  const auto [first, second] = std::minmax(a, b);
  return nearest(first, second, bodies_.pair(first, second, tolerance_mm));
}

/// A contact at a wide tolerance is told by the first place that is near enough. Halved until it is
/// as narrow as the gap, it tells the least.
PairVerdict FactSource::nearest(const std::string& a, const std::string& b, PairVerdict pair) {
  constexpr double kGapStep_mm = 1.0e-3;
  double least_mm = 0.0;
  while (pair.verdict == Verdict::Contact && pair.gap_mm - least_mm > kGapStep_mm) {
    const double tolerance_mm = 0.5 * (least_mm + pair.gap_mm);
    const PairVerdict closer = bodies_.pair(a, b, tolerance_mm);
    if (closer.verdict == Verdict::Clear) {
      least_mm = tolerance_mm;
    } else {
      pair.gap_mm = closer.verdict == Verdict::Contact ? closer.gap_mm : 0.0;
      pair.witness_W = closer.witness_W;
    }
  }
  return pair;
}

const std::vector<WrenchAccess>& FactSource::wrenches() {
  if (!wrenches_) wrenches_ = wrench_bench_.access(*this);
  return *wrenches_;
}

std::vector<std::string> FactSource::in_way_of_cutter(const CriticalPoint& point,
                                                      double diameter_mm, double length_mm) {
  return wrench_bench_.in_way_of_cutter(*this, point, diameter_mm, length_mm);
}

const UnloadAnalysis& FactSource::unloading(const FixtureModel& model) {
  Unloading unloading = unloading_of(model, *this);
  KnownUnloading& known = unloadings_[model.workpiece];
  if (!(known.of == unloading)) known = {unloading, analyse_unloading(unloading, bodies_)};
  return known.analysis;
}

const FoolproofAnalysis& FactSource::foolproof(const FixtureModel& model) {
  FoolproofQuestion question = foolproof_question(model, *this);
  KnownFoolproof& known = foolproofs_[model.workpiece];
  if (!(known.answer.question == question)) {
    const Element& workpiece = element(*state_.find(model.workpiece));
    known.answer = analyse_foolproof(std::move(question), known.answer, workpiece, bodies_);
    known.analysis = known.answer.analysis();
  }
  return known.analysis;
}

}  // namespace dowel
