#pragma once

#include <algorithm>
#include <limits>
#include <map>
#include <type_traits>
#include <utility>
#include <vector>

#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/bvh/BVH_model.h>
#include <fcl/narrowphase/detail/traversal/collision/mesh_collision_traversal_node.h>
#include <fcl/narrowphase/detail/traversal/collision_node.h>
#include <fcl/narrowphase/distance.h>

#include "methods.h"

namespace dowel::bench {

/// The walk of tree against tree that fcl::collide takes for two meshes.
template <class BoundingVolume>
struct FclWalk;

template <class Scalar>
struct FclWalk<fcl::OBB<Scalar>> {
  using Node = fcl::detail::MeshCollisionTraversalNodeOBB<Scalar>;
};

template <class Scalar>
struct FclWalk<fcl::OBBRSS<Scalar>> {
  using Node = fcl::detail::MeshCollisionTraversalNodeOBBRSS<Scalar>;
};

/// A dynamic AABB tree over the elements, a tree of bounding volumes over each one's triangles. Two
/// meshes go straight to the walk that fcl::collide would find for them in its table, since it
/// counts its tests and takes the same time; the table takes minutes to compile in single
/// precision.
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
    Query query{{}, counters_};
    manager_.collide(moving_.get(), &query, &FclChecker::collide);
    return {query.result.isCollision(), {}};
  }

  /// N_b: pairs of elements that the tree over them leaves, and of volumes.
  std::optional<Counters> take_counters() override { return std::exchange(counters_, {}); }

  /// FCL measures the distance of meshes that are apart, on trees that have spheres swept along
  /// rectangles; it knows no depth.
  std::optional<double> measured_gap_mm(const Pose& X_WM) override {
    if constexpr (std::is_same_v<BoundingVolume, fcl::OBBRSS<double>>) {
      place(*moving_, X_WM);
      double gap_mm = std::numeric_limits<double>::infinity();
      for (const auto& object : objects_) {
        const fcl::DistanceRequest<double> request;
        fcl::DistanceResult<double> result;
        gap_mm = std::min(gap_mm, fcl::distance(moving_.get(), object.get(), request, result));
      }
      return gap_mm > 0.0 ? std::optional(gap_mm) : std::nullopt;
    } else {
      return {};
    }
  }

 private:
  struct Query {
    fcl::CollisionResult<Scalar> result;
    Counters& counters;
  };

  static const Model& model_of(const Object& object) {
    return static_cast<const Model&>(*object.collisionGeometry());
  }

  /// Ends the query at the first hit.
  static bool collide(Object* a, Object* b, void* data) {
    Query& query = *static_cast<Query*>(data);
    typename FclWalk<BoundingVolume>::Node node;
    node.enable_statistics = true;
    fcl::detail::initialize(node, model_of(*a), a->getTransform(), model_of(*b), b->getTransform(),
                            fcl::CollisionRequest<Scalar>(), query.result);
    fcl::detail::collide(&node);
    query.counters.box_tests += 1U + static_cast<std::uint64_t>(node.num_bv_tests);
    query.counters.triangle_tests += static_cast<std::uint64_t>(node.num_leaf_tests);
    return query.result.isCollision();
  }

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
  Counters counters_;
};

}  // namespace dowel::bench
