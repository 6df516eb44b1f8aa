#include <cstdio>

#include <dowel/catalog/catalog.h>
#include <dowel/collision/scene.h>

int main(int, char** argv) {
  const dowel::Catalog catalog(argv[1], dowel::Catalog::Access::ReadOnly);
  const auto element = [&](const char* name) {
    return std::make_shared<const dowel::CollisionElement>(
        catalog.find(name).value().obb, [&catalog, name] { return catalog.solid(name); });
  };
  dowel::CollisionScene scene;
  scene.add(element("H40-12/plate-6x6"), dowel::Pose());
  const dowel::BodyId riser = scene.add(element("H40-12/riser-80x80x40"), dowel::Pose());
  for (const double z_mm : {45.0, 40.0, 39.0}) {  // above, on and in the plate
    const auto pose = dowel::Pose::from_translation({0, 0, z_mm});
    std::puts(to_string(worst(scene.check({&riser, 1}, {&pose, 1}, {}))).data());
  }
}
