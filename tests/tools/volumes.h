#pragma once

// Volumes of the pieces that the library's parts are made of, by formula.

#include <cmath>
#include <numbers>

namespace dowel::library {

inline constexpr double kPi = std::numbers::pi;

inline double cylinder(double diameter_mm, double length_mm) {
  return kPi / 4.0 * diameter_mm * diameter_mm * length_mm;
}

inline double cone(double from_mm, double to_mm, double length_mm) {
  return kPi / 12.0 * (from_mm * from_mm + from_mm * to_mm + to_mm * to_mm) * length_mm;
}

inline double hexagon_area(double across_flats_mm) {
  return std::sqrt(3.0) / 2.0 * across_flats_mm * across_flats_mm;
}

/// Material that two wrench flats take off a round bar.
inline double flats(double diameter_mm, double across_mm, double length_mm) {
  const double r = diameter_mm / 2.0;
  const double h = across_mm / 2.0;
  return 2.0 * (r * r * std::acos(h / r) - h * std::sqrt(r * r - h * h)) * length_mm;
}

inline double spigot() {
  return cylinder(11.9885, 13.0) + cylinder(9.5, 2.0) + cylinder(12.0, 18.0) +
         cone(12.0, 10.0, 1.0);
}

inline double node(double depth_mm) {
  return cylinder(12.0, 15.0) + cylinder(10.106, depth_mm - 15.0);
}

}  // namespace dowel::library
