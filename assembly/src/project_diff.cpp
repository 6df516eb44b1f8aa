#include "dowel/assembly/project_diff.h"

#include <algorithm>
#include <tuple>

#include "dowel/assembly/joint.h"
#include "project_database.h"
#include "project_rows.h"

namespace dowel {
namespace {

/// What rounding of another way to the same place may leave.
constexpr double kSamePlace_mm = 1.0e-9;

bool is_same_place(const Pose& a, const Pose& b) {
  return (a.translation() - b.translation()).norm() <= kSamePlace_mm &&
         kMateArm_mm * a.rotation().angularDistance(b.rotation()) <= kSamePlace_mm;
}

bool is_same(const Instance& a, const Instance& b) {
  return a.element == b.element && a.grounded == b.grounded && is_same_place(a.X_WI, b.X_WI);
}

auto key_of(const Mate& mate) {
  const auto text = [](const FeatureName& name) { return name.text(); };
  return std::tuple(mate.kind, text(mate.moving), text(mate.fixed), text(mate.moving_face),
                    text(mate.fixed_face));
}

bool is_same(const Mate& a, const Mate& b) {
  if (a.X_FM.has_value() != b.X_FM.has_value()) return false;
  if (a.X_FM && !is_same_place(*a.X_FM, *b.X_FM)) return false;
  return a.offset_mm == b.offset_mm && a.angle_rad == b.angle_rad && a.flip == b.flip;
}

}  // namespace

ProjectState read_project_state(const std::filesystem::path& file) {
  return ProjectDatabase(file, ProjectAccess::ReadOnly).read_state();
}

ProjectDiff diff(const ProjectState& a, const ProjectState& b) {
  ProjectDiff result;
  for (const auto& [name, instance] : a.instances) {
    const Instance* other = b.find(name);
    if (other == nullptr) {
      result.removed.push_back(instance);
    } else if (!is_same(instance, *other)) {
      result.changed.emplace_back(instance, *other);
    }
  }
  for (const auto& [name, instance] : b.instances) {
    if (a.find(name) == nullptr) result.added.push_back(instance);
  }
  using Key = decltype(key_of(Mate()));
  std::multimap<Key, const Mate*> of_b;
  for (const auto& [number, mate] : b.mates) of_b.emplace(key_of(mate), &mate);
  for (const auto& [number, mate] : a.mates) {
    const auto found = of_b.find(key_of(mate));
    if (found == of_b.end()) {
      result.mates_removed.push_back(mate);
      continue;
    }
    if (!is_same(mate, *found->second)) result.mates_changed.emplace_back(mate, *found->second);
    of_b.erase(found);
  }
  for (const auto& [key, mate] : of_b) result.mates_added.push_back(*mate);
  std::ranges::sort(result.mates_added, {}, &Mate::number);
  const auto settings_a = settings_of(a);
  const auto settings_b = settings_of(b);
  for (std::size_t i = 0; i < settings_a.size(); ++i) {
    if (settings_a[i] == settings_b[i]) continue;
    result.settings.push_back(settings_a[i].name + ": " + settings_a[i].value + ", " +
                              settings_b[i].value);
  }
  return result;
}

}  // namespace dowel
