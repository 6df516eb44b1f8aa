#include "mate_graph.h"

#include <algorithm>

namespace dowel {
namespace {

bool is_on(const Mate& mate, const PartNames& group) {
  return group.contains(mate.moving.instance) || group.contains(mate.fixed.instance) ||
         (mate.has_seat() && group.contains(mate.fixed_face.instance));
}

/// Adds to `group` all parts that `joins(mate, group)` names, until there are no more. Asks of
/// mates alone that are on the group.
template <class Joins>
PartNames grown(PartNames group, const ProjectState& state, Joins&& joins) {
  for (bool grows = true; grows;) {
    grows = false;
    for (const auto& [number, mate] : state.mates) {
      if (!is_on(mate, group)) continue;
      for (const std::string& part : joins(mate, group)) {
        if (group.insert(part).second) grows = true;
      }
    }
  }
  return group;
}

bool meet(const PartNames& a, const PartNames& b) {
  return std::ranges::any_of(a, [&](const std::string& part) { return b.contains(part); });
}

}  // namespace

PartNames parts_of(const Mate& mate) {
  PartNames parts{mate.moving.instance, mate.fixed.instance};
  if (mate.has_seat()) parts.insert(mate.fixed_face.instance);
  return parts;
}

PartNames hanging_together(const ProjectState& state, const std::string& name) {
  return grown({name}, state, [&](const Mate& mate, const PartNames& group) {
    const PartNames parts = parts_of(mate);
    const bool joins = std::ranges::any_of(parts, [&](const std::string& part) {
      return group.contains(part) && !state.find(part)->grounded;
    });
    return joins ? parts : PartNames();
  });
}

PartNames unit_of(const ProjectState& state, const std::string& name) {
  return grown({name}, state, [](const Mate& mate, const PartNames& group) {
    if (mate.kind != MateKind::Fix) return PartNames();
    const PartNames parts = parts_of(mate);
    return meet(parts, group) ? parts : PartNames();
  });
}

PartNames sub_assembly_of(const ProjectState& state, const std::string& name) {
  const PartNames unit = unit_of(state, name);
  const PartNames all = hanging_together(state, name);
  // What stays of itself.
  PartNames rest;
  for (const std::string& part : all) {
    if (state.find(part)->grounded && !unit.contains(part)) rest.insert(part);
  }
  if (rest.empty()) {
    const PartNames carried = grown(unit, state, [](const Mate& mate, const PartNames& group) {
      const PartNames parts = parts_of(mate);
      const bool hangs_on = group.contains(mate.fixed.instance) ||
                            (mate.kind == MateKind::Fix && group.contains(mate.moving.instance));
      return hangs_on ? PartNames{mate.moving.instance, mate.fixed.instance} : PartNames();
    });
    std::ranges::set_difference(all, carried, std::inserter(rest, rest.end()));
  }
  // And what hangs on that without going over the unit.
  rest = grown(std::move(rest), state, [&](const Mate& mate, const PartNames& group) {
    PartNames parts = parts_of(mate);
    if (!meet(parts, group)) return PartNames();
    std::erase_if(parts, [&](const std::string& part) { return unit.contains(part); });
    return parts;
  });
  PartNames carried;
  std::ranges::set_difference(all, rest, std::inserter(carried, carried.end()));
  carried.insert(unit.begin(), unit.end());
  return carried;
}

bool is_in_loop(const ProjectState& state, const PartNames& group) {
  PartNames others;
  for (const auto& [number, mate] : state.mates) {
    if (!is_on(mate, group)) continue;
    for (const std::string& part : parts_of(mate)) {
      // No instance is called nothing.
      if (!group.contains(part)) others.insert(state.find(part)->grounded ? "" : part);
    }
  }
  return others.size() >= 2;
}

PartNames free_parts(const ProjectState& state, PartNames group, const std::string& held) {
  const std::size_t all = group.size();
  std::erase_if(group, [&](const std::string& part) { return state.find(part)->grounded; });
  if (group.size() == all) group.erase(held);
  return group;
}

}  // namespace dowel
