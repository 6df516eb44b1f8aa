#include "dowel/assembly/fixture_analysis.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "dowel/kernel/error.h"
#include "fact_source.h"
#include "fixture_result.h"

namespace dowel {
namespace {

/// A contact that a direction leaves by less than this is slid along: rounding of normals.
constexpr double kLeaves = 1.0e-6;

/// Directions to take the workpiece out by: up first, then up and away from the locators, then
/// along the axes. Only those that leave or slide along every contact.
std::vector<Eigen::Vector3d> ways_out(const FixtureModel& model) {
  Eigen::Vector3d away = Eigen::Vector3d::Zero();
  for (const LocatingPoint& point : model.locators) away += point.normal;
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  std::vector<Eigen::Vector3d> candidates{up};
  if (away.norm() > kLeaves) candidates.push_back(away.normalized());
  for (const int axis : {0, 1, 2}) {
    for (const double sense : {1.0, -1.0})
      candidates.emplace_back(sense * Eigen::Vector3d::Unit(axis));
  }
  std::erase_if(candidates, [&](const Eigen::Vector3d& way) {
    return std::ranges::any_of(model.locators, [&](const LocatingPoint& point) {
      const double leaves = way.dot(point.normal);
      return leaves < -kLeaves || (point.two_sided && leaves > kLeaves);
    });
  });
  return candidates;
}

}  // namespace

std::set<std::string> taken_off(const ProjectState& state, Session& session,
                                const std::vector<Touch>& touches) {
  std::set<std::string> clamps;
  std::set<std::string> fasteners;
  for (const auto& [name, instance] : state.instances) {
    const Role role = fixture_role(state, instance, session.element(instance.element));
    if (role == Role::Clamp) clamps.insert(name);
    if (role == Role::Fastener) fasteners.insert(name);
  }
  std::set<std::string> off = clamps;
  bool grows = true;
  while (grows) {
    grows = false;
    for (const Touch& touch : touches) {
      for (const auto& [one, other] :
           {std::pair(touch.instance, touch.with), std::pair(touch.with, touch.instance)}) {
        if (off.contains(one) && fasteners.contains(other)) grows |= off.insert(other).second;
      }
    }
  }
  return off;
}

Eigen::MatrixXd all_wrenches(const FixtureModel& model) {
  std::vector<LocatingPoint> points = model.locators;
  for (const WorkpieceContact& contact : model.contacts) {
    if (contact.role == Role::Clamp) {
      points.push_back({contact.instance, contact.at, contact.normal, 0.0, false});
    }
  }
  return pushing_matrix(points, model.frame);
}

std::optional<Seating> seating_of(const FixtureModel& model, const FixtureDesign& design) {
  const Wrench clamping = clamping_of(model, design);
  if (clamping.isZero() || !analyse_locating(model.locators, model.frame).is_deterministic()) {
    return std::nullopt;
  }
  return seating_forces(model.locators, model.frame, clamping + weight_of(model));
}

double clamp_margin_mm(const FixtureModel& model, const WorkpieceContact& clamp) {
  const auto supports = support_points(model);
  if (supports.empty() || clamp.normal.z() > -std::sqrt(0.5)) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  double height_mm = 0.0;
  double count = 0.0;
  for (const WorkpieceContact& contact : model.contacts) {
    if (!is_locating(contact.role) || contact.normal.z() < std::sqrt(0.5)) continue;
    height_mm += contact.at.z();
    count += 1.0;
  }
  const double way_mm = (height_mm / count - clamp.at.z()) / clamp.normal.z();
  const Eigen::Vector3d meets = clamp.at + way_mm * clamp.normal;
  return support_margin_mm(supports, meets.head<2>());
}

std::vector<PointAnalysis> analyse_points(const FixtureModel& model, const FixtureDesign& design) {
  const bool settled = analyse_locating(model.locators, model.frame).is_deterministic();
  std::vector<PointAnalysis> result;
  for (const auto& [name, point] : design.points) {
    PointAnalysis analysis{name, point, {}};
    if (settled) {
      analysis.error = position_error(model.locators, model.frame, point.at);
    } else {
      const double unknown = std::numeric_limits<double>::quiet_NaN();
      analysis.error = {unknown, unknown, unknown};
    }
    result.push_back(std::move(analysis));
  }
  return result;
}

std::vector<LoadAnalysis> analyse_loads(const FixtureModel& model, const FixtureDesign& design) {
  const auto contacts = friction_contacts(model, design);
  const Wrench weight = weight_of(model);
  std::vector<LoadAnalysis> result;
  for (const auto& [name, load] : design.loads) {
    Wrench wrench = wrench_of(load.force_N, load.at, model.frame);
    wrench.tail<3>() += load.torque_Nmm / model.frame.length_mm;
    const ForceClosure closure =
        force_closure(contacts, model.frame, weight + design.limit("safety") * wrench);
    result.push_back({name, load, closure.holds, closure.residual_N,
                      load_factor(contacts, model.frame, weight, wrench)});
  }
  return result;
}

ProjectState opened_around(const FixtureModel& model, FactSource& source, double reach_mm) {
  const ProjectState& state = source.state();
  const std::set<std::string> off = taken_off(state, source.session(), source.touches());
  ProjectState opened;
  for (const auto& [name, instance] : state.instances) {
    // By the ball around its box.
    const Obb& box = source.element(instance).obb;
    const double away_mm = (instance.X_WI * box.center - model.frame.reference).norm();
    if (!off.contains(name) && away_mm - box.half_extents_mm.norm() <= reach_mm) {
      opened.instances.emplace(name, instance);
    }
  }
  return opened;
}

Unloading unloading_of(const FixtureModel& model, FactSource& source) {
  const double lift_mm = source.state().design.limit("lift_mm");
  const double tolerance_mm = source.state().tolerance_mm;
  return {model.workpiece,
          opened_around(model, source, model.frame.length_mm + lift_mm + tolerance_mm),
          ways_out(model), lift_mm, tolerance_mm};
}

UnloadAnalysis analyse_unloading(const Unloading& unloading, const PlacedBodies& models) {
  PlacedBodies bodies = models.empty_copy();
  bodies.follow(unloading.opened);
  UnloadAnalysis result;
  result.lift_mm = unloading.lift_mm;
  const Pose X_WI = unloading.opened.find(unloading.workpiece)->X_WI;
  for (const Eigen::Vector3d& way : unloading.ways) {
    const Pose X_WI_out(X_WI.rotation(), X_WI.translation() + result.lift_mm * way);
    const auto path =
        bodies.sweep({{unloading.workpiece, Pose()}}, {X_WI, X_WI_out}, unloading.tolerance_mm);
    if (path.free_share >= result.free_share) {
      result.free_share = path.free_share;
      result.direction = way;
      result.blocked_by.clear();
      for (const Touch& touch : path.touches) {
        if (touch.pair.verdict == Verdict::Interference && result.blocked_by.empty()) {
          result.blocked_by = touch.with;
        }
      }
    }
    if (path.touches.empty()) {
      result.is_free = true;
      result.blocked_by.clear();
      break;
    }
  }
  return result;
}

namespace {

const FixtureModel& only_fixture(FactSource& source) {
  const auto& fixtures = source.fixtures();
  if (fixtures.size() == 1) return fixtures.front();
  std::string found;
  for (const FixtureModel& model : fixtures) {
    found += (found.empty() ? ": " : ", ") + model.workpiece;
  }
  throw Error(
      ErrorCode::InvalidInput,
      fixtures.empty()
          ? std::string("no instance is the workpiece; say which with `role NAME workpiece`")
          : "expected one workpiece, there are " + std::to_string(fixtures.size()) + found);
}

}  // namespace

FixtureModel fixture_model(Session& session) {
  FactSource source(session);
  source.update();
  return only_fixture(source);
}

FixtureAnalysis analyse_fixture(Session& session) {
  FactSource source(session);
  source.update();
  FixtureAnalysis result;
  result.model = only_fixture(source);
  const FixtureModel& model = result.model;
  const FixtureDesign& design = session.state().design;
  result.locating = analyse_locating(model.locators, model.frame);
  result.points = analyse_points(model, design);
  result.seating = seating_of(model, design);
  result.loads = analyse_loads(model, design);
  result.has_form_closure = has_form_closure(all_wrenches(model));
  const auto supports = support_points(model);
  result.support_area_mm2 = polygon_area_mm2(convex_polygon(supports));
  result.support_margin_mm = supports.empty()
                                 ? -std::numeric_limits<double>::infinity()
                                 : support_margin_mm(supports, model.center_of_mass.head<2>());
  result.unloading = source.unloading(model);
  result.foolproof = source.foolproof(model);
  result.wrenches = source.wrenches();
  return result;
}

}  // namespace dowel
