#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numbers>
#include <set>
#include <stdexcept>

#include <Eigen/Geometry>
#include <assimp/Importer.hpp>
#include <assimp/scene.h>
#include <catch2/catch.hpp>

#include "display_scenes.h"
#include "dowel/io/file.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/error.h"
#include "glb_file.h"
#include "program.h"

using namespace dowel;
using namespace dowel::testing;
using Eigen::Vector3d;

namespace {

/// Positions are stored as float: half an ulp at the 1.2 m that the scenes reach to.
constexpr double kFloatError_mm = 1.0e-4;

/// glTF to the assembly's frame: metres and y up to millimetres and z up.
Vector3d z_up_mm(const Vector3d& v) {
  return 1000.0 * Vector3d(v.x(), -v.z(), v.y());
}

std::vector<Vector3d> vectors(const GlbFile& glb, const nlohmann::json& accessor) {
  const std::vector<double> values = read_accessor(glb, accessor.get<std::size_t>());
  std::vector<Vector3d> result;
  for (std::size_t i = 0; i < values.size(); i += 3) {
    result.emplace_back(values[i], values[i + 1], values[i + 2]);
  }
  return result;
}

double six_volumes(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  return a.dot(b.cross(c));
}

double facet_volume_mm3(const FacetedSolid& solid) {
  double sum = 0.0;
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const auto [a, b, c] = solid.corners(t);
    sum += six_volumes(a, b, c);
  }
  return sum / 6.0;
}

/// What assimp makes of a node: volume and bounds of its facets, in the assembly's frame.
struct ReadNode {
  double volume_mm3 = 0.0;
  Aabb bounds;
  std::size_t line_count = 0;
};

ReadNode read_node(const aiScene& scene, const aiNode& node) {
  ReadNode result;
  aiMatrix4x4 transform;
  for (const aiNode* at = &node; at != nullptr; at = at->mParent) {
    transform = at->mTransformation * transform;
  }
  for (const unsigned index : std::span(node.mMeshes, node.mNumMeshes)) {
    const aiMesh& mesh = *scene.mMeshes[index];
    std::vector<Vector3d> points;
    for (const aiVector3D& vertex : std::span(mesh.mVertices, mesh.mNumVertices)) {
      const aiVector3D placed = transform * vertex;
      points.push_back(z_up_mm({placed.x, placed.y, placed.z}));
    }
    for (const aiFace& face : std::span(mesh.mFaces, mesh.mNumFaces)) {
      const unsigned* i = face.mIndices;
      if (face.mNumIndices == 2) ++result.line_count;
      if (face.mNumIndices != 3) continue;
      result.volume_mm3 += six_volumes(points[i[0]], points[i[1]], points[i[2]]) / 6.0;
      for (int k = 0; k < 3; ++k) result.bounds.extend(points[i[k]]);
    }
  }
  return result;
}

/// Surface primitive of the only mesh of a one-part scene.
struct OnePart {
  GlbFile glb;
  std::vector<Vector3d> positions;  ///< mm, z up
  std::vector<Vector3d> normals;    ///< z up
  std::vector<double> triangles;
  std::vector<double> lines;
};

OnePart one_part(FacetedSolid solid) {
  OnePart part;
  part.glb = parse_glb(to_glb(scene_of(std::move(solid))));
  const auto& primitives = part.glb.document.at("meshes").at(0).at("primitives");
  const auto& attributes = primitives.at(0).at("attributes");
  for (const Vector3d& p : vectors(part.glb, attributes.at("POSITION"))) {
    part.positions.push_back(z_up_mm(p));
  }
  for (const Vector3d& n : vectors(part.glb, attributes.at("NORMAL"))) {
    part.normals.emplace_back(n.x(), -n.z(), n.y());
  }
  part.triangles = read_accessor(part.glb, primitives.at(0).at("indices").get<std::size_t>());
  if (primitives.size() == 2) {
    part.lines = read_accessor(part.glb, primitives.at(1).at("indices").get<std::size_t>());
  }
  return part;
}

/// Unit normal of the facet that starts at `first` in the indices.
Vector3d facet_normal(const OnePart& part, std::size_t first) {
  std::array<Vector3d, 3> p;
  for (std::size_t k = 0; k < 3; ++k) {
    p[k] = part.positions[static_cast<std::size_t>(part.triangles[first + k])];
  }
  return (p[1] - p[0]).cross(p[2] - p[0]).normalized();
}

}  // namespace

