#include "wrench_access.h"

#include <algorithm>
#include <array>
#include <cmath>
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

/// A tool on a drive: a cylinder about the axis and a lever square to it. Heights along the axis.
struct TurningTool {
  std::string name;
  double sense = 1.0;  ///< along the drive's axis, or against it
  double head_mm = 0.0;
  double from_mm = 0.0;
  double to_mm = 0.0;
  double lever_at_mm = 0.0;
  double lever_diameter_mm = 0.0;
  double lever_mm = 0.0;
};

/// Hexagon keys: width across flats, short and long leg. Source: ISO 2936, by general knowledge.
struct HexKey {
  double size_mm;
  double short_mm;
  double long_mm;
};
constexpr std::array kHexKeys{HexKey{2.5, 18, 56}, HexKey{3, 20, 63},   HexKey{4, 25, 70},
                              HexKey{5, 28, 80},   HexKey{6, 32, 90},   HexKey{8, 36, 100},
                              HexKey{10, 40, 112}, HexKey{12, 45, 125}, HexKey{14, 56, 140},
                              HexKey{17, 63, 160}, HexKey{19, 70, 180}};
constexpr double kKeyPlay_mm = 0.3;

/// Sockets with a square drive of 12.5 mm: outside 1.25 s + 3 as in ISO 2725-1, and a handle like
/// ISO 3315. Open-ended spanners: head and thickness like DIN 3110. General knowledge, all.
constexpr double kSocketHeight_mm = 42.0;
constexpr double kHandle_mm = 250.0;
constexpr double kHandleDiameter_mm = 20.0;
constexpr double kSpannerHead = 2.1;        // widths across flats
constexpr double kSpannerThickness = 0.42;  // the same
constexpr double kSpannerLength = 12.0;     // the same

/// A tool does not scrape along what the fastener stands on.
constexpr double kOffSeat_mm = 0.5;

const double kCornersByFlats = 2.0 / std::sqrt(3.0);

std::string size_text(double size_mm) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", size_mm);
  return text.data();
}

std::optional<TurningTool> hex_key_for(const Drive& drive) {
  for (const HexKey& key : kHexKeys) {
    if (std::abs(key.size_mm - drive.across_flats_mm) > kKeyPlay_mm) continue;
    const double corners_mm = kCornersByFlats * key.size_mm;
    const double bend_mm = drive.from_mm + key.short_mm - 0.5 * corners_mm;
    return TurningTool{"hex key " + size_text(key.size_mm),
                       1.0,
                       corners_mm,
                       drive.to_mm,
                       std::max(bend_mm, drive.to_mm + corners_mm),
                       std::max(bend_mm, drive.to_mm + 0.5 * corners_mm + kOffSeat_mm),
                       corners_mm,
                       key.long_mm};
  }
  return std::nullopt;
}

TurningTool socket_for(const Drive& drive, double sense) {
  const double from_mm = sense > 0.0 ? drive.from_mm : -drive.to_mm;
  const double top_mm = from_mm + kOffSeat_mm + kSocketHeight_mm;
  return {"socket " + size_text(drive.across_flats_mm),
          sense,
          1.25 * drive.across_flats_mm + 3.0,
          from_mm + kOffSeat_mm,
          top_mm,
          top_mm + 0.5 * kHandleDiameter_mm,
          kHandleDiameter_mm,
          kHandle_mm};
}

TurningTool spanner_for(const Drive& drive) {
  const double middle_mm = 0.5 * (drive.from_mm + drive.to_mm);
  const double half_mm = std::min(0.5 * kSpannerThickness * drive.across_flats_mm,
                                  0.5 * (drive.to_mm - drive.from_mm) - kOffSeat_mm);
  return {"spanner " + size_text(drive.across_flats_mm),
          1.0,
          kSpannerHead * drive.across_flats_mm,
          middle_mm - half_mm,
          middle_mm + half_mm,
          middle_mm,
          2.0 * half_mm,
          kSpannerLength * drive.across_flats_mm};
}

/// Best first.
std::vector<TurningTool> wrenches_for(const Drive& drive) {
  if (drive.kind == Drive::Kind::Socket) {
    const auto key = hex_key_for(drive);
    return key ? std::vector{*key} : std::vector<TurningTool>();
  }
  std::vector<TurningTool> wrenches{socket_for(drive, 1.0)};
  if (drive.is_nut) wrenches.push_back(socket_for(drive, -1.0));
  if (drive.to_mm - drive.from_mm > 3.0 * kOffSeat_mm) wrenches.push_back(spanner_for(drive));
  return wrenches;
}

