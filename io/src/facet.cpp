#include "facet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>
#include <variant>
#include <vector>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Copy.hxx>
#include <BRepBuilderAPI_MakeSolid.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <BRepGProp.hxx>
#include <BRepMesh_IncrementalMesh.hxx>
#include <BRepTools.hxx>
#include <BRep_Builder.hxx>
#include <BRep_Tool.hxx>
#include <Bnd_Box.hxx>
#include <GProp_GProps.hxx>
#include <Poly_Triangulation.hxx>
#include <ShapeFix_Shape.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>
#include <TopoDS_Solid.hxx>

#include "crack.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/mesh_defect.h"
#include "dowel/kernel/tolerance.h"
#include "exact_edges.h"
#include "exact_surface.h"
#include "facet_error.h"
#include "occt.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

struct Deflection {
  double linear_mm = 0.0;
  double angular_rad = 0.0;
};

/// The facets of one solid and the faces that they came from, in the same order.
struct Piece {
  TopoDS_Solid solid;
  FacetedSolid facets;
  std::vector<TopoDS_Face> faces;
  std::vector<bool> turned;      ///< per face: its facets were turned inside out
  std::vector<double> moved_mm;  ///< per face: how far closing a crack moved its vertices
};

/// A mesh that holds, or why there is none.
struct Attempt {
  std::vector<Piece> pieces;
  std::size_t triangles = 0;
  std::string defect;
};

std::vector<TopoDS_Solid> solids_of(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Solid> solids;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) {
    solids.push_back(TopoDS::Solid(it.Current()));
  }
  return solids;
}

Aabb bounds_of(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::Add(shape, box, false);
  // Poles of splines may lie far outside: look closer before a part is refused.
  const auto reaches_far = [&] {
    return box.IsVoid() || box.IsOpen() || box.CornerMin().XYZ().Modulus() > kMaxCoordinate_mm ||
           box.CornerMax().XYZ().Modulus() > kMaxCoordinate_mm;
  };
  if (reaches_far()) {
    box.SetVoid();
    BRepBndLib::AddOptimal(shape, box, false, false);
  }
  if (box.IsVoid()) return {};
  return {to_eigen(box.CornerMin()), to_eigen(box.CornerMax())};
}

/// Throws where no mesher should be let near the shape: a wrong unit in a file asks for 10^12
/// facets.
double checked_diagonal_mm(const TopoDS_Shape& shape) {
  const Aabb box = bounds_of(shape);
  if (box.is_empty() || !box.min.allFinite() || !box.max.allFinite()) {
    throw Error(ErrorCode::FileMalformed, "its bounding box is empty or not finite");
  }
  const double reach_mm = std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  if (reach_mm > kMaxCoordinate_mm) {
    throw Error(ErrorCode::FileMalformed, "it reaches " + std::to_string(reach_mm) +
                                              " mm from the origin, expected at most " +
                                              std::to_string(kMaxCoordinate_mm) +
                                              " mm: is the unit in the file right?");
  }
  return box.size().norm();
}

void append_face(const TopoDS_Face& face, Piece& piece) {
  TopLoc_Location location;
  const auto facets = BRep_Tool::Triangulation(face, location);
  const auto face_index = static_cast<std::uint32_t>(piece.faces.size());
  piece.faces.push_back(face);
  piece.facets.faces.emplace_back();
  if (facets.IsNull()) return;
  const auto offset = static_cast<std::uint32_t>(piece.facets.vertices.size());
  const gp_Trsf placement = location.Transformation();
  for (int n = 1; n <= facets->NbNodes(); ++n) {
    piece.facets.vertices.push_back(to_eigen(facets->Node(n).Transformed(placement)));
  }
  const bool is_reversed = face.Orientation() == TopAbs_REVERSED;
  for (int t = 1; t <= facets->NbTriangles(); ++t) {
    int a = 0;
    int b = 0;
    int c = 0;
    facets->Triangle(t).Get(a, b, c);
    if (is_reversed) std::swap(b, c);
    const auto vertex = [&](int node) { return offset + static_cast<std::uint32_t>(node - 1); };
    piece.facets.triangles.push_back({vertex(a), vertex(b), vertex(c)});
    piece.facets.face_of.push_back(face_index);
  }
}

/// Orients the facets of one solid and notes which faces were turned for it.
void orient(Piece& piece) {
  FacetedSolid& facets = piece.facets;
  const std::vector<Triangle> as_meshed = facets.triangles;
  orient_outward(facets);
  piece.turned.assign(piece.faces.size(), false);
  for (std::size_t t = 0; t < as_meshed.size(); ++t) {
    if (facets.triangles[t] != as_meshed[t]) piece.turned[facets.face_of[t]] = true;
  }
}

