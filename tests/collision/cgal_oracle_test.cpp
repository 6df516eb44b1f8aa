// Moves through a whole assembly against CGAL's exact predicates, which share no code with ours.

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <numbers>
#include <set>
#include <vector>

#include <CGAL/Rigid_triangle_mesh_collision_detection.h>
#include <catch2/catch.hpp>

#include "cgal_mesh.h"
#include "collision_element.h"
#include "random_geometry.h"
#include "solids.h"

using dowel::BodyId;
using dowel::CollisionScene;
using dowel::Pose;
using dowel::Verdict;
namespace testing = dowel::testing;

namespace {

using Outline = std::vector<Eigen::Vector2d>;
using Mesh = testing::CgalMesh;
using Detection = CGAL::Rigid_triangle_mesh_collision_detection<Mesh>;

#ifdef DOWEL_SANITIZED
constexpr int kPoses = 200;
#else
constexpr int kPoses = 10'000;
#endif
constexpr double kTolerance_mm = 0.01;

/// The outline with all sides moved outwards (negative: inwards), corners mitred.
Outline offset(const Outline& outline, double by_mm) {
  Outline result;
  const std::size_t n = outline.size();
  const auto outward = [](const Eigen::Vector2d& along) {
    return Eigen::Vector2d(along.y(), -along.x()).normalized();
  };
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d before = outward(outline[i] - outline[(i + n - 1) % n]);
    const Eigen::Vector2d after = outward(outline[(i + 1) % n] - outline[i]);
    result.emplace_back(outline[i] + by_mm * (before + after) / (1.0 + before.dot(after)));
  }
  return result;
}

struct Prism {
  Outline outline;
  double height_mm = 0.0;

  /// All faces moved outwards. Inwards, by d: holds every point that is deeper than d times the
  /// root of 3, and none that is not d deep. Outwards: holds every point that is no further off.
  dowel::FacetedSolid grown(double by_mm) const {
    return testing::transformed(Pose::from_translation({0.0, 0.0, -by_mm}),
                                testing::prism(offset(outline, by_mm), height_mm + 2.0 * by_mm));
  }
};

Outline rectangle(double width_mm, double depth_mm) {
  const double x = 0.5 * width_mm;
  const double y = 0.5 * depth_mm;
  return {{-x, -y}, {x, -y}, {x, y}, {-x, y}};
}

Outline regular(int corners, double radius_mm) {
  Outline result;
  for (int i = 0; i < corners; ++i) {
    const double angle_rad = 2.0 * std::numbers::pi * i / corners;
    result.emplace_back(radius_mm * std::cos(angle_rad), radius_mm * std::sin(angle_rad));
  }
  return result;
}

/// A plate of 80 by 30 with a T-slot of throat 14, undercut 24 by 10, seen along the slot.
Outline slotted() {
  return {{-40, 0}, {40, 0},  {40, 30},  {7, 30},  {7, 18},  {12, 18},
          {12, 8},  {-12, 8}, {-12, 18}, {-7, 18}, {-7, 30}, {-40, 30}};
}

/// A nut that the slot leaves 0.2 mm all round.
Outline tee() {
  return {{-11.8, 8.2}, {11.8, 8.2},  {11.8, 17.8}, {6.8, 17.8},
          {6.8, 29.8},  {-6.8, 29.8}, {-6.8, 17.8}, {-11.8, 17.8}};
}

Outline vee() {
  return {{-30, 0}, {30, 0}, {30, 40}, {20, 40}, {0, 15}, {-20, 40}, {-30, 40}};
}

/// Outlines lie in x and y; here they stand, with y upwards and the length along -y.
Pose standing(double x, double y, double z) {
  return {Eigen::Quaterniond(Eigen::AngleAxisd(0.5 * std::numbers::pi, Eigen::Vector3d::UnitX())),
          {x, y, z}};
}

/// The assembly in CGAL's hands, with all solids grown by the same amount.
class CgalAssembly {
 public:
  explicit CgalAssembly(double grown_mm) : grown_mm_(grown_mm) {}

  std::size_t add(const Prism& prism, const Pose& X_WB) {
    meshes_.push_back(std::make_unique<Mesh>(testing::cgal_mesh(prism.grown(grown_mm_))));
    const std::size_t id = detection_.add_mesh(*meshes_.back());
    place(id, X_WB);
    return id;
  }

  void place(std::size_t id, const Pose& pose) {
    detection_.set_transformation(id, testing::cgal_pose(pose));
  }

  /// Those that have a point in common with `id`.
  std::set<std::size_t> meets(std::size_t id) {
    std::set<std::size_t> result;
    for (const auto& [other, is_inclusion] : detection_.get_all_intersections_and_inclusions(id)) {
      result.insert(other);
    }
    return result;
  }

 private:
  double grown_mm_;
  std::vector<std::unique_ptr<Mesh>> meshes_;
  Detection detection_;
};

