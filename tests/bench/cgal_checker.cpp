#include <array>
#include <map>
#include <vector>

#include <CGAL/Rigid_triangle_mesh_collision_detection.h>

#include "cgal_mesh.h"
#include "methods.h"

namespace dowel::bench {

namespace {

/// Exact predicates on AABB trees, one a mesh, for elements whose boxes overlap.
class CgalChecker : public Checker {
  using Mesh = testing::CgalMesh;
  using Detection = CGAL::Rigid_triangle_mesh_collision_detection<Mesh>;

  struct Shared {
    Mesh mesh;
    std::unique_ptr<Detection::AABB_tree> tree;
  };

 public:
  void prepare(const ElementPtr& element) override { (void)shared(element); }

  void add(const Placed& placed) override {
    const Shared& found = shared(placed.element);
    ids_.push_back(detection_.add_mesh(*found.tree, found.mesh));
    boxes_W_.push_back(placed.box_W);
    place(ids_.back(), placed.X_WE);
  }

  void remove_last() override {
    detection_.remove_mesh(ids_.back());
    ids_.pop_back();
    boxes_W_.pop_back();
  }

  void set_moving(const ElementPtr& element) override {
    const Shared& found = shared(element);
    moving_ = detection_.add_mesh(*found.tree, found.mesh);
    moving_box_ = {element->box.center(), Eigen::Matrix3d::Identity(), 0.5 * element->box.size()};
  }

  Answer check(const Pose& X_WM) override {
    place(moving_, X_WM);
    const Aabb box_W = bounds(transformed(X_WM, moving_box_)).padded(kRounding_mm);
    for (std::size_t i = 0; i < ids_.size(); ++i) {
      if (!boxes_W_[i].overlaps(box_W)) continue;
      if (!detection_.get_all_intersections(moving_, std::array{ids_[i]}).empty()) {
        return {true, {}};
      }
    }
    return {};
  }

 private:
  static constexpr double kRounding_mm = 1.0e-6;  // of turned boxes, generously

  void place(std::size_t id, const Pose& pose) {
    detection_.set_transformation(id, testing::cgal_pose(pose));
  }

  const Shared& shared(const ElementPtr& element) {
    Shared& found = meshes_[element.get()];
    if (found.tree == nullptr) {
      found.mesh = testing::cgal_mesh(*element->solid);
      const auto [begin, end] = faces(found.mesh);
      found.tree = std::make_unique<Detection::AABB_tree>(begin, end, found.mesh);
      found.tree->build();
    }
    return found;
  }

  std::map<const Element*, Shared> meshes_;
  Detection detection_;
  std::vector<std::size_t> ids_;
  std::vector<Aabb> boxes_W_;
  Obb moving_box_;
  std::size_t moving_ = 0;
};

}  // namespace

std::unique_ptr<Checker> make_cgal() {
  return std::make_unique<CgalChecker>();
}

}  // namespace dowel::bench
