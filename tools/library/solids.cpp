#include "solids.h"

#include <cmath>
#include <numbers>

#include <BRepAlgoAPI_Common.hxx>
#include <BRepAlgoAPI_Cut.hxx>
#include <BRepAlgoAPI_Fuse.hxx>
#include <BRepBuilderAPI_MakeFace.hxx>
#include <BRepBuilderAPI_MakePolygon.hxx>
#include <BRepGProp.hxx>
#include <BRepPrimAPI_MakeBox.hxx>
#include <BRepPrimAPI_MakePrism.hxx>
#include <BRepPrimAPI_MakeRevol.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <Eigen/Geometry>
#include <GProp_GProps.hxx>
#include <ShapeUpgrade_UnifySameDomain.hxx>
#include <TopExp_Explorer.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_ListOfShape.hxx>
#include <gp_Ax1.hxx>
#include <gp_Ax2.hxx>
#include <gp_Dir.hxx>
#include <gp_Pnt.hxx>
#include <gp_Trsf.hxx>
#include <gp_Vec.hxx>

#include "dowel/kernel/check.h"

namespace dowel::library {
namespace {

/// How far a cutting tool stands out of the faces it opens: coplanar faces would only cost time.
constexpr double kRunOut_mm = 1.0;

gp_Pnt to_pnt(const Eigen::Vector3d& p) {
  return {p.x(), p.y(), p.z()};
}

TopoDS_Shape face_of(const std::vector<gp_Pnt>& corners) {
  BRepBuilderAPI_MakePolygon wire;
  for (const gp_Pnt& corner : corners) wire.Add(corner);
  wire.Close();
  return BRepBuilderAPI_MakeFace(wire.Wire(), Standard_True).Face();
}

/// The only solid of a boolean operation's result.
TopoDS_Shape single_solid(const TopoDS_Shape& shape) {
  TopExp_Explorer solids(shape, TopAbs_SOLID);
  DOWEL_EXPECTS(solids.More());
  const TopoDS_Shape solid = solids.Current();
  solids.Next();
  DOWEL_EXPECTS(!solids.More());
  return solid;
}

/// Faces that continue each other are one face to whoever machines the part.
TopoDS_Shape unified(const TopoDS_Shape& shape) {
  ShapeUpgrade_UnifySameDomain unify(shape);
  unify.Build();
  return single_solid(unify.Shape());
}

/// Body of revolution about the line through `origin` along `axis`; `outline` as for `turned`.
TopoDS_Shape revolved(const std::vector<Eigen::Vector2d>& outline, const gp_Pnt& origin,
                      const gp_Dir& axis) {
  const gp_Ax2 frame(origin, axis);
  std::vector<gp_Pnt> corners;
  corners.reserve(outline.size());
  for (const Eigen::Vector2d& p : outline) {
    corners.push_back(
        origin.Translated(gp_Vec(frame.XDirection()) * p.x() + gp_Vec(frame.Direction()) * p.y()));
  }
  return BRepPrimAPI_MakeRevol(face_of(corners), gp_Ax1(origin, axis)).Shape();
}

/// The material that the drill takes away, standing out at its open ends.
TopoDS_Shape drill_tool(const Feature& hole) {
  DOWEL_EXPECTS(!hole.segments.empty());
  const HoleSegment& mouth = hole.segments.front();
  std::vector<Eigen::Vector2d> outline{{0.0, -kRunOut_mm}, {mouth.diameter_mm / 2.0, -kRunOut_mm}};
  const auto add = [&outline](double diameter_mm, double depth_mm) {
    const Eigen::Vector2d p(diameter_mm / 2.0, depth_mm);
    if (outline.back() != p) outline.push_back(p);
  };
  for (const HoleSegment& segment : hole.segments) {
    // A cylinder at the mouth and its run-out are one straight line.
    const bool straight_mouth = &segment == &mouth && segment.type == HoleSegment::Type::Cylinder;
    if (!straight_mouth) add(segment.diameter_mm, segment.from_mm);
    add(segment.diameter_end_mm, segment.to_mm);
  }
  if (hole.through) outline.back().y() += kRunOut_mm;
  if (outline.back().x() > 0.0) outline.emplace_back(0.0, outline.back().y());
  return revolved(outline, to_pnt(hole.origin),
                  gp_Dir(hole.direction.x(), hole.direction.y(), hole.direction.z()));
}

/// What a cutter takes away along a slot with that section (half widths over depths from the floor
/// up to the mouth), standing out where the slot is open.
TopoDS_Shape slot_prism(const Feature& slot, const std::vector<Eigen::Vector2d>& section) {
  const Eigen::Vector3d& run = slot.slot->run;
  const Eigen::Vector3d across = slot.direction.cross(run);
  const double reach_mm = slot.slot->length_mm / 2.0 + kRunOut_mm;
  const Eigen::Vector3d start = slot.origin - reach_mm * run;
  std::vector<gp_Pnt> corners;
  const auto add = [&](double across_mm, double depth_mm) {
    corners.push_back(to_pnt(start + across_mm * across + depth_mm * slot.direction));
  };
  for (const Eigen::Vector2d& p : section) add(p.x(), p.y());
  for (auto p = section.rbegin(); p != section.rend(); ++p) add(-p->x(), p->y());
  const Eigen::Vector3d sweep = 2.0 * reach_mm * run;
  return BRepPrimAPI_MakePrism(face_of(corners), gp_Vec(sweep.x(), sweep.y(), sweep.z())).Shape();
}

TopoDS_Shape slot_tool(const Feature& slot) {
  const SlotShape& shape = slot.slot.value();
  const double half_mm = slot.diameter_mm / 2.0;
  const double undercut_mm = shape.undercut_width_mm / 2.0;
  switch (shape.type) {
    case SlotShape::Type::Plain:
      return slot_prism(slot, {{half_mm, slot.depth_mm}, {half_mm, -kRunOut_mm}});
    case SlotShape::Type::Tee:
      return slot_prism(slot, {{undercut_mm, slot.depth_mm},
                               {undercut_mm, shape.throat_depth_mm},
                               {half_mm, shape.throat_depth_mm},
                               {half_mm, -kRunOut_mm}});
    case SlotShape::Type::Through:
      break;
  }
  DOWEL_EXPECTS(shape.run.x() == 1.0 && slot.direction == kDown);
  return moved_y(oblong(slot.origin.x(), shape.length_mm, slot.diameter_mm,
                        slot.origin.z() - slot.depth_mm - kRunOut_mm, slot.origin.z() + kRunOut_mm),
                 slot.origin.y());
}

}  // namespace

TopoDS_Shape box(const Eigen::Vector3d& low, const Eigen::Vector3d& high) {
  return BRepPrimAPI_MakeBox(to_pnt(low), to_pnt(high)).Solid();
}

TopoDS_Shape block(double length_x_mm, double width_y_mm, double height_z_mm) {
  return box({-length_x_mm / 2.0, -width_y_mm / 2.0, 0.0},
             {length_x_mm / 2.0, width_y_mm / 2.0, height_z_mm});
}

TopoDS_Shape turned(const std::vector<Eigen::Vector2d>& outline) {
  return revolved(outline, gp_Pnt(0.0, 0.0, 0.0), gp_Dir(0.0, 0.0, 1.0));
}

TopoDS_Shape prism_z(const std::vector<Eigen::Vector2d>& outline, double low_z_mm,
                     double high_z_mm) {
  std::vector<gp_Pnt> corners;
  corners.reserve(outline.size());
  for (const Eigen::Vector2d& p : outline) corners.emplace_back(p.x(), p.y(), low_z_mm);
  return BRepPrimAPI_MakePrism(face_of(corners), gp_Vec(0.0, 0.0, high_z_mm - low_z_mm)).Shape();
}

TopoDS_Shape prism_y(const std::vector<Eigen::Vector2d>& outline, double width_mm) {
  std::vector<gp_Pnt> corners;
  corners.reserve(outline.size());
  for (const Eigen::Vector2d& p : outline) corners.emplace_back(p.x(), -width_mm / 2.0, p.y());
  return BRepPrimAPI_MakePrism(face_of(corners), gp_Vec(0.0, width_mm, 0.0)).Shape();
}

TopoDS_Shape hexagon(double across_flats_mm, double low_z_mm, double high_z_mm) {
  const double corner_mm = across_flats_mm / std::numbers::sqrt3;
  std::vector<Eigen::Vector2d> outline;
  for (int i = 0; i < 6; ++i) {
    const double angle_rad = i * std::numbers::pi / 3.0;
    outline.emplace_back(corner_mm * std::cos(angle_rad), corner_mm * std::sin(angle_rad));
  }
  return prism_z(outline, low_z_mm, high_z_mm);
}

TopoDS_Shape oblong(double center_x_mm, double overall_length_mm, double width_mm, double low_z_mm,
                    double high_z_mm) {
  const double radius_mm = width_mm / 2.0;
  const double reach_mm = overall_length_mm / 2.0 - radius_mm;
  const TopoDS_Shape end =
      turned({{0.0, low_z_mm}, {radius_mm, low_z_mm}, {radius_mm, high_z_mm}, {0.0, high_z_mm}});
  TopoDS_Shape slot = box({center_x_mm - reach_mm, -radius_mm, low_z_mm},
                          {center_x_mm + reach_mm, radius_mm, high_z_mm});
  for (const double x_mm : {center_x_mm - reach_mm, center_x_mm + reach_mm}) {
    gp_Trsf shift;
    shift.SetTranslation(gp_Vec(x_mm, 0.0, 0.0));
    slot = fuse(slot, end.Moved(TopLoc_Location(shift)));
  }
  return slot;
}

TopoDS_Shape with_flats(const TopoDS_Shape& body, double diameter_mm, double across_mm,
                        double low_z_mm, double high_z_mm) {
  const double out_mm = diameter_mm / 2.0 + kRunOut_mm;
  const double flat_mm = across_mm / 2.0;
  return cut(body, {box({-out_mm, flat_mm, low_z_mm}, {out_mm, out_mm, high_z_mm}),
                    box({-out_mm, -out_mm, low_z_mm}, {out_mm, -flat_mm, high_z_mm})});
}

TopoDS_Shape moved_y(const TopoDS_Shape& shape, double distance_mm) {
  gp_Trsf shift;
  shift.SetTranslation(gp_Vec(0.0, distance_mm, 0.0));
  return shape.Moved(TopLoc_Location(shift));
}

TopoDS_Shape ball(double radius_mm, double center_z_mm) {
  return BRepPrimAPI_MakeSphere(gp_Pnt(0.0, 0.0, center_z_mm), radius_mm).Solid();
}

TopoDS_Shape cut(const TopoDS_Shape& body, const std::vector<TopoDS_Shape>& tools) {
  if (tools.empty()) return body;
  TopTools_ListOfShape arguments;
  TopTools_ListOfShape cutters;
  arguments.Append(body);
  for (const TopoDS_Shape& tool : tools) cutters.Append(tool);
  BRepAlgoAPI_Cut operation;
  operation.SetArguments(arguments);
  operation.SetTools(cutters);
  operation.Build();
  DOWEL_EXPECTS(operation.IsDone() && !operation.HasErrors());
  return single_solid(operation.Shape());
}

TopoDS_Shape fuse(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  BRepAlgoAPI_Fuse operation(a, b);
  DOWEL_EXPECTS(operation.IsDone() && !operation.HasErrors());
  return unified(operation.Shape());
}

TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b) {
  BRepAlgoAPI_Common operation(a, b);
  DOWEL_EXPECTS(operation.IsDone() && !operation.HasErrors());
  return single_solid(operation.Shape());
}

double volume_mm3(const TopoDS_Shape& solid) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(solid, properties);
  return properties.Mass();
}

TopoDS_Shape machined(const TopoDS_Shape& body, const std::vector<Feature>& features) {
  std::vector<TopoDS_Shape> drills;
  std::vector<TopoDS_Shape> along_x;
  std::vector<TopoDS_Shape> across_x;
  for (const Feature& feature : features) {
    if (feature.kind == FeatureKind::Hole) drills.push_back(drill_tool(feature));
    if (feature.kind != FeatureKind::Slot) continue;
    const bool is_along_x = feature.slot.value().run.x() == 1.0;
    (is_along_x ? along_x : across_x).push_back(slot_tool(feature));
  }
  // Tools of one cut that meet each other cost most of its time.
  const TopoDS_Shape part = cut(cut(cut(body, along_x), across_x), drills);
  // Slots that cross leave their floors in pieces.
  return across_x.empty() ? part : unified(part);
}

}  // namespace dowel::library
