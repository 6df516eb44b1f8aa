#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace dowel {

/// Tolerance class of ISO 286: the letter of its position, a capital one for holes, and its grade.
struct ToleranceClass {
  char letter = 'H';
  int grade = 7;

  bool is_hole() const { return letter >= 'A' && letter <= 'Z'; }
  std::string text() const { return letter + std::to_string(grade); }
  bool operator==(const ToleranceClass&) const = default;
};

/// Limits of a size, from its nominal one.
struct Deviations {
  double lower_um = 0.0;
  double upper_um = 0.0;
};

/// Reads "H7": F, G, H for holes, f, g, h, k, m, n, p for shafts, grades 5 to 11. Nothing for
/// others.
std::optional<ToleranceClass> tolerance_class_from(std::string_view text);

/// Nominal sizes with known deviations: over 3 mm up to 80 mm.
bool is_nominal_size(double nominal_mm);

/// Source: ISO 286-1. Grades are its table of standard tolerances, which its formula with 16 i
/// meets but for rounding; positions are its formulae over the geometric mean of the range of
/// sizes. Expects: a nominal size as above and a class as read above.
Deviations deviations(double nominal_mm, const ToleranceClass& tolerance);

/// Hole and shaft of one nominal size.
struct Fit {
  double nominal_mm = 0.0;
  ToleranceClass hole;
  ToleranceClass shaft;

  double least_clearance_um() const;  ///< negative: interference
  double most_clearance_um() const;
  /// "clearance", "transition" or "interference".
  std::string_view kind() const;
  /// "12 H7/g6"
  std::string text() const;
};

/// Reads "H7/g6". Nothing where that is no hole over a shaft.
std::optional<Fit> fit_from(double nominal_mm, std::string_view text);

/// The fit that two diameters stand for as elements are drawn: the hole at its nominal size, taken
/// as H7, and the shaft in the middle of its class. Nothing where no class of grade 6 has that
/// middle.
std::optional<Fit> fit_as_drawn(double hole_diameter_mm, double shaft_diameter_mm);

}  // namespace dowel