TEST_CASE("every accessor of a GLB lies in its buffer and every bound is that of its data") {
  const GlbFile glb = parse_glb(to_glb(small_fixture()));
  const auto& accessors = glb.document.at("accessors");
  std::size_t bounded = 0;
  for (std::size_t i = 0; i < accessors.size(); ++i) {
    CAPTURE(i);
    const std::vector<double> values = read_accessor(glb, i);
    if (!accessors[i].contains("min")) continue;
    ++bounded;
    for (std::size_t k = 0; k < 3; ++k) {
      double low = values[k];
      double high = values[k];
      for (std::size_t j = k; j < values.size(); j += 3) {
        low = std::min(low, values[j]);
        high = std::max(high, values[j]);
      }
      CHECK(accessors[i]["min"][k].get<double>() == low);
      CHECK(accessors[i]["max"][k].get<double>() == high);
    }
  }
  CHECK(bounded == 3);
  for (const auto& mesh : glb.document.at("meshes")) {
    for (const auto& primitive : mesh.at("primitives")) {
      const auto& positions =
          accessors.at(primitive.at("attributes").at("POSITION").get<std::size_t>());
      for (const double index : read_accessor(glb, primitive.at("indices").get<std::size_t>())) {
        REQUIRE(index < positions.at("count").get<double>());
      }
    }
  }
}

TEST_CASE("another reader finds every instance where the scene has it, in metres and y up") {
  const DisplayScene scene = small_fixture();
  const std::vector<std::byte> glb = to_glb(scene);
  Assimp::Importer importer;
  const aiScene* read = importer.ReadFileFromMemory(glb.data(), glb.size(), 0, "glb");
  REQUIRE(read != nullptr);
  for (const DisplayInstance& instance : scene.instances) {
    CAPTURE(instance.name);
    const aiNode* node = read->mRootNode->FindNode(instance.name.c_str());
    REQUIRE(node != nullptr);
    const ReadNode got = read_node(*read, *node);
    const FacetedSolid& solid = *scene.meshes[instance.mesh].solid;
    Aabb expected;
    for (const Vector3d& vertex : solid.vertices) expected.extend(instance.X_WI * vertex);
    CHECK((got.bounds.min - expected.min).norm() < 2.0 * kFloatError_mm);
    CHECK((got.bounds.max - expected.max).norm() < 2.0 * kFloatError_mm);
    const double volume_mm3 = facet_volume_mm3(solid);
    CHECK(volume_mm3 > 1000.0);
    CHECK(got.volume_mm3 == Approx(volume_mm3).epsilon(1e-3));
    CHECK(got.line_count > 0);
  }
}

TEST_CASE("a box of a metre is a metre wide in the file and stands on its y axis") {
  const OnePart part = one_part(box({1000, 500, 250}, {0, 0, 125}));
  const auto& accessor = part.glb.document.at("accessors").at(0);
  CHECK(accessor.at("min") == nlohmann::json({-0.5, 0.0, -0.25}));
  CHECK(accessor.at("max") == nlohmann::json({0.5, 0.25, 0.25}));
}

TEST_CASE("normals are of unit length, outward, and those of the exact faces") {
  SECTION("the wall of a bore and of a pin point away from the material") {
    const OnePart part = one_part(tube(10.0, 25.0, 40.0, 16));
    std::size_t inner = 0;
    std::size_t outer = 0;
    for (std::size_t i = 0; i < part.positions.size(); ++i) {
      const Vector3d& n = part.normals[i];
      REQUIRE(std::abs(n.norm() - 1.0) < 1e-6);
      if (std::abs(n.z()) > 0.5) continue;
      Vector3d radial(part.positions[i].x(), part.positions[i].y(), 0.0);
      const bool is_inner = radial.norm() < 15.0;
      (is_inner ? inner : outer) += 1;
      radial.normalize();
      CHECK((n - (is_inner ? -radial : radial)).norm() < 1e-5);
    }
    CHECK(inner == 2 * 16);
    CHECK(outer == 2 * 16);
  }
  SECTION("facets around the tip of a cone keep their own side") {
    const OnePart part = one_part(cone(10.0, 15.0, 20));
    for (std::size_t i = 0; i < part.triangles.size(); i += 3) {
      const Vector3d own = facet_normal(part, i);
      for (std::size_t k = 0; k < 3; ++k) {
        CHECK(part.normals[static_cast<std::size_t>(part.triangles[i + k])].dot(own) > 0.95);
      }
    }
  }
  SECTION("a free-form face is smooth where its facets turn little and breaks where they fold") {
    FacetedSolid round = sphere(20.0, 32);
    round.faces[0].surface = OtherSurface{};
    const OnePart smooth = one_part(round);
    CHECK(smooth.positions.size() == round.vertices.size());
    for (std::size_t i = 0; i < smooth.positions.size(); ++i) {
      CHECK(smooth.normals[i].dot(smooth.positions[i].normalized()) > 0.99);
    }
    FacetedSolid folded = box({10, 10, 10});
    for (Face& face : folded.faces) face.surface = OtherSurface{};
    for (auto& face : folded.face_of) face = 0;
    folded.edges.clear();
    const OnePart flat = one_part(folded);
    CHECK(flat.positions.size() == 24);
    CHECK(flat.lines.size() == 2 * 12);
  }
}

