#include "instance_boxes.h"

#include <algorithm>
#include <tuple>

namespace dowel {

Eigen::AlignedBox3d box_around(const Instance& instance, const Element& element) {
  const Obb& box = element.obb;
  const Eigen::Matrix3d axes_W = instance.X_WI.rotation() * box.axes;
  const Eigen::Vector3d center_W = instance.X_WI * box.center;
  const Eigen::Vector3d half_mm = axes_W.cwiseAbs() * box.half_extents_mm;
  return {center_W - half_mm, center_W + half_mm};
}

std::vector<std::pair<const Instance*, const Instance*>> near_pairs(
    const ProjectState& state, const ElementOf& element_of, double gap_mm,
    const std::set<std::string>* of) {
  struct Entry {
    const Instance* instance;
    Eigen::AlignedBox3d box;
    bool is_asked;
  };
  std::vector<Entry> entries;
  const Eigen::Vector3d reach_mm = Eigen::Vector3d::Constant(gap_mm);
  for (const auto& [name, instance] : state.instances) {
    Eigen::AlignedBox3d box = box_around(instance, element_of(instance));
    box.max() += reach_mm;
    entries.push_back({&instance, box, of == nullptr || of->contains(name)});
  }
  // Along x, each box meets those only that begin before it ends.
  std::ranges::stable_sort(entries, {}, [](const Entry& entry) { return entry.box.min().x(); });
  std::vector<std::pair<const Instance*, const Instance*>> pairs;
  for (auto a = entries.begin(); a != entries.end(); ++a) {
    for (auto b = a + 1; b != entries.end() && b->box.min().x() <= a->box.max().x(); ++b) {
      if ((!a->is_asked && !b->is_asked) || !a->box.intersects(b->box)) continue;
      pairs.emplace_back(a->instance, b->instance);
      if (b->instance->name < a->instance->name) {
        std::swap(pairs.back().first, pairs.back().second);
      }
    }
  }
  std::ranges::sort(pairs, {},
                    [](const auto& pair) { return std::tie(pair.first->name, pair.second->name); });
  return pairs;
}

}  // namespace dowel
