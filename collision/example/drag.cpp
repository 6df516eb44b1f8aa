// How a program with triangle meshes of its own embeds collision: a block is dragged over a plate
// towards a post, frame by frame, as a mouse or a hand would.

#include <array>
#include <cstdio>
#include <memory>

#include <dowel/collision/scene.h>

namespace {

/// Stands on z = 0, about the z axis. Each side is one flat face of two triangles; a mesh without
/// known faces has one face with an OtherSurface.
std::shared_ptr<const dowel::CollisionElement> block(const Eigen::Vector3d& size_mm) {
  auto solid = std::make_shared<dowel::FacetedSolid>();
  solid->solid_count = 1;
  const Eigen::Vector3d half(0.5 * size_mm.x(), 0.5 * size_mm.y(), size_mm.z());
  for (const double z : {0.0, 1.0}) {
    for (const auto& [x, y] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      solid->vertices.emplace_back(half.cwiseProduct(Eigen::Vector3d(x, y, z)));
    }
  }
  constexpr std::array<std::array<std::uint32_t, 4>, 6> kSides{
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
  for (const auto& [a, b, c, d] : kSides) {
    const auto& v = solid->vertices;
    const Eigen::Vector3d normal = (v[b] - v[a]).cross(v[c] - v[a]);
    const auto face = static_cast<std::uint32_t>(solid->faces.size());
    solid->faces.push_back(
        {dowel::PlaneSurface{v[a], normal.normalized()}, false, 0.0, normal.norm(), 0});
    solid->triangles.push_back({a, b, c});
    solid->triangles.push_back({a, c, d});
    solid->face_of.insert(solid->face_of.end(), {face, face});
  }
  const dowel::Aabb box = dowel::bounds(solid->vertices);
  const dowel::Obb obb{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()};
  return std::make_shared<const dowel::CollisionElement>(obb, [solid] { return solid; });
}

}  // namespace

int main() {
  dowel::CollisionScene scene;
  const auto small = block({20, 20, 20});  // one element, two bodies: shared facets, shared tree
  scene.add(block({300, 100, 10}), dowel::Pose::from_translation({0, 0, -10}));
  const auto post = scene.add(small, dowel::Pose::from_translation({100, 0, 0}));
  const auto dragged = scene.add(small, dowel::Pose());

  // One check a frame. What touches is `contact`; only what enters is `interference`.
  double x_mm = -100.0;
  for (int frame = 0; frame < 1000; ++frame) {
    const auto pose = dowel::Pose::from_translation({x_mm + 0.2, 0, 0});
    if (worst(scene.check({&dragged, 1}, {&pose, 1}, {})) == dowel::Verdict::Interference) break;
    x_mm += 0.2;
    scene.move(dragged, pose);
  }
  std::printf("stopped at x = %.1f mm\n", x_mm);

  // A leap to the other side of the post: each end is free, the way is not.
  const auto from = dowel::Pose::from_translation({-50, 0, 0});
  const auto to = dowel::Pose::from_translation({140, 0, 0});
  const dowel::Pose own_frame;
  const dowel::SweepResult swept = scene.sweep({&dragged, 1}, {&own_frame, 1}, from, to, {});
  std::printf("leap: %s after %.0f %% of the way\n", to_string(swept.verdict).data(),
              100.0 * swept.time_of_impact);

  // Both small blocks as one unit, lifted: they are not checked against each other.
  const std::array unit{dragged, post};
  const std::array lifted{dowel::Pose::from_translation({x_mm, 0, 0.5}),
                          dowel::Pose::from_translation({100, 0, 0.5})};
  std::printf("lifted by 0.5 mm: %s\n", to_string(worst(scene.check(unit, lifted, {}))).data());
  std::printf("%llu box tests, %llu facet pairs\n",
              static_cast<unsigned long long>(scene.counters().box_tests),
              static_cast<unsigned long long>(scene.counters().triangle_tests));
}
