#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "dowel/catalog/element.h"

namespace dowel {

/// What there is along the axis of a fastener: a cylinder of some part's hole, by depth from where
/// the head is seated.
struct BoreStretch {
  double from_mm = 0.0;
  double to_mm = 0.0;
  double diameter_mm = 0.0;
  std::size_t hole = 0;  ///< whose: an index of the caller's
};

/// A standard part by what fastening needs of it.
struct Fastener {
  enum class Kind { Screw, Washer, Nut, TeeNut };
  Kind kind = Kind::Screw;
  std::string element;
  double nominal_mm = 0.0;        ///< of its thread; washer: the largest thread that goes through
  double length_mm = 0.0;         ///< screw: from under the head to the tip; others: height
  double thread_end_mm = 0.0;     ///< screw: from under the head to the last full thread
  double head_diameter_mm = 0.0;  ///< screw, washer: outside
  std::string feature;            ///< screw: its shaft; others: their hole
  double core_diameter_mm = 0.0;  ///< nut, T-nut: of its hole
  double foot_height_mm = 0.0;    ///< T-nut: of what is under the slot's throat
  double foot_width_mm = 0.0;     ///< T-nut
};

/// The screw, washer, nut or T-nut that an element is, by its name ("screw-M12x55", "tee-nut-M12")
/// and its features; nothing where it is none.
std::optional<Fastener> fastener_of(const Element& element);

/// A way of fastening.
struct Fastening {
  Fastener screw;
  std::optional<Fastener> washer;   ///< under the head, where this has no counterbore
  std::optional<Fastener> nut;      ///< behind the last part, where none has a thread
  std::optional<Fastener> tee_nut;  ///< in the slot below the last part
  std::size_t thread = 0;           ///< hole of the stretch that the screw engages; none with a nut
  double grip_mm = 0.0;             ///< from under the head to where the thread begins
  double engagement_mm = 0.0;       ///< of full threads
  double spare_mm = 0.0;            ///< from the tip to the end of the thread; a nut: tip beyond it
};

/// What fastening found, and why not more.
struct FasteningChoices {
  std::vector<Fastening> ways;  ///< best first: the shortest screw that holds
  std::string reason;           ///< where there is no way: one sentence with the numbers
};

struct FasteningOptions {
  /// Full threads in use, in diameters: as much as steel in steel needs.
  double engagement_in_diameters = 1.0;
  bool needs_washer = false;  ///< the head stands on a face, not in a counterbore
};

/// Chooses screws for a bore. The screw passes every stretch before the first that is a core hole
/// of its thread, engages it by `engagement_in_diameters` or more, and ends one pitch short of the
/// end of that thread or more, so that it does not run out of it. Where no stretch is a core hole,
/// a nut behind the last one takes its place, and the screw looks out of it by one to six pitches.
/// `stretches`: sorted by depth.
FasteningChoices choose_fastening(std::span<const BoreStretch> stretches,
                                  std::span<const Fastener> fasteners,
                                  const FasteningOptions& options);

}  // namespace dowel
