#pragma once

#include <array>
#include <string_view>

/// The numbers of the library, one table a concept. "like ISO ..." marks numbers of general
/// engineering knowledge that follow the standard without having been compared with its text.
namespace dowel::library {

/// Metric coarse thread and the holes that go with it.
struct ThreadSize {
  std::string_view name;
  double diameter_mm;
  double pitch_mm;
  double minor_diameter_mm;     ///< D1 = d - 1.0825318 P, to a micrometre
  double clearance_hole_mm;     ///< ISO 273, medium
  double counterbore_mm;        ///< like DIN 974-1, row 1
  double counterbore_depth_mm;  ///< head height and about 1 mm
};

/// Socket head cap screw like ISO 4762.
struct SocketHead {
  double head_diameter_mm;  ///< dk
  double head_height_mm;    ///< k
  double key_size_mm;       ///< s
  double key_depth_mm;      ///< t
};

/// Hexagon nut like ISO 4032 and the one 1.5 d high like DIN 6330.
struct NutSize {
  double height_mm;       ///< m of ISO 4032
  double width_mm;        ///< s of both
  double high_height_mm;  ///< m of DIN 6330
};

/// Plain washer like ISO 7089 and the heavy one like DIN 6340.
struct WasherSize {
  double inner_mm;
  double outer_mm;
  double height_mm;
  double heavy_inner_mm;
  double heavy_outer_mm;
  double heavy_height_mm;
};

struct FastenerSize {
  ThreadSize thread;
  SocketHead socket;
  NutSize nut;
  WasherSize washer;
};

/// M6, M8, M10, M12. Sources: ISO 273 clearance holes; ISO 4762, 4032, 7089, DIN 6330 and 6340 as
/// in the tables of FastenersWB, ISO 4032 widths across flats of the 2012 edition; counterbores
/// and key depths are general knowledge.
inline constexpr std::array<FastenerSize, 4> kFasteners{{
    {{"M6", 6.0, 1.0, 4.917, 6.6, 11.0, 6.8},
     {10.0, 6.0, 5.0, 3.0},
     {5.2, 10.0, 9.0},
     {6.4, 12.0, 1.6, 6.4, 17.0, 3.0}},
    {{"M8", 8.0, 1.25, 6.647, 9.0, 15.0, 9.0},
     {13.0, 8.0, 6.0, 4.0},
     {6.8, 13.0, 12.0},
     {8.4, 16.0, 1.6, 8.4, 23.0, 4.0}},
    {{"M10", 10.0, 1.5, 8.376, 11.0, 18.0, 11.0},
     {16.0, 10.0, 8.0, 5.0},
     {8.4, 16.0, 15.0},
     {10.5, 20.0, 2.0, 10.5, 26.0, 4.0}},
    {{"M12", 12.0, 1.75, 10.106, 13.5, 20.0, 13.0},
     {18.0, 12.0, 10.0, 6.0},
     {10.8, 18.0, 18.0},
     {13.0, 24.0, 2.5, 13.0, 35.0, 5.0}},
}};

/// The row of `kFasteners` called `thread`. Expects: there is one.
const FastenerSize& fastener_size(std::string_view thread);

/// The system H40-12: nodes every 40 mm, each a 12H7 bore over an M12 thread in one axis.
/// Source: the common "M12/40" size of European hole systems (general knowledge).
inline constexpr std::string_view kSystem = "H40-12";
inline constexpr const char* kSystemSource =
    "hole system 40 mm, M12/12H7: dimensions of this library";
inline constexpr std::string_view kSystemThread = "M12";
inline constexpr double kPitch_mm = 40.0;
inline constexpr double kBore_mm = 12.0;         ///< locating bore, H7
inline constexpr double kBoreDepth_mm = 15.0;    ///< the thread starts here, 1.25 d
inline constexpr double kThreadDepth_mm = 36.0;  ///< full thread of a blind node ends here
inline constexpr double kPlateHeight_mm = 40.0;

/// Shank 12g6 in the middle of its tolerance: -6/-17 um (ISO 286).
inline constexpr double kShank_mm = 11.9885;
/// Length of the part of a spigot that locates; its thread starts below a relief of 2 mm.
inline constexpr double kSpigotFit_mm = 13.0;
inline constexpr double kSpigotRelief_mm = 2.0;
inline constexpr double kSpigotReliefDiameter_mm = 9.5;
inline constexpr double kSpigotLength_mm = 34.0;

/// Thread of a fit screw: below it, the shank of 12g6 ends 25 mm above the tip.
inline constexpr double kFitScrewThread_mm = 23.0;

/// Nodes of the base plates along x and y.
struct PlateSize {
  int nodes_x;
  int nodes_y;
};
inline constexpr std::array<PlateSize, 4> kPlates{{{6, 6}, {10, 8}, {12, 10}, {15, 10}}};

inline constexpr std::array<int, 3> kRiserHeights_mm{40, 80, 120};
/// Up to three of these reach every 5 mm up to 230 mm.
inline constexpr std::array<int, 11> kSpacerHeights_mm{5, 10, 15, 20, 25, 30, 40, 50, 60, 80, 100};
inline constexpr std::array<int, 5> kColumnHeights_mm{50, 60, 80, 100, 120};
inline constexpr std::array<int, 4> kRestPadHeights_mm{20, 30, 40, 50};
inline constexpr std::array<int, 3> kRestButtonHeights_mm{25, 30, 40};
inline constexpr std::array<int, 3> kEdgeLocatorHeights_mm{40, 60, 80};

/// Locating pin like DIN 6321, forms B (round) and C (diamond), long. The shank is pressed in: it
/// is modelled at its nominal diameter, its hole too.
struct PinSize {
  double diameter_mm;      ///< nominal, g6
  double fit_diameter_mm;  ///< middle of g6
  double head_length_mm;
  double shank_diameter_mm;  ///< n6
  double shank_length_mm;
  double land_mm;  ///< form C
};
/// Sources: sizes as in DIN 6321 (general knowledge, size 10 confirmed by a public model); g6 from
/// ISO 286: 6: -4/-12, 8 and 10: -5/-14, 12 and 16: -6/-17 um.
inline constexpr std::array<PinSize, 5> kPins{{
    {6.0, 5.992, 12.0, 4.0, 6.0, 1.0},
    {8.0, 7.9905, 16.0, 6.0, 9.0, 1.6},
    {10.0, 9.9905, 18.0, 6.0, 9.0, 2.5},
    {12.0, 11.9885, 18.0, 6.0, 9.0, 2.5},
    {16.0, 15.9885, 22.0, 8.0, 12.0, 3.5},
}};
/// Half angle of the lead-in cone of a pin, in degrees, and its length as a part of the head.
inline constexpr double kPinLeadIn_deg = 15.0;
inline constexpr double kPinLeadInShare = 1.0 / 3.0;

/// Carrier of such pins: bore for the shank, depth.
struct PinHolderSize {
  double bore_mm;
  double depth_mm;
};
inline constexpr std::array<PinHolderSize, 3> kPinHolders{{{4.0, 8.0}, {6.0, 11.0}, {8.0, 14.0}}};

struct VeeBlockSize {
  double width_mm;
  double angle_deg;
  double height_mm;      ///< 0.75 width and 10 mm
  double screw_seat_mm;  ///< height of the counterbore's floor
};
inline constexpr std::array<VeeBlockSize, 3> kVeeBlocks{
    {{40.0, 90.0, 40.0, 11.0}, {80.0, 90.0, 70.0, 25.0}, {80.0, 120.0, 70.0, 38.0}}};

/// Clamp strap like DIN 6314 (general knowledge): slot, length, width, height.
struct StrapSize {
  double slot_mm;
  double slot_length_mm;  ///< overall
  double length_mm;
  double width_mm;
  double height_mm;
};
inline constexpr std::array<StrapSize, 2> kStraps{
    {{14.0, 40.0, 100.0, 40.0, 20.0}, {14.0, 64.0, 160.0, 40.0, 25.0}}};

/// Heel screws M12: hexagon head with a flat face, thread to the end.
inline constexpr std::array<int, 4> kHeelScrewLengths_mm{45, 50, 60, 70};
inline constexpr double kHeelScrewHead_mm = 10.0;
inline constexpr double kHeelScrewWidth_mm = 18.0;

/// Studs M12 like DIN 6379 (general knowledge): length, thread at the lower and at the upper end.
struct StudSize {
  double length_mm;
  double lower_thread_mm;
  double upper_thread_mm;
};
inline constexpr std::array<StudSize, 7> kStuds{{{50.0, 20.0, 25.0},
                                                 {63.0, 20.0, 32.0},
                                                 {80.0, 25.0, 40.0},
                                                 {100.0, 25.0, 50.0},
                                                 {125.0, 25.0, 75.0},
                                                 {160.0, 25.0, 100.0},
                                                 {200.0, 25.0, 125.0}}};

/// Lengths of ISO 888 that the elements of the system and their stacks ask for.
struct ScrewLengths {
  std::string_view thread;
  std::array<int, 16> lengths_mm;  ///< 0 ends the list
};
inline constexpr std::array<ScrewLengths, 4> kScrews{{
    {"M6", {12, 16, 20, 25, 30}},
    {"M8", {16, 20, 25, 30, 40}},
    {"M10", {20, 25, 30, 40, 50}},
    {"M12", {30, 35, 40, 45, 50, 55, 60, 65, 70, 80, 90, 100, 110, 120, 130, 140}},
}};
inline constexpr std::array<int, 11> kFitScrewLengths_mm{45, 50,  60,  65,  70, 80,
                                                         90, 100, 110, 120, 130};

/// Parallel pins, hardened, like ISO 8734, modelled at their nominal diameter.
struct DowelPinSize {
  double diameter_mm;
  double length_mm;
  double chamfer_mm;
};
inline constexpr std::array<DowelPinSize, 9> kDowelPins{{{6.0, 20.0, 1.0},
                                                         {6.0, 30.0, 1.0},
                                                         {8.0, 24.0, 1.3},
                                                         {8.0, 40.0, 1.3},
                                                         {10.0, 30.0, 1.6},
                                                         {10.0, 50.0, 1.6},
                                                         {12.0, 26.0, 1.8},
                                                         {12.0, 30.0, 1.8},
                                                         {12.0, 50.0, 1.8}}};

}  // namespace dowel::library
