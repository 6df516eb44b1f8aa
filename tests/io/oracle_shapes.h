#pragma once

#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <numbers>
#include <string>
#include <vector>

#include <BRepFilletAPI_MakeFillet.hxx>
#include <BRepPrimAPI_MakeSphere.hxx>
#include <BRepPrimAPI_MakeTorus.hxx>
#include <TopExp.hxx>
#include <TopLoc_Location.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Shape.hxx>
#include <gp_Quaternion.hxx>
#include <gp_Trsf.hxx>

#include "dowel/kernel/pose.h"
#include "library/solids.h"
#include "random_geometry.h"

/// Exact shapes like those of a modular fixture, of random size.
namespace dowel::testing {

/// Open upwards, its axis along z in the plane y = 0.
struct UprightHole {
  double x_mm = 0.0;
  double radius_mm = 0.0;
  double top_z_mm = 0.0;  ///< of its narrow part
};

struct NamedShape {
  std::string name;  ///< kind and sizes: enough to make it again
  TopoDS_Shape shape;
  std::vector<UprightHole> holes;
};

inline TopoDS_Shape placed(const TopoDS_Shape& shape, const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation();
  const Eigen::Vector3d& t = pose.translation();
  gp_Trsf placement;
  placement.SetTransformation(gp_Quaternion(q.x(), q.y(), q.z(), q.w()),
                              gp_Vec(t.x(), t.y(), t.z()));
  return shape.Moved(TopLoc_Location(placement));
}

inline std::string named(const char* kind, std::initializer_list<double> sizes_mm) {
  std::string result = kind;
  for (const double size_mm : sizes_mm) {
    char text[32];
    std::snprintf(text, sizeof text, " %.17g", size_mm);
    result += text;
  }
  return result;
}

/// Cylinder about the z axis.
inline TopoDS_Shape round_bar(double radius_mm, double low_z_mm, double high_z_mm) {
  return library::turned(
      {{0.0, low_z_mm}, {radius_mm, low_z_mm}, {radius_mm, high_z_mm}, {0.0, high_z_mm}});
}

inline TopoDS_Shape at(double x_mm, double y_mm, const TopoDS_Shape& shape) {
  return placed(shape, Pose::from_translation({x_mm, y_mm, 0.0}));
}

/// 80 x 50 x `height`, top at z = height: at x = -25 a bore, at x = 0 a counterbored one, at x = 25
/// a blind one with a drill's point.
inline NamedShape holed_plate(double height_mm, double radius_mm) {
  const double floor_mm = 0.4 * height_mm;
  const std::vector<TopoDS_Shape> tools{at(-25.0, 0.0, round_bar(radius_mm, -1.0, height_mm + 1.0)),
                                        library::turned({{0.0, -1.0},
                                                         {radius_mm, -1.0},
                                                         {radius_mm, 0.5 * height_mm},
                                                         {1.5 * radius_mm, 0.5 * height_mm},
                                                         {1.5 * radius_mm, height_mm + 1.0},
                                                         {0.0, height_mm + 1.0}}),
                                        at(25.0, 0.0,
                                           library::turned({{0.0, floor_mm - 0.3 * radius_mm},
                                                            {radius_mm, floor_mm},
                                                            {radius_mm, height_mm + 1.0},
                                                            {0.0, height_mm + 1.0}}))};
  return {named("plate", {height_mm, radius_mm}),
          library::cut(library::block(80.0, 50.0, height_mm), tools),
          {{-25.0, radius_mm, height_mm},
           {0.0, radius_mm, 0.5 * height_mm},
           {25.0, radius_mm, height_mm}}};
}

/// Shank below z = 0 with a chamfer of a tenth of the radius at its lower end, head above.
inline NamedShape stepped_pin(double radius_mm, double length_mm, double head_mm) {
  const double chamfer_mm = 0.1 * radius_mm;
  return {named("stepped pin", {radius_mm, length_mm, head_mm}),
          library::turned({{0.0, -length_mm},
                           {radius_mm - chamfer_mm, -length_mm},
                           {radius_mm, chamfer_mm - length_mm},
                           {radius_mm, 0.0},
                           {head_mm, 0.0},
                           {head_mm, 0.5 * length_mm},
                           {0.0, 0.5 * length_mm}}),
          {}};
}

/// All edges of `shape` rounded.
inline TopoDS_Shape rounded(const TopoDS_Shape& shape, double radius_mm) {
  BRepFilletAPI_MakeFillet fillet(shape);
  TopTools_IndexedMapOfShape edges;
  TopExp::MapShapes(shape, TopAbs_EDGE, edges);
  for (int i = 1; i <= edges.Extent(); ++i) fillet.Add(radius_mm, TopoDS::Edge(edges(i)));
  return fillet.Shape();
}

inline NamedShape vee_block(double width_mm, double height_mm, double length_mm) {
  const double half_mm = 0.5 * width_mm;
  const double groove_mm = 0.4 * width_mm;
  return {named("vee block", {width_mm, height_mm, length_mm}),
          library::prism_y({{-half_mm, 0.0},
                            {-half_mm, height_mm},
                            {-groove_mm, height_mm},
                            {0.0, height_mm - groove_mm},
                            {groove_mm, height_mm},
                            {half_mm, height_mm},
                            {half_mm, 0.0}},
                           length_mm),
          {}};
}

/// T profile, foot down, neck up; narrower than its slot by `play_mm` on each side.
inline TopoDS_Shape tee(double neck_mm, double play_mm, double neck_top_mm, double length_mm) {
  const double neck = 0.5 * neck_mm - play_mm;
  const double foot = 0.9 * neck_mm - play_mm;
  const double foot_top = 0.6 * neck_mm - play_mm;
  return library::prism_y({{-foot, 0.0},
                           {-foot, foot_top},
                           {-neck, foot_top},
                           {-neck, neck_top_mm},
                           {neck, neck_top_mm},
                           {neck, foot_top},
                           {foot, foot_top},
                           {foot, 0.0}},
                          length_mm);
}

inline NamedShape tee_nut(double neck_mm, double length_mm) {
  return {named("T-nut", {neck_mm, length_mm}),
          library::cut(tee(neck_mm, 0.02, neck_mm, length_mm),
                       {round_bar(0.25 * neck_mm, -1.0, 2.0 * neck_mm)}),
          {{0.0, 0.25 * neck_mm, neck_mm}}};
}

inline NamedShape tee_slot_plate(double neck_mm, double height_mm) {
  const TopoDS_Shape slot = placed(tee(neck_mm, 0.0, height_mm, 100.0),
                                   Pose::from_translation({0.0, 0.0, height_mm - neck_mm}));
  return {named("T-slot plate", {neck_mm, height_mm}),
          library::cut(library::block(80.0, 60.0, height_mm), {at(-18, 0, slot), at(18, 0, slot)}),
          {}};
}

inline NamedShape clamp_strap(double length_mm, double width_mm, double height_mm) {
  const double nose_mm = 0.35 * length_mm;
  const double end_mm = 0.5 * length_mm;
  const TopoDS_Shape body = library::prism_y({{-end_mm, 0.0},
                                              {-end_mm, height_mm},
                                              {nose_mm, height_mm},
                                              {end_mm, 0.4 * height_mm},
                                              {end_mm, 0.0}},
                                             width_mm);
  return {named("strap", {length_mm, width_mm, height_mm}),
          library::cut(
              body, {library::oblong(0.0, 0.5 * length_mm, 0.4 * width_mm, -1.0, height_mm + 1.0)}),
          {{-0.15 * length_mm, 0.2 * width_mm, height_mm}}};
}

/// Flats cut from a turned blank, so that the chamfers meet them in hyperbolas.
inline NamedShape hex_nut(double flats_mm, double height_mm, double bore_mm) {
  const double face_mm = 0.48 * flats_mm;
  const double reach_mm = face_mm + 0.2 * flats_mm;
  const double drop_mm = (reach_mm - face_mm) / std::numbers::sqrt3;  // 30 degrees
  const TopoDS_Shape blank = library::turned({{0.0, 0.0},
                                              {face_mm, 0.0},
                                              {reach_mm, drop_mm},
                                              {reach_mm, height_mm - drop_mm},
                                              {face_mm, height_mm},
                                              {0.0, height_mm}});
  const TopoDS_Shape nut =
      library::common(library::hexagon(flats_mm, -1.0, height_mm + 1.0), blank);
  return {named("hex nut", {flats_mm, height_mm, bore_mm}),
          library::cut(nut, {round_bar(0.5 * bore_mm, -1.0, height_mm + 1.0)}),
          {{0.0, 0.5 * bore_mm, height_mm}}};
}

/// One of each kind.
inline std::vector<NamedShape> random_shapes(RandomGeometry& random) {
  // Hundredths of a millimetre read well in a report.
  const auto size = [&random](double low_mm, double high_mm) {
    return std::round(100.0 * random.uniform(low_mm, high_mm)) / 100.0;
  };
  std::vector<NamedShape> shapes;
  shapes.push_back(holed_plate(size(12, 40), size(2, 8)));
  shapes.push_back(stepped_pin(size(2, 8), size(8, 40), size(9, 20)));
  shapes.push_back(vee_block(size(30, 60), size(30, 50), size(20, 60)));
  shapes.push_back(tee_nut(size(8, 18), size(15, 40)));
  shapes.push_back(tee_slot_plate(size(10, 16), size(25, 40)));
  shapes.push_back(clamp_strap(size(50, 100), size(20, 40), size(8, 20)));
  shapes.push_back(hex_nut(size(10, 30), size(8, 15), size(4, 9)));
  {
    const double base = size(5, 25);
    const double top = random.coin() ? 0.0 : size(1, 4);
    const double height = size(8, 40);
    std::vector<Eigen::Vector2d> outline{{0.0, 0.0}, {base, 0.0}, {top, height}, {0.0, height}};
    if (top == 0.0) outline.pop_back();
    shapes.push_back({named("cone", {base, top, height}), library::turned(outline), {}});
  }
  {
    const double radius = size(3, 30);
    shapes.push_back({named("sphere", {radius}), BRepPrimAPI_MakeSphere(radius).Solid(), {}});
  }
  {
    const double major = size(10, 30);
    const double minor = size(2, 8);
    shapes.push_back(
        {named("torus", {major, minor}), BRepPrimAPI_MakeTorus(major, minor).Solid(), {}});
  }
  {
    const double inner = size(4, 15);
    const double outer = inner + size(2, 12);
    const double height = size(2, 20);
    shapes.push_back({named("ring", {inner, outer, height}),
                      library::turned({{inner, 0}, {outer, 0}, {outer, height}, {inner, height}}),
                      {{0.0, inner, height}}});
  }
  {
    const double x = size(15, 60);
    const double y = size(15, 60);
    const double z = size(15, 60);
    const double edge = size(1, 5);
    shapes.push_back(
        {named("rounded block", {x, y, z, edge}), rounded(library::block(x, y, z), edge), {}});
  }
  {
    const double radius = size(4, 20);
    const double height = size(10, 40);
    shapes.push_back({named("rounded cylinder", {radius, height}),
                      rounded(round_bar(radius, 0.0, height), 0.2 * radius),
                      {}});
  }
  {
    const double tip_deg = size(5, 60);
    const double height = size(15, 40);
    const double half = height * std::tan(0.5 * tip_deg * std::numbers::pi / 180.0);
    shapes.push_back({named("wedge", {tip_deg, height}),
                      library::prism_y({{-half, 0.0}, {0.0, height}, {half, 0.0}}, 30.0),
                      {}});
  }
  return shapes;
}

}  // namespace dowel::testing
