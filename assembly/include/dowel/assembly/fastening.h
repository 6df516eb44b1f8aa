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
  enum class Kind { Screw, Washer, Nut, TeeNut, TeeBolt, SphericalWasher, ConicalSeat };
  Kind kind = Kind::Screw;
  std::string element;
  double nominal_mm = 0.0;  ///< of its thread; washer: the largest thread that goes through
  double pitch_mm = 0.0;    ///< of its thread; 0: the coarse one
  /// Screw: from under the head to the tip; T-bolt: from the shoulder; others: height.
  double length_mm = 0.0;
  double thread_end_mm = 0.0;     ///< screw, T-bolt: likewise, to the last full thread
  double head_diameter_mm = 0.0;  ///< screw, washer, nut, seat: outside; nut: of what it bears on
  bool has_collar = false;        ///< nut: needs no washer
  bool flip = false;              ///< collar nut, spherical washer: stands on its hole's opening
  std::string feature;            ///< screw, T-bolt: its shaft; others: their hole
  double hole_diameter_mm = 0.0;  ///< nut, T-nut: of its core hole; washer, seat: of its hole
  double foot_height_mm = 0.0;    ///< T-nut, T-bolt: of what is under the slot's throat
  double foot_width_mm = 0.0;     ///< T-nut, T-bolt: the wider way across
  double foot_diagonal_mm = 0.0;  ///< T-nut, T-bolt: of the foot's corners; round: its diameter
  double neck_height_mm = 0.0;    ///< T-nut, T-bolt: of what is in the throat; 0: no neck
  double ball_radius_mm = 0.0;    ///< spherical washer
  double mouth_mm = 0.0;          ///< conical seat: diameter of its cone where it is widest
  double cone_rad = 0.0;          ///< conical seat: between cone and axis
};

/// The fastener that an element is, by its name ("screw-M12x55", "tee-nut-M12", "tee-bolt-M12x80",
/// "collar-nut-M12", "spherical-washer-M12", "conical-seat-M12") and its features; nothing where it
/// is none.
std::optional<Fastener> fastener_of(const Element& element);

/// Height of a spherical washer in its seat, both level, from the seat's bottom to the washer's
/// top: the ball touches the cone in the circle where both have one normal. Nothing where the two
/// do not go together. Source: DIN 6319, forms C with D and G.
std::optional<double> pair_height_mm(const Fastener& spherical_washer, const Fastener& seat);

/// A way of fastening.
struct Fastening {
  Fastener screw;                        ///< or T-bolt, its head in the slot below the last part
  std::optional<Fastener> conical_seat;  ///< under a spherical washer
  std::optional<Fastener> washer;        ///< under the head or a T-bolt's nut
  std::optional<Fastener> nut;           ///< behind the last part; of a T-bolt on the first
  std::optional<Fastener> tee_nut;       ///< in the slot below the last part
  double seat_mm = 0.0;                  ///< depth at which the head, its nut or its washer sits
  std::size_t thread = 0;  ///< hole of the stretch that the screw engages; slot of a T-bolt
  double grip_mm = 0.0;    ///< from under the head, or the T-bolt's shoulder, to the thread or nut
  double engagement_mm = 0.0;  ///< of full threads
  double spare_mm = 0.0;       ///< from the tip to the end of the thread; a nut: tip beyond it

  /// From the seat to under the head or nut.
  double lift_mm() const;
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
/// a nut behind the last one takes its place, and the screw looks out of it by one to six pitches;
/// nuts with a collar are ways of their own. Threads of one diameter with another pitch do not go
/// together. `stretches`: sorted by depth.
FasteningChoices choose_fastening(std::span<const BoreStretch> stretches,
                                  std::span<const Fastener> fasteners,
                                  const FasteningOptions& options);

/// Chooses a T-bolt that comes up through a bore, its shoulder at depth `shoulder_mm`, and what
/// goes on it: washer and nut, a collar nut, a spherical washer in its seat and a nut. What stands
/// on the face is wider than `mouth_mm`. For each the shortest T-bolt that looks out of the nut by
/// a pitch or more.
FasteningChoices choose_tee_bolt(std::span<const BoreStretch> stretches,
                                 std::span<const Fastener> fasteners, double shoulder_mm,
                                 double mouth_mm);

}  // namespace dowel
