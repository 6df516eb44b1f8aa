#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dimensions.h"

/// The modular systems: one row of numbers each, from which all elements are made.
namespace dowel::library {

/// A node of a hole system: locating bore H7 over a coaxial thread.
struct NodeSize {
  double bore_mm = 0.0;
  double bore_depth_mm = 0.0;    ///< the thread starts here, 1.25 d
  double thread_depth_mm = 0.0;  ///< full thread of a blind node ends here
};

/// What screws a turned element in, from its seat down: a shank that locates, a relief, a thread.
struct FootSize {
  double shank_mm = 0.0;         ///< middle of g6
  double shank_length_mm = 0.0;  ///< 0: no shank
  double relief_diameter_mm = 0.0;
  double relief_length_mm = 0.0;
  double length_mm = 0.0;
};

/// Fit screw: below its shank and the relief of the foot comes a thread of this length.
struct FitScrewSizes {
  double thread_length_mm = 0.0;
  std::vector<int> lengths_mm;
};

/// Bodies of turned elements: diameter, width across two flats.
struct TurnedSize {
  double diameter_mm = 0.0;
  double wrench_mm = 0.0;
};

struct PlateSize {
  /// Nodes along x; where the system has crossing slots instead, those that run along y.
  int columns = 0;
  int rows = 0;            ///< nodes along y; slots along x
  double length_mm = 0.0;  ///< along x, where no columns tell it
};

struct AnglePlateSize {
  int columns = 0;  ///< of nodes or tapped holes on the upright, across
  int rows = 0;     ///< upwards
  double foot_height_mm = 0.0;
};

/// Carrier of locating pins: bore for the shank, depth.
struct PinHolderSize {
  double bore_mm = 0.0;
  double depth_mm = 0.0;
};

struct VeeBlockSize {
  double width_mm = 0.0;
  double angle_deg = 0.0;
  double height_mm = 0.0;      ///< 0.75 width and 10 mm
  double screw_seat_mm = 0.0;  ///< height of the counterbore's floor
};

/// Post of a swing clamp: base, post that the arm turns about, thread for its nut.
struct SwingClampSize {
  double base_height_mm = 0.0;
  double post_length_mm = 0.0;
  double thread_length_mm = 0.0;
};

/// Socket head cap screws of one thread, lengths of ISO 888.
struct ScrewSizes {
  std::string_view thread;
  std::vector<int> lengths_mm;
};

/// Key between a slot and the key slot of an element, half of its height in each; the upper half is
/// as wide as the key slot.
struct KeySize {
  double width_mm = 0.0;
  double length_mm = 0.0;
  double height_mm = 0.0;
};

struct System {
  std::string_view name;
  std::string_view source;  ///< where its dimensions come from
  std::string_view thread;
  double pitch_mm = 0.0;
  double plate_height_mm = 0.0;
  std::optional<NodeSize> node;     ///< a hole system
  std::optional<TeeSlotSize> slot;  ///< a slot system
  double key_width_mm = 0.0;        ///< of the key slot below an element
  double key_depth_mm = 0.0;        ///< its depth; 0: none
  FootSize foot;
  TurnedSize column;
  TurnedSize rest_pad;
  TurnedSize pin_holder;
  double swing_post_mm = 0.0;  ///< diameter, h9
  double swing_arm_thickness_mm = 0.0;

  std::vector<PlateSize> plates;
  std::vector<int> riser_heights_mm;
  std::vector<int> spacer_heights_mm;
  std::vector<AnglePlateSize> angle_plates;
  std::vector<int> column_heights_mm;
  std::vector<int> rest_pad_heights_mm;
  std::vector<int> rest_button_heights_mm;
  std::vector<int> adjustable_support_heights_mm;
  std::vector<int> support_screw_lengths_mm;
  std::vector<int> edge_locator_heights_mm;
  std::vector<PinSize> pins;
  std::vector<PinHolderSize> pin_holders;
  std::vector<VeeBlockSize> vee_blocks;
  std::vector<StrapSize> straps;
  std::vector<int> heel_screw_lengths_mm;
  std::vector<int> edge_clamp_heights_mm;
  std::vector<SwingClampSize> swing_clamps;
  std::vector<int> swing_arm_lengths_mm;
  std::vector<StudSize> studs;
  std::vector<ScrewSizes> screws;
  std::optional<FitScrewSizes> fit_screws;
  std::vector<std::string_view> nut_threads;
  std::vector<std::string_view> washer_threads;
  std::vector<TeeNutSize> tee_nuts;
  std::vector<int> tee_bolt_lengths_mm;
  std::vector<KeySize> keys;
  std::vector<DowelPinSize> dowel_pins;
};

/// H40-12, H50-16, T14, U12.
const std::vector<System>& systems();

/// The row called `name`. Expects: there is one.
const System& system_called(std::string_view name);

/// Thread of the system, and all that goes with it.
const FastenerSize& fastener_of(const System& system);

}  // namespace dowel::library
