#include "turning_tool.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <optional>

namespace dowel {
namespace {

/// Hexagon keys: width across flats, short and long leg. Source: ISO 2936, by general knowledge.
struct HexKey {
  double size_mm;
  double short_mm;
  double long_mm;
};
constexpr std::array kHexKeys{HexKey{2.5, 18, 56}, HexKey{3, 20, 63},   HexKey{4, 25, 70},
                              HexKey{5, 28, 80},   HexKey{6, 32, 90},   HexKey{8, 36, 100},
                              HexKey{10, 40, 112}, HexKey{12, 45, 125}, HexKey{14, 56, 140},
                              HexKey{17, 63, 160}, HexKey{19, 70, 180}};
constexpr double kKeyPlay_mm = 0.3;

/// Sockets with a square drive of 12.5 mm: outside 1.25 s + 3 as in ISO 2725-1, and a handle like
/// ISO 3315. Open-ended spanners: head and thickness like DIN 3110. General knowledge, all.
constexpr double kSocketHeight_mm = 42.0;
constexpr double kHandle_mm = 250.0;
constexpr double kHandleDiameter_mm = 20.0;
constexpr double kSpannerHead = 2.1;        // widths across flats
constexpr double kSpannerThickness = 0.42;  // the same
constexpr double kSpannerLength = 12.0;     // the same

const double kCornersByFlats = 2.0 / std::sqrt(3.0);

std::string size_text(double size_mm) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.3g", size_mm);
  return text.data();
}

std::optional<TurningTool> hex_key_for(const Drive& drive) {
  for (const HexKey& key : kHexKeys) {
    if (std::abs(key.size_mm - drive.across_flats_mm) > kKeyPlay_mm) continue;
    const double corners_mm = kCornersByFlats * key.size_mm;
    const double bend_mm = drive.from_mm + key.short_mm - 0.5 * corners_mm;
    return TurningTool{"hex key " + size_text(key.size_mm),
                       1.0,
                       corners_mm,
                       drive.to_mm,
                       std::max(bend_mm, drive.to_mm + corners_mm),
                       std::max(bend_mm, drive.to_mm + 0.5 * corners_mm + kOffSeat_mm),
                       corners_mm,
                       key.long_mm};
  }
  return std::nullopt;
}

TurningTool socket_for(const Drive& drive, double sense) {
  const double from_mm = sense > 0.0 ? drive.from_mm : -drive.to_mm;
  const double top_mm = from_mm + kOffSeat_mm + kSocketHeight_mm;
  return {"socket " + size_text(drive.across_flats_mm),
          sense,
          1.25 * drive.across_flats_mm + 3.0,
          from_mm + kOffSeat_mm,
          top_mm,
          top_mm + 0.5 * kHandleDiameter_mm,
          kHandleDiameter_mm,
          kHandle_mm};
}

TurningTool spanner_for(const Drive& drive) {
  const double middle_mm = 0.5 * (drive.from_mm + drive.to_mm);
  const double half_mm = std::min(0.5 * kSpannerThickness * drive.across_flats_mm,
                                  0.5 * (drive.to_mm - drive.from_mm) - kOffSeat_mm);
  return {"spanner " + size_text(drive.across_flats_mm),
          1.0,
          kSpannerHead * drive.across_flats_mm,
          middle_mm - half_mm,
          middle_mm + half_mm,
          middle_mm,
          2.0 * half_mm,
          kSpannerLength * drive.across_flats_mm};
}

}  // namespace

std::vector<TurningTool> wrenches_for(const Drive& drive) {
  if (drive.kind == Drive::Kind::Socket) {
    const auto key = hex_key_for(drive);
    return key ? std::vector{*key} : std::vector<TurningTool>();
  }
  std::vector<TurningTool> wrenches{socket_for(drive, 1.0)};
  if (drive.is_nut) wrenches.push_back(socket_for(drive, -1.0));
  if (drive.to_mm - drive.from_mm > 3.0 * kOffSeat_mm) wrenches.push_back(spanner_for(drive));
  return wrenches;
}

}  // namespace dowel
