#include <algorithm>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>
#include <variant>

#include <BRepBuilderAPI_NurbsConvert.hxx>
#include <BRepBuilderAPI_Transform.hxx>
#include <BRepPrimAPI_MakeCone.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <BRep_Builder.hxx>
#include <STEPControl_Controller.hxx>
#include <TopExp_Explorer.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Shell.hxx>
#include <catch2/catch.hpp>
#include <gp_Trsf.hxx>

#include "dowel/io/import.h"
#include "dowel/kernel/blob.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/mass_properties.h"
#include "dowel/kernel/mesh_defect.h"
#include "dowel/kernel/tolerance.h"
#include "program.h"
#include "step_files.h"

namespace dowel {
namespace {

using testing::drilled_plate;
using testing::read_text;
using testing::replaced;
using testing::TemporaryFolder;
using testing::write_step;
using testing::write_text;
using Status = ImportResult::Status;

constexpr double kPlateVolume_mm3 = 60.0 * 40.0 * 10.0 - std::numbers::pi * 36.0 * 10.0;

ImportedPart only_part(const std::filesystem::path& file, const ImportOptions& options = {}) {
  ImportResult result = import_file(file, options);
  INFO(result.reason);
  REQUIRE(result.status == Status::Ok);
  REQUIRE(result.parts.size() == 1);
  INFO(find_defect(result.parts[0].solid).value_or("sound"));
  REQUIRE_FALSE(find_defect(result.parts[0].solid));
  return std::move(result.parts[0]);
}

ImportedPart imported(const TopoDS_Shape& shape, const ImportOptions& options = {}) {
  const TemporaryFolder folder;
  write_step(folder / "part.step", {shape});
  return only_part(folder / "part.step", options);
}

template <class Kind>
std::vector<Face> faces_of_kind(const FacetedSolid& solid) {
  std::vector<Face> faces;
  for (const Face& face : solid.faces) {
    if (std::holds_alternative<Kind>(face.surface)) faces.push_back(face);
  }
  return faces;
}

std::size_t edges_of(const FacetedSolid& solid, Convexity convexity, CurveKind curve) {
  return static_cast<std::size_t>(
      std::count_if(solid.edges.begin(), solid.edges.end(),
                    [&](const Edge& e) { return e.convexity == convexity && e.curve == curve; }));
}

TopoDS_Shell shell_of(const TopoDS_Shape& shape, std::size_t left_out) {
  BRep_Builder builder;
  TopoDS_Shell shell;
  builder.MakeShell(shell);
  std::size_t index = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    if (index++ >= left_out) builder.Add(shell, it.Current());
  }
  shell.Closed(left_out == 0);
  return shell;
}

TEST_CASE("a drilled plate arrives with its exact size, faces and edges") {
  const ImportedPart part = imported(drilled_plate());
  CHECK(part.volume_mm3 == Approx(kPlateVolume_mm3).epsilon(1e-9));
  CHECK(part.center_of_mass.z() == Approx(5.0));
  CHECK(part.unit_in_file == "mm");
  CHECK_FALSE(part.brep.empty());
  const FacetedSolid& solid = part.solid;
  CHECK(solid.solid_count == 1);
  CHECK(solid.faces.size() == 7);
  const auto bores = faces_of_kind<CylinderSurface>(solid);
  REQUIRE(bores.size() == 1);
  CHECK(bores[0].reversed);
  CHECK(bores[0].area_mm2 == Approx(2.0 * std::numbers::pi * 6.0 * 10.0));
  const auto& bore = std::get<CylinderSurface>(bores[0].surface);
  CHECK(bore.radius_mm == Approx(6.0));
  CHECK(bore.axis.cross(Eigen::Vector3d::UnitZ()).norm() < kParallel_rad);
  CHECK(Eigen::Vector2d(bore.origin.x() - 20.0, bore.origin.y() - 20.0).norm() < kCoincident_mm);
  CHECK(edges_of(solid, Convexity::Convex, CurveKind::Line) == 12);
  CHECK(edges_of(solid, Convexity::Convex, CurveKind::Circle) == 2);
  CHECK(solid.edges.size() == 14);
  for (const Edge& edge : solid.edges) {
    CHECK(edge.closed == (edge.curve == CurveKind::Circle));
    CHECK(edge.faces[0] < edge.faces[1]);
    if (edge.curve == CurveKind::Circle) CHECK(edge.radius_mm == Approx(6.0));
  }
}

TEST_CASE("planes face outward and the facet error is what the facets show") {
  const ImportedPart part = imported(drilled_plate(), {.deflection_mm = 0.2});
  const FacetedSolid& solid = part.solid;
  double largest_error_mm = 0.0;
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const auto c = solid.corners(t);
    const Eigen::Vector3d normal = (c[1] - c[0]).cross(c[2] - c[0]).normalized();
    const Face& face = solid.faces[solid.face_of[t]];
    if (const auto* plane = std::get_if<PlaneSurface>(&face.surface)) {
      CHECK(normal.dot(plane->normal) == Approx(1.0));
      CHECK(face.facet_error_mm == 0.0);
    } else {
      for (std::size_t k = 0; k < 3; ++k) {
        const double off = signed_distance_mm(face.surface, 0.5 * (c[k] + c[(k + 1) % 3]));
        largest_error_mm = std::max(largest_error_mm, std::abs(off));
        CHECK(std::abs(off) <= face.facet_error_mm + 1e-12);
      }
    }
  }
  CHECK(largest_error_mm > 0.01);
  CHECK(faces_of_kind<CylinderSurface>(solid)[0].facet_error_mm ==
        Approx(largest_error_mm).margin(1e-9));
}

