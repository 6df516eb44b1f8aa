#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <sstream>
#include <string>
#include <variant>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/io/import.h"
#include "dowel/io/scene_page.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/mass_properties.h"
#include "dowel/kernel/mesh_defect.h"
#include "program.h"
#include "solids.h"

namespace dowel {
namespace {

using testing::box;
using testing::TemporaryFolder;
using testing::write_text;
using Status = ImportResult::Status;

const std::vector<Eigen::Vector3d> kCorners{{0, 0, 0},  {20, 0, 0},  {20, 30, 0},  {0, 30, 0},
                                            {0, 0, 40}, {20, 0, 40}, {20, 30, 40}, {0, 30, 40}};
const std::vector<std::array<int, 4>> kQuads{{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4},
                                             {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};

/// The solids one after the other; a part of the file each.
std::string obj_of(const std::vector<FacetedSolid>& solids) {
  std::ostringstream text;
  text.precision(17);
  std::size_t first = 1;
  for (const FacetedSolid& solid : solids) {
    for (const auto& v : solid.vertices) {
      text << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
    }
    for (const Triangle& t : solid.triangles) {
      text << "f " << t[0] + first << ' ' << t[1] + first << ' ' << t[2] + first << '\n';
    }
    first += solid.vertices.size();
  }
  return text.str();
}

std::string obj_of(const FacetedSolid& solid) {
  return obj_of(std::vector{solid});
}

std::string quad_box_obj() {
  std::ostringstream text;
  text << "# a box\nmtllib none.mtl\no box\n";
  for (const auto& v : kCorners) text << "v " << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  text << "vn 0 0 1\nvt 0 0\ns off\nusemtl grey\n";
  for (const auto& q : kQuads) {
    text << "f " << q[0] + 1 << "/1/1 " << q[1] + 1 << "//1 " << q[2] - 8 << ' ' << q[3] + 1
         << "\r\n";
  }
  return text.str();
}

std::string quad_box_off() {
  std::ostringstream text;
  text << "OFF\n# a box\n8 6 0\n";
  for (const auto& v : kCorners) text << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& q : kQuads) {
    text << "4 " << q[0] << ' ' << q[1] << ' ' << q[2] << ' ' << q[3] << " 255 0 0\n";
  }
  return text.str();
}

std::string quad_box_ply() {
  std::ostringstream text;
  text << "ply\nformat ascii 1.0\nelement vertex 8\nproperty float x\nproperty float y\n"
          "property float z\nelement face 6\nproperty list uchar int vertex_indices\nend_header\n";
  for (const auto& v : kCorners) text << v.x() << ' ' << v.y() << ' ' << v.z() << '\n';
  for (const auto& q : kQuads) {
    text << "4 " << q[0] << ' ' << q[1] << ' ' << q[2] << ' ' << q[3] << '\n';
  }
  return text.str();
}

std::string binary_ply_box(bool is_big_endian) {
  std::string bytes = "ply\nformat binary_" + std::string(is_big_endian ? "big" : "little") +
                      "_endian 1.0\ncomment a box\nelement vertex 8\nproperty double x\n"
                      "property double y\nproperty double z\nproperty uchar red\n"
                      "element face 6\nproperty list uint8 uint32 vertex_indices\nend_header\n";
  const auto append = [&](auto value) {
    auto raw = std::bit_cast<std::array<char, sizeof value>>(value);
    if (is_big_endian) std::reverse(raw.begin(), raw.end());
    bytes.append(raw.data(), raw.size());
  };
  for (const auto& v : kCorners) {
    for (const double x : v) append(x);
    bytes += '\x7F';
  }
  for (const auto& q : kQuads) {
    bytes += '\x04';
    for (const int corner : q) append(static_cast<std::uint32_t>(corner));
  }
  return bytes;
}

std::string ascii_stl_of(const FacetedSolid& solid) {
  std::ostringstream text;
  text.precision(17);
  text << "solid box\n";
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    text << " facet normal 0 0 0\n  outer loop\n";
    for (const auto& c : solid.corners(t)) {
      text << "   vertex " << c.x() << ' ' << c.y() << ' ' << c.z() << '\n';
    }
    text << "  endloop\n endfacet\n";
  }
  text << "endsolid box\n";
  return text.str();
}

std::string binary_stl_of(const FacetedSolid& solid) {
  std::string bytes = "solid that is binary";
  bytes.resize(80, ' ');
  const auto append = [&](auto value) {
    const auto raw = std::bit_cast<std::array<char, sizeof value>>(value);
    bytes.append(raw.data(), raw.size());
  };
  append(static_cast<std::uint32_t>(solid.triangles.size()));
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    for (int i = 0; i < 3; ++i) append(0.0F);
    for (const auto& c : solid.corners(t)) {
      for (const double x : c) append(static_cast<float>(x));
    }
    append(std::uint16_t{0});
  }
  return bytes;
}

