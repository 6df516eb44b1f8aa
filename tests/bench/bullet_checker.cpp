#include <map>
#include <vector>

#include <BulletCollision/Gimpact/btGImpactCollisionAlgorithm.h>
#include <BulletCollision/Gimpact/btGImpactShape.h>
#include <btBulletCollisionCommon.h>

#include "methods.h"

namespace dowel::bench {

namespace {

/// A dynamic AABB tree over the elements, GImpact over each one's triangles, single precision.
class BulletChecker : public Checker {
 public:
  BulletChecker() {
    // contactTest asks for closest-point algorithms; without these two it finds nothing.
    btGImpactCollisionAlgorithm::registerAlgorithm(&dispatcher_);
    dispatcher_.registerClosestPointsCreateFunc(GIMPACT_SHAPE_PROXYTYPE, GIMPACT_SHAPE_PROXYTYPE,
                                                &create_);
  }

  ~BulletChecker() override {
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
  }

  BulletChecker(const BulletChecker&) = delete;
  BulletChecker& operator=(const BulletChecker&) = delete;

  void prepare(const ElementPtr& element) override { (void)shared(element); }

  void add(const Placed& placed) override {
    objects_.push_back(std::make_unique<btCollisionObject>());
    objects_.back()->setCollisionShape(shared(placed.element));
    place(*objects_.back(), placed.X_WE);
    world_.addCollisionObject(objects_.back().get());
  }

  void remove_last() override {
    world_.removeCollisionObject(objects_.back().get());
    objects_.pop_back();
  }

  void set_moving(const ElementPtr& element) override {
    moving_ = std::make_unique<btCollisionObject>();
    moving_->setCollisionShape(shared(element));
  }

  Answer check(const Pose& X_WM) override {
    place(*moving_, X_WM);
    AnyContact found;
    world_.contactTest(moving_.get(), found);
    return {found.hit, {}};
  }

 private:
  struct AnyContact : btCollisionWorld::ContactResultCallback {
    bool hit = false;
    btScalar addSingleResult(btManifoldPoint& /*point*/, const btCollisionObjectWrapper* /*a*/,
                             int /*part_a*/, int /*index_a*/, const btCollisionObjectWrapper* /*b*/,
                             int /*part_b*/, int /*index_b*/) override {
      hit = true;
      return 0;
    }
    bool needsCollision(btBroadphaseProxy* /*proxy*/) const override { return !hit; }
  };

  struct Mesh {
    std::vector<btScalar> vertices;
    std::vector<int> indices;
    std::unique_ptr<btTriangleIndexVertexArray> array;
    std::unique_ptr<btGImpactMeshShape> shape;
  };

  static btScalar single(double value) { return static_cast<btScalar>(value); }

  static void place(btCollisionObject& object, const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation();
    const Eigen::Vector3d& p = pose.translation();
    object.setWorldTransform(
        btTransform(btQuaternion(single(q.x()), single(q.y()), single(q.z()), single(q.w())),
                    btVector3(single(p.x()), single(p.y()), single(p.z()))));
  }

  btGImpactMeshShape* shared(const ElementPtr& element) {
    Mesh& mesh = meshes_[element.get()];
    if (mesh.shape == nullptr) {
      for (const Eigen::Vector3d& p : element->solid->vertices) {
        for (const double value : {p.x(), p.y(), p.z()}) mesh.vertices.push_back(single(value));
      }
      for (const Triangle& t : element->solid->triangles) {
        for (const std::uint32_t v : t) mesh.indices.push_back(static_cast<int>(v));
      }
      mesh.array = std::make_unique<btTriangleIndexVertexArray>(
          static_cast<int>(mesh.indices.size() / 3), mesh.indices.data(),
          static_cast<int>(3 * sizeof(int)), static_cast<int>(mesh.vertices.size() / 3),
          mesh.vertices.data(), static_cast<int>(3 * sizeof(btScalar)));
      mesh.shape = std::make_unique<btGImpactMeshShape>(mesh.array.get());
      mesh.shape->setMargin(0);
      mesh.shape->updateBound();
    }
    return mesh.shape.get();
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btGImpactCollisionAlgorithm::CreateFunc create_;
  btDbvtBroadphase broadphase_;
  std::map<const Element*, Mesh> meshes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
  std::unique_ptr<btCollisionObject> moving_;
  btCollisionWorld world_{&dispatcher_, &broadphase_, &configuration_};
};

}  // namespace

std::unique_ptr<Checker> make_bullet() {
  return std::make_unique<BulletChecker>();
}

}  // namespace dowel::bench