TEST_CASE("a finer deflection gives a smaller facet error and a better volume of the facets") {
  const ImportedPart coarse = imported(drilled_plate(), {.deflection_mm = 0.5});
  const ImportedPart fine =
      imported(drilled_plate(), {.deflection_mm = 0.005, .angular_deflection_rad = 0.1});
  const auto error_mm3 = [](const ImportedPart& part) {
    return std::abs(mass_properties(part.solid).volume_mm3 - kPlateVolume_mm3);
  };
  CHECK(fine.solid.triangles.size() > coarse.solid.triangles.size());
  CHECK(error_mm3(fine) < 0.2 * error_mm3(coarse));
}

TEST_CASE("a part is coarsened until it has few enough triangles") {
  const TopoDS_Shape ball = BRepPrimAPI_MakeSphere(50.0).Shape();
  CHECK(imported(ball).solid.triangles.size() > 1000);
  const ImportedPart coarse = imported(ball, {.max_triangles = 500});
  CHECK(coarse.solid.triangles.size() <= 500);
  CHECK(coarse.volume_mm3 == Approx(4.0 / 3.0 * std::numbers::pi * 125000.0));
}

TEST_CASE("cones, spheres and tori keep their exact surfaces") {
  const ImportedPart cone = imported(BRepPrimAPI_MakeCone(10.0, 4.0, 12.0).Shape());
  const auto cones = faces_of_kind<ConeSurface>(cone.solid);
  REQUIRE(cones.size() == 1);
  const auto& exact = std::get<ConeSurface>(cones[0].surface);
  CHECK(exact.half_angle_rad == Approx(std::atan2(6.0, 12.0)));
  CHECK(exact.apex.z() == Approx(20.0));
  CHECK(exact.axis.z() == Approx(-1.0));
  CHECK_FALSE(cones[0].reversed);

  const auto spheres = faces_of_kind<SphereSurface>(imported(BRepPrimAPI_MakeSphere(7.0)).solid);
  REQUIRE(spheres.size() == 1);
  CHECK(std::get<SphereSurface>(spheres[0].surface).radius_mm == Approx(7.0));

  const auto tori = faces_of_kind<TorusSurface>(imported(BRepPrimAPI_MakeTorus(9.0, 2.0)).solid);
  REQUIRE(tori.size() == 1);
  CHECK(std::get<TorusSurface>(tori[0].surface).major_radius_mm == Approx(9.0));
  CHECK(std::get<TorusSurface>(tori[0].surface).minor_radius_mm == Approx(2.0));
}

