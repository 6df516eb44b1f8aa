// Placing new instances.

#include <algorithm>

#include "dowel/assembly/names.h"
#include "session_impl.h"

namespace dowel {

std::vector<Mate> Session::Impl::mate_in_place(ProjectState& next, const Instance& placed,
                                               const FeatureName& at) {
  const Instance& part = instance(at.instance);
  const Element& moving = element(placed.element);
  const Element& fixed = element(part.element);
  const Pose X_BE = part.X_WI.inverse() * placed.X_WI;
  std::vector<Mate> made;
  for (const FeaturePair& pair :
       holding_pairs(matching_pairs(moving, X_BE, fixed), moving, at.feature)) {
    Mate mate;
    mate.moving = {placed.name, pair.moving};
    mate.fixed = {part.name, pair.fixed};
    const PlacedFeature moving_W{moving.find_feature(pair.moving), placed.X_WI};
    const PlacedFeature fixed_W{fixed.find_feature(pair.fixed), part.X_WI};
    mate.kind = made.empty() ? mate_kind(*moving_W.feature, *fixed_W.feature) : MateKind::Align;
    mate.thread = expect_fit(mate.moving, moving_W, mate.fixed, fixed_W);
    mate.number = next.mates.empty() ? 1 : next.mates.rbegin()->first + 1;
    if (mate.kind == MateKind::Align) {
      MateFeatures features;
      features.kind = mate.kind;
      features.moving = moving_W.feature;
      features.fixed = fixed_W.feature;
      mate.flip = nearest_flip(features, X_BE);
    }
    next.mates.emplace(mate.number, mate);
    made.push_back(std::move(mate));
  }
  return made;
}

MoveReport Session::Impl::place(std::string_view element_name, std::string_view name,
                                const Pose& X_WI, const std::optional<FeatureName>& at,
                                std::string_view command) {
  Instance placed;
  placed.element = element(element_name).name;
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
    bodies.follow(next);
    report.touches = bodies.check(placed.name, placed.X_WI, state().tolerance_mm);
    report.verdict = worst(report.touches);
    if (report.verdict == Verdict::Interference) report.free_share = 0.0;
    report.refused = state().mode == CheckMode::Block && report.verdict == Verdict::Interference;
  }
  if (!report.refused) {
    if (at) report.held_by = mate_in_place(next, placed, *at);
    commit(command, next, missing_copy(placed.element));
  }
  return report;
}

}  // namespace dowel
