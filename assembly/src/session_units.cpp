// Units of a session: fixed together, brought in from another project; mates that hold already.

#include <algorithm>
#include <array>

#include "dowel/kernel/check.h"
#include "mate_graph.h"
#include "session_impl.h"

namespace dowel {
namespace {

std::uint32_t next_number(const ProjectState& state) {
  return state.mates.empty() ? 1 : state.mates.rbegin()->first + 1;
}

FeatureName renamed(const FeatureName& name, const std::string& prefix) {
  return name.instance.empty() ? name : FeatureName{prefix + name.instance, name.feature};
}

/// Holds `moving` as it stands to `fixed`.
Mate fixing(const Instance& moving, const Instance& fixed) {
  Mate mate;
  mate.kind = MateKind::Fix;
  mate.moving.instance = moving.name;
  mate.fixed.instance = fixed.name;
  mate.X_FM = settled(fixed.X_WI.inverse() * moving.X_WI);
  return mate;
}

}  // namespace

std::vector<Mate> Session::adopt(std::span<const Mate> mates, std::string_view command) {
  ProjectState next = state();
  std::vector<std::uint32_t> numbers;
  for (Mate mate : mates) {
    mate.number = next_number(next);
    if (!impl_->holds(mate, next)) {
      refuse("the mate of " + mate.moving.text() + " with " + mate.fixed.text() +
             " does not hold as the parts stand");
    }
    numbers.push_back(mate.number);
    next.mates.emplace(mate.number, std::move(mate));
  }
  PartNames free;
  for (const auto& [name, placed] : next.instances) {
    if (!placed.grounded) free.insert(name);
  }
  if (free.size() == next.instances.size() && !free.empty()) {
    free.erase(next.in_order().front()->name);
  }
  const NamedProblem named = impl_->problem(next, free);
  const MateSolution solution = solve_mates(named.problem);
  std::vector<Mate> made;
  for (std::size_t i = 0; i < named.mates.size(); ++i) {
    const Mate& mate = named.mates[i];
    if (std::ranges::find(numbers, mate.number) == numbers.end()) continue;
    if (solution.mates[i].status == MateStatus::Holds) {
      made.push_back(mate);
    } else {
      next.mates.erase(mate.number);
    }
  }
  impl_->commit(command, next);
  return made;
}

MoveReport Session::put(std::string_view name, const Pose& X_WI, std::span<const Mate> mates,
                        std::string_view command) {
  const Instance before = impl_->movable(name);
  expect_in_reach(X_WI, before.name);
  MoveReport report;
  report.X_WI = X_WI;
  report.X_WI_free = X_WI;
  ProjectState there = state();
  there.instances.at(before.name).X_WI = settled(X_WI);
  ProjectState next = state();
  for (Mate mate : mates) {
    const auto at = [&](const FeatureName& feature) {
      return PlacedFeature{impl_->feature(feature).feature, there.find(feature.instance)->X_WI};
    };
    if (!impl_->holds(mate, there)) {
      refuse("the mate of " + mate.moving.text() + " with " + mate.fixed.text() +
             " would not hold there");
    }
    mate.thread = Impl::expect_fit(mate.moving, at(mate.moving), mate.fixed, at(mate.fixed));
    mate.number = next_number(next);
    report.held_by.push_back(mate);
    next.mates.emplace(mate.number, std::move(mate));
  }
  if (state().mode != CheckMode::Off) report.touches = check_at(before.name, X_WI);
  if (worst(report.touches) == Verdict::Interference) report.free_share = 0.0;
  report = impl_->finish(std::move(report), before, std::move(next), command);
  if (report.refused) report.held_by.clear();
  return report;
}

std::vector<Mate> Session::fix(std::span<const std::string> names, std::string_view command) {
  DOWEL_EXPECTS(names.size() >= 2);
  const Instance first = impl_->instance(names.front());
  ProjectState next = state();
  std::vector<Mate> made;
  for (const std::string& name : names.subspan(1)) {
    const Instance& other = impl_->instance(name);
    if (unit_of(next, first.name).contains(other.name)) {
      refuse(other.name + " is fixed to " + first.name + " already");
    }
    Mate mate = fixing(other, first);
    mate.number = next_number(next);
    made.push_back(mate);
    next.mates.emplace(mate.number, std::move(mate));
  }
  impl_->commit(command, next);
  return made;
}

std::vector<MoveReport> Session::insert_unit(const Project& unit, std::string_view prefix,
                                             const Pose& X_WU, std::string_view command) {
  const std::vector<const Instance*> parts = unit.state().in_order();
  if (parts.empty()) refuse(unit.file().string() + " has no instances to place");
  for (const Instance* part : parts) {
    const Element& copy = *unit.find_element(part->element);
    const Element* mine = impl_->project.find_element(part->element);
    if (mine != nullptr) {
      if (mine->sha256 == copy.sha256 && mine->volume_mm3 == copy.volume_mm3) continue;
      refuse("the project has another element called \"" + copy.name + "\" than " +
             unit.file().string());
    }
    impl_->candidates.insert_or_assign(
        copy.name,
        Impl::Candidate{copy, unit.solid(copy.name),
                        std::make_shared<const std::vector<std::byte>>(unit.brep(copy.name))});
  }
  const std::string start = std::string(prefix) + "-";
  ProjectState next = state();
  std::vector<MoveReport> reports;
  for (const Instance* part : parts) {
    reports.push_back(impl_->add(next, {part->element, start + part->name, X_WU * part->X_WI, {}}));
    if (!reports.back().refused) continue;
    for (MoveReport& report : reports) report.refused = true;
    return reports;
  }
  for (const auto& [old_number, old] : unit.state().mates) {
    Mate mate = old;
    mate.number = next_number(next);
    for (FeatureName* name :
         std::array{&mate.moving, &mate.fixed, &mate.moving_face, &mate.fixed_face}) {
      *name = renamed(*name, start);
    }
    next.mates.emplace(mate.number, std::move(mate));
  }
  const Instance& first = *next.find(start + parts.front()->name);
  for (const Instance* part : parts) {
    const Instance& placed = *next.find(start + part->name);
    if (unit_of(next, first.name).contains(placed.name)) continue;
    Mate mate = fixing(placed, first);
    mate.number = next_number(next);
    next.mates.emplace(mate.number, std::move(mate));
  }
  impl_->commit_placed(command, next);
  return reports;
}

}  // namespace dowel
