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
  const Body* screw = &bodies_.at(a);
  const Body* tapped = &bodies_.at(b);
  const auto reliefs_in = [&](const Body& hole, const Body& shaft) {
    if (!may_thread(hole, shaft)) return std::vector<ThreadRelief>();
    return thread_reliefs(find_element_(hole.element), hole.X_WI, find_element_(shaft.element),
                          shaft.X_WI);
  };
  std::vector<ThreadRelief> reliefs = reliefs_in(*tapped, *screw);
  std::vector<ThreadRelief> others = reliefs_in(*screw, *tapped);
  // A screw that moves in what stands is judged by its profile, which is quicker by far.
  if (reliefs.empty() && !others.empty()) {
    std::swap(screw, tapped);
    std::swap(reliefs, others);
  }
  const Pose X_TS = tapped->X_WI.inverse() * screw->X_WI;
  for (ThreadRelief relief : others) {
    relief.start = X_TS * relief.start;
    relief.direction = X_TS.rotation() * relief.direction;
    reliefs.push_back(relief);
  }
  CollisionScene scene;
  const BodyId moving = scene.add(shape(screw->element), screw->X_WI);
  const BodyId with = scene.add(shape(tapped->element), tapped->X_WI);
  if (!reliefs.empty()) scene.set_reliefs(with, moving, std::move(reliefs));
  const auto verdicts =
      scene.check(std::array{moving}, std::array{screw->X_WI}, {.tolerance_mm = tolerance_mm});
  return verdicts.empty() ? PairVerdict{} : verdicts.front().pair;
}

}  // namespace dowel
