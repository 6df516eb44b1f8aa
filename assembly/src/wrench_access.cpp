#include "wrench_access.h"

#include <algorithm>
#include <numbers>
#include <set>

#include <Eigen/Geometry>

#include "fact_source.h"
#include "fixture_result.h"
#include "instance_boxes.h"
#include "tool_solid.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// Which parts are held by which, as numbers.
class HoldingGraph {
 public:
  explicit HoldingGraph(FactSource& source) {
    for (const auto& [name, instance] : source.state().instances) {
      number_.emplace(name, names_.size());
      names_.push_back(name);
      is_base_.push_back(instance.grounded || source.role(instance) == Role::BasePlate);
    }
    holds_.resize(names_.size());
    for (const Holding& holding : source.holdings()) {
      holds_[number_.at(holding.by)].push_back(number_.at(holding.held));
    }
    reached_ = reached_without(names_.size());
  }

  /// What a fastener holds, or is held by.
  std::set<std::string> neighbours(const std::string& fastener) const {
    std::set<std::string> names;
    for (const std::size_t other : holds_[number_.at(fastener)]) names.insert(names_[other]);
    return names;
  }

  /// Parts that hang on the base by `part` alone: they come after it.
  std::set<std::string> dependents(const std::string& part) {
    const auto [entry, is_new] = dependents_.try_emplace(part);
    if (!is_new) return entry->second;
    const std::size_t gone = number_.at(part);
    if (is_base_[gone]) return {};
    const std::vector<bool> reached = reached_without(gone);
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (i != gone && reached_[i] && !reached[i]) entry->second.insert(names_[i]);
    }
    return entry->second;
  }

 private:
  std::vector<bool> reached_without(std::size_t gone) const {
    std::vector<bool> reached(names_.size(), false);
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < names_.size(); ++i) {
      if (!is_base_[i] || i == gone) continue;
      reached[i] = true;
      open.push_back(i);
    }
    while (!open.empty()) {
      const std::size_t at = open.back();
      open.pop_back();
      for (const std::size_t held : holds_[at]) {
        if (held == gone || reached[held]) continue;
        reached[held] = true;
        open.push_back(held);
      }
    }
    return reached;
  }

  std::map<std::string, std::size_t> number_;
  std::vector<std::string> names_;
  std::vector<bool> is_base_;
  std::vector<std::vector<std::size_t>> holds_;
  std::vector<bool> reached_;
  std::map<std::string, std::set<std::string>> dependents_;
};

/// The widest gap between blocked angles.
double widest_swing(const std::vector<bool>& is_blocked) {
  const int steps = static_cast<int>(is_blocked.size());
  if (std::ranges::find(is_blocked, true) == is_blocked.end()) return 2.0 * std::numbers::pi;
  int widest = 0;
  int run = 0;
  for (int i = 0; i < 2 * steps; ++i) {
    run = is_blocked[static_cast<std::size_t>(i % steps)] ? 0 : run + 1;
    widest = std::max(widest, run);
  }
  return 2.0 * std::numbers::pi * std::max(0, widest - 1) / steps;
}

/// What is not there yet when a fastener is tightened. Those of clamps come last of all.
std::set<std::string> not_there_yet(const std::string& fastener, bool before_workpiece,
                                    const std::set<std::string>& of_clamping, HoldingGraph& graph) {
  std::set<std::string> names{fastener};
  if (!before_workpiece) return names;
  names.insert(of_clamping.begin(), of_clamping.end());
  const std::set<std::string> neighbours = graph.neighbours(fastener);
  for (const std::string& neighbour : neighbours) {
    for (const std::string& later : graph.dependents(neighbour)) {
      if (!neighbours.contains(later)) names.insert(later);
    }
  }
  return names;
}

}  // namespace

const std::shared_ptr<const CollisionElement>& WrenchBench::cylinder(double diameter_mm,
                                                                     double length_mm) {
  auto& found = cylinders_[{diameter_mm, length_mm}];
  if (found == nullptr) found = cylinder_model(diameter_mm, length_mm);
  return found;
}

void WrenchBench::use_tolerance(double tolerance_mm) {
  if (tolerance_mm != tolerance_mm_) known_.clear();
  tolerance_mm_ = tolerance_mm;
}

bool WrenchBench::is_in(const ToolRoom& room, const Placed& part) {
  if (!box_of(room).intersects(part.box_W)) return false;
  CollisionScene scene;
  scene.add(part.model, part.instance->X_WI);
  const BodyId tool = scene.add(cylinder(room.diameter_mm, room.length_mm), room.X_WT);
  const auto verdicts = scene.check({&tool, 1}, {&room.X_WT, 1}, {.tolerance_mm = tolerance_mm_});
  return std::ranges::any_of(verdicts, [](const BodyVerdict& verdict) {
    return verdict.pair.verdict == Verdict::Interference;
  });
}