DisplayScene scene_of(const FacetedSolid& solid) {
  DisplayScene scene;
  scene.meshes.emplace_back().solid = std::make_shared<FacetedSolid>(solid);
  scene.instances.emplace_back().name = "only";
  return scene;
}

ImportResult imported(const std::string& name, const std::string& content) {
  const TemporaryFolder folder;
  write_text(folder / name, content);
  return import_file(folder / name, {});
}

ImportedPart only_part(ImportResult result) {
  INFO(result.reason);
  REQUIRE(result.status == Status::Ok);
  REQUIRE(result.parts.size() == 1);
  REQUIRE_FALSE(find_defect(result.parts[0].solid));
  return std::move(result.parts[0]);
}

std::string reason(const std::string& name, const std::string& content) {
  const ImportResult result = imported(name, content);
  CHECK(result.status == Status::Failed);
  CHECK(result.parts.empty());
  CHECK_THAT(result.reason, !Catch::Contains("crash"));
  return result.reason;
}

void check_box(const ImportedPart& part) {
  CHECK(part.volume_mm3 == Approx(20.0 * 30.0 * 40.0));
  CHECK(part.surface_mm2 == Approx(2.0 * (600.0 + 800.0 + 1200.0)));
  CHECK(bounds(part.solid.vertices).size().isApprox(Eigen::Vector3d(20, 30, 40)));
  CHECK(part.solid.vertices.size() == 8);
  CHECK(part.solid.triangles.size() == 12);
  CHECK(part.solid.solid_count == 1);
  REQUIRE(part.solid.faces.size() == 6);
  REQUIRE(part.solid.edges.size() == 12);
  for (const Edge& edge : part.solid.edges) CHECK(edge.convexity == Convexity::Convex);
  const Eigen::Vector3d center = bounds(part.solid.vertices).center();
  for (const Face& face : part.solid.faces) {
    REQUIRE(is_plane(face.surface));
    CHECK(signed_distance_mm(face.surface, center) < 0.0);
    CHECK(face.facet_error_mm == 0.0);
  }
}

TEST_CASE("a box in each mesh format is the same box") {
  const FacetedSolid solid = box({20, 30, 40});
  check_box(only_part(imported("box.obj", quad_box_obj())));
  check_box(only_part(imported("box.obj", obj_of(solid))));
  check_box(only_part(imported("box.off", quad_box_off())));
  check_box(only_part(imported("box.stl", ascii_stl_of(solid))));
  check_box(only_part(imported("box.STL", binary_stl_of(solid))));
  check_box(only_part(imported("box.ply", quad_box_ply())));
  check_box(only_part(imported("box.ply", binary_ply_box(false))));
  check_box(only_part(imported("box.ply", binary_ply_box(true))));
}

TEST_CASE("glTF is metres and y up, and comes back as it was written") {
  const TemporaryFolder folder;
  const DisplayScene scene = scene_of(box({20, 30, 40}));
  write_glb(folder / "box.glb", scene);
  const ImportedPart part = only_part(import_file(folder / "box.glb", {}));
  CHECK(bounds(part.solid.vertices).size().isApprox(Eigen::Vector3d(20, 30, 40), 1e-6));
  CHECK(part.volume_mm3 == Approx(24000.0).epsilon(1e-6));
  CHECK(part.unit_in_file == "m");
}

