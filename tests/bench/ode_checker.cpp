#include <map>
#include <vector>

#include <ode/ode.h>

#include "methods.h"

namespace dowel::bench {

namespace {

/// A quadtree over the elements, OPCODE over each one's triangles. ODE's temporal coherence is for
/// primitives against meshes only, so none is used.
class OdeChecker : public Checker {
 public:
  OdeChecker() {
    static const bool kIsReady = dInitODE2(0) != 0;
    (void)kIsReady;
    const dVector3 center{0.0, 0.0, 0.0, 0.0};
    const dVector3 half{kReach_mm, kReach_mm, kReach_mm, 0.0};
    space_ = dQuadTreeSpaceCreate(nullptr, center, half, kDepth);
  }

  ~OdeChecker() override {
    if (moving_ != nullptr) dGeomDestroy(moving_);
    dSpaceDestroy(space_);
    for (const auto& [element, mesh] : meshes_) dGeomTriMeshDataDestroy(mesh.data);
  }

  OdeChecker(const OdeChecker&) = delete;
  OdeChecker& operator=(const OdeChecker&) = delete;

  void prepare(const ElementPtr& element) override { (void)shared(element); }

  void add(const Placed& placed) override {
    const dGeomID geom = dCreateTriMesh(space_, shared(placed.element), nullptr, nullptr, nullptr);
    place(geom, placed.X_WE);
    geoms_.push_back(geom);
  }

  void remove_last() override {
    dGeomDestroy(geoms_.back());
    geoms_.pop_back();
  }

  void set_moving(const ElementPtr& element) override {
    moving_ = dCreateTriMesh(nullptr, shared(element), nullptr, nullptr, nullptr);
  }

  Answer check(const Pose& X_WM) override {
    place(moving_, X_WM);
    bool hit = false;
    dSpaceCollide2(moving_, reinterpret_cast<dGeomID>(space_), &hit, &OdeChecker::collide);
    return {hit, {}};
  }

 private:
  // The square of the growth test's largest field, in cells of 34 mm.
  static constexpr double kReach_mm = 4400.0;
  static constexpr int kDepth = 8;

  struct Mesh {
    std::vector<double> vertices;
    std::vector<dTriIndex> indices;
    dTriMeshDataID data = nullptr;
  };

  static void collide(void* data, dGeomID a, dGeomID b) {
    bool& hit = *static_cast<bool*>(data);
    if (hit) return;  // a query cannot be ended early
    dContactGeom contact;
    hit = dCollide(a, b, static_cast<int>(CONTACTS_UNIMPORTANT | 1U), &contact, sizeof contact) > 0;
  }

  static void place(dGeomID geom, const Pose& pose) {
    const Eigen::Vector3d& p = pose.translation();
    const Eigen::Matrix3d r = pose.rotation_matrix();
    const dMatrix3 rotation{r(0, 0), r(0, 1), r(0, 2), 0.0,     r(1, 0), r(1, 1),
                            r(1, 2), 0.0,     r(2, 0), r(2, 1), r(2, 2), 0.0};
    dGeomSetPosition(geom, p.x(), p.y(), p.z());
    dGeomSetRotation(geom, rotation);
  }

  dTriMeshDataID shared(const ElementPtr& element) {
    Mesh& mesh = meshes_[element.get()];
    if (mesh.data == nullptr) {
      for (const Eigen::Vector3d& p : element->solid->vertices) {
        mesh.vertices.insert(mesh.vertices.end(), {p.x(), p.y(), p.z()});
      }
      for (const Triangle& t : element->solid->triangles) {
        mesh.indices.insert(mesh.indices.end(), {t[0], t[1], t[2]});
      }
      mesh.data = dGeomTriMeshDataCreate();
      dGeomTriMeshDataBuildDouble(mesh.data, mesh.vertices.data(), 3 * sizeof(double),
                                  static_cast<int>(mesh.vertices.size() / 3), mesh.indices.data(),
                                  static_cast<int>(mesh.indices.size()), 3 * sizeof(dTriIndex));
    }
    return mesh.data;
  }

  dSpaceID space_ = nullptr;
  std::map<const Element*, Mesh> meshes_;
  std::vector<dGeomID> geoms_;  // the space destroys them
  dGeomID moving_ = nullptr;
};

}  // namespace

std::unique_ptr<Checker> make_ode() {
  return std::make_unique<OdeChecker>();
}

}  // namespace dowel::bench
