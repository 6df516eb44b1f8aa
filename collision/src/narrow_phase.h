#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "dowel/collision/model.h"
#include "dowel/collision/scene.h"
#include "dowel/collision/verdict.h"
#include "dowel/kernel/pose.h"

// Two models in detail. Private to collision.

namespace dowel {

/// Work space of the narrow phase, kept between queries so that they allocate nothing.
struct NarrowScratch {
  struct NodePair {
    std::uint32_t a;
    std::uint32_t b;
  };
  std::vector<NodePair> stack;
};

/// Two models, one placed relative to the other.
struct ModelPair {
  const CollisionModel& a;
  const CollisionModel& b;
  Pose X_BA;                                ///< pose of A in B
  std::span<const ThreadRelief> reliefs_B;  ///< in the frame of B
};

/// The verdict, with witness in the frame of B.
///
/// Interference is only ever said with a witness: a point that lies tolerance / 2 or deeper in both
/// exact solids. Candidates for it are the crossings of facets moved inwards by tolerance / 2 and,
/// where exact faces stand off their facets, the places where facets come near each other; each is
/// moved until it is deep enough in both solids or is given up. Containment is found by points
/// stored deep inside each component.
PairVerdict judge(const ModelPair& pair, const QueryOptions& options, NarrowScratch& scratch,
                  QueryCounters& counters);

/// Lower bound of the distance of the two solids, up to `cap_mm`; 0 where they touch or overlap.
double gap_lower_bound_mm(const ModelPair& pair, HoleMode holes, double cap_mm,
                          NarrowScratch& scratch, QueryCounters& counters);

}  // namespace dowel
