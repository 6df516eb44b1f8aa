#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <vector>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/broadphase/default_broadphase_callbacks.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/collision.h>
#include <fcl/narrowphase/distance.h>

#include "methods.h"

namespace dowel::bench {

/// A dynamic AABB tree over the elements, a tree of bounding volumes over each one's triangles.
template <class BoundingVolume>
class FclChecker : public Checker {
  using Scalar = typename BoundingVolume::S;
  using Model = fcl::BVHModel<BoundingVolume>;
  using Object = fcl::CollisionObject<Scalar>;

 public:
  void prepare(const ElementPtr& element) override { (void)shared(element); }

  void add(const Placed& placed) override {
    objects_.push_back(std::make_unique<Object>(shared(placed.element)));
    place(*objects_.back(), placed.X_WE);
    // One by one, as in a session.
    manager_.registerObject(objects_.back().get());
  }

  void remove_last() override {
    manager_.unregisterObject(objects_.back().get());
    objects_.pop_back();
  }

  void set_moving(const ElementPtr& element) override {
    moving_ = std::make_unique<Object>(shared(element));
  }

  void finish() override { manager_.setup(); }

  Answer check(const Pose& X_WM) override {
    place(*moving_, X_WM);
    fcl::DefaultCollisionData<Scalar> data;
    manager_.collide(moving_.get(), &data, fcl::DefaultCollisionFunction<Scalar>);
    return {data.result.isCollision(), {}};
  }

  /// FCL measures the distance of meshes that are apart, on trees that have spheres swept along
  /// rectangles; it knows no depth.
  std::optional<double> measured_gap_mm(const Pose& X_WM) override {
    if (Model().getNodeType() != fcl::BV_OBBRSS) return {};
    place(*moving_, X_WM);
    double gap_mm = std::numeric_limits<double>::infinity();
    for (const auto& object : objects_) {
      fcl::DistanceRequest<Scalar> request;
      fcl::DistanceResult<Scalar> result;
      gap_mm = std::min(
          gap_mm, static_cast<double>(fcl::distance(moving_.get(), object.get(), request, result)));
    }
    return gap_mm > 0.0 ? std::optional(gap_mm) : std::nullopt;
  }

 private:
  static void place(Object& object, const Pose& pose) {
    fcl::Transform3<Scalar> transform = fcl::Transform3<Scalar>::Identity();
    transform.linear() = pose.rotation_matrix().template cast<Scalar>();
    transform.translation() = pose.translation().template cast<Scalar>();
    object.setTransform(transform);
    object.computeAABB();
  }

  std::shared_ptr<Model> shared(const ElementPtr& element) {
    auto& model = models_[element.get()];
    if (model == nullptr) {
      const FacetedSolid& solid = *element->solid;
      std::vector<fcl::Vector3<Scalar>> vertices;
      for (const Eigen::Vector3d& p : solid.vertices) {
        vertices.push_back(p.template cast<Scalar>());
      }
      std::vector<fcl::Triangle> triangles;
      for (const Triangle& t : solid.triangles) triangles.emplace_back(t[0], t[1], t[2]);
      model = std::make_shared<Model>();
      model->beginModel();
      model->addSubModel(vertices, triangles);
      model->endModel();
    }
    return model;
  }

  std::map<const Element*, std::shared_ptr<Model>> models_;
  std::vector<std::unique_ptr<Object>> objects_;
  std::unique_ptr<Object> moving_;
  fcl::DynamicAABBTreeCollisionManager<Scalar> manager_;
};

}  // namespace dowel::bench
