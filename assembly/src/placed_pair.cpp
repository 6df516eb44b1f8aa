#include <array>

#include "dowel/assembly/thread.h"
#include "placed_bodies.h"

namespace dowel {

PlacedBodies PlacedBodies::empty_copy() const {
  PlacedBodies copy(find_element_, load_solid_);
  copy.shapes_ = shapes_;
  return copy;
}

PairVerdict PlacedBodies::pair(const std::string& a, const std::string& b, double tolerance_mm) {
  const Body& first = bodies_.at(a);
  const Body& second = bodies_.at(b);
  CollisionScene scene;
  const BodyId moving = scene.add(shape(first.element), first.X_WI);
  const BodyId with = scene.add(shape(second.element), second.X_WI);
  std::vector<ThreadRelief> reliefs;
  if (may_thread(first, second)) {
    reliefs = thread_reliefs(find_element_(first.element), first.X_WI,
                             find_element_(second.element), second.X_WI);
  }
  if (may_thread(second, first)) {
    const Pose X_AB = first.X_WI.inverse() * second.X_WI;
    for (ThreadRelief relief : thread_reliefs(find_element_(second.element), second.X_WI,
                                              find_element_(first.element), first.X_WI)) {
      relief.start = X_AB * relief.start;
      relief.direction = X_AB.rotation() * relief.direction;
      reliefs.push_back(relief);
    }
  }
  if (!reliefs.empty()) scene.set_reliefs(moving, with, std::move(reliefs));
  const auto verdicts =
      scene.check(std::array{moving}, std::array{first.X_WI}, {.tolerance_mm = tolerance_mm});
  return verdicts.empty() ? PairVerdict{} : verdicts.front().pair;
}

}  // namespace dowel