TEST_CASE("text formats keep every bit of a number") {
  FacetedSolid solid = box({20, 30, 40});
  for (auto& v : solid.vertices) v += Eigen::Vector3d(9000.1, 1.0 / 3.0, -7e3);
  for (const auto& part : {only_part(imported("a.obj", obj_of(solid))),
                           only_part(imported("a.stl", ascii_stl_of(solid)))}) {
    CHECK(bounds(part.solid.vertices).min == bounds(solid.vertices).min);
    CHECK(bounds(part.solid.vertices).max == bounds(solid.vertices).max);
    CHECK(part.solid.faces.size() == 6);
  }
}

TEST_CASE("a concave polygon is cut inside its outline") {
  const std::string text =
      "OFF\n12 8 0\n0 0 0\n30 0 0\n30 10 0\n10 10 0\n10 30 0\n0 30 0\n"
      "0 0 5\n30 0 5\n30 10 5\n10 10 5\n10 30 5\n0 30 5\n"
      "6 5 4 3 2 1 0\n6 6 7 8 9 10 11\n4 0 1 7 6\n4 1 2 8 7\n4 2 3 9 8\n4 3 4 10 9\n"
      "4 4 5 11 10\n4 5 0 6 11\n";
  const ImportedPart part = only_part(imported("angle.off", text));
  CHECK(part.volume_mm3 == Approx(500.0 * 5.0));
  CHECK(part.solid.faces.size() == 8);
  CHECK(std::count_if(part.solid.edges.begin(), part.solid.edges.end(),
                      [](const Edge& e) { return e.convexity == Convexity::Concave; }) == 1);
}

TEST_CASE("a mesh that is inside out as a whole is turned, cavities are kept") {
  const FacetedSolid solid = box({20, 30, 40});
  check_box(only_part(imported("box.obj", obj_of(testing::inverted(solid)))));
  const FacetedSolid core = testing::transformed(Pose::from_translation({5, 5, 5}), box({4, 4, 4}));
  for (const auto& each :
       {std::vector{solid, testing::inverted(core)}, std::vector{testing::inverted(solid), core}}) {
    const ImportedPart part = only_part(imported("hollow.obj", obj_of(each)));
    CHECK(part.volume_mm3 == Approx(24000.0 - 64.0));
    CHECK(part.solid.solid_count == 1);
    CHECK(part.solid.faces.size() == 12);
  }
}

TEST_CASE("separate boxes of a file are solids of one part") {
  const FacetedSolid one = box({10, 10, 10});
  const FacetedSolid other = testing::transformed(Pose::from_translation({50, 0, 0}), one);
  const ImportedPart part = only_part(imported("two.obj", obj_of({one, other})));
  CHECK(part.solid.solid_count == 2);
  CHECK(part.volume_mm3 == Approx(2000.0));
}

TEST_CASE("degenerate triangles are dropped") {
  const std::string text = obj_of(box({20, 30, 40})) + "f 1 1 2\nf 3 3 3\n";
  check_box(only_part(imported("box.obj", text)));
}

TEST_CASE("meshes that bound no solid fail with a reason") {
  const std::string whole = obj_of(box({20, 30, 40}));
  const std::string open = whole.substr(0, whole.rfind("f "));
  CHECK_THAT(reason("open.obj", open), Catch::Contains("3 of its 18 edges"));
  const std::string last = whole.substr(whole.rfind("f "));
  int a = 0;
  int b = 0;
  int c = 0;
  REQUIRE(std::sscanf(last.c_str(), "f %d %d %d", &a, &b, &c) == 3);
  std::ostringstream twisted;
  twisted << open << "f " << a << ' ' << c << ' ' << b << '\n';
  CHECK_THAT(reason("twisted.obj", twisted.str()), Catch::Contains("outside"));
  CHECK_THAT(reason("flat.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 3 2\n"),
             Catch::Contains("volume"));
  CHECK_THAT(reason("empty.obj", ""), Catch::Contains("no triangles"));
  CHECK_THAT(reason("points.obj", "v 0 0 0\nv 1 0 0\n"), Catch::Contains("no triangles"));
}