TEST_CASE("lines are the edges that a drawing shows") {
  SECTION("a box has twelve") {
    CHECK(one_part(box({10, 20, 30})).lines.size() == 2 * 12);
  }
  SECTION("a cylinder has two circles and no seam") {
    CHECK(one_part(cylinder(10, 20, 24)).lines.size() == 2 * 48);
  }
  SECTION("a sphere of one face has none") {
    CHECK(one_part(sphere(10, 16)).lines.empty());
  }
  SECTION("the halves of a cylinder that an exporter has cut show no border") {
    FacetedSolid halves = cylinder(10, 20, 24);
    const auto wall = static_cast<std::uint32_t>(
        std::ranges::find_if(halves.faces,
                             [](const Face& face) { return !is_plane(face.surface); }) -
        halves.faces.begin());
    const auto second = static_cast<std::uint32_t>(halves.faces.size());
    halves.faces.push_back(halves.faces[wall]);
    for (std::uint32_t t = 0; t < halves.triangles.size(); ++t) {
      const auto [a, b, c] = halves.corners(t);
      if (halves.face_of[t] == wall && (a + b + c).y() > 0.0) halves.face_of[t] = second;
    }
    CHECK(std::ranges::count(halves.face_of, second) == 24);
    halves.edges.clear();
    CHECK(one_part(halves).lines.size() == 2 * 48);
  }
  SECTION("a plane that runs into a fillet shows where") {
    // A stadium: two planes, tangent to two half cylinders.
    std::vector<Eigen::Vector2d> outline;
    for (const double side : {1.0, -1.0}) {
      for (int i = 0; i <= 12; ++i) {
        const double angle = std::numbers::pi * (i / 12.0 - 0.5);
        outline.push_back(side *
                          Eigen::Vector2d(15.0 + 10.0 * std::cos(angle), 10.0 * std::sin(angle)));
      }
    }
    FacetedSolid stadium = prism(outline, 8.0);
    const auto first_side = std::uint32_t{2};
    const auto sides = static_cast<std::uint32_t>(stadium.faces.size()) - first_side;
    REQUIRE(sides == outline.size());
    for (std::uint32_t side = 0; side < sides; ++side) {
      const Eigen::Vector2d middle = 0.5 * (outline[side] + outline[(side + 1) % sides]);
      if (std::abs(middle.x()) < 14.0) continue;
      const double x = middle.x() > 0.0 ? 15.0 : -15.0;
      stadium.faces[first_side + side].surface =
          CylinderSurface{{x, 0.0, 0.0}, Vector3d::UnitZ(), 10.0};
    }
    stadium.edges.clear();
    const std::size_t on_rims = 2 * outline.size();
    CHECK(one_part(stadium).lines.size() == 2 * (on_rims + 4));
  }
}

TEST_CASE("instances share one copy of their part, and states share its data") {
  const GlbFile glb = parse_glb(to_glb(small_fixture()));
  const auto& nodes = glb.document.at("nodes");
  const auto& meshes = glb.document.at("meshes");
  REQUIRE(nodes.size() == 6);
  CHECK(nodes[2].at("mesh") == nodes[4].at("mesh"));
  CHECK(nodes[1].at("mesh") != nodes[2].at("mesh"));
  const auto surface = [&](std::size_t node) {
    return meshes.at(nodes[node].at("mesh").get<std::size_t>()).at("primitives").at(0);
  };
  CHECK(surface(1).at("attributes") == surface(3).at("attributes"));
  CHECK(surface(1).at("indices") == surface(3).at("indices"));
  std::set<int> materials;
  for (const std::size_t pin : {1U, 2U, 3U})
    materials.insert(surface(pin).at("material").get<int>());
  CHECK(materials.size() == 3);
  const auto& colliding =
      glb.document.at("materials").at(surface(3).at("material").get<std::size_t>());
  const auto& colour = colliding.at("pbrMetallicRoughness").at("baseColorFactor");
  CHECK(colour[0].get<double>() > 0.5);
  CHECK(colour[1].get<double>() < 0.1);
  CHECK(nodes[3].at("extras") ==
        nlohmann::json({{"state", "colliding"}, {"note", "plate 1: 3.2 mm"}}));
  CHECK(nodes[0].at("extras") == nlohmann::json({{"state", "normal"}}));
}