TEST_CASE("flat B-splines are planes, curved ones are other surfaces with a measured error") {
  const ImportedPart part = imported(BRepBuilderAPI_NurbsConvert(drilled_plate()).Shape());
  CHECK(faces_of_kind<PlaneSurface>(part.solid).size() == 6);
  const auto others = faces_of_kind<OtherSurface>(part.solid);
  REQUIRE(others.size() == 1);
  CHECK(others[0].facet_error_mm > 0.0);
  CHECK(others[0].facet_error_mm < 0.1);
  CHECK(part.volume_mm3 == Approx(kPlateVolume_mm3).epsilon(1e-6));
  CHECK(std::none_of(part.solid.edges.begin(), part.solid.edges.end(),
                     [](const Edge& e) { return e.convexity != Convexity::Convex; }));
}

TEST_CASE("a blind step is concave at its floor") {
  const TopoDS_Shape block = BRepPrimAPI_MakeBox(30.0, 30.0, 30.0).Shape();
  const TopoDS_Shape corner = BRepPrimAPI_MakeBox(gp_Pnt(10, -1, 10), gp_Pnt(40, 40, 40)).Shape();
  const ImportedPart part = imported(BRepAlgoAPI_Cut(block, corner).Shape());
  CHECK(edges_of(part.solid, Convexity::Concave, CurveKind::Line) == 1);
  CHECK(edges_of(part.solid, Convexity::Smooth, CurveKind::Line) == 0);
  CHECK(edges_of(part.solid, Convexity::Unknown, CurveKind::Line) == 0);
}

TEST_CASE("the unit of a file changes nothing but its name") {
  const TemporaryFolder folder;
  const std::vector<std::pair<const char*, const char*>> units{
      {"INCH", "inch"}, {"M", "m"}, {"CM", "cm"}, {"FT", "foot"}};
  for (const auto& unit : units) {
    CAPTURE(unit.first);
    write_step(folder / "part.step", {drilled_plate()}, unit.first);
    const ImportedPart part = only_part(folder / "part.step");
    CHECK(part.unit_in_file == unit.second);
    CHECK(part.volume_mm3 == Approx(kPlateVolume_mm3).epsilon(1e-9));
    CHECK(bounds(part.solid.vertices).size().x() == Approx(60.0).epsilon(1e-9));
  }
}

TEST_CASE("a unit that somebody set in the process before does not matter") {
  STEPControl_Controller::Init();
  Interface_Static::SetCVal("xstep.cascade.unit", "M");
  const ImportedPart part = imported(drilled_plate());
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  // The writer takes the model for metres then; the reader must give millimetres nevertheless.
  const double scale = bounds(part.solid.vertices).size().x() / 60.0;
  CHECK((scale == Approx(1.0) || scale == Approx(1000.0)));
  CHECK(part.volume_mm3 == Approx(kPlateVolume_mm3 * scale * scale * scale).epsilon(1e-9));

  const TemporaryFolder folder;
  write_step(folder / "part.step", {drilled_plate()});
  Interface_Static::SetCVal("xstep.cascade.unit", "M");
  const ImportedPart again = only_part(folder / "part.step");
  Interface_Static::SetCVal("xstep.cascade.unit", "MM");
  CHECK(bounds(again.solid.vertices).size().x() == Approx(60.0));
}

