// Boxes of exact solids against CGAL's on fine points of their boundary, which OpenCascade finds.

#include <algorithm>
#include <filesystem>
#include <functional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include <BRepAdaptor_Curve.hxx>
#include <BRepAdaptor_Surface.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <BinTools.hxx>
#include <GCPnts_TangentialDeflection.hxx>
#include <Poly_Triangulation.hxx>
#include <TopExp.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <catch2/catch.hpp>

#include "cgal_box.h"
#include "dowel/io/import.h"
#include "dowel/kernel/tolerance.h"
#include "exact_reach.h"
#include "library/builders.h"
#include "library/systems.h"

namespace dowel::testing {
namespace {

using Eigen::Vector3d;

/// CGAL's search is no exact one either.
constexpr double kAllowedRatio = 1.001;

/// Points of the curved edges, chords within `deflection_mm` of them, and of the corners.
void add_edge_points(const TopoDS_Shape& shape, double deflection_mm,
                     std::vector<Vector3d>& points) {
  constexpr double kAngle_rad = 0.05;
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int e = 1; e <= edges.Extent(); ++e) {
    const TopoDS_Edge& edge = TopoDS::Edge(edges(e));
    if (BRep_Tool::Degenerated(edge)) continue;
    const BRepAdaptor_Curve curve(edge);
    const GCPnts_TangentialDeflection chords(curve, kAngle_rad, deflection_mm);
    for (int n = 1; n <= chords.NbPoints(); ++n) {
      const gp_Pnt p = chords.Value(n);
      points.emplace_back(p.X(), p.Y(), p.Z());
    }
  }
}

/// Nodes of a fine mesh of one face.
void add_face_points(const TopoDS_Face& face, double deflection_mm, std::vector<Vector3d>& points) {
  const TopoDS_Shape copy = BRepBuilderAPI_Copy(face).Shape();
  BRepTools::Clean(copy);
  constexpr double kAngle_rad = 0.05;
  const BRepMesh_IncrementalMesh mesher(copy, deflection_mm, false, kAngle_rad);
  TopLoc_Location location;
  const auto facets = BRep_Tool::Triangulation(TopoDS::Face(copy), location);
  if (facets.IsNull()) return;
  for (int n = 1; n <= facets->NbNodes(); ++n) {
    const gp_Pnt p = facets->Node(n).Transformed(location.Transformation());
    points.emplace_back(p.X(), p.Y(), p.Z());
  }
}

/// Points of the boundary whose hull is that of the solid up to `deflection_mm`. Every point of a
/// plane, cylinder or cone lies between two points of its face's edges; of the other faces points
/// in between count, too. (A mesh of everything costs minutes: plates with hundreds of fine
/// circles.)
std::vector<Vector3d> fine_points(const TopoDS_Shape& shape, double deflection_mm) {
  std::vector<Vector3d> points;
  add_edge_points(shape, deflection_mm, points);
  for (TopExp_Explorer it(shape, TopAbs_FACE); it.More(); it.Next()) {
    const TopoDS_Face& face = TopoDS::Face(it.Current());
    const GeomAbs_SurfaceType type = BRepAdaptor_Surface(face, false).GetType();
    if (type != GeomAbs_Plane && type != GeomAbs_Cylinder && type != GeomAbs_Cone) {
      add_face_points(face, deflection_mm, points);
    }
  }
  return points;
}

/// True where the solid stands out of the box nowhere and CGAL finds none that is much smaller.
void check_box(const Obb& box, const TopoDS_Shape& shape, double slack_mm) {
  constexpr double kPerDiagonal = 5.0e-5;
  const std::vector<Vector3d> points =
      fine_points(shape, kPerDiagonal * box.half_extents_mm.norm());
  REQUIRE_FALSE(points.empty());
  double outside_mm = -1.0;
  for (const Vector3d& p : points) outside_mm = std::max(outside_mm, box.face_distance_mm(p));
  CHECK(outside_mm <= slack_mm);
  const double cgal_mm3 = cgal_box_volume_mm3(points);
  CAPTURE(box.volume_mm3() / cgal_mm3);
  CHECK(box.volume_mm3() <= kAllowedRatio * cgal_mm3);
}

void check_parts(const std::vector<library::Part>& parts) {
  CHECK_FALSE(parts.empty());
  for (const library::Part& part : parts) {
    CAPTURE(part.name);
    constexpr double kSlack_mm = 1.0e-5;
    check_box(exact_box(facet(part.solid, {})), part.solid, kSlack_mm);
  }
}

TopoDS_Shape shape_of(const ImportedPart& part) {
  std::istringstream stream(
      std::string(reinterpret_cast<const char*>(part.brep.data()), part.brep.size()),
      std::ios::in | std::ios::binary);
  TopoDS_Shape shape;
  BinTools::Read(shape, stream);
  return shape;
}

void check_files(const std::function<bool(const std::filesystem::path&)>& is_asked) {
  const std::filesystem::path folder = DOWEL_SHARED_STEP;
  if (!std::filesystem::exists(folder / "MANIFEST.tsv")) {
    WARN("no folder of real STEP files here: " << folder.string());
    return;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (is_step_file(entry.path()) && is_asked(entry.path())) files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<ImportResult> results;
  import_files(files, {}, 2, [&](std::size_t, ImportResult&& result) {
    results.push_back(std::move(result));
    return true;
  });
  std::size_t checked = 0;
  for (std::size_t i = 0; i < results.size(); ++i) {
    for (const ImportedPart& part : results[i].parts) {
      if (part.brep.empty()) continue;
      CAPTURE(files[i].filename().string(), part.name);
      // Edges of real files leave their faces by their tolerance.
      check_box(part.obb, shape_of(part), kBoxSlack_mm);
      ++checked;
    }
  }
  CHECK(2 * checked > files.size());
}

// Those whose boxes are decided by trimmed cones, spheres and arcs; of one size each.
TEST_CASE("boxes of library elements contain them and are as small as CGAL's") {
  const library::System& system = library::system_called("H40-12");
  for (const auto& made :
       {library::nuts(system), library::locating_pins(system), library::support_screws(system)}) {
    REQUIRE_FALSE(made.empty());
    check_parts({made.back()});
  }
}

// Two minutes of processor time: run by name or tag.
TEST_CASE("boxes of all library elements contain them and are as small as CGAL's", "[.slow]") {
  check_parts(library::all_parts());
}

TEST_CASE("boxes of real parts contain them and are as small as CGAL's") {
  check_files([](const std::filesystem::path& file) {
    return file.filename() == "ISO4032_Hex_Nut_M10.step";
  });
}

TEST_CASE("boxes of all real parts contain them and are as small as CGAL's", "[.slow]") {
  check_files([](const std::filesystem::path&) { return true; });
}

}  // namespace
}  // namespace dowel::testing