TEST_CASE("a part with more than 65535 corners has wide indices and loses none") {
  const FacetedSolid solid = sphere(50.0, 380);
  const OnePart part = one_part(solid);
  REQUIRE(part.positions.size() > 65535);
  CHECK(*std::ranges::max_element(part.triangles) ==
        static_cast<double>(part.positions.size() - 1));
  CHECK(part.triangles.size() == 3 * solid.triangles.size());
}

TEST_CASE("names of any content come through as valid JSON") {
  DisplayScene scene = scene_of(box({1, 1, 1}));
  scene.instances[0].name = "a \"quoted\" \\ </script>\n\x01 name";
  scene.meshes[0].name =
      "Gr\xF6\xDF"
      "e";  // Latin-1
  scene.title = std::string("zero \0 byte", 11);
  const GlbFile glb = parse_glb(to_glb(scene));
  CHECK(glb.document["nodes"][0]["name"] == scene.instances[0].name);
  CHECK(glb.document["meshes"][0]["name"] ==
        "Gr\xEF\xBF\xBD\xEF\xBF\xBD"
        "e");
  CHECK(glb.document["scenes"][0]["name"] == scene.title);
}

TEST_CASE("scenes with nothing to show are valid files") {
  SECTION("no instance") {
    const GlbFile glb = parse_glb(to_glb({}));
    CHECK_FALSE(glb.document.contains("nodes"));
    CHECK_FALSE(glb.document.contains("buffers"));
    CHECK(glb.buffer.empty());
  }
  SECTION("a part without facets") {
    const GlbFile glb = parse_glb(to_glb(scene_of({})));
    CHECK(glb.document["nodes"][0]["name"] == "part 1");
    CHECK_FALSE(glb.document["nodes"][0].contains("mesh"));
    CHECK_FALSE(glb.document.contains("meshes"));
  }
}

TEST_CASE("facets without area and open meshes are drawn") {
  FacetedSolid solid = box({10, 10, 10});
  solid.triangles.pop_back();
  solid.face_of.pop_back();
  const std::size_t sound = solid.triangles.size();
  solid.triangles.push_back({0, 0, 1});  // two equal corners
  solid.face_of.push_back(0);
  const auto middle = static_cast<std::uint32_t>(solid.vertices.size());
  solid.vertices.push_back(0.5 * (solid.vertices[0] + solid.vertices[1]));
  solid.triangles.push_back({0, middle, 1});  // a needle
  solid.face_of.push_back(0);
  solid.faces[0].surface = OtherSurface{};
  const OnePart part = one_part(solid);
  CHECK(part.triangles.size() == 3 * (sound + 1));
  for (const Vector3d& normal : part.normals) CHECK(std::abs(normal.norm() - 1.0) < 1e-6);
}

TEST_CASE("a colour that is not one gives a valid material") {
  DisplayScene scene = scene_of(box({1, 1, 1}));
  scene.meshes[0].colour = {std::numeric_limits<double>::quiet_NaN(), -3.0, 7.0};
  const GlbFile glb = parse_glb(to_glb(scene));
  CHECK(glb.document["materials"][0]["pbrMetallicRoughness"]["baseColorFactor"] ==
        nlohmann::json({0.0, 0.0, 1.0, 1.0}));
}

TEST_CASE("a scene that names what it does not have is refused") {
  DisplayScene scene = scene_of(box({1, 1, 1}));
  SECTION("an instance of no mesh") {
    scene.instances[0].mesh = 1;
  }
  SECTION("a mesh without a solid") {
    scene.meshes[0].solid = nullptr;
  }
  SECTION("a facet of no vertex") {
    FacetedSolid solid = box({1, 1, 1});
    solid.triangles[3][1] = 8;
    scene.meshes[0].solid = shared(solid);
  }
  SECTION("a facet of no face") {
    FacetedSolid solid = box({1, 1, 1});
    solid.face_of[3] = 6;
    scene.meshes[0].solid = shared(solid);
  }
  SECTION("a vertex that is not a number") {
    FacetedSolid solid = box({1, 1, 1});
    solid.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
    scene.meshes[0].solid = shared(solid);
  }
  CHECK_THROWS_AS(to_glb(scene), std::logic_error);
}

TEST_CASE("the same scene gives the same GLB, also as a file") {
  const std::vector<std::byte> glb = to_glb(small_fixture());
  CHECK((glb == to_glb(small_fixture())));
  const TemporaryFolder folder;
  write_glb(folder / "scene.glb", small_fixture());
  const std::string file = read_text(folder / "scene.glb");
  REQUIRE(file.size() == glb.size());
  CHECK(std::memcmp(file.data(), glb.data(), glb.size()) == 0);
  CHECK_THROWS_AS(write_glb(folder / "none" / "scene.glb", small_fixture()), Error);
}
