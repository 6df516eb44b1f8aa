#include "dowel/collision/scene.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "dowel/collision/box_separation.h"
#include "dowel/collision/layered_projection.h"
#include "dowel/collision/model.h"
#include "dowel/collision/silhouette.h"
#include "dowel/kernel/check.h"
#include "judge.h"
#include "scene_impl.h"

namespace dowel {
namespace {

/// Bodies whose last check is remembered; more that take turns are asked afresh.
constexpr std::size_t kMaxMovers = 64;

/// Candidates are found with room for this many moves like the last, up to this share of the
/// mover's size.
constexpr double kStepsOfRoom = 40.0;
constexpr double kSizesOfRoom = 0.75;

/// Added to each step of a way: rounding of poses 100 m from the origin.
constexpr double kWayRounding_mm = 1.0e-10;

}  // namespace

void expect_valid(const QueryOptions& options) {
  DOWEL_EXPECTS(options.tolerance_mm >= kMinTolerance_mm &&
                options.tolerance_mm <= kMaxTolerance_mm);
}

void expect_valid_place(const Pose& X_WB) {
  DOWEL_EXPECTS(X_WB.translation().cwiseAbs().maxCoeff() <= kMaxPlace_mm);
}

CollisionScene::CollisionScene() : impl_(std::make_unique<Impl>()) {}
CollisionScene::~CollisionScene() = default;
CollisionScene::CollisionScene(CollisionScene&&) noexcept = default;
CollisionScene& CollisionScene::operator=(CollisionScene&&) noexcept = default;

CollisionScene::Impl::Body& CollisionScene::Impl::body(BodyId id) {
  DOWEL_EXPECTS(id.value < bodies.size() && bodies[id.value].element != nullptr);
  return bodies[id.value];
}

BodyId CollisionScene::add(std::shared_ptr<const CollisionElement> element, const Pose& X_WB) {
  DOWEL_EXPECTS(element != nullptr);
  expect_valid_place(X_WB);
  BodyId id{static_cast<std::uint32_t>(impl_->bodies.size())};
  if (impl_->free_ids.empty()) {
    impl_->bodies.add_one();
  } else {
    id = impl_->free_ids.back();
    impl_->free_ids.pop_back();
  }
  Impl::Body& body = impl_->bodies[id.value];
  body = {std::move(element), X_WB, false};
  impl_->projection.insert(id.value, bounds(body.obb_W()));
  impl_->movers.clear();
  return id;
}

void CollisionScene::remove(BodyId id) {
  impl_->body(id) = {};
  impl_->projection.remove(id.value);
  impl_->free_ids.push_back(id);
  impl_->movers.clear();
  std::erase_if(impl_->reliefs, [id](const auto& entry) {
    return entry.first.first == id || entry.first.second == id;
  });
}

void CollisionScene::move(BodyId id, const Pose& X_WB) {
  expect_valid_place(X_WB);
  Impl::Body& body = impl_->body(id);
  body.X_WB = X_WB;
  impl_->projection.remove(id.value);
  impl_->projection.insert(id.value, bounds(body.obb_W()));
  impl_->forget_all_but(id);
}

const Pose& CollisionScene::pose(BodyId id) const {
  return impl_->body(id).X_WB;
}

std::size_t CollisionScene::size() const {
  return impl_->projection.size();
}

void CollisionScene::set_reliefs(BodyId first, BodyId second, std::vector<ThreadRelief> reliefs) {
  impl_->body(first);
  impl_->body(second);
  DOWEL_EXPECTS(first != second);
  for (const ThreadRelief& relief : reliefs) {
    DOWEL_EXPECTS(relief.start.allFinite() && std::isfinite(relief.length_mm) &&
                  std::isfinite(relief.radius_mm));
    DOWEL_EXPECTS(std::abs(relief.direction.norm() - 1.0) <= kStoredAxisSlack);
  }
  impl_->movers.clear();
  impl_->reliefs.erase({second, first});
  if (reliefs.empty()) {
    impl_->reliefs.erase({first, second});
  } else {
    impl_->reliefs[{first, second}] = std::move(reliefs);
  }
}

std::span<const ThreadRelief> CollisionScene::Impl::reliefs_in(BodyId a, BodyId b,
                                                               const Pose& X_BA) {
  if (reliefs.empty()) return {};
  if (const auto in_b = reliefs.find({b, a}); in_b != reliefs.end()) return in_b->second;
  const auto in_a = reliefs.find({a, b});
  if (in_a == reliefs.end()) return {};
  relief_scratch.clear();
  for (const ThreadRelief& relief : in_a->second) {
    relief_scratch.push_back({X_BA * relief.start, X_BA.rotation() * relief.direction,
                              relief.length_mm, relief.radius_mm});
  }
  return relief_scratch;
}

PairVerdict CollisionScene::Impl::judge_bodies(BodyId a, const Pose& X_WA, BodyId b,
                                               const QueryOptions& options, PairMemory& memory) {
  const PlacedPair placed(*this, a, X_WA, b);
  PairVerdict verdict = judge(placed.pair, options, memory, scratch, counters);
  verdict.witness_W = bodies[b.value].X_WB * verdict.witness_W;
  return verdict;
}

CollisionScene::Impl::Mover& CollisionScene::Impl::mover_at(BodyId id, const Pose& X_WB,
                                                            const QueryOptions& options) {
  auto known = std::ranges::find(movers, id, &Mover::id);
  if (known == movers.end()) {
    if (movers.size() < kMaxMovers) {
      movers.emplace_back();
      known = movers.end() - 1;
    } else {
      known = std::ranges::min_element(movers, {}, &Mover::last_use);
    }
    known->id = id;
    known->candidates.clear();
    known->listed_until = -1.0;
  }
  Mover& mover = *known;
  mover.last_use = query_count;
  if (mover.listed_until < 0.0) {
    mover.element = body(id).element.get();
    mover.box_is_upright = mover.element->obb().axes == Eigen::Matrix3d::Identity();
    mover.radius_mm = mover.element->obb().half_extents_mm.norm();
    mover.obb_W = mover.element->obb();
    mover.axes_are_old = true;
  }
  const Eigen::Vector3d center_W = X_WB * mover.element->obb().center;
  const Eigen::Vector4d turn = X_WB.rotation().coeffs() - mover.X_WB.rotation().coeffs();
  double step_mm = 0.0;
  if (mover.tolerance_mm != options.tolerance_mm || mover.holes != options.holes ||
      mover.without != options.without) {
    mover.tolerance_mm = options.tolerance_mm;
    mover.holes = options.holes;
    mover.without = options.without;
    mover.candidates.clear();
    mover.listed_until = -1.0;
  } else if (mover.listed_until >= 0.0) {
    // No point is further from the box's centre than a corner. Turned by an angle it moves by twice
    // the sine of half of that, and the quaternions differ by twice the sine of a quarter.
    step_mm = (center_W - mover.obb_W.center).norm() + 2.0 * turn.norm() * mover.radius_mm +
              kWayRounding_mm;
    mover.way_mm += step_mm;
  }
  mover.X_WB = X_WB;
  mover.obb_W.center = center_W;
  mover.axes_are_old = mover.axes_are_old || turn != Eigen::Vector4d::Zero();
  if (mover.way_mm >= mover.listed_until) find_candidates(mover, step_mm);
  return mover;
}

void CollisionScene::Impl::find_candidates(Mover& mover, double step_mm) {
  const Obb& obb_W = mover.box_W();
  const double room_mm = mover.without.contains(Skip::Way)
                             ? 0.0
                             : std::min(kStepsOfRoom * step_mm, kSizesOfRoom * mover.radius_mm);
  const double margin_mm = mover.tolerance_mm + room_mm;
  const Silhouette outline = silhouette(obb_W);
  find_bodies(bounds(obb_W).padded(margin_mm), mover.without);
  std::swap(mover.candidates, old_candidates);
  mover.candidates.clear();
  auto old = old_candidates.begin();
  for (const std::uint32_t other : found) {
    if (other == mover.id.value) continue;
    while (old != old_candidates.end() && old->id.value < other) ++old;
    if (old != old_candidates.end() && old->id.value == other) {
      old->clear_until -= mover.way_mm;
      const bool is_beyond_room = old->plane >= 0 && old->clear_until >= room_mm;
      if (!is_beyond_room) mover.candidates.push_back(*old);
      continue;
    }
    const Obb other_W = bodies[other].obb_W();
    if (!mover.without.contains(Skip::Silhouettes) &&
        are_apart(outline, silhouette(other_W), margin_mm)) {
      counters.note(Skip::Silhouettes);
      continue;
    }
    mover.candidates.push_back(
        {BodyId{other}, other_W, bodies[other].X_WB.rotation_matrix(), -1, 0.0, {}});
  }
  mover.way_mm = 0.0;
  mover.listed_until = room_mm;
  mover.clear_until = 0.0;
}

void CollisionScene::Impl::find_bodies(const Aabb& box_W, SkipSet without) {
  if (!without.contains(Skip::Layers)) {
    projection.query(box_W, found);
    counters.note(Skip::Layers, projection.size() - found.size());
    return;
  }
  found.clear();
  for (std::uint32_t id = 0; id < bodies.size(); ++id) {
    if (bodies[id].element != nullptr) found.push_back(id);
  }
}

bool CollisionScene::Impl::boxes_keep_apart(Mover& mover, Candidate& candidate,
                                            double tolerance_mm) {
  if (mover.without.contains(Skip::Planes)) return false;
  const Obb& obb_W = mover.box_W();
  double gap_mm = candidate.plane >= 0 ? gap_along(obb_W, candidate.obb_W, candidate.plane) : 0.0;
  if (gap_mm <= tolerance_mm) {
    const BoxSeparation boxes = separate(obb_W, candidate.obb_W, tolerance_mm);
    candidate.plane = static_cast<std::int8_t>(boxes.plane);
    if (boxes.plane < 0) return false;
    gap_mm = boxes.gap_mm;
  }
  candidate.clear_until = mover.way_mm + gap_mm - tolerance_mm;
  counters.note(Skip::Planes);
  return true;
}

bool CollisionScene::Impl::meet(Mover& mover, Candidate& candidate, const QueryOptions& options) {
  ++counters.box_tests;
  if (mover.without.contains(Skip::Memory)) {
    candidate.plane = -1;
    candidate.memory = {};
  }
  // What met last time is likely to meet in the same way, whatever their boxes do.
  const bool met = candidate.plane < 0 && !candidate.memory.is_empty();
  if (!met && boxes_keep_apart(mover, candidate, options.tolerance_mm)) return false;
  BodyVerdict& found_out = verdicts.emplace_back();
  found_out.moving = mover.id;
  found_out.with = candidate.id;
  if (judge_candidate(mover, candidate, met, options, found_out.pair)) return true;
  verdicts.pop_back();
  return false;
}

bool CollisionScene::Impl::judge_candidate(Mover& mover, Candidate& candidate, bool met,
                                           const QueryOptions& options, PairVerdict& verdict) {
  const Body& other = bodies[candidate.id.value];
  if (candidate.memory.may_rest() && still_rests(mover.placed(),
                                                 {other.element->model(), candidate.rotation_WB,
                                                  other.X_WB.translation(), candidate.obb_W},
                                                 options, candidate.memory, counters, verdict)) {
    counters.note(Skip::Memory);
    return true;
  }
  const PlacedPair placed(*this, mover.id, mover.X_WB, candidate.id);
  Judge judge(placed.pair, options, candidate.memory, scratch, counters);
  if (judge.recall()) {
    counters.note(Skip::Memory);
  } else {
    if (met && boxes_keep_apart(mover, candidate, options.tolerance_mm)) return false;
    judge.decide();
  }
  verdict = judge.result();
  if (verdict.verdict == Verdict::Clear) {
    candidate.clear_until = mover.way_mm + verdict.gap_mm - options.tolerance_mm;
    return false;
  }
  verdict.witness_W = other.X_WB * verdict.witness_W;
  return true;
}

bool CollisionScene::Impl::check_mover(Mover& mover, bool is_alone, const QueryOptions& options) {
  const bool knows_way = !options.without.contains(Skip::Way);
  if (knows_way && mover.way_mm < mover.clear_until) {
    counters.note(Skip::Way, mover.candidates.size());
    return true;
  }
  double clear_until = mover.listed_until;
  for (Candidate& candidate : mover.candidates) {
    if (!is_alone && bodies[candidate.id.value].is_moving) {
      clear_until = 0.0;  // who moves along may be another one next time
      continue;
    }
    if (knows_way && mover.way_mm < candidate.clear_until) {
      counters.note(Skip::Way);
      clear_until = std::min(clear_until, candidate.clear_until);
      continue;
    }
    if (!meet(mover, candidate, options)) {
      clear_until = std::min(clear_until, candidate.clear_until);
      continue;
    }
    clear_until = 0.0;
    if (options.first_only && verdicts.back().pair.verdict == Verdict::Interference) {
      verdicts.erase(verdicts.begin(), verdicts.end() - 1);
      return false;
    }
  }
  mover.clear_until = clear_until;
  return true;
}

void CollisionScene::Impl::forget_all_but(BodyId id) {
  std::erase_if(movers, [id](const Mover& mover) { return mover.id != id; });
}

std::span<const BodyVerdict> CollisionScene::check(std::span<const BodyId> moving,
                                                   std::span<const Pose> poses,
                                                   const QueryOptions& options) {
  expect_valid(options);
  DOWEL_EXPECTS(moving.size() == poses.size());
  impl_->verdicts.clear();
  ++impl_->query_count;
  if (moving.size() == 1) {
    impl_->check_mover(impl_->mover_at(moving[0], poses[0], options), true, options);
    return impl_->verdicts;
  }
  const Impl::MovingMark mark(*impl_, moving);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    Impl::Mover& mover = impl_->mover_at(moving[i], poses[i], options);
    if (!impl_->check_mover(mover, false, options)) break;
  }
  return impl_->verdicts;
}