TEST_CASE("damaged mesh files fail and name the line") {
  CHECK_THAT(reason("a.obj", "v 0 0 nan\n"), Catch::Contains("line 1"));
  CHECK_THAT(reason("a.obj", "v 0 0 1e999\n"), Catch::Contains("line 1"));
  CHECK_THAT(reason("a.obj", "v 0 0\n"), Catch::Contains("missing"));
  CHECK_THAT(reason("a.obj", "v 0 0 0\nf 1 2 3\n"), Catch::Contains("line 2"));
  CHECK_THAT(reason("a.obj", "v 0 0 0\nf 0 0 0\n"), Catch::Contains("index 0"));
  CHECK_THAT(reason("a.obj", "v 0 0 0\nf -2 -1 -1\n"), Catch::Contains("out of range"));
  CHECK_THAT(reason("a.obj", "v 0 0 0\nf 1 1\n"), Catch::Contains("three"));
  CHECK_THAT(reason("a.obj", "v 2e5 0 0\nf 1 1 1\n"), Catch::Contains("beyond"));
  CHECK_THAT(reason("a.off", ""), Catch::Contains("OFF"));
  CHECK_THAT(reason("a.off", "OFF\n-1 2 0\n"), Catch::Contains("negative"));
  CHECK_THAT(reason("a.off", "OFF\n9999999999 1 0\n0 0 0\n"), Catch::Contains("ends"));
  CHECK_THAT(reason("a.off", "OFF\n1 1 0\n0 0 0\n3 0 0 -1\n"), Catch::Contains("out of range"));
  CHECK_THAT(reason("a.off", "OFF\n1 1 0\n0 0 0\n99999999 0 0 0\n"), Catch::Contains("line 4"));
  CHECK_THAT(reason("a.off", "4OFF\n1 1 0\n"), Catch::Contains("not supported"));
  CHECK_THAT(reason("a.stl", "solid x\nvertex 0 0 0\n"), Catch::Contains("line 2"));
  CHECK_THAT(reason("a.stl", "solid x\nfacet\nouter loop\nvertex 0 0 0\n"),
             Catch::Contains("inside a loop"));
  reason("a.stl", "\x01\x02\x03");
  reason("a.ply", "");
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_index\nend_header\n";
  CHECK_THAT(reason("a.ply", "ply\nformat ascii 1.0\n"), Catch::Contains("end_header"));
  CHECK_THAT(reason("a.ply", header + "0 0"), Catch::Contains("ends"));
  CHECK_THAT(reason("a.ply", header + "0 0 inf 3 0 0 0"), Catch::Contains("finite"));
  CHECK_THAT(reason("a.ply", header + "0 0 0 3 0 1 0"), Catch::Contains("out of range"));
  CHECK_THAT(reason("a.ply", header + "0 0 0 3 0 -1 0"), Catch::Contains("out of range"));
  CHECK_THAT(reason("a.ply", header + "0 0 0 1e18 0 0 0"), Catch::Contains("ends"));
  CHECK_THAT(reason("a.ply", "ply\nformat ascii 1.0\nelement vertex 1000000000000\nend_header\n"),
             Catch::Contains("no properties"));
  reason("a.glb", "glTF");
  reason("a.glb", "");
}

TEST_CASE("cut-off and bent binary meshes never end the program", "[fault]") {
  const TemporaryFolder folder;
  const DisplayScene scene = scene_of(box({20, 30, 40}));
  const std::vector<std::byte> bytes = to_glb(scene);
  const std::string glb(reinterpret_cast<const char*>(bytes.data()), bytes.size());
  std::vector<std::filesystem::path> files;
  const auto add = [&](const std::string& ending, const std::string& content) {
    files.push_back(folder / ("bent" + std::to_string(files.size()) + ending));
    write_text(files.back(), content);
  };
  const std::string stl = binary_stl_of(box({20, 30, 40}));
  const std::string ply = quad_box_ply();
  for (std::size_t k = 1; k < 8; ++k) {
    add(".glb", glb.substr(0, glb.size() * k / 8));
    add(".stl", stl.substr(0, stl.size() * k / 8));
    add(".ply", ply.substr(0, ply.size() * k / 8));
    std::string bent = glb;
    bent[12 + bent.size() * k / 10] ^= 0x11;
    add(".glb", bent);
  }
  std::size_t failed = 0;
  import_files(files, {.max_seconds = 20.0}, 2, [&](std::size_t, ImportResult&& result) {
    CHECK(result.reason.empty() == (result.status == Status::Ok));
    if (result.status == Status::Failed) ++failed;
    return true;
  });
  CHECK(failed >= 15);
}

}  // namespace
}  // namespace dowel
