#include <atomic>
#include <mutex>
#include <optional>
#include <string>
#include <utility>

#include "dowel/collision/model.h"
#include "dowel/collision/scene.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

bool is_box(const Obb& obb) {
  // Written so that NaN fails.
  const Eigen::Matrix3d skew = obb.axes.transpose() * obb.axes - Eigen::Matrix3d::Identity();
  return obb.center.allFinite() && obb.half_extents_mm.allFinite() &&
         obb.half_extents_mm.minCoeff() >= 0.0 && skew.cwiseAbs().maxCoeff() <= kStoredAxisSlack;
}

/// A box that is too small hides contacts: the first vertex that sticks out of it.
std::optional<std::string> find_vertex_outside(const FacetedSolid& solid, const Obb& obb) {
  const double slack_mm = kBoxSlack_mm + kBoxSlackRatio * obb.half_extents_mm.norm();
  for (std::size_t v = 0; v < solid.vertices.size(); ++v) {
    const double outside_mm = obb.face_distance_mm(solid.vertices[v]);
    if (outside_mm <= slack_mm) continue;
    return "vertex " + std::to_string(v) + " is " + std::to_string(outside_mm) +
           " mm outside the box of its element";
  }
  return std::nullopt;
}

}  // namespace

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
  DOWEL_EXPECTS(load != nullptr && is_box(obb));
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
    const std::shared_ptr<const FacetedSolid> solid = state_->load();
    auto model = std::make_unique<const CollisionModel>(solid, state_->hole_faces);
    if (const auto defect = find_vertex_outside(*solid, obb_)) {
      throw Error(ErrorCode::FileMalformed, *defect);
    }
    state_->model = std::move(model);
    state_->ready.store(state_->model.get(), std::memory_order_release);
  }
  return *state_->model;
}

}  // namespace dowel
