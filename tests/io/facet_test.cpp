#include "facet.h"

#include <algorithm>
#include <span>
#include <variant>
#include <vector>

#include <BRepAdaptor_Surface.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <GProp_GProps.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <catch2/catch.hpp>
#include <gp_Cylinder.hxx>

#include "crack.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/mass_properties.h"
#include "dowel/kernel/mesh_defect.h"
#include "result_codec.h"
#include "solids.h"
#include "step_files.h"

namespace dowel {
namespace {

double volume_mm3(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

TEST_CASE("a solid that is inside out is turned, with its faces, edges and exact shape") {
  const TopoDS_Shape plate = testing::drilled_plate();
  TopoDS_Shape inside_out;
  for (TopExp_Explorer it(plate, TopAbs_SOLID); it.More(); it.Next()) {
    inside_out = it.Current().Reversed();
  }
  REQUIRE(volume_mm3(inside_out) < 0.0);
  const FacetedShape straight = facet(plate, {});
  const FacetedShape turned = facet(inside_out, {});
  CHECK(volume_mm3(turned.shape) == Approx(volume_mm3(plate)));
  CHECK(mass_properties(turned.solid).volume_mm3 ==
        Approx(mass_properties(straight.solid).volume_mm3));
  REQUIRE(turned.solid.faces.size() == straight.solid.faces.size());
  for (const Face& face : turned.solid.faces) {
    if (std::holds_alternative<CylinderSurface>(face.surface)) CHECK(face.reversed);
  }
  for (const Edge& edge : turned.solid.edges) CHECK(edge.convexity == Convexity::Convex);
}

TEST_CASE("bores and shafts are told as the orientation rule of the B-rep tells them") {
  const gp_Ax2 axis(gp_Pnt(30.0, 20.0, 10.0), gp::DZ());
  const TopoDS_Shape pin = BRepPrimAPI_MakeCylinder(axis, 4.0, 15.0).Shape();
  for (const TopoDS_Shape& shape : {testing::drilled_plate(), pin}) {
    const FacetedShape result = facet(shape, {});
    std::size_t index = 0;
    for (TopExp_Explorer it(result.shape, TopAbs_FACE); it.More(); it.Next(), ++index) {
      const BRepAdaptor_Surface adaptor(TopoDS::Face(it.Current()));
      if (adaptor.GetType() != GeomAbs_Cylinder) continue;
      const bool is_reversed = it.Current().Orientation() == TopAbs_REVERSED;
      CHECK(result.solid.faces[index].reversed == (adaptor.Cylinder().Direct() == is_reversed));
    }
  }
}

TEST_CASE("hairline cracks are closed, gaps are not") {
  const FacetedSolid whole = testing::box({20, 30, 40});
  for (const double gap_mm : {1e-5, 0.5}) {
    CAPTURE(gap_mm);
    FacetedSolid cracked = whole;
    const std::uint32_t corner = cracked.triangles[0][0];
    cracked.vertices.push_back(cracked.vertices[corner] + Eigen::Vector3d(0, 0, gap_mm));
    cracked.triangles[0][0] = static_cast<std::uint32_t>(cracked.vertices.size() - 1);
    REQUIRE(find_defect(cracked));
    const std::vector<double> moved_mm = close_cracks(cracked, 1e-3);
    CHECK(find_defect(cracked).has_value() == (gap_mm > 1e-3));
    CHECK(*std::max_element(moved_mm.begin(), moved_mm.end()) ==
          Approx(gap_mm < 1e-3 ? gap_mm : 0.0).margin(1e-12));
  }
}

TEST_CASE("a result survives its way through the pipe, and no damaged one is believed", "[fault]") {
  ImportResult result;
  result.status = ImportResult::Status::Ok;
  result.warnings = {"one", ""};
  ImportedPart part;
  part.name = "Größe";
  part.unit_in_file = "inch";
  part.solid = testing::cylinder(5.0, 10.0, 24);
  part.volume_mm3 = 1.0 / 3.0;
  part.surface_mm2 = 2.0;
  part.center_of_mass = {1, 2, 3};
  part.colour = {{0.1, 0.2, 0.3}};
  part.brep = {std::byte{1}, std::byte{0}, std::byte{255}};
  result.parts.push_back(part);
  const std::vector<std::byte> bytes = encode(result);
  const ImportResult back = decode_result(bytes);
  CHECK(encode(back) == bytes);
  CHECK(back.parts.at(0).name == part.name);
  CHECK(back.parts.at(0).colour == part.colour);
  CHECK(back.parts.at(0).brep == part.brep);
  CHECK(back.warnings == result.warnings);
  for (std::size_t length = 0; length < bytes.size(); length += 7) {
    CHECK_THROWS_AS(decode_result(std::span(bytes).first(length)), Error);
  }
  for (std::size_t at = 0; at < 64; ++at) {
    std::vector<std::byte> bent = bytes;
    bent[at] ^= std::byte{0xFF};
    try {
      decode_result(bent);
    } catch (const Error& error) {
      CHECK(error.code() != ErrorCode::InvalidInput);
    }
  }
}

}  // namespace
}  // namespace dowel
