// Placing new instances.

#include <algorithm>

#include "dowel/assembly/names.h"
#include "dowel/kernel/check.h"
#include "session_impl.h"

namespace dowel {

std::vector<Mate> Session::Impl::mate_in_place(ProjectState& next, const Instance& placed,
                                               const FeatureName& at) {
  const Instance part = *next.find(at.instance);
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

MoveReport Session::Impl::add(ProjectState& next, const Placement& placement) {
  Instance placed;
  placed.element = element(placement.element).name;
  const auto is_taken = [&](const std::string& n) { return next.find(n) != nullptr; };
  placed.name = placement.name.empty() ? free_name(placement.element, is_taken) : placement.name;
  if (const auto defect = instance_name_defect(placed.name)) {
    refuse("instance name \"" + placed.name + "\" " + *defect);
  }
  if (is_taken(placed.name)) refuse("an instance is called \"" + placed.name + "\" already");
  expect_in_reach(placement.X_WI, placed.name);
  placed.X_WI = settled(placement.X_WI);
  for (const auto& [other_name, other] : next.instances) {
    placed.number = std::max(placed.number, other.number);
  }
  ++placed.number;

  next.instances.emplace(placed.name, placed);
  MoveReport report;
  report.instance = placed.name;
  report.X_WI = placed.X_WI;
  report.X_WI_free = placed.X_WI;
  report.checked = next.mode != CheckMode::Off;
  if (report.checked) {
    bodies.follow(next);
    report.touches = bodies.check(placed.name, placed.X_WI, next.tolerance_mm);
    report.verdict = worst(report.touches);
    if (report.verdict == Verdict::Interference) report.free_share = 0.0;
    report.refused = next.mode == CheckMode::Block && report.verdict == Verdict::Interference;
  }
  if (report.refused) {
    next.instances.erase(placed.name);
    return report;
  }
  for (Mate mate : placement.mates) {
    mate.moving.instance = placed.name;
    mate.number = next.mates.empty() ? 1 : next.mates.rbegin()->first + 1;
    DOWEL_EXPECTS(next.find(mate.fixed.instance) != nullptr);
    next.mates.emplace(mate.number, mate);
    report.held_by.push_back(std::move(mate));
  }
  return report;
}

void Session::Impl::commit_placed(std::string_view command, const ProjectState& next) {
  std::vector<ProjectElement> copies;
  for (const auto& [name, placed] : next.instances) {
    if (state().find(name) != nullptr) continue;
    const bool is_there =
        project.find_element(placed.element) != nullptr ||
        std::ranges::any_of(copies, [&, &wanted = placed](const ProjectElement& copy) {
          return copy.element.name == wanted.element;
        });
    if (!is_there) copies.push_back(missing_copy(placed.element).front());
  }
  commit(command, next, copies);
}

MoveReport Session::place(std::string_view element_name, std::string_view name, const Pose& X_WI,
                          std::string_view command) {
  const Placement placement{std::string(element_name), std::string(name), X_WI, {}};
  return place_all({&placement, 1}, command).front();
}

MoveReport Session::place_at(std::string_view element_name, std::string_view name, const Pose& X_WI,
                             const FeatureName& at, std::string_view command) {
  impl_->feature(at);
  ProjectState next = state();
  MoveReport report = impl_->add(next, {std::string(element_name), std::string(name), X_WI, {}});
  if (report.refused) return report;
  const Instance placed = *next.find(report.instance);
  report.held_by = impl_->mate_in_place(next, placed, at);
  impl_->commit_placed(command, next);
  return report;
}

std::vector<MoveReport> Session::place_all(std::span<const Placement> placements,
                                           std::optional<std::string_view> command) {
  ProjectState next = state();
  std::vector<MoveReport> reports;
  for (const Placement& placement : placements) {
    reports.push_back(impl_->add(next, placement));
    if (!reports.back().refused) continue;
    for (MoveReport& report : reports) report.refused = true;
    return reports;
  }
  if (command) impl_->commit_placed(*command, next);
  return reports;
}

}  // namespace dowel
