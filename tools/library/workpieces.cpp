// Workpieces to design fixtures for.

#include <string>

#include "builders.h"
#include "holes.h"
#include "solids.h"

namespace dowel::library {
namespace {

/// Box with vertical edges rounded with `radius_mm`, centred on the z axis.
TopoDS_Shape rounded_pocket(double length_x_mm, double width_y_mm, double radius_mm,
                            double low_z_mm, double high_z_mm) {
  const double reach_x_mm = length_x_mm / 2.0 - radius_mm;
  const double width_mm = 2.0 * radius_mm;
  const double reach_y_mm = width_y_mm / 2.0 - radius_mm;
  // Two bars with round ends and what lies between them.
  const TopoDS_Shape bar = oblong(0.0, length_x_mm, width_mm, low_z_mm, high_z_mm);
  const TopoDS_Shape core = box({-reach_x_mm - radius_mm, -reach_y_mm, low_z_mm},
                                {reach_x_mm + radius_mm, reach_y_mm, high_z_mm});
  return fuse(fuse(core, moved_y(bar, reach_y_mm)), moved_y(bar, -reach_y_mm));
}

/// A machined block, 240x160x60 mm: ledges for clamps at both short ends, a milled pocket, a step
/// along one long side, two locating holes of one pitch pattern and four screw holes.
Part bracket() {
  Part part;
  const double length_mm = 240.0;
  const double width_mm = 160.0;
  const double height_mm = 60.0;
  const double ledge_mm = 30.0;  // length along x
  const double ledge_height_mm = 25.0;
  const double step_mm = 18.0;  // width along y
  const double step_height_mm = 42.0;
  const double pocket_floor_mm = 28.0;
  const double half_x_mm = length_mm / 2.0;
  const double half_y_mm = width_mm / 2.0;
  const double out_mm = 1.0;
  part.name = "workpiece/bracket";
  part.role = "workpiece";
  part.description = "machined block with a pocket, a step, locating holes and ledges for clamps";
  part.source = "dimensions of this library";
  part.material = kAluminium;
  part.dimensions = {{"length", length_mm},
                     {"width", width_mm},
                     {"height", height_mm},
                     {"ledge_length", ledge_mm},
                     {"ledge_height", ledge_height_mm},
                     {"step_width", step_mm},
                     {"step_height", step_height_mm},
                     {"pocket_depth", height_mm - pocket_floor_mm}};
  part.features = {
      fitted(plain_hole({"L1", {-60.0, -60.0, height_mm}}, 12.0, height_mm, true), "H7"),
      fitted(plain_hole({"L2", {60.0, -60.0, height_mm}}, 12.0, height_mm, true), "H7"),
      plain_hole({"bore", {0.0, 0.0, pocket_floor_mm}}, 32.0, pocket_floor_mm, true)};
  int number = 0;
  for (const double x_mm : {-45.0, 45.0}) {
    for (const double y_mm : {-30.0, 30.0}) {
      part.features.push_back(
          plain_hole({"S" + std::to_string(++number), {x_mm, y_mm, pocket_floor_mm}}, 9.0,
                     pocket_floor_mm, true));
    }
  }
  const double inner_x_mm = half_x_mm - ledge_mm;
  const TopoDS_Shape rough =
      cut(block(length_mm, width_mm, height_mm),
          {box({-half_x_mm - out_mm, -half_y_mm - out_mm, ledge_height_mm},
               {-inner_x_mm, half_y_mm + out_mm, height_mm + out_mm}),
           box({inner_x_mm, -half_y_mm - out_mm, ledge_height_mm},
               {half_x_mm + out_mm, half_y_mm + out_mm, height_mm + out_mm}),
           box({-half_x_mm - out_mm, half_y_mm - step_mm, step_height_mm},
               {half_x_mm + out_mm, half_y_mm + out_mm, height_mm + out_mm})});
  const TopoDS_Shape milled =
      cut(rough, {rounded_pocket(130.0, 90.0, 10.0, pocket_floor_mm, height_mm + out_mm)});
  part.solid = machined(milled, part.features);
  part.features.push_back(face("bottom", {0.0, 0.0, 0.0}, kDown));
  part.features.push_back(
      face("ledge-left", {-half_x_mm + ledge_mm / 2.0, 0.0, ledge_height_mm}, kUp));
  part.features.push_back(
      face("ledge-right", {half_x_mm - ledge_mm / 2.0, 0.0, ledge_height_mm}, kUp));
  part.features.push_back(face("front", {0.0, -half_y_mm, height_mm / 2.0}, {0.0, -1.0, 0.0}));
  part.features.push_back(face("left", {-half_x_mm, 0.0, ledge_height_mm / 2.0}, {-1.0, 0.0, 0.0}));
  part.colour = {0.80, 0.78, 0.70};
  return part;
}

}  // namespace

std::vector<Part> workpieces() {
  std::vector<Part> parts{bracket()};
  for (Part& part : parts) name_features(part);
  return parts;
}

}  // namespace dowel::library
