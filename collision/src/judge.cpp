// The order of questions on one pair, and what forbids interference.

#include "judge.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "dowel/collision/axis_profile.h"
#include "dowel/collision/box_separation.h"

namespace dowel {

bool Judge::recall() {
  if (knows_cores() || knows_ball()) return true;
  bool is_free = false;
  if (memory_.shaft != PairMemory::kNone) {
    is_free = take_fit(memory_.shaft_is_in_a, memory_.shaft, memory_.bore);
    if (is_decided_) return true;
  }
  if (memory_.contact_a == PairMemory::kNone) return false;
  return is_free && still_touches();
}

PairVerdict Judge::decide() {
  const bool are_shallow = boxes_are_shallow();
  if (are_shallow && still_touches()) return result_;
  const bool is_free = shaft_fits() || are_shallow;
  if (is_decided_) {
    counters_.note(Skip::Fits);
    return result_;
  }
  if (!is_free) {
    if (overfull_B_ && is_deep_at(*overfull_B_)) return result_;
    // Where bodies are deep in each other, a deep point tells so at once. Where facets crossed
    // before, they are likely to do so now.
    if (cores_overlap()) {
      counters_.note(Skip::Cores);
      return result_;
    }
    look_for_containment();
    if (is_interference() || still_crosses()) return result_;
  }
  const bool touches_still = !are_shallow && still_touches();
  const bool is_seated = !touches_still && seat_touches();
  if (is_seated) counters_.note(Skip::Seats);
  if (!(touches_still || is_seated) || !is_free) look_among_facets(!is_free);
  return result_;
}

PairVerdict Judge::decide_by_brute_force() {
  double apart = std::numeric_limits<double>::infinity();
  scratch_.facets.clear();
  for_each_pair([&](std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
    if (is_clear()) faces_lie_on_each_other(i, a_B, j);
    const auto near = near_facets(i, a_B, j, apart);
    if (near && crosses(*near, a_B)) return false;
    if (near && is_clear()) scratch_.facets.push_back(*near);
    return true;
  });
  for (const NarrowScratch::FacetPair& near : scratch_.facets) {
    if (!is_clear() || touches(near)) break;
  }
  if (!is_interference()) look_for_containment();
  if (is_clear()) result_.gap_mm = std::max(apart, options_.tolerance_mm);
  return result_;
}

bool Judge::boxes_are_shallow() {
  if (leaves_out(Skip::ShallowBoxes)) return false;
  const Obb obb_a_B = transformed(pair_.X_BA, pair_.obb_a);
  const double overlap = -options_.tolerance_mm * (1.0 - kSafety);
  const BoxSeparation boxes = separate(obb_a_B, pair_.obb_b, overlap, memory_.shallow_plane);
  memory_.shallow_plane = static_cast<std::int8_t>(boxes.plane);
  if (boxes.plane >= 0) counters_.note(Skip::ShallowBoxes);
  return boxes.plane >= 0;
}

bool Judge::shaft_fits() {
  if (options_.holes == HoleMode::Paper || leaves_out(Skip::Fits)) return false;
  // A pin that stands on a plate is free of each of its holes; the one that it stands over says
  // how far it is from the plate.
  bool is_free = memory_.shaft != PairMemory::kNone &&
                 take_fit(memory_.shaft_is_in_a, memory_.shaft, memory_.bore);
  if (is_decided_) return true;
  if (!is_free) memory_.shaft = PairMemory::kNone;
  for (const bool shaft_is_in_a : {true, false}) {
    const CollisionModel& with_shaft = shaft_is_in_a ? pair_.a : pair_.b;
    const CollisionModel& with_bore = shaft_is_in_a ? pair_.b : pair_.a;
    const Pose& X_VS = shaft_is_in_a ? pair_.X_BA : X_AB_;
    const auto& shafts = with_shaft.profiles().shafts;
    const auto& bores = with_bore.profiles().bores;
    for (std::uint32_t s = 0; s < shafts.size(); ++s) {
      const Eigen::Vector3d origin = X_VS * shafts[s].origin;
      const Eigen::Vector3d direction = X_VS.rotation() * shafts[s].direction;
      for (std::uint32_t v = 0; v < bores.size(); ++v) {
        if (may_hold(origin, direction, bores[v]) && take_fit(shaft_is_in_a, s, v)) {
          memory_.shaft_is_in_a = shaft_is_in_a;
          memory_.shaft = s;
          memory_.bore = v;
          is_free = true;
          if (is_decided_) return true;
        }
      }
    }
  }
  return is_free;
}

bool Judge::may_hold(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                     const AxisProfile& bore) {
  if (std::abs(direction.dot(bore.direction)) < 0.99) return false;
  const double middle = 0.5 * (bore.steps.front().from_mm + bore.steps.back().to_mm);
  const Eigen::Vector3d offset = bore.origin + middle * bore.direction - origin;
  double radius = 0.0;
  for (const ProfileStep& step : bore.steps) radius = std::max(radius, step.most_radius_mm());
  return (offset - direction.dot(offset) * direction).squaredNorm() <= radius * radius;
}

bool Judge::take_fit(bool shaft_is_in_a, std::uint32_t s, std::uint32_t v) {
  const AxisProfile& shaft = (shaft_is_in_a ? pair_.a : pair_.b).profiles().shafts[s];
  const AxisProfile& bore = (shaft_is_in_a ? pair_.b : pair_.a).profiles().bores[v];
  const Pose& X_VS = shaft_is_in_a ? pair_.X_BA : X_AB_;
  const Fit fitted = fit(shaft, bore, X_VS, options_.tolerance_mm * (1.0 - kSafety),
                         shaft_is_in_a ? pair_.reliefs_B : reliefs_A());
  const Eigen::Vector3d place_B =
      shaft_is_in_a ? fitted.place_V : Eigen::Vector3d(pair_.X_BA * fitted.place_V);
  if (!fitted.is_free) {
    if (fitted.gap_mm < -options_.tolerance_mm) overfull_B_ = place_B;
    return false;
  }
  result_.method = Method::Exact;
  if (fitted.gap_mm > options_.tolerance_mm) {
    result_.gap_mm = fitted.gap_mm;
    is_decided_ = true;
  } else if (const auto gap_mm = fitted.gap_is_met ? gap_at(place_B) : std::nullopt) {
    touch(*gap_mm, place_B);
    is_decided_ = true;
  }
  return true;
}

std::optional<double> Judge::gap_at(const Eigen::Vector3d& place_B) const {
  const auto outside_mm = [](const NearestPoint& near) {
    return near.inside ? 0.0 : near.distance_mm;
  };
  const double gap_mm =
      outside_mm(pair_.a.nearest(X_AB_ * place_B)) + outside_mm(pair_.b.nearest(place_B));
  return gap_mm <= options_.tolerance_mm ? std::optional(gap_mm) : std::nullopt;
}

std::span<const ThreadRelief> Judge::reliefs_A() {
  scratch_.reliefs_A.clear();
  for (const ThreadRelief& relief : pair_.reliefs_B) {
    scratch_.reliefs_A.push_back({X_AB_ * relief.start, X_AB_.rotation() * relief.direction,
                                  relief.length_mm, relief.radius_mm});
  }
  return scratch_.reliefs_A;
}

bool Judge::takes_part(const ModelTriangle& t) const {
  return options_.holes == HoleMode::Exact || !t.is_hole;
}

template <class Visit>
void Judge::for_each_pair(const Visit& visit) const {
  for (std::uint32_t i = 0; i < pair_.a.triangles().size(); ++i) {
    const ModelTriangle& a = pair_.a.triangles()[i];
    if (!takes_part(a)) continue;
    const PlacedTriangle a_B = placement_ * a;
    for (std::uint32_t j = 0; j < pair_.b.triangles().size(); ++j) {
      if (takes_part(pair_.b.triangles()[j]) && !visit(i, a_B, j)) return;
    }
  }
}

void Judge::note_method(std::uint32_t i, std::uint32_t j) {
  dowel::note_method(pair_.a, i, pair_.b, j, result_);
}

}  // namespace dowel