/// Makes one sound mesh of the facets of a solid's faces. What is wrong with it, if anything.
std::optional<std::string> finish_mesh(Piece& piece) {
  piece.facets.solid_count = 1;
  piece.moved_mm.assign(piece.faces.size(), 0.0);
  weld(piece.facets);
  const FacetedSolid as_meshed = piece.facets;
  orient(piece);
  const auto defect = find_defect(piece.facets);
  if (!defect) return std::nullopt;
  piece.facets = as_meshed;
  piece.moved_mm = close_cracks(piece.facets, kSewing_mm);
  orient(piece);
  return find_defect(piece.facets) ? defect : std::nullopt;
}

Attempt mesh(const TopoDS_Shape& shape, const Deflection& deflection) {
  BRepTools::Clean(shape);
  IMeshTools_Parameters parameters;
  parameters.Deflection = deflection.linear_mm;
  parameters.Angle = deflection.angular_rad;
  const BRepMesh_IncrementalMesh mesher(shape, parameters);
  Attempt attempt;
  for (const TopoDS_Solid& solid : solids_of(shape)) {
    Piece& piece = attempt.pieces.emplace_back();
    piece.solid = solid;
    for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) {
      const bool is_boundary = it.Current().Orientation() == TopAbs_FORWARD ||
                               it.Current().Orientation() == TopAbs_REVERSED;
      if (is_boundary) append_face(TopoDS::Face(it.Current()), piece);
    }
    const auto defect = finish_mesh(piece);
    attempt.triangles += piece.facets.triangles.size();
    if (defect && attempt.defect.empty()) attempt.defect = *defect;
  }
  if (attempt.pieces.empty()) attempt.defect = "there is no solid";
  return attempt;
}

/// Meshes coarser and coarser until the part has few enough triangles.
Attempt mesh_within(const TopoDS_Shape& shape, Deflection deflection, std::uint32_t max_triangles) {
  constexpr int kMostRounds = 12;
  constexpr double kCoarsestAngle_rad = 1.5;
  Attempt attempt;
  for (int round = 0; round < kMostRounds; ++round) {
    attempt = mesh(shape, deflection);
    if (attempt.triangles <= max_triangles) return attempt;
    deflection.linear_mm *= attempt.triangles > 4UL * max_triangles ? 4.0 : 2.0;
    deflection.angular_rad = std::min(1.5 * deflection.angular_rad, kCoarsestAngle_rad);
  }
  throw Error(ErrorCode::FileMalformed, "it needs " + std::to_string(attempt.triangles) +
                                            " triangles, expected at most " +
                                            std::to_string(max_triangles));
}

TopoDS_Shape compound_of(const std::vector<TopoDS_Solid>& solids) {
  BRep_Builder builder;
  TopoDS_Compound compound;
  builder.MakeCompound(compound);
  for (const TopoDS_Solid& solid : solids) builder.Add(compound, solid);
  return compound;
}

/// OpenCascade's general repair of a copy.
TopoDS_Shape fixed(const TopoDS_Shape& shape) {
  ShapeFix_Shape fix(BRepBuilderAPI_Copy(shape).Shape());
  fix.Perform();
  return compound_of(solids_of(fix.Shape()));
}

/// Each solid rebuilt from its faces, sewn together anew; null where that gives no closed shell.
TopoDS_Shape sewn(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Solid> solids;
  for (const TopoDS_Solid& solid : solids_of(BRepBuilderAPI_Copy(shape).Shape())) {
    BRepBuilderAPI_Sewing sewing(kSewing_mm);
    for (TopExp_Explorer it(solid, TopAbs_FACE); it.More(); it.Next()) sewing.Add(it.Current());
    sewing.Perform();
    BRepBuilderAPI_MakeSolid rebuilt;
    bool is_closed = false;
    for (TopExp_Explorer it(sewing.SewedShape(), TopAbs_SHELL); it.More(); it.Next()) {
      rebuilt.Add(TopoDS::Shell(it.Current()));
      is_closed = true;
    }
    if (!is_closed || !rebuilt.IsDone()) return {};
    solids.push_back(rebuilt.Solid());
  }
  return compound_of(solids);
}