std::vector<BodyVerdict> CollisionScene::check_brute_force(std::span<const BodyId> moving,
                                                           std::span<const Pose> poses,
                                                           const QueryOptions& options) {
  expect_valid(options);
  DOWEL_EXPECTS(moving.size() == poses.size());
  std::vector<BodyVerdict> result;
  const Impl::MovingMark mark(*impl_, moving);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    for (std::uint32_t other = 0; other < impl_->bodies.size(); ++other) {
      const Impl::Body& body = impl_->bodies[other];
      if (body.element == nullptr || body.is_moving) continue;
      const Impl::PlacedPair placed(*impl_, moving[i], poses[i], BodyId{other});
      PairVerdict verdict =
          judge_by_brute_force(placed.pair, options, impl_->scratch, impl_->counters);
      if (verdict.verdict == Verdict::Clear) continue;
      verdict.witness_W = body.X_WB * verdict.witness_W;
      result.push_back({moving[i], BodyId{other}, verdict});
    }
  }
  return result;
}

std::vector<BodyVerdict> CollisionScene::check_all(const QueryOptions& options) {
  expect_valid(options);
  std::vector<BodyVerdict> result;
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < impl_->bodies.size(); ++i) {
    const Impl::Body& body = impl_->bodies[i];
    if (body.element == nullptr) continue;
    const Obb obb_W = body.obb_W();
    impl_->projection.query(bounds(obb_W).padded(options.tolerance_mm), found);
    for (const std::uint32_t other : found) {
      if (other <= i) continue;
      ++impl_->counters.box_tests;
      if (separate(obb_W, impl_->bodies[other].obb_W(), options.tolerance_mm).plane >= 0) continue;
      PairMemory memory;
      const PairVerdict verdict =
          impl_->judge_bodies(BodyId{i}, body.X_WB, BodyId{other}, options, memory);
      if (verdict.verdict == Verdict::Clear) continue;
      result.push_back({BodyId{i}, BodyId{other}, verdict});
      if (options.first_only && verdict.verdict == Verdict::Interference) return result;
    }
  }
  return result;
}