const WrenchBench::InWay& WrenchBench::in_way(Known& known, const Placed& part) {
  const auto [entry, is_new] = known.in_way.try_emplace(part.instance->name);
  InWay& found = entry->second;
  if (!is_new && found.part == *part.instance) return found;
  found = {*part.instance, {}, {}, false};
  for (const WrenchRoom& room : known.rooms.wrenches) {
    found.of_head.push_back(is_in(room.head, part));
    std::vector<bool>& of_lever = found.of_lever.emplace_back();
    for (const ToolRoom& lever : room.levers) of_lever.push_back(is_in(lever, part));
    if (std::ranges::find(of_lever, true) == of_lever.end()) of_lever.clear();
  }
  found.of_way_in = known.rooms.way_in && is_in(*known.rooms.way_in, part);
  return found;
}

WrenchAccess WrenchBench::answer(Known& known, const std::vector<Placed>& near,
                                 const std::set<std::string>& put_together) {
  WrenchAccess result;
  result.fastener = known.fastener.name;
  std::vector<const InWay*> parts;
  parts.reserve(near.size());
  for (const Placed& part : near) parts.push_back(&in_way(known, part));
  for (std::size_t i = 0; i < known.rooms.wrenches.size(); ++i) {
    const WrenchRoom& room = known.rooms.wrenches[i];
    const auto first = std::ranges::find_if(parts, [&](const InWay* p) { return p->of_head[i]; });
    const bool is_free = first == parts.end();
    std::vector<bool> is_blocked(room.levers.size(), false);
    for (const InWay* part : parts) {
      for (std::size_t at = 0; at < part->of_lever[i].size(); ++at) {
        if (part->of_lever[i][at]) is_blocked[at] = true;
      }
    }
    const double swing_rad = is_free ? widest_swing(is_blocked) : 0.0;
    const bool is_better = swing_rad > result.swing_rad || (is_free && !result.is_free);
    if (!is_better && !result.wrench.empty()) continue;
    result.wrench = room.wrench.name;
    result.is_free = is_free;
    result.blocked_by = is_free ? std::string() : (*first)->part.name;
    result.lever_mm = room.wrench.lever_mm;
    result.swing_rad = swing_rad;
  }
  if (known.rooms.way_in) {
    const auto first = std::ranges::find_if(parts, [&](const InWay* part) {
      return part->of_way_in && !put_together.contains(part->part.name);
    });
    result.comes_in = first == parts.end();
    if (first != parts.end()) result.stopped_by = (*first)->part.name;
  }
  return result;
}

WrenchBench::Known& WrenchBench::known(const Instance& fastener, const Drive& drive) {
  Known& known = known_[fastener.name];
  if (!(known.fastener == fastener)) {
    known = {fastener, rooms_around(drive, fastener.X_WI), {}};
  }
  return known;
}

const std::optional<Drive>& WrenchBench::drive(const std::string& element, FactSource& source) {
  const auto [entry, is_new] = drives_.try_emplace(element);
  if (is_new) entry->second = drive_of(source.session().element(element), *source.solid(element));
  return entry->second;
}

std::vector<WrenchBench::Placed> WrenchBench::placed(FactSource& source) {
  std::vector<Placed> parts;
  for (const auto& [name, instance] : source.state().instances) {
    parts.push_back({&instance, box_around(instance, source.element(instance)),
                     source.shape(instance.element)});
  }
  return parts;
}

std::vector<WrenchAccess> WrenchBench::access(FactSource& source) {
  const ProjectState& state = source.state();
  use_tolerance(state.tolerance_mm);
  const std::set<std::string> clamping = taken_off(state, source.session(), source.touches());
  std::set<std::string> of_clamping = clamping;
  for (const auto& [name, instance] : state.instances) {
    if (source.role(instance) == Role::Workpiece) of_clamping.insert(name);
  }
  const std::vector<Placed> parts = placed(source);
  HoldingGraph graph(source);
  std::vector<WrenchAccess> all;
  for (const auto& [name, instance] : state.instances) {
    const auto& hexagon = drive(instance.element, source);
    if (!hexagon) continue;
    Known& of_fastener = known(instance, *hexagon);
    if (of_fastener.rooms.wrenches.empty()) continue;
    const bool before_workpiece = !clamping.contains(name);
    std::set<std::string> absent = not_there_yet(name, before_workpiece, of_clamping, graph);
    // A nut's wrench goes around the screw that is in it.
    for (const AxisPair& pair : source.axes()) {
      if (pair.hole_instance == name) absent.insert(pair.shaft_instance);
    }
    std::vector<Placed> near;
    for (const Placed& part : parts) {
      if (of_fastener.rooms.may_be_in(part.box_W) && !absent.contains(part.instance->name)) {
        near.push_back(part);
      }
    }
    // What is put together in no certain order: parts of clamps.
    all.push_back(answer(of_fastener, near, before_workpiece ? std::set<std::string>() : clamping));
    all.back().before_workpiece = before_workpiece;
  }
  return all;
}

std::vector<std::string> WrenchBench::in_way_of_cutter(FactSource& source,
                                                       const CriticalPoint& point,
                                                       double diameter_mm, double length_mm) {
  use_tolerance(source.state().tolerance_mm);
  const ToolRoom cutter{Pose::from_translation(point.at), diameter_mm, length_mm};
  std::vector<std::string> names;
  for (const Placed& part : placed(source)) {
    if (source.role(*part.instance) != Role::Workpiece && is_in(cutter, part)) {
      names.push_back(part.instance->name);
    }
  }
  return names;
}

}  // namespace dowel