TEST_CASE("product names come as UTF-8, generic ones give way to the file's name") {
  const TemporaryFolder folder;
  write_step(folder / "base plate.step", {drilled_plate()});
  const std::string text = read_text(folder / "base plate.step");
  const std::size_t product = text.find("PRODUCT('");
  REQUIRE(product != text.npos);
  const std::size_t begin = product + 9;
  const std::string generic = text.substr(begin, text.find('\'', begin) - begin);
  CHECK(only_part(folder / "base plate.step").name == "base plate");
  const std::vector<std::pair<std::string, std::string>> names{{"Spannplatte 40", "Spannplatte 40"},
                                                               {"Gr\\X2\\00F600DF\\X0\\e", "Größe"},
                                                               {"Gr\\X\\F6\\X\\DFe", "Größe"},
                                                               {"\\X2\\6CBB5177\\X0\\", "治具"},
                                                               {"Gr\xC3\xB6\xC3\x9F"
                                                                "e",
                                                                "Größe"},
                                                               {"Gr\xF6\xDF"
                                                                "e",
                                                                "Größe"},
                                                               {"  ", "base plate"},
                                                               {"SOLID", "base plate"},
                                                               {"0815", "base plate"}};
  for (const auto& name : names) {
    CAPTURE(name.first);
    write_text(folder / "base plate.step",
               replaced(text, "'" + generic + "'", "'" + name.first + "'"));
    CHECK(only_part(folder / "base plate.step").name == name.second);
  }
}

TEST_CASE("several roots are several parts, or one part of several solids") {
  const TemporaryFolder folder;
  gp_Trsf far_away;
  far_away.SetTranslation(gp_Vec(200.0, 0.0, 0.0));
  write_step(folder / "two.step", {drilled_plate(), drilled_plate().Moved(far_away)});
  const ImportResult parts = import_file(folder / "two.step", {});
  REQUIRE(parts.status == Status::Ok);
  REQUIRE(parts.parts.size() == 2);
  CHECK(parts.parts[0].name == "two");
  CHECK(parts.parts[1].name == "two-2");
  const ImportedPart whole = only_part(folder / "two.step", {.whole_file = true});
  CHECK(whole.solid.solid_count == 2);
  CHECK(whole.volume_mm3 == Approx(2.0 * kPlateVolume_mm3));
  CHECK(bounds(whole.solid.vertices).size().x() == Approx(260.0));
}

TEST_CASE("solids of one part may touch and stay closed each") {
  const TemporaryFolder folder;
  write_step(folder / "stack.step",
             {BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 0), gp_Pnt(10, 10, 10)).Shape(),
              BRepPrimAPI_MakeBox(gp_Pnt(0, 0, 10), gp_Pnt(10, 10, 20)).Shape()});
  const ImportedPart part = only_part(folder / "stack.step", {.whole_file = true});
  CHECK(part.solid.solid_count == 2);
  CHECK(part.solid.vertices.size() == 16);
  CHECK(part.volume_mm3 == Approx(2000.0));
}

TEST_CASE("surfaces without a solid are told, closed ones become a solid") {
  const TemporaryFolder folder;
  write_step(folder / "open.step", {shell_of(drilled_plate(), 1)});
  const ImportResult open = import_file(folder / "open.step", {});
  CHECK(open.status == Status::Empty);
  CHECK(open.reason == "1 open shell, no solid");
  CHECK(open.parts.empty());
  write_step(folder / "closed.step", {shell_of(drilled_plate(), 0)});
  CHECK(only_part(folder / "closed.step").volume_mm3 == Approx(kPlateVolume_mm3));
}

TEST_CASE("a part of a wrong unit is refused before it is meshed") {
  const TemporaryFolder folder;
  write_step(folder / "huge.step", {BRepPrimAPI_MakeBox(3.0e5, 10.0, 10.0).Shape()});
  const ImportResult result = import_file(folder / "huge.step", {});
  CHECK(result.status == Status::Failed);
  CHECK_THAT(result.reason, Catch::Contains("unit"));
}

TEST_CASE("the same file gives the same bytes each time", "[determinism]") {
  const TemporaryFolder folder;
  write_step(folder / "part.step", {drilled_plate()});
  const ImportedPart first = only_part(folder / "part.step");
  const ImportedPart second = only_part(folder / "part.step");
  CHECK(to_blob(first.solid) == to_blob(second.solid));
  CHECK(first.brep == second.brep);
}

