#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/assembly/feature_index.h"
#include "dowel/assembly/session.h"

namespace dowel {

/// How far from its goal a part may be.
struct SnapReach {
  double reach_mm = 25.0;   ///< between the features that go together
  double reach_rad = 0.35;  ///< between their directions; 20 degrees
};

/// A place where a part would be held, and by which mates.
struct SnapOffer {
  FeatureMatch match = FeatureMatch::Fit;
  Pose X_WI;
  std::vector<Mate> mates;  ///< one or two; without numbers
  /// Of the first mate's shaft and bore, as drawn; nothing for other mates.
  std::optional<double> clearance_mm;
  double travel_mm = 0.0;  ///< of the part's middle
  double turn_rad = 0.0;
  Verdict verdict = Verdict::Clear;  ///< there; `places_for`, and `snap_offers` where asked
};

/// The mates that fit for an instance near its goal, best first: by the way that the part goes
/// (turns counted at kMateArm_mm), to which looser matches and faces add some millimetres. They are
/// found by an index over the features of all other parts. Where a second hole or shaft of the part
/// comes near its match once the first is in place, the part is turned onto it, too.
std::vector<SnapOffer> snap_offers(Session& session, std::string_view instance,
                                   const SnapReach& reach);

/// The same by trying all features with all others. Reference for tests.
std::vector<SnapOffer> snap_offers_brute_force(Session& session, std::string_view instance,
                                               const SnapReach& reach);

/// Where in the project an element can go by its shafts, else by the holes that it stands on, else
/// as a key into a slot; only places where it interferes with nothing. Best match first, then by
/// order of placing and features.
std::vector<SnapOffer> places_for(Session& session, std::string_view element);

/// Mates that hold as the parts stand and that nobody made: shafts in holes, holes on holes, faces
/// on faces, each later part with earlier ones. As found in parts that came from a STEP assembly.
std::vector<Mate> recognise_mates(Session& session);

}  // namespace dowel
