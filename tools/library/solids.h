#pragma once

#include <vector>

#include <Eigen/Core>
#include <TopoDS_Shape.hxx>

#include "part.h"

/// The few ways in which the library's parts are made. Every function returns one valid solid.
namespace dowel::library {

/// Box centred on the z axis with its bottom at z = 0.
TopoDS_Shape block(double length_x_mm, double width_y_mm, double height_z_mm);

/// Box between two corners.
TopoDS_Shape box(const Eigen::Vector3d& low, const Eigen::Vector3d& high);

/// Part turned about the z axis: `outline` is a list of (radius, z) from the axis at its bottom,
/// around the outside, to the axis at its top.
TopoDS_Shape turned(const std::vector<Eigen::Vector2d>& outline);

/// Right prism over the polygon `outline` of (x, y), counter-clockwise, from `low_z` to `high_z`.
TopoDS_Shape prism_z(const std::vector<Eigen::Vector2d>& outline, double low_z_mm,
                     double high_z_mm);

/// Right prism over the polygon `outline` of (x, z), clockwise seen along +y, centred on y = 0.
TopoDS_Shape prism_y(const std::vector<Eigen::Vector2d>& outline, double width_mm);

/// Hexagonal prism about the z axis, two flats facing +-y.
TopoDS_Shape hexagon(double across_flats_mm, double low_z_mm, double high_z_mm);

/// Slot with round ends along x, centred on (`center_x_mm`, 0).
TopoDS_Shape oblong(double center_x_mm, double overall_length_mm, double width_mm, double low_z_mm,
                    double high_z_mm);

/// Two flats for a wrench: a round `body` keeps `across_mm` along y between two heights.
TopoDS_Shape with_flats(const TopoDS_Shape& body, double diameter_mm, double across_mm,
                        double low_z_mm, double high_z_mm);

/// `shape` shifted along y.
TopoDS_Shape moved_y(const TopoDS_Shape& shape, double distance_mm);

/// Ball about a point of the z axis.
TopoDS_Shape ball(double radius_mm, double center_z_mm);

TopoDS_Shape cut(const TopoDS_Shape& body, const std::vector<TopoDS_Shape>& tools);
TopoDS_Shape fuse(const TopoDS_Shape& a, const TopoDS_Shape& b);
TopoDS_Shape common(const TopoDS_Shape& a, const TopoDS_Shape& b);

double volume_mm3(const TopoDS_Shape& solid);

/// `body` without the material of the holes and slots among `features`, which open at their
/// origins. Expects: slots lie along x, y or z; slotted holes open upwards and run along x.
TopoDS_Shape machined(const TopoDS_Shape& body, const std::vector<Feature>& features);

}  // namespace dowel::library
