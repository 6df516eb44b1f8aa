// Straight ways by which parts leave the others or are brought in.

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"
#include "mate_graph.h"
#include "session_impl.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// Past the others by this much a part counts as out.
constexpr double kBeyond_mm = 1.0;

void add_new(std::vector<WayDirection>& all, const Vector3d& direction_W,
             const std::string& along) {
  const Vector3d unit = direction_W.normalized();
  const bool is_known = std::ranges::any_of(all, [&](const WayDirection& other) {
    return (other.direction_W - unit).norm() <= kCoaxial_rad;
  });
  if (!is_known) all.push_back({unit, along});
}

/// What a part gives on its way in: a hand that moves it has that much play. A sweep at a tolerance
/// as fine as a verdict's takes minutes where a nut runs along its stud.
constexpr double kGive_mm = 0.1;

/// Places on a way where the project's own tolerance counts: a bore that is too tight is so all
/// along.
constexpr int kPlacesOnWay = 32;

/// How far along `direction_W` the box reaches: from, to.
std::pair<double, double> reach(const Obb& obb, const Pose& X_WI, const Vector3d& direction_W) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const Vector3d& corner : obb.corners()) {
    const double at = direction_W.dot(X_WI * corner);
    low = std::min(low, at);
    high = std::max(high, at);
  }
  return {low, high};
}

}  // namespace

std::vector<WayDirection> Session::Impl::mate_directions(const ProjectState& in,
                                                         const std::set<std::string>& group) {
  std::vector<WayDirection> all;
  for (const auto& [number, mate] : in.mates) {
    if (mate.kind == MateKind::Fix || mate.kind == MateKind::Angle) continue;
    const bool moves = group.contains(mate.moving.instance);
    if (moves == group.contains(mate.fixed.instance)) continue;
    const FeatureName& other = moves ? mate.fixed : mate.moving;
    const PlacedFeature placed{feature(other).feature, in.find(other.instance)->X_WI};
    const Vector3d into_W = placed.direction_W();
    const bool is_face = placed.feature->kind == FeatureKind::Face;
    // Out of a hole or slot is against it, off a face along it; a through one has two ends.
    add_new(all, is_face || placed.feature->kind == FeatureKind::Shaft ? into_W : Vector3d(-into_W),
            other.text());
    if (placed.feature->through) add_new(all, into_W, other.text());
    if (placed.feature->slot) {
      const Vector3d run_W = placed.X_WI.rotation() * placed.feature->slot->run;
      add_new(all, run_W, other.text());
      add_new(all, -run_W, other.text());
    }
  }
  return all;
}

std::optional<WayDirection> Session::Impl::base_direction(const ProjectState& in,
                                                          const std::set<std::string>& group) {
  const bool has_ground =
      std::ranges::any_of(in.instances, [&](const auto& entry) { return entry.second.grounded; });
  for (const Instance* placed : in.in_order()) {
    if (group.contains(placed->name) || (has_ground && !placed->grounded)) continue;
    return WayDirection{placed->X_WI.rotation() * Vector3d::UnitZ(), placed->name};
  }
  return std::nullopt;
}

WayOut Session::Impl::way_out(const ProjectState& in, const std::set<std::string>& group,
                              const WayDirection& direction) {
  WayOut way;
  way.direction_W = direction.direction_W;
  way.along = direction.along;
  double own_low = std::numeric_limits<double>::infinity();
  double others_high = -own_low;
  std::vector<PlacedBodies::Part> parts_W;
  for (const Instance* placed : in.in_order()) {
    const auto [low, high] = reach(element(placed->element).obb, placed->X_WI, way.direction_W);
    if (group.contains(placed->name)) {
      own_low = std::min(own_low, low);
      parts_W.push_back({placed->name, placed->X_WI});
    } else {
      others_high = std::max(others_high, high);
    }
  }
  way.way_mm = std::max(0.0, others_high - own_low + kBeyond_mm);
  way.free_mm = way.way_mm;
  if (way.way_mm == 0.0) return way;
  const auto shifted = [&](double by_mm) {
    return Pose::from_translation(by_mm * way.direction_W);
  };
  const double give_mm = std::max(kGive_mm, in.tolerance_mm);
  const PlacedBodies::Path path = bodies.sweep(parts_W, {Pose(), shifted(way.way_mm)}, give_mm);
  way.blocked_by = path.touches;
  if (!path.touches.empty()) {
    way.free_mm = std::clamp(path.X_WU_free.translation().norm() - give_mm, 0.0, way.way_mm);
    return way;
  }
  for (int place = 1; place < kPlacesOnWay; ++place) {
    const double by_mm = way.way_mm * place / kPlacesOnWay;
    std::vector<Touch> touches = check_parts(parts_W, shifted(by_mm), in.tolerance_mm);
    std::erase_if(touches,
                  [](const Touch& touch) { return touch.pair.verdict != Verdict::Interference; });
    if (touches.empty()) continue;
    way.blocked_by = std::move(touches);
    way.free_mm = way.way_mm * (place - 1) / kPlacesOnWay;
    break;
  }
  return way;
}

std::vector<WayOut> Session::ways_out(std::string_view name, const WayQuery& query) {
  const std::string part = instance(name).name;
  std::optional<ProjectState> reduced;
  if (!query.without.empty()) {
    reduced = state();
    for (const std::string& gone : query.without) {
      reduced->instances.erase(gone);
      std::erase_if(reduced->mates,
                    [&](const auto& entry) { return parts_of(entry.second).contains(gone); });
    }
  }
  const ProjectState& in = reduced ? *reduced : state();
  DOWEL_EXPECTS(in.find(part) != nullptr);
  const PartNames group = query.with_sub_assembly ? sub_assembly_of(in, part) : unit_of(in, part);
  impl_->bodies.follow(in);
  std::vector<WayDirection> directions = impl_->mate_directions(in, group);
  if (const auto up = impl_->base_direction(in, group); up && !query.by_mates_alone) {
    add_new(directions, up->direction_W, up->along);
  }
  std::vector<WayOut> ways;
  for (const WayDirection& direction : directions) {
    ways.push_back(impl_->way_out(in, group, direction));
    if (query.first_free && ways.back().blocked_by.empty()) break;
  }
  std::ranges::stable_sort(ways, [](const WayOut& a, const WayOut& b) {
    if (a.blocked_by.empty() != b.blocked_by.empty()) return a.blocked_by.empty();
    return a.blocked_by.empty() ? a.way_mm < b.way_mm : a.free_mm > b.free_mm;
  });
  return ways;
}

std::vector<std::string> Session::sub_assembly(std::string_view name) const {
  const PartNames group = sub_assembly_of(state(), impl_->instance(name).name);
  return {group.begin(), group.end()};
}

std::vector<std::string> Session::unit(std::string_view name) const {
  const PartNames group = unit_of(state(), impl_->instance(name).name);
  return {group.begin(), group.end()};
}

std::vector<Touch> Session::check_at(std::string_view name, const Pose& X_WI) {
  const Instance& placed = instance(name);
  impl_->bodies.follow(state());
  const auto unit = impl_->parts(unit_of(state(), placed.name), placed.name, placed.X_WI);
  return impl_->check_parts(unit, X_WI, state().tolerance_mm);
}

}  // namespace dowel
