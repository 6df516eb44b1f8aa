#include "systems.h"

#include <algorithm>

#include "dowel/kernel/check.h"

// A standard part that several systems use is in one of them alone: M6 to M12 screws, nuts, washers
// and pins in H40-12, M16 in H50-16; T14 takes its screws from H40-12, U12 its washers.

namespace dowel::library {
namespace {

/// Locating pins. Sources: sizes as in DIN 6321 (general knowledge, size 10 confirmed by a public
/// model), short and long heads; g6 from ISO 286: 6: -4/-12, 8 and 10: -5/-14, 12 and 16: -6/-17,
/// 20 and 25: -7/-20 um.
const std::vector<PinSize> kLongPins{{6.0, 5.992, 12.0, 4.0, 6.0, 1.0},
                                     {8.0, 7.9905, 16.0, 6.0, 9.0, 1.6},
                                     {10.0, 9.9905, 18.0, 6.0, 9.0, 2.5},
                                     {12.0, 11.9885, 18.0, 6.0, 9.0, 2.5},
                                     {16.0, 15.9885, 22.0, 8.0, 12.0, 3.5}};
const std::vector<PinSize> kLargePins{{20.0, 19.9865, 25.0, 12.0, 18.0, 5.0},
                                      {25.0, 24.9865, 25.0, 12.0, 18.0, 5.0}};
const std::vector<PinSize> kShortPins{{6.0, 5.992, 7.0, 4.0, 6.0, 1.0},
                                      {8.0, 7.9905, 10.0, 6.0, 9.0, 1.6},
                                      {10.0, 9.9905, 10.0, 6.0, 9.0, 2.5},
                                      {12.0, 11.9885, 10.0, 6.0, 9.0, 2.5}};
const std::vector<PinSize> kShortLargePins{{16.0, 15.9885, 13.0, 8.0, 12.0, 3.5},
                                           {20.0, 19.9865, 15.0, 12.0, 18.0, 5.0},
                                           {25.0, 24.9865, 15.0, 12.0, 18.0, 5.0}};

const std::vector<StudSize> kStudsM12{
    {50.0, 20.0, 25.0},  {63.0, 20.0, 32.0},   {80.0, 25.0, 40.0},  {100.0, 25.0, 50.0},
    {125.0, 25.0, 75.0}, {160.0, 25.0, 100.0}, {200.0, 25.0, 125.0}};

/// Up to three of the first row reach every 5 mm up to 230 mm.
const std::vector<int> kSpacers_mm{5, 10, 15, 20, 25, 30, 40, 50, 60, 80, 100};

/// The common "M12/40" size of European hole systems (general knowledge). Shank 12g6 is -6/-17 um
/// (ISO 286).
System h40_12() {
  return {
      .name = "H40-12",
      .source = "hole system 40 mm, M12/12H7: dimensions of this library",
      .thread = "M12",
      .pitch_mm = 40.0,
      .plate_height_mm = 40.0,
      .node = NodeSize{12.0, 15.0, 36.0},
      .slot = {},
      .foot = {11.9885, 13.0, 9.5, 2.0, 34.0},
      .column = {36.0, 30.0},
      .rest_pad = {18.0, 15.0},
      .pin_holder = {30.0, 24.0},
      .swing_post_mm = 20.0,
      .swing_arm_thickness_mm = 25.0,
      .plates = {{6, 6}, {10, 8}, {12, 10}, {15, 10}},
      .riser_heights_mm = {40, 80, 120},
      .spacer_heights_mm = kSpacers_mm,
      .angle_plates = {{3, 3, 27.0}, {3, 5, 27.0}},
      .column_heights_mm = {50, 60, 80, 100, 120},
      .rest_pad_heights_mm = {20, 30, 40, 50},
      .rest_button_heights_mm = {25, 30, 40},
      .adjustable_support_heights_mm = {40, 60, 80},
      .support_screw_lengths_mm = {40, 60, 80},
      .edge_locator_heights_mm = {40, 60, 80},
      .pins = kLongPins,
      .pin_holders = {{4.0, 8.0}, {6.0, 11.0}, {8.0, 14.0}},
      .vee_blocks = {{40.0, 90.0, 40.0, 11.0}, {80.0, 90.0, 70.0, 25.0}, {80.0, 120.0, 70.0, 38.0}},
      .straps = {{14.0, 40.0, 100.0, 40.0, 20.0}, {14.0, 64.0, 160.0, 40.0, 25.0}},
      .heel_screw_lengths_mm = {45, 50, 60, 70},
      .edge_clamp_heights_mm = {40, 60},
      .swing_clamps = {{40.0, 30.0, 25.0}, {60.0, 30.0, 25.0}},
      .swing_arm_lengths_mm = {80, 110},
      .studs = kStudsM12,
      .screws = {{"M6", {12, 16, 20, 25, 30}},
                 {"M8", {16, 20, 25, 30, 40}},
                 {"M10", {20, 25, 30, 40, 50}},
                 {"M12", {30, 35, 40, 45, 50, 55, 60, 65, 70, 80, 90, 100, 110, 120, 130, 140}}},
      .fit_screws = FitScrewSizes{23.0, {45, 50, 60, 65, 70, 80, 90, 100, 110, 120, 130}},
      .nut_threads = {"M6", "M8", "M10", "M12"},
      .washer_threads = {"M6", "M8", "M10", "M12"},
      .tee_nuts = {},
      .tee_bolt_lengths_mm = {},
      .keys = {},
      .dowel_pins = {{6.0, 20.0, 1.0},
                     {6.0, 30.0, 1.0},
                     {8.0, 24.0, 1.3},
                     {8.0, 40.0, 1.3},
                     {10.0, 30.0, 1.6},
                     {10.0, 50.0, 1.6},
                     {12.0, 26.0, 1.8},
                     {12.0, 30.0, 1.8},
                     {12.0, 50.0, 1.8}}};
}

/// The common "M16/50" size (general knowledge). Shank 16g6 is -6/-17 um (ISO 286).
System h50_16() {
  return {
      .name = "H50-16",
      .source = "hole system 50 mm, M16/16H7: dimensions of this library",
      .thread = "M16",
      .pitch_mm = 50.0,
      .plate_height_mm = 50.0,
      .node = NodeSize{16.0, 20.0, 46.0},
      .slot = {},
      .foot = {15.9885, 18.0, 13.0, 2.0, 44.0},
      .column = {48.0, 41.0},
      .rest_pad = {24.0, 21.0},
      .pin_holder = {40.0, 34.0},
      .swing_post_mm = 25.0,
      .swing_arm_thickness_mm = 32.0,
      .plates = {{6, 6}, {8, 8}, {12, 8}, {16, 10}},
      .riser_heights_mm = {50, 100, 150},
      .spacer_heights_mm = kSpacers_mm,
      .angle_plates = {{3, 3, 35.0}, {3, 5, 35.0}},
      .column_heights_mm = {60, 80, 100, 125, 150},
      .rest_pad_heights_mm = {25, 40, 50, 60},
      .rest_button_heights_mm = {30, 40, 50},
      .adjustable_support_heights_mm = {60, 80, 100},
      .support_screw_lengths_mm = {50, 80, 100},
      .edge_locator_heights_mm = {50, 75, 100},
      .pins = kLargePins,
      .pin_holders = {{8.0, 14.0}, {12.0, 20.0}},
      .vee_blocks = {{50.0, 90.0, 47.5, 11.0},
                     {100.0, 90.0, 85.0, 28.0},
                     {100.0, 120.0, 85.0, 45.0}},
      .straps = {{18.0, 50.0, 125.0, 50.0, 25.0}, {18.0, 80.0, 200.0, 50.0, 30.0}},
      .heel_screw_lengths_mm = {55, 65, 80, 100},
      .edge_clamp_heights_mm = {50, 75},
      .swing_clamps = {{50.0, 38.0, 32.0}, {75.0, 38.0, 32.0}},
      .swing_arm_lengths_mm = {100, 140},
      .studs = {{63.0, 25.0, 32.0},
                {80.0, 32.0, 40.0},
                {100.0, 32.0, 50.0},
                {125.0, 32.0, 63.0},
                {160.0, 32.0, 100.0},
                {200.0, 32.0, 125.0},
                {250.0, 32.0, 160.0}},
      .screws = {{"M16", {40, 45, 50, 55, 60, 70, 80, 90, 100, 110, 120, 130, 140, 160}}},
      .fit_screws = FitScrewSizes{28.0, {50, 55, 60, 70, 80, 90, 100, 110, 120, 130, 140}},
      .nut_threads = {"M16"},
      .washer_threads = {"M16"},
      .tee_nuts = {},
      .tee_bolt_lengths_mm = {},
      .keys = {},
      .dowel_pins = {{16.0, 40.0, 2.5}, {16.0, 60.0, 2.5}, {20.0, 50.0, 3.0}, {20.0, 80.0, 3.0}}};
}

/// T-slots 14 every 63 mm along x: pitch of ISO 299. A key in the key slot below an element aligns
/// it with the slot; screw and T-nut, or T-bolt, hold it.
System t14() {
  return {.name = "T14",
          .source =
              "slot system 14 mm at 63 mm, M12: slots like ISO 299, else dimensions of this "
              "library",
          .thread = "M12",
          .pitch_mm = 63.0,
          .plate_height_mm = 55.0,
          .node = {},
          .slot = kTeeSlot14,
          .key_width_mm = 14.0,
          .key_depth_mm = 5.0,
          .foot = {0.0, 0.0, 9.5, 2.0, 25.0},
          .column = {40.0, 34.0},
          .rest_pad = {24.0, 21.0},
          .pin_holder = {30.0, 24.0},
          .swing_post_mm = 22.0,
          .swing_arm_thickness_mm = 28.0,
          .plates = {{0, 4, 315.0}, {0, 5, 400.0}, {0, 6, 500.0}, {0, 8, 630.0}},
          .riser_heights_mm = {63, 100, 126},
          .spacer_heights_mm = {5, 10, 15, 20, 25, 30, 40, 50, 63, 80},
          .angle_plates = {{2, 2, 30.0}, {2, 3, 30.0}},
          .column_heights_mm = {50, 63, 80, 100},
          .rest_pad_heights_mm = {20, 25, 32, 40, 50},
          .rest_button_heights_mm = {},
          .adjustable_support_heights_mm = {45, 63, 80},
          .support_screw_lengths_mm = {},
          .edge_locator_heights_mm = {45, 63, 80},
          .pins = kShortPins,
          .pin_holders = {{4.0, 8.0}, {6.0, 11.0}},
          .vee_blocks = {{63.0, 90.0, 57.0, 21.0},
                         {126.0, 90.0, 104.0, 40.0},
                         {126.0, 120.0, 104.0, 60.0}},
          .straps = {{14.0, 50.0, 125.0, 40.0, 25.0}, {14.0, 80.0, 200.0, 50.0, 30.0}},
          .heel_screw_lengths_mm = {},
          .edge_clamp_heights_mm = {40, 63},
          .swing_clamps = {{50.0, 33.0, 25.0}, {80.0, 33.0, 25.0}},
          .swing_arm_lengths_mm = {90, 125},
          .studs = {},
          .screws = {},
          .fit_screws = {},
          .nut_threads = {},
          .washer_threads = {},
          .tee_nuts = {{"M10", 14.0, 22.0, 16.0, 8.0}, {"M12", 14.0, 22.0, 16.0, 8.0}},
          .tee_bolt_lengths_mm = {50, 63, 80, 100, 125, 160},
          .keys = {{14.0, 28.0, 10.0}, {14.0, 42.0, 10.0}, {14.0, 63.0, 10.0}},
          .dowel_pins = {}};
}

/// The "building block" kind (USP/CATIC): T-slots 12 every 60 mm both ways, thread M12x1.5 (general
/// knowledge).
System u12() {
  return {.name = "U12",
          .source =
              "building block system, slots 12 mm at 60 mm both ways, M12x1.5: dimensions of "
              "this library",
          .thread = "M12x1.5",
          .pitch_mm = 60.0,
          .plate_height_mm = 60.0,
          .node = {},
          .slot = kTeeSlot12,
          .key_width_mm = 18.0,  // wider than the slot, for the hole of a screw lies in it
          .key_depth_mm = 6.0,
          .foot = {0.0, 0.0, 9.8, 2.0, 24.0},
          .column = {45.0, 36.0},
          .rest_pad = {20.0, 17.0},
          .pin_holder = {32.0, 27.0},
          .swing_post_mm = 24.0,
          .swing_arm_thickness_mm = 30.0,
          .plates = {{4, 4}, {6, 4}, {6, 6}},
          .riser_heights_mm = {60, 90, 120},
          .spacer_heights_mm = {5, 10, 15, 20, 30, 40, 60, 90},
          .angle_plates = {{2, 2, 35.0}, {2, 4, 35.0}},
          .column_heights_mm = {60, 90, 120},
          .rest_pad_heights_mm = {20, 30, 40, 60},
          .rest_button_heights_mm = {},
          .adjustable_support_heights_mm = {50, 70, 90},
          .support_screw_lengths_mm = {45, 65, 85},
          .edge_locator_heights_mm = {45, 60, 90},
          .pins = kShortLargePins,
          .pin_holders = {{8.0, 14.0}, {12.0, 20.0}},
          .vee_blocks = {{60.0, 90.0, 55.0, 20.0}, {120.0, 90.0, 100.0, 40.0}},
          .straps = {{14.0, 45.0, 110.0, 38.0, 22.0}, {14.0, 75.0, 180.0, 45.0, 28.0}},
          .heel_screw_lengths_mm = {40, 55, 75},
          .edge_clamp_heights_mm = {45, 60},
          .swing_clamps = {{45.0, 35.0, 25.0}, {75.0, 35.0, 25.0}},
          .swing_arm_lengths_mm = {85, 115},
          .studs = {{60.0, 20.0, 30.0},
                    {90.0, 25.0, 45.0},
                    {120.0, 25.0, 60.0},
                    {150.0, 25.0, 90.0},
                    {180.0, 25.0, 120.0}},
          .screws = {{"M12x1.5", {30, 40, 50, 60, 70, 80, 100, 120}}},
          .fit_screws = {},
          .nut_threads = {"M12x1.5"},
          .washer_threads = {},
          .tee_nuts = {{"M12x1.5", 12.0, 18.0, 8.0, 8.0}},
          .tee_bolt_lengths_mm = {45, 60, 90, 120, 150},
          .keys = {{12.0, 24.0, 12.0}, {12.0, 36.0, 12.0}, {12.0, 60.0, 12.0}},
          .dowel_pins = {}};
}

}  // namespace

const std::vector<System>& systems() {
  static const std::vector<System> all{h40_12(), h50_16(), t14(), u12()};
  return all;
}

const System& system_called(std::string_view name) {
  const auto found = std::ranges::find(systems(), name, &System::name);
  DOWEL_EXPECTS(found != systems().end());
  return *found;
}

const FastenerSize& fastener_of(const System& system) {
  return fastener_size(system.thread);
}

}  // namespace dowel::library