/// World pose of a frame on the drive's axis, z along it.
Pose axis_frame(const Drive& drive, double sense, const Pose& X_WI) {
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond::FromTwoVectors(Vector3d::UnitZ(), sense * drive.axis);
  return X_WI * Pose(turn, drive.axis_origin);
}

Pose lifted(const Pose& X_WA, double by_mm) {
  return X_WA * Pose::from_translation({0, 0, by_mm});
}

/// Parts near a fastener, as bodies that tools are held against.
class Surroundings {
 public:
  Surroundings(const std::vector<Instance>& near, double tolerance_mm, FactSource& source)
      : options_{.tolerance_mm = tolerance_mm} {
    for (const Instance& instance : near) {
      const BodyId id = scene_.add(source.shape(instance.element), instance.X_WI);
      names_.emplace_back(id, instance.name);
    }
  }

  BodyId add(const std::shared_ptr<const CollisionElement>& tool) {
    tools_.push_back(scene_.add(tool, Pose()));
    return tools_.back();
  }

  /// Parts that the tool is in, by name.
  std::vector<std::string> in_way(BodyId tool, const Pose& X_WT) {
    std::vector<std::string> found;
    for (const BodyVerdict& verdict : scene_.check({&tool, 1}, {&X_WT, 1}, options_)) {
      if (verdict.pair.verdict != Verdict::Interference) continue;
      const auto name =
          std::ranges::find(names_, verdict.with, &std::pair<BodyId, std::string>::first);
      if (name != names_.end()) found.push_back(name->second);
    }
    std::ranges::sort(found);
    return found;
  }

 private:
  CollisionScene scene_;
  QueryOptions options_;
  std::vector<std::pair<BodyId, std::string>> names_;
  std::vector<BodyId> tools_;
};

/// Tells what is on the way of a lever: it is tried at angles so close that it sweeps all between.
double widest_swing(Surroundings& around, BodyId lever, const Pose& X_WA,
                    const TurningTool& wrench) {
  const double step_rad = std::asin(std::min(1.0, wrench.lever_diameter_mm / wrench.lever_mm));
  const int steps = static_cast<int>(std::ceil(2.0 * std::numbers::pi / step_rad));
  std::vector<bool> is_free;
  for (int i = 0; i < steps; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / steps;
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle_rad, Vector3d::UnitZ()) *
                                  Eigen::AngleAxisd(0.5 * std::numbers::pi, Vector3d::UnitY()));
    is_free.push_back(
        around.in_way(lever, lifted(X_WA, wrench.lever_at_mm) * Pose(turn, Vector3d::Zero()))
            .empty());
  }
  if (std::ranges::find(is_free, false) == is_free.end()) return 2.0 * std::numbers::pi;
  int widest = 0;
  int run = 0;
  for (int i = 0; i < 2 * steps; ++i) {
    run = is_free[static_cast<std::size_t>(i % steps)] ? run + 1 : 0;
    widest = std::max(widest, run);
  }
  return 2.0 * std::numbers::pi * std::max(0, widest - 1) / steps;
}

/// How far from the axis, and along it, anything may be in the way.
Eigen::AlignedBox3d room_of(const Drive& drive, const Pose& X_WI) {
  double low_mm = drive.low_mm;
  double high_mm = drive.high_mm + (drive.seat_mm - drive.low_mm);
  double radius_mm = drive.radius_mm;
  for (const TurningTool& wrench : wrenches_for(drive)) {
    const double top_mm = std::max(wrench.to_mm, wrench.lever_at_mm + wrench.lever_diameter_mm);
    if (wrench.sense > 0.0) {
      low_mm = std::min(low_mm, wrench.from_mm);
      high_mm = std::max(high_mm, top_mm);
    } else {
      low_mm = std::min(low_mm, -top_mm);
    }
    radius_mm = std::max({radius_mm, wrench.lever_mm, 0.5 * wrench.head_mm});
  }
  const Vector3d axis_W = X_WI.rotation() * drive.axis;
  const Vector3d origin_W = X_WI * drive.axis_origin;
  Eigen::AlignedBox3d room(origin_W + low_mm * axis_W);
  room.extend(origin_W + high_mm * axis_W);
  const Vector3d reach_mm =
      radius_mm * (Vector3d::Ones() - axis_W.cwiseAbs2()).cwiseMax(0.0).cwiseSqrt();
  room.min() -= reach_mm;
  room.max() += reach_mm;
  return room;
}

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

