#pragma once

#include <array>
#include <string_view>

/// The numbers of standard parts and materials, one table a concept. "like ISO ..." marks numbers
/// of general engineering knowledge that follow the standard without having been compared with its
/// text. The numbers of the modular systems are in systems.h.
namespace dowel::library {

/// Density: general knowledge, to about 1 %.
struct Material {
  std::string_view name;
  double density_kg_per_m3 = 0.0;
};
inline constexpr Material kCastIron{"cast iron GJL-250", 7200.0};
inline constexpr Material kSteel{"steel C45", 7850.0};
inline constexpr Material kCaseHardenedSteel{"steel 16MnCr5, case hardened", 7850.0};
inline constexpr Material kHardenedSteel{"steel, through hardened", 7850.0};
inline constexpr Material kScrewSteel{"steel, property class 8.8", 7850.0};
inline constexpr Material kAluminium{"aluminium EN AW-6082", 2700.0};

/// ISO metric thread and the holes that go with it.
struct ThreadSize {
  std::string_view name;
  double diameter_mm = 0.0;
  double pitch_mm = 0.0;
  double minor_diameter_mm = 0.0;     ///< D1 = d - 1.0825318 P, to a micrometre
  double clearance_hole_mm = 0.0;     ///< ISO 273, medium
  double counterbore_mm = 0.0;        ///< like DIN 974-1, row 1
  double counterbore_depth_mm = 0.0;  ///< head height and about 1 mm
};

/// Socket head cap screw like ISO 4762.
struct SocketHead {
  double head_diameter_mm = 0.0;  ///< dk
  double head_height_mm = 0.0;    ///< k
  double key_size_mm = 0.0;       ///< s
  double key_depth_mm = 0.0;      ///< t
};

/// Hexagon nut like ISO 4032 and the one 1.5 d high like DIN 6330.
struct NutSize {
  double height_mm = 0.0;       ///< m of ISO 4032
  double width_mm = 0.0;        ///< s of both
  double high_height_mm = 0.0;  ///< m of DIN 6330
};

/// Plain washer like ISO 7089 and the heavy one like DIN 6340.
struct WasherSize {
  double inner_mm = 0.0;
  double outer_mm = 0.0;
  double height_mm = 0.0;
  double heavy_inner_mm = 0.0;
  double heavy_outer_mm = 0.0;
  double heavy_height_mm = 0.0;
};

/// Collar of a hexagon nut like DIN 6331, as high over all and as wide as the one of DIN 6330.
struct CollarSize {
  double diameter_mm = 0.0;  ///< d1
  double height_mm = 0.0;    ///< a
};

/// Spherical washer like DIN 6319 form C and the conical seats it turns in, form D and, for slotted
/// holes, the wide form G.
struct SphericalWasherSize {
  double inner_mm = 0.0;        ///< d1
  double outer_mm = 0.0;        ///< d3, that of form D, too
  double height_mm = 0.0;       ///< h2
  double ball_radius_mm = 0.0;  ///< R
  double seat_inner_mm = 0.0;   ///< d2 of D and G
  double seat_mouth_mm = 0.0;   ///< d5 of D and G, the cone's upper end
  double seat_height_mm = 0.0;  ///< h3 of D
  double wide_outer_mm = 0.0;   ///< d4 of G
  double wide_height_mm = 0.0;  ///< h3 of G
};
inline constexpr double kConicalSeat_deg = 120.0;

struct FastenerSize {
  ThreadSize thread{};
  SocketHead socket{};
  NutSize nut{};
  WasherSize washer{};
  CollarSize collar{};
  SphericalWasherSize spherical{};
};

/// M6 to M16 coarse, and M12x1.5. Sources: ISO 273 clearance holes; ISO 4762, 4032, 7089, DIN 6330,
/// 6331, 6340 and 6319 as in the tables of FastenersWB (M8 of DIN 6331 as its misprint "3,5" was
/// meant), ISO 4032 widths across flats of the 2012 edition; cones of DIN 6319 as in a maker's data
/// sheet (Ganter); ball radii (size 20 confirmed by FastenersWB), counterbores and key depths are
/// general knowledge.
inline constexpr std::array<FastenerSize, 6> kFasteners{{
    {{"M6", 6.0, 1.0, 4.917, 6.6, 11.0, 6.8},
     {10.0, 6.0, 5.0, 3.0},
     {5.2, 10.0, 9.0},
     {6.4, 12.0, 1.6, 6.4, 17.0, 3.0},
     {14.0, 3.0},
     {6.4, 12.0, 2.3, 9.0, 7.1, 11.0, 2.8, 17.0, 4.0}},
    {{"M8", 8.0, 1.25, 6.647, 9.0, 15.0, 9.0},
     {13.0, 8.0, 6.0, 4.0},
     {6.8, 13.0, 12.0},
     {8.4, 16.0, 1.6, 8.4, 23.0, 4.0},
     {18.0, 3.5},
     {8.4, 17.0, 3.2, 12.0, 9.6, 14.5, 3.5, 24.0, 5.0}},
    {{"M10", 10.0, 1.5, 8.376, 11.0, 18.0, 11.0},
     {16.0, 10.0, 8.0, 5.0},
     {8.4, 16.0, 15.0},
     {10.5, 20.0, 2.0, 10.5, 26.0, 4.0},
     {22.0, 4.0},
     {10.5, 21.0, 4.0, 15.0, 12.0, 18.5, 4.2, 30.0, 5.0}},
    {{"M12", 12.0, 1.75, 10.106, 13.5, 20.0, 13.0},
     {18.0, 12.0, 10.0, 6.0},
     {10.8, 18.0, 18.0},
     {13.0, 24.0, 2.5, 13.0, 35.0, 5.0},
     {25.0, 4.0},
     {13.0, 24.0, 4.6, 17.0, 14.2, 20.0, 5.0, 36.0, 6.0}},
    {{"M12x1.5", 12.0, 1.5, 10.376, 13.5, 20.0, 13.0},
     {18.0, 12.0, 10.0, 6.0},
     {10.8, 18.0, 18.0},
     {13.0, 24.0, 2.5, 13.0, 35.0, 5.0},
     {25.0, 4.0},
     {13.0, 24.0, 4.6, 17.0, 14.2, 20.0, 5.0, 36.0, 6.0}},
    {{"M16", 16.0, 2.0, 13.835, 17.5, 26.0, 17.5},
     {24.0, 16.0, 14.0, 8.0},
     {14.8, 24.0, 24.0},
     {17.0, 30.0, 3.0, 17.0, 45.0, 6.0},
     {31.0, 5.0},
     {17.0, 30.0, 5.3, 22.0, 19.0, 26.0, 6.2, 44.0, 7.0}},
}};

/// The row of `kFasteners` called `thread`. Expects: there is one.
const FastenerSize& fastener_size(std::string_view thread);

/// T-slot like ISO 299 (the numbers of BS 2485).
struct TeeSlotSize {
  double throat_mm = 0.0;           ///< a
  double undercut_mm = 0.0;         ///< b, the middle of its range
  double undercut_height_mm = 0.0;  ///< c, likewise
  double depth_mm = 0.0;            ///< H, likewise
};
inline constexpr TeeSlotSize kTeeSlot12{12.0, 20.0, 8.5, 22.0};
inline constexpr TeeSlotSize kTeeSlot14{14.0, 24.0, 10.0, 26.0};

/// T-nut like DIN 508 (FastenersWB); the neck is 0.3 mm narrower than the slot. Where it is as high
/// as its foot it has no neck.
struct TeeNutSize {
  std::string_view thread;
  double slot_mm = 0.0;
  double width_mm = 0.0;        ///< e, width and length of the foot
  double height_mm = 0.0;       ///< h
  double foot_height_mm = 0.0;  ///< k
};
inline constexpr double kTeeNutNeckPlay_mm = 0.3;

/// Locating pin like DIN 6321, forms B (round) and C (diamond). The shank is pressed in: it is
/// modelled at its nominal diameter, its hole too.
struct PinSize {
  double diameter_mm = 0.0;      ///< nominal, g6
  double fit_diameter_mm = 0.0;  ///< middle of g6
  double head_length_mm = 0.0;
  double shank_diameter_mm = 0.0;  ///< n6
  double shank_length_mm = 0.0;
  double land_mm = 0.0;  ///< form C
};
/// Half angle of the lead-in cone of a pin, in degrees, and its length as a part of the head.
inline constexpr double kPinLeadIn_deg = 15.0;
inline constexpr double kPinLeadInShare = 1.0 / 3.0;
/// Of a shank that is pressed in, at the same angle: an edge broken at 45 degrees looks like the
/// end of a thread.
inline constexpr double kShankLeadIn_mm = 1.0;

/// Clamp strap like DIN 6314 (general knowledge): slot, length, width, height.
struct StrapSize {
  double slot_mm = 0.0;
  double slot_length_mm = 0.0;  ///< overall
  double length_mm = 0.0;
  double width_mm = 0.0;
  double height_mm = 0.0;
};

/// Stud like DIN 6379 (general knowledge): length, thread at the lower and at the upper end.
struct StudSize {
  double length_mm = 0.0;
  double lower_thread_mm = 0.0;
  double upper_thread_mm = 0.0;
};

/// Parallel pin, hardened, like ISO 8734, modelled at its nominal diameter.
struct DowelPinSize {
  double diameter_mm = 0.0;
  double length_mm = 0.0;
  double chamfer_mm = 0.0;
};

}  // namespace dowel::library
