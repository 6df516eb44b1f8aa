#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/assembly/fastening.h"
#include "dowel/assembly/session.h"
#include "dowel/assembly/stack.h"

namespace dowel {

/// Spacers from the project and the catalogue that reach a height on a hole.
struct StackPlan {
  FeatureName on;
  double height_mm = 0.0;
  /// Ways, best first; never empty. See `stack_choices`.
  std::vector<std::vector<Spacer>> ways;
};

/// Elements named spacer-... of the family of the part below, or of any where it has none. Throws
/// Error{InvalidInput} where they do not reach the height, with the heights that there are.
StackPlan plan_stack(Session& session, double height_mm, const FeatureName& on);

/// Places the spacers of `way` (from 0) on each other, mated hole on hole; without a command only
/// tells what would come of it.
std::vector<MoveReport> stack(Session& session, const StackPlan& plan, std::size_t way,
                              std::optional<std::string_view> command);

/// What fastens the parts along a hole.
struct FasteningPlan {
  FeatureName hole;
  /// On the axis; what `Fastening::thread` counts. Last the T-slot, where there is one below.
  std::vector<FeatureName> holes;
  std::vector<Fastening> ways;  ///< best first; never empty
};

/// Fasteners so named (see `fastener_of`), each kind of the family of the part, or of any where it
/// has none. A head goes into the counterbore of the hole where it has one that is wide enough,
/// else onto its face, with a washer where there is one. Where the bore ends over a T-slot, in its
/// middle, a T-nut that fits the slot takes the screw, drawn up under the throat; or a T-bolt comes
/// up from there and takes a nut on the face. Ways that hold by 0.9 d come first. Throws
/// Error{InvalidInput} with the reason and numbers where nothing fastens.
FasteningPlan plan_fastening(Session& session, const FeatureName& hole);

/// Places the parts of `way` (from 0), mated with the hole and each other; without a
/// command only tells what would come of it.
std::vector<MoveReport> fasten(Session& session, const FasteningPlan& plan, std::size_t way,
                               std::optional<std::string_view> command);

}  // namespace dowel
