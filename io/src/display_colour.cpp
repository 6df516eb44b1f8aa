#include "display_colour.h"

#include <cmath>

namespace dowel {
namespace {

constexpr Colour kColliding{0.90, 0.16, 0.14};
constexpr Colour kContact{0.20, 0.52, 0.85};
constexpr double kContactShare = 0.22;

/// NaN becomes 0: the comparison is false for it.
double clamped(double component) {
  if (!(component > 0.0)) return 0.0;
  return component < 1.0 ? component : 1.0;
}

}  // namespace

Colour surface_colour(const Colour& own, DisplayState state) {
  Colour colour{};
  for (std::size_t i = 0; i < 3; ++i) {
    switch (state) {
      case DisplayState::Normal:
        colour[i] = clamped(own[i]);
        break;
      case DisplayState::Contact:
        colour[i] = (1.0 - kContactShare) * clamped(own[i]) + kContactShare * kContact[i];
        break;
      case DisplayState::Colliding:
        colour[i] = kColliding[i];
        break;
    }
  }
  return colour;
}

Colour line_colour(DisplayState state) {
  switch (state) {
    case DisplayState::Contact:
      return {0.05, 0.20, 0.38};
    case DisplayState::Colliding:
      return {0.36, 0.02, 0.02};
    case DisplayState::Normal:
      break;
  }
  return {0.13, 0.15, 0.18};
}

/// Source: IEC 61966-2-1.
Colour linear_from_srgb(const Colour& colour) {
  Colour linear{};
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = clamped(colour[i]);
    linear[i] = c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  }
  return linear;
}

std::string to_hex(const Colour& colour) {
  static constexpr const char* kDigits = "0123456789abcdef";
  std::string hex = "#";
  for (const double component : colour) {
    const auto byte = static_cast<unsigned>(std::lround(255.0 * clamped(component)));
    hex += kDigits[byte / 16];
    hex += kDigits[byte % 16];
  }
  return hex;
}

}  // namespace dowel
