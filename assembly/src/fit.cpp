#include "dowel/assembly/fit.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>

#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

constexpr int kFirstGrade = 5;
constexpr int kLastGrade = 11;
constexpr std::string_view kLetters = "FGHfghkmnp";

/// Over the first up to and with the second.
constexpr std::array<double, 7> kRanges_mm{3.0, 6.0, 10.0, 18.0, 30.0, 50.0, 80.0};

/// Standard tolerances IT5 to IT11, one row a range.
constexpr std::array<std::array<int, 7>, 6> kGrades_um{{{5, 8, 12, 18, 30, 48, 75},
                                                        {6, 9, 15, 22, 36, 58, 90},
                                                        {8, 11, 18, 27, 43, 70, 110},
                                                        {9, 13, 21, 33, 52, 84, 130},
                                                        {11, 16, 25, 39, 62, 100, 160},
                                                        {13, 19, 30, 46, 74, 120, 190}}};

/// What p adds to IT7, by range.
constexpr std::array<int, 6> kAboveIt7_um{0, 0, 0, 1, 1, 2};

/// A drawn diameter this close to the middle of a class stands for it.
constexpr double kDrawn_um = 0.25;

std::size_t range_of(double nominal_mm) {
  std::size_t range = 0;
  while (nominal_mm > kRanges_mm[range + 1]) ++range;
  return range;
}

int grade_um(std::size_t range, int grade) {
  return kGrades_um[range][static_cast<std::size_t>(grade - kFirstGrade)];
}

/// The limit of a shaft that is nearer to its nominal size: upper for f, g, h, lower for k to p.
double near_limit_um(char letter, std::size_t range) {
  const double mean_mm = std::sqrt(kRanges_mm[range] * kRanges_mm[range + 1]);
  const int step_um = grade_um(range, 7) - grade_um(range, 6);
  switch (letter) {
    case 'f':
      return -std::round(5.5 * std::pow(mean_mm, 0.41));
    case 'g':
      return -std::round(2.5 * std::pow(mean_mm, 0.34));
    case 'k':
      return std::round(0.6 * std::cbrt(mean_mm));
    case 'm':
      return step_um;
    case 'n':
      return std::round(5.0 * std::pow(mean_mm, 0.34));
    case 'p':
      return grade_um(range, 7) + kAboveIt7_um[range];
    default:
      DOWEL_EXPECTS(letter == 'h');
      return 0.0;
  }
}

char lower_case(char letter) {
  return static_cast<char>(letter >= 'A' && letter <= 'Z' ? letter - 'A' + 'a' : letter);
}

}  // namespace

std::optional<ToleranceClass> tolerance_class_from(std::string_view text) {
  if (text.size() < 2 || kLetters.find(text.front()) == std::string_view::npos) return std::nullopt;
  ToleranceClass tolerance;
  tolerance.letter = text.front();
  const char* const end = text.data() + text.size();
  const auto [stop, error] = std::from_chars(text.data() + 1, end, tolerance.grade);
  if (error != std::errc{} || stop != end || tolerance.grade < kFirstGrade ||
      tolerance.grade > kLastGrade) {
    return std::nullopt;
  }
  return tolerance;
}

bool is_nominal_size(double nominal_mm) {
  return nominal_mm > kRanges_mm.front() && nominal_mm <= kRanges_mm.back();
}

Deviations deviations(double nominal_mm, const ToleranceClass& tolerance) {
  DOWEL_EXPECTS(is_nominal_size(nominal_mm));
  DOWEL_EXPECTS(tolerance_class_from(tolerance.text()) == tolerance);
  const std::size_t range = range_of(nominal_mm);
  const double width_um = grade_um(range, tolerance.grade);
  const char letter = lower_case(tolerance.letter);
  const double near_um = near_limit_um(letter, range);
  const bool is_below = letter == 'f' || letter == 'g' || letter == 'h';
  const Deviations shaft =
      is_below ? Deviations{near_um - width_um, near_um} : Deviations{near_um, near_um + width_um};
  // A hole is the mirror of the shaft; F, G, H are, without a further rule.
  if (tolerance.is_hole()) return {0.0 - shaft.upper_um, 0.0 - shaft.lower_um};
  return shaft;
}

double Fit::least_clearance_um() const {
  return deviations(nominal_mm, hole).lower_um - deviations(nominal_mm, shaft).upper_um;
}

double Fit::most_clearance_um() const {
  return deviations(nominal_mm, hole).upper_um - deviations(nominal_mm, shaft).lower_um;
}

std::string_view Fit::kind() const {
  if (least_clearance_um() >= 0.0) return "clearance";
  return most_clearance_um() > 0.0 ? "transition" : "interference";
}

std::string Fit::text() const {
  std::array<char, 32> buffer{};
  const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), nominal_mm).ptr;
  return std::string(buffer.data(), end) + " " + hole.text() + "/" + shaft.text();
}

std::optional<Fit> fit_from(double nominal_mm, std::string_view text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string_view::npos || !is_nominal_size(nominal_mm)) return std::nullopt;
  const auto hole = tolerance_class_from(text.substr(0, slash));
  const auto shaft = tolerance_class_from(text.substr(slash + 1));
  if (!hole || !shaft || !hole->is_hole() || shaft->is_hole()) return std::nullopt;
  return Fit{nominal_mm, *hole, *shaft};
}

std::optional<Fit> fit_as_drawn(double hole_diameter_mm, double shaft_diameter_mm) {
  constexpr double kUm_per_mm = 1000.0;
  const double nominal_mm = 0.5 * std::round(2.0 * hole_diameter_mm);
  if (!is_nominal_size(nominal_mm) || std::abs(hole_diameter_mm - nominal_mm) > kCoincident_mm) {
    return std::nullopt;
  }
  const double off_um = kUm_per_mm * (shaft_diameter_mm - nominal_mm);
  for (const char letter : {'f', 'g', 'h', 'k', 'm', 'n', 'p'}) {
    const ToleranceClass shaft{letter, letter == 'f' ? 7 : 6};
    const Deviations limits = deviations(nominal_mm, shaft);
    if (std::abs(off_um - 0.5 * (limits.lower_um + limits.upper_um)) <= kDrawn_um) {
      return Fit{nominal_mm, {'H', 7}, shaft};
    }
  }
  return std::nullopt;
}

}  // namespace dowel