/// The first mesh without a defect: as asked, with other deflections, then of healed copies. The
/// mesher's failures are local accidents of its parameters, so that a small change often helps.
Attempt closed_mesh(const TopoDS_Shape& shape, const Deflection& asked,
                    std::uint32_t max_triangles) {
  std::string first_defect;
  const auto attempted = [&](const TopoDS_Shape& candidate, double linear, double angular) {
    Attempt attempt = mesh_within(
        candidate, {asked.linear_mm * linear, asked.angular_rad * angular}, max_triangles);
    if (first_defect.empty()) first_defect = attempt.defect;
    return attempt;
  };
  constexpr std::array<std::array<double, 2>, 5> kFactors{
      {{1.0, 1.0}, {0.5, 1.0}, {0.25, 1.0}, {2.0, 1.0}, {0.5, 0.4}}};
  for (const auto& factors : kFactors) {
    Attempt attempt = attempted(shape, factors[0], factors[1]);
    if (attempt.defect.empty()) return attempt;
  }
  for (const auto& heal : {std::function(fixed), std::function(sewn)}) {
    TopoDS_Shape healed;
    try {
      healed = heal(shape);
    } catch (const Standard_Failure&) {
      continue;  // a repair that fails leaves the next one
    }
    if (healed.IsNull() || solids_of(healed).size() != solids_of(shape).size()) continue;
    for (const double linear : {1.0, 0.5}) {
      Attempt attempt = attempted(healed, linear, 1.0);
      if (attempt.defect.empty()) return attempt;
    }
  }
  throw Error(ErrorCode::FileMalformed, "mesh is not closed: " + first_defect);
}

Vector3d centroid(const Piece& piece, std::uint32_t triangle) {
  const auto corners = piece.facets.corners(triangle);
  return (corners[0] + corners[1] + corners[2]) / 3.0;
}

/// Area-weighted agreement of the facets' outward normals with the surface's natural side, and the
/// facets' area, per face.
struct FacetSums {
  double agreement_mm2 = 0.0;
  double area_mm2 = 0.0;
};

std::vector<FacetSums> sum_facets(const Piece& piece) {
  std::vector<FacetSums> sums(piece.faces.size());
  for (std::uint32_t t = 0; t < piece.facets.triangles.size(); ++t) {
    const auto corners = piece.facets.corners(t);
    const Vector3d normal = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]);
    FacetSums& sum = sums[piece.facets.face_of[t]];
    sum.area_mm2 += normal.norm();
    const Surface& surface = piece.facets.faces[piece.facets.face_of[t]].surface;
    if (std::holds_alternative<OtherSurface>(surface)) continue;
    sum.agreement_mm2 += normal.dot(distance_gradient(surface, centroid(piece, t)));
  }
  return sums;
}

/// False where the face's boundary lies off the surface that it claims.
bool set_surface(const TopoDS_Face& face, const Vector3d& inside, double deflection_mm,
                 double moved_mm, Face& result) {
  TopLoc_Location location;
  const auto facets = BRep_Tool::Triangulation(face, location);
  if (facets.IsNull()) return true;
  const gp_Trsf placement = location.Transformation();
  result.surface = exact_surface(face, inside);
  // Damaged files have boundaries far off the surface that they claim.
  const bool is_misplaced = !std::holds_alternative<OtherSurface>(result.surface) &&
                            !(corner_error_mm(*facets, placement, result.surface) <= deflection_mm);
  if (is_misplaced) result.surface = OtherSurface{};
  result.facet_error_mm = facet_error_mm(face, *facets, placement, result.surface) + moved_mm;
  if (is_plane(result.surface) && result.facet_error_mm < kMinTolerance_mm) {
    result.facet_error_mm = 0.0;
  }
  return !is_misplaced;
}

double exact_area_mm2(const TopoDS_Face& face, double facet_area_mm2) {
  GProp_GProps properties;
  BRepGProp::SurfaceProperties(face, properties);
  const double area_mm2 = std::abs(properties.Mass());
  // The integration goes astray on faces with a broken parameter range.
  constexpr double kPlausible = 0.5;
  const bool is_plausible = std::isfinite(area_mm2) && area_mm2 > kPlausible * facet_area_mm2 &&
                            kPlausible * area_mm2 < facet_area_mm2;
  return is_plausible ? area_mm2 : facet_area_mm2;
}

/// Exact surfaces, their errors, sides and areas for the faces of one solid. Returns how many of
/// them do not lie on the surface that they claim.
std::size_t describe_faces(Piece& piece, double deflection_mm) {
  std::vector<Vector3d> inside(piece.faces.size(), Vector3d::Zero());
  for (std::uint32_t t = 0; t < piece.facets.triangles.size(); ++t) {
    inside[piece.facets.face_of[t]] = centroid(piece, t);
  }
  std::size_t misplaced = 0;
  for (std::size_t f = 0; f < piece.faces.size(); ++f) {
    const bool is_placed = set_surface(piece.faces[f], inside[f], deflection_mm, piece.moved_mm[f],
                                       piece.facets.faces[f]);
    if (!is_placed) ++misplaced;
  }
  const std::vector<FacetSums> sums = sum_facets(piece);
  for (std::size_t f = 0; f < piece.faces.size(); ++f) {
    Face& face = piece.facets.faces[f];
    face.area_mm2 = exact_area_mm2(piece.faces[f], sums[f].area_mm2);
    if (auto* plane = std::get_if<PlaneSurface>(&face.surface)) {
      if (sums[f].agreement_mm2 < 0.0) plane->normal = -plane->normal;
    } else {
      face.reversed = sums[f].agreement_mm2 < 0.0;
    }
  }
  return misplaced;
}