/// The same assembly in dowel and, at four sizes, in CGAL.
class Assembly {
 public:
  void add(const Prism& prism, const Pose& X_WB) {
    bodies_.push_back(scene_.add(testing::collision_element(prism.grown(0.0)), X_WB));
    poses_.push_back(X_WB);
    for (CgalAssembly& assembly : truths_) assembly.add(prism, X_WB);
  }
  std::size_t size() const { return bodies_.size(); }
  const Pose& pose(std::size_t i) const { return poses_[i]; }

  /// Compares the verdicts on body `moving`, were it at `X_WB`.
  void compare(std::size_t moving, const Pose& X_WB) {
    const std::array<BodyId, 1> body{bodies_[moving]};
    std::map<std::size_t, Verdict> said;
    for (const auto& found :
         scene_.check(body, std::span(&X_WB, 1), {.tolerance_mm = kTolerance_mm})) {
      said[found.with.value] = found.pair.verdict;
    }
    std::array<std::set<std::size_t>, 4> meets;
    for (std::size_t k = 0; k < truths_.size(); ++k) {
      truths_[k].place(moving, X_WB);
      meets[k] = truths_[k].meets(moving);
      truths_[k].place(moving, poses_[moving]);
    }
    for (std::size_t other = 0; other < bodies_.size(); ++other) {
      if (other == moving) continue;
      CAPTURE(moving, other, X_WB.translation().transpose(), X_WB.rotation().coeffs().transpose());
      const Verdict verdict = said.contains(other) ? said[other] : Verdict::Clear;
      if (meets[0].contains(other)) CHECK(verdict == Verdict::Interference);
      if (!meets[1].contains(other)) CHECK(verdict != Verdict::Interference);
      if (meets[2].contains(other)) CHECK(verdict != Verdict::Clear);
      if (!meets[3].contains(other)) CHECK(verdict == Verdict::Clear);
      ++counts[verdict];
    }
  }

  std::map<Verdict, int> counts;

 private:
  CollisionScene scene_;
  std::vector<BodyId> bodies_;
  std::vector<Pose> poses_;
  // Deeper than 1.1 t for certain; all that is deeper than 0.9 t; touching; within 1.1 t.
  std::array<CgalAssembly, 4> truths_{CgalAssembly(-0.55 * kTolerance_mm),
                                      CgalAssembly(-0.45 / std::numbers::sqrt3 * kTolerance_mm),
                                      CgalAssembly(0.0), CgalAssembly(0.55 * kTolerance_mm)};
};

/// Mostly small steps, flush with where it stood along some of the axes; at times further away.
Pose moved(testing::RandomGeometry& random, const Pose& from) {
  constexpr std::array<double, 5> kSteps_mm{0.0, 0.5 * kTolerance_mm, 2.0 * kTolerance_mm, 0.3, 30};
  Eigen::Vector3d way;
  for (Eigen::Index i = 0; i < 3; ++i) {
    way[i] = random.uniform(-1.0, 1.0) * kSteps_mm[random.index(kSteps_mm.size())];
  }
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  if (random.index(4) == 0) turn = random.rotation();
  if (random.index(4) == 0) {
    turn = Eigen::AngleAxisd(random.uniform(-0.01, 0.01), random.direction());
  }
  return {turn * from.rotation(), from.translation() + way};
}

}  // namespace

TEST_CASE("moves in an assembly are judged as CGAL's exact predicates judge them", "[property]") {
  testing::RandomGeometry random(1);
  Assembly assembly;
  assembly.add({slotted(), 200.0}, standing(0, 100, -30));
  assembly.add({tee(), 22.0}, standing(0, 40, -30));
  assembly.add({rectangle(30, 40), 25.0}, Pose::from_translation({-25, 20, 0}));
  assembly.add({rectangle(30, 40), 25.0}, Pose::from_translation({25, 20, 0}));
  assembly.add({rectangle(80, 20), 10.0}, Pose::from_translation({0, 20, 25}));
  assembly.add({vee(), 35.0}, standing(0, -40, 0));
  assembly.add({regular(6, 11.0), 12.0}, Pose::from_translation({-29, 20, 35}));
  assembly.add({regular(3, 14.0), 18.0}, Pose::from_translation({29, 20, 35}));
  assembly.add({regular(8, 5.0), 60.0}, Pose::from_translation({-10, -10, 0}));
  for (int i = 0; i < kPoses; ++i) {
    const std::size_t moving = random.index(static_cast<std::uint32_t>(assembly.size()));
    assembly.compare(moving, moved(random, assembly.pose(moving)));
  }
  for (const Verdict verdict : {Verdict::Clear, Verdict::Contact, Verdict::Interference}) {
    CAPTURE(to_string(verdict));
    CHECK(assembly.counts[verdict] > kPoses / 10);
  }
}