WrenchAccess WrenchBench::answer(const Question& question, const Drive& drive, FactSource& source) {
  WrenchAccess result;
  result.fastener = question.fastener.name;
  result.before_workpiece = question.before_workpiece;
  Surroundings around(question.near, question.tolerance_mm, source);
  const Pose& X_WI = question.fastener.X_WI;
  for (const TurningTool& wrench : wrenches_for(drive)) {
    const Pose X_WA = axis_frame(drive, wrench.sense, X_WI);
    const BodyId head = around.add(cylinder(wrench.head_mm, wrench.to_mm - wrench.from_mm));
    const auto in_way = around.in_way(head, lifted(X_WA, wrench.from_mm));
    const bool is_free = in_way.empty();
    double swing_rad = 0.0;
    if (is_free) {
      const BodyId lever = around.add(cylinder(wrench.lever_diameter_mm, wrench.lever_mm));
      swing_rad = widest_swing(around, lever, X_WA, wrench);
    }
    const bool is_better = swing_rad > result.swing_rad || (is_free && !result.is_free);
    if (!is_better && !result.wrench.empty()) continue;
    result.wrench = wrench.name;
    result.is_free = is_free;
    result.blocked_by = is_free ? std::string() : in_way.front();
    result.lever_mm = wrench.lever_mm;
    result.swing_rad = swing_rad;
  }
  if (!drive.is_nut) {
    const double from_mm = drive.seat_mm + kOffSeat_mm;
    const double to_mm = drive.high_mm + drive.seat_mm - drive.low_mm;
    const BodyId path = around.add(cylinder(2.0 * drive.radius_mm, to_mm - from_mm));
    auto in_way = around.in_way(path, lifted(axis_frame(drive, 1.0, X_WI), from_mm));
    std::erase_if(in_way,
                  [&](const std::string& name) { return question.put_together.contains(name); });
    result.comes_in = in_way.empty();
    if (!in_way.empty()) result.stopped_by = in_way.front();
  }
  return result;
}

std::vector<WrenchAccess> WrenchBench::access(FactSource& source) {
  const ProjectState& state = source.state();
  std::set<std::string> of_clamping = taken_off(state, source.session(), source.touches());
  const std::set<std::string> clamping = of_clamping;
  for (const auto& [name, instance] : state.instances) {
    if (source.role(instance) == Role::Workpiece) of_clamping.insert(name);
  }
  std::map<std::string, Eigen::AlignedBox3d> boxes_W;
  for (const auto& [name, instance] : state.instances) {
    boxes_W.emplace(name, box_around(instance, source.element(instance)));
  }
  HoldingGraph graph(source);
  std::vector<WrenchAccess> all;
  for (const auto& [name, instance] : state.instances) {
    const auto [drive, is_new] = drives_.try_emplace(instance.element);
    if (is_new) drive->second = drive_of(source.element(instance), *source.solid(instance.element));
    if (!drive->second || wrenches_for(*drive->second).empty()) continue;
    Question question{instance, !clamping.contains(name), {}, {}, state.tolerance_mm};
    std::set<std::string> absent =
        not_there_yet(name, question.before_workpiece, of_clamping, graph);
    // A nut's wrench goes around the screw that is in it.
    for (const AxisPair& pair : source.axes()) {
      if (pair.hole_instance == name) absent.insert(pair.shaft_instance);
    }
    const Eigen::AlignedBox3d room = room_of(*drive->second, instance.X_WI);
    for (const auto& [other, box] : boxes_W) {
      if (!room.intersects(box) || absent.contains(other)) continue;
      question.near.push_back(*state.find(other));
      if (!question.before_workpiece && clamping.contains(other)) {
        question.put_together.insert(other);
      }
    }
    Known& known = known_[name];
    if (!(known.question == question)) {
      known.access = answer(question, *drive->second, source);
      known.question = std::move(question);
    }
    all.push_back(known.access);
  }
  return all;
}

std::vector<std::string> WrenchBench::in_way_of_cutter(FactSource& source,
                                                       const CriticalPoint& point,
                                                       double diameter_mm, double length_mm) {
  const Vector3d reach_mm(0.5 * diameter_mm, 0.5 * diameter_mm, 0.0);
  Eigen::AlignedBox3d room(point.at - reach_mm);
  room.extend(point.at + reach_mm + Vector3d(0, 0, length_mm));
  std::vector<Instance> near;
  for (const auto& [name, instance] : source.state().instances) {
    if (source.role(instance) != Role::Workpiece &&
        room.intersects(box_around(instance, source.element(instance)))) {
      near.push_back(instance);
    }
  }
  Surroundings around(near, source.state().tolerance_mm, source);
  const BodyId cutter = around.add(cylinder(diameter_mm, length_mm));
  return around.in_way(cutter, Pose::from_translation(point.at));
}

}  // namespace dowel
