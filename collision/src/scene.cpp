#include "dowel/collision/scene.h"

#include <algorithm>
#include <atomic>
#include <map>
#include <mutex>

#include "dowel/collision/box_separation.h"
#include "dowel/collision/layered_projection.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "narrow_phase.h"
#include "scene_impl.h"

namespace dowel {

struct CollisionElement::State {
  Loader load;
  std::vector<std::uint32_t> hole_faces;
  mutable std::mutex mutex;
  mutable std::unique_ptr<const CollisionModel> model;
  mutable std::atomic<const CollisionModel*> ready{nullptr};
};

CollisionElement::CollisionElement(const Obb& obb, Loader load,
                                   std::vector<std::uint32_t> hole_faces)
    : obb_(obb), state_(std::make_unique<State>()) {
  DOWEL_EXPECTS(load != nullptr);
  state_->load = std::move(load);
  state_->hole_faces = std::move(hole_faces);
}

CollisionElement::~CollisionElement() = default;

bool CollisionElement::is_loaded() const noexcept {
  return state_->ready.load(std::memory_order_acquire) != nullptr;
}

const CollisionModel& CollisionElement::model() const {
  if (const CollisionModel* model = state_->ready.load(std::memory_order_acquire)) return *model;
  const std::scoped_lock lock(state_->mutex);
  if (!state_->model) {
    state_->model = std::make_unique<const CollisionModel>(state_->load(), state_->hole_faces);
    state_->ready.store(state_->model.get(), std::memory_order_release);
  }
  return *state_->model;
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
  BodyId id{static_cast<std::uint32_t>(impl_->bodies.size())};
  if (impl_->free_ids.empty()) {
    impl_->bodies.emplace_back();
  } else {
    id = impl_->free_ids.back();
    impl_->free_ids.pop_back();
  }
  const Obb obb_W = transformed(X_WB, element->obb());
  impl_->bodies[id.value] = {std::move(element), X_WB, obb_W, -1, false};
  impl_->projection.insert(id.value, bounds(obb_W));
  return id;
}

void CollisionScene::remove(BodyId id) {
  impl_->body(id) = {};
  impl_->projection.remove(id.value);
  impl_->free_ids.push_back(id);
  std::erase_if(impl_->reliefs, [id](const auto& entry) {
    return entry.first.first == id || entry.first.second == id;
  });
}

void CollisionScene::move(BodyId id, const Pose& X_WB) {
  Impl::Body& body = impl_->body(id);
  body.X_WB = X_WB;
  body.obb_W = transformed(X_WB, body.element->obb());
  impl_->projection.remove(id.value);
  impl_->projection.insert(id.value, bounds(body.obb_W));
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
                                               const QueryOptions& options) {
  const Body& body_b = bodies[b.value];
  const Pose X_BA = body_b.X_WB.inverse() * X_WA;
  const ModelPair pair{bodies[a.value].element->model(), body_b.element->model(), X_BA,
                       reliefs_in(a, b, X_BA)};
  PairVerdict verdict = judge(pair, options, scratch, counters);
  verdict.witness_W = body_b.X_WB * verdict.witness_W;
  return verdict;
}

namespace {

void expect_valid(const QueryOptions& options) {
  DOWEL_EXPECTS(options.tolerance_mm >= kMinTolerance_mm && options.tolerance_mm < 1e3);
}

}  // namespace

std::vector<BodyVerdict> CollisionScene::check(std::span<const BodyId> moving,
                                               std::span<const Pose> poses,
                                               const QueryOptions& options) {
  expect_valid(options);
  DOWEL_EXPECTS(moving.size() == poses.size());
  std::vector<BodyVerdict> result;
  const Impl::MovingMark mark(*impl_, moving);
  for (std::size_t i = 0; i < moving.size(); ++i) {
    const Obb obb_W = transformed(poses[i], impl_->body(moving[i]).element->obb());
    impl_->projection.query(bounds(obb_W).padded(options.tolerance_mm), impl_->found);
    for (const std::uint32_t other : impl_->found) {
      Impl::Body& body = impl_->bodies[other];
      if (body.is_moving) continue;
      ++impl_->counters.box_tests;
      const BoxSeparation separation =
          separate(obb_W, body.obb_W, options.tolerance_mm, body.last_plane);
      body.last_plane = static_cast<std::int8_t>(separation.plane);
      if (separation.plane >= 0) continue;
      const PairVerdict verdict = impl_->judge_bodies(moving[i], poses[i], BodyId{other}, options);
      if (verdict.verdict == Verdict::Clear) continue;
      if (options.first_only && verdict.verdict == Verdict::Interference) {
        return {{moving[i], BodyId{other}, verdict}};
      }
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
    impl_->projection.query(bounds(body.obb_W).padded(options.tolerance_mm), found);
    for (const std::uint32_t other : found) {
      if (other <= i) continue;
      ++impl_->counters.box_tests;
      if (separate(body.obb_W, impl_->bodies[other].obb_W, options.tolerance_mm).plane >= 0) {
        continue;
      }
      const PairVerdict verdict = impl_->judge_bodies(BodyId{i}, body.X_WB, BodyId{other}, options);
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
  std::size_t bytes = sizeof(Impl) + impl_->bodies.capacity() * sizeof(Impl::Body) +
                      impl_->projection.memory_bytes();
  std::vector<const CollisionElement*> elements;
  for (const Impl::Body& body : impl_->bodies) {
    if (body.element != nullptr) elements.push_back(body.element.get());
  }
  std::ranges::sort(elements);
  elements.erase(std::ranges::unique(elements).begin(), elements.end());
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
