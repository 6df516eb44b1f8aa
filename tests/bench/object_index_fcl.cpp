#include <memory>
#include <vector>

#include <fcl/broadphase/broadphase_SSaP.h>
#include <fcl/broadphase/broadphase_dynamic_AABB_tree.h>
#include <fcl/geometry/shape/box.h>
#include <fcl/narrowphase/collision_object.h>

#include "object_index.h"

namespace dowel::bench {

namespace {

template <class Manager>
class FclIndex : public ObjectIndex {
  using Object = fcl::CollisionObject<double>;

 public:
  void insert(const Aabb& box) override {
    objects_.push_back(object(box));
    manager_.registerObject(objects_.back().get());
  }

  void remove_last() override {
    manager_.unregisterObject(objects_.back().get());
    objects_.pop_back();
  }

  std::size_t count_overlaps(const Aabb& box) override {
    manager_.setup();  // sorts or balances what has changed
    std::size_t count = 0;
    manager_.collide(object(box).get(), &count, [](Object*, Object*, void* data) {
      ++*static_cast<std::size_t*>(data);
      return false;  // go on
    });
    return count;
  }

 private:
  static std::unique_ptr<Object> object(const Aabb& box) {
    const Eigen::Vector3d size = box.size();
    auto shape = std::make_shared<fcl::Box<double>>(size.x(), size.y(), size.z());
    fcl::Transform3<double> X = fcl::Transform3<double>::Identity();
    X.translation() = box.center();
    auto result = std::make_unique<Object>(std::move(shape), X);
    result->computeAABB();
    return result;
  }

  Manager manager_;
  std::vector<std::unique_ptr<Object>> objects_;
};

}  // namespace

std::unique_ptr<ObjectIndex> make_fcl_tree() {
  return std::make_unique<FclIndex<fcl::DynamicAABBTreeCollisionManager<double>>>();
}

std::unique_ptr<ObjectIndex> make_fcl_sweep_and_prune() {
  return std::make_unique<FclIndex<fcl::SSaPCollisionManager<double>>>();
}

}  // namespace dowel::bench