TEST_CASE("what is not a STEP file fails with a reason") {
  const TemporaryFolder folder;
  write_text(folder / "empty.step", "");
  write_text(folder / "letter.stp", "Dear Sir or Madam");
  write_text(folder / "part.dwg", "AC1032");
  std::filesystem::create_directory(folder / "folder.step");
  const auto reason = [&](const char* name) {
    const ImportResult result = import_file(folder / name, {});
    CHECK(result.status == Status::Failed);
    return result.reason;
  };
  CHECK(reason("empty.step") == "is empty, expected a STEP file");
  CHECK_THAT(reason("letter.stp"), Catch::Contains("not a STEP file"));
  CHECK_THAT(reason("part.dwg"), Catch::Contains(".step"));
  CHECK_THAT(reason("folder.step"), Catch::Contains("folder"));
  CHECK_THAT(reason("missing.step"), Catch::Contains("no such file"));
}

/// Imports damaged copies of a small file and counts how they ended. None may end this process.
std::vector<std::size_t> import_all(const TemporaryFolder& folder,
                                    const std::vector<std::string>& contents) {
  std::vector<std::filesystem::path> files;
  for (const std::string& content : contents) {
    files.push_back(folder / ("damaged" + std::to_string(files.size()) + ".step"));
    write_text(files.back(), content);
  }
  std::vector<std::size_t> counts(3, 0);
  std::size_t next = 0;
  import_files(files, {.max_seconds = 20.0}, 2, [&](std::size_t i, ImportResult&& result) {
    CAPTURE(i, result.reason);
    CHECK(i == next++);
    CHECK(result.reason.empty() == (result.status == Status::Ok));
    CHECK(result.parts.empty() == (result.status != Status::Ok));
    CHECK_THAT(result.reason, !Catch::Contains("exit code"));
    for (const ImportedPart& part : result.parts) CHECK_FALSE(find_defect(part.solid));
    ++counts[static_cast<std::size_t>(result.status)];
    return true;
  });
  CHECK(next == files.size());
  return counts;
}

TEST_CASE("a file cut off anywhere fails, and only it", "[fault]") {
  const TemporaryFolder folder;
  write_step(folder / "part.step", {drilled_plate()});
  const std::string text = read_text(folder / "part.step");
  std::vector<std::string> contents;
  for (std::size_t k = 0; k < 24; ++k) contents.push_back(text.substr(0, text.size() * k / 24));
  const auto counts = import_all(folder, contents);
  CHECK(counts[static_cast<std::size_t>(Status::Ok)] == 0);
  CHECK(counts[static_cast<std::size_t>(Status::Failed)] > 20);
}

TEST_CASE("flipped bits and lost entities never end the program", "[fault][property]") {
  const TemporaryFolder folder;
  write_step(folder / "part.step", {drilled_plate()});
  const std::string text = read_text(folder / "part.step");
  std::mt19937 random(20240607);
  std::vector<std::string> contents;
  for (int i = 0; i < 40; ++i) {
    std::string damaged = text;
    for (int flips = i % 4; flips >= 0; --flips) {
      char& hit = damaged[text.size() / 5 + random() % (text.size() * 4 / 5)];
      hit = static_cast<char>(hit ^ (1 << (random() % 7)));
    }
    const std::size_t entity = damaged.find("\n#", random() % text.size());
    if (i % 2 == 0 && entity != damaged.npos) {
      damaged.erase(entity, damaged.find('\n', entity + 1) - entity);
    }
    contents.push_back(damaged);
  }
  const auto counts = import_all(folder, contents);
  CHECK(counts[static_cast<std::size_t>(Status::Ok)] > 3);
  CHECK(counts[static_cast<std::size_t>(Status::Failed)] > 3);
}

}  // namespace
}  // namespace dowel