const QueryCounters& CollisionScene::counters() const {
  return impl_->counters;
}
void CollisionScene::reset_counters() {
  impl_->counters = {};
}

std::size_t CollisionScene::memory_bytes() const {
  std::size_t bytes =
      sizeof(Impl) + impl_->bodies.size() * sizeof(Impl::Body) + impl_->projection.memory_bytes();
  for (const Impl::Mover& mover : impl_->movers) {
    bytes += sizeof(mover) + mover.candidates.capacity() * sizeof(Impl::Candidate);
  }
  std::vector<const CollisionElement*> elements;
  for (std::size_t i = 0; i < impl_->bodies.size(); ++i) {
    const CollisionElement* element = impl_->bodies[i].element.get();
    if (element != nullptr) elements.push_back(element);
  }
  std::ranges::sort(elements);
  elements.erase(std::unique(elements.begin(), elements.end()), elements.end());
  for (const CollisionElement* element : elements) {
    bytes += sizeof(CollisionElement);
    if (element->is_loaded()) bytes += element->model().memory_bytes();
  }
  return bytes;
}

Verdict worst(std::span<const BodyVerdict> verdicts) {
  Verdict result = Verdict::Clear;
  for (const BodyVerdict& verdict : verdicts) result = std::max(result, verdict.pair.verdict);
  return result;
}

}  // namespace dowel