/// The solid with its shells turned as its facets were.
TopoDS_Solid turned_solid(const Piece& piece) {
  if (std::find(piece.turned.begin(), piece.turned.end(), true) == piece.turned.end()) {
    return piece.solid;
  }
  BRep_Builder builder;
  TopoDS_Solid result;
  builder.MakeSolid(result);
  std::size_t face = 0;
  for (TopExp_Explorer shell(piece.solid, TopAbs_SHELL); shell.More(); shell.Next()) {
    bool is_turned = false;
    for (TopExp_Explorer it(shell.Current(), TopAbs_FACE); it.More(); it.Next()) {
      if (face < piece.faces.size() && it.Current().IsSame(piece.faces[face])) {
        is_turned = is_turned || piece.turned[face];
        ++face;
      }
    }
    builder.Add(result, is_turned ? shell.Current().Reversed() : shell.Current());
  }
  return result;
}

/// Moves vertices of one solid that coincide with vertices of another by a few ulp: the solids of a
/// part may touch, and each must stay closed in itself where all are welded together.
void separate_touching(FacetedSolid& solid) {
  std::vector<std::uint32_t> order(solid.vertices.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) order[i] = i;
  const auto key = [&](std::uint32_t i) {
    const Vector3d& v = solid.vertices[i];
    return std::tuple(v.y(), v.z(), v.x(), i);
  };
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 1; i < order.size(); ++i) {
    const Vector3d& before = solid.vertices[order[i - 1]];
    Vector3d& vertex = solid.vertices[order[i]];
    if (before.y() != vertex.y() || before.z() != vertex.z() || before.x() < vertex.x()) continue;
    const double ulp = std::nextafter(std::abs(before.x()), HUGE_VAL) - std::abs(before.x());
    vertex.x() = before.x() + std::max(2.0 * ulp, kTouchingSolids_mm);
  }
}

void append(const Piece& piece, std::uint32_t solid_index, FacetedSolid& whole) {
  const auto vertex_offset = static_cast<std::uint32_t>(whole.vertices.size());
  const auto face_offset = static_cast<std::uint32_t>(whole.faces.size());
  whole.vertices.insert(whole.vertices.end(), piece.facets.vertices.begin(),
                        piece.facets.vertices.end());
  for (const Triangle& t : piece.facets.triangles) {
    whole.triangles.push_back({t[0] + vertex_offset, t[1] + vertex_offset, t[2] + vertex_offset});
  }
  for (const std::uint32_t face : piece.facets.face_of) whole.face_of.push_back(face + face_offset);
  whole.faces.insert(whole.faces.end(), piece.facets.faces.begin(), piece.facets.faces.end());
  for (std::size_t f = face_offset; f < whole.faces.size(); ++f) {
    whole.faces[f].solid = solid_index;
  }
  std::vector<PlacedFace> placed;
  for (std::uint32_t f = 0; f < piece.faces.size(); ++f) {
    placed.push_back({piece.faces[f], f + face_offset, piece.turned[f]});
  }
  const std::vector<Edge> edges = exact_edges(placed, whole.faces);
  whole.edges.insert(whole.edges.end(), edges.begin(), edges.end());
}

}  // namespace

double default_deflection_mm(double diagonal_mm) {
  constexpr double kPerDiagonal = 1.0e-3;
  return std::clamp(kPerDiagonal * diagonal_mm, kMinDeflection_mm, kMaxDeflection_mm);
}

FacetedShape facet(const TopoDS_Shape& shape, const FacetOptions& options) {
  return guarded("the mesher failed", [&] {
    const double diagonal_mm = checked_diagonal_mm(shape);
    const double linear_mm =
        options.deflection_mm > 0.0 ? options.deflection_mm : default_deflection_mm(diagonal_mm);
    Attempt attempt =
        closed_mesh(shape, {linear_mm, options.angular_deflection_rad}, options.max_triangles);
    FacetedShape result;
    std::vector<TopoDS_Solid> solids;
    for (Piece& piece : attempt.pieces) {
      result.misplaced_faces += describe_faces(piece, linear_mm);
      append(piece, static_cast<std::uint32_t>(solids.size()), result.solid);
      solids.push_back(turned_solid(piece));
    }
    result.solid.solid_count = static_cast<std::uint32_t>(solids.size());
    separate_touching(result.solid);
    result.shape = compound_of(solids);
    if (const auto defect = find_defect(result.solid)) {
      throw Error(ErrorCode::FileMalformed, "mesh is not closed: " + *defect);
    }
    return result;
  });
}

}  // namespace dowel
