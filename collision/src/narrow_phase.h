#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "dowel/collision/model.h"
#include "dowel/collision/scene.h"
#include "dowel/collision/verdict.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/pose.h"

// Two models in detail. Private to collision.

namespace dowel {

class KeptOff;

/// A share of the tolerance that certificates keep for rounding.
inline constexpr double kSafety = 1.0e-6;

/// Work space of the narrow phase, kept between queries so that they allocate nothing.
struct NarrowScratch {
  struct NodePair {
    std::uint32_t a;
    std::uint32_t b;
    double gap_mm;  ///< lower bound of the distance of the nodes' boxes
  };
  struct LeafPair {
    const BvhNode* a;
    const BvhNode* b;
    bool may_cross;  ///< neither is kept off the other body
  };
  /// Facets of A and B within the tolerance of each other and what their faces stand off them.
  struct FacetPair {
    std::uint32_t a;
    std::uint32_t b;
    bool is_flat;  ///< neither stands for a curved boundary
    Eigen::Vector3d on_a_B;
    Eigen::Vector3d on_b;
  };
  std::vector<NodePair> stack;
  std::vector<LeafPair> leaves;  ///< that are near each other
  std::vector<FacetPair> facets;
  std::vector<ThreadRelief> reliefs_A;  ///< of a pair, in the frame of A
};

/// Two models, one placed relative to the other.
struct ModelPair {
  const CollisionModel& a;
  const CollisionModel& b;
  const Obb& obb_a;                         ///< in the frame of A
  const Obb& obb_b;                         ///< in the frame of B
  Pose X_BA;                                ///< pose of A in B
  std::span<const ThreadRelief> reliefs_B;  ///< in the frame of B
};

/// What the last query found out about a pair and the next one tries first. Nothing in it is
/// believed without a test at the new pose, so that it never changes a verdict.
struct PairMemory {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  /// Plane of the boxes along which they overlapped by less than the tolerance, -1: none.
  std::int8_t shallow_plane = -1;

  /// Shaft and bore that fit, one in each body.
  bool shaft_is_in_a = true;
  std::uint32_t shaft = kNone;
  std::uint32_t bore = kNone;

  /// Facets that were in contact, and a place on the exact face of each where they were, in the
  /// frame of its body.
  std::uint32_t contact_a = kNone;
  std::uint32_t contact_b = kNone;
  bool has_contact_place = false;
  Eigen::Vector3d contact_A = Eigen::Vector3d::Zero();
  Eigen::Vector3d contact_B = Eigen::Vector3d::Zero();

  /// Facets whose crossing led to interference.
  std::uint32_t crossing_a = kNone;
  std::uint32_t crossing_b = kNone;

  /// Cores that overlapped, and a point of both in the frame of A.
  std::uint32_t core_a = kNone;
  std::uint32_t core_b = kNone;
  /// Cores that were apart are asked again after some poses, each time twice as many.
  int poses_without_cores = 0;
  int poses_until_cores = 0;
  Eigen::Vector3d in_cores_A = Eigen::Vector3d::Zero();

  /// A ball in both bodies: its centre and its depth in each; depth 0: none.
  Eigen::Vector3d ball_A = Eigen::Vector3d::Zero();
  Eigen::Vector3d ball_B = Eigen::Vector3d::Zero();
  double ball_depth_a_mm = 0.0;
  double ball_depth_b_mm = 0.0;

  /// Whether the pair was in contact at a known place and its boxes left no room for more.
  bool may_rest() const { return shallow_plane >= 0 && contact_a != kNone && has_contact_place; }

  bool is_empty() const {
    return shaft == kNone && contact_a == kNone && core_a == kNone && ball_depth_a_mm <= 0.0;
  }
};

/// The verdict, with witness in the frame of B.
///
/// Interference is only ever said with a witness: a point that lies tolerance / 2 or deeper in both
/// exact solids. First it is asked whether there can be one at all: not where the boxes overlap by
/// less than the tolerance along one of their planes, nor where a shaft is in a bore that leaves it
/// room (axis_profile.h). Candidates for a witness are the crossings of facets moved inwards by
/// tolerance / 2 and, where exact faces stand off their facets, the places where facets come near
/// each other; each is moved until it is deep enough in both solids or is given up. Containment is
/// found by points stored deep inside each component.
PairVerdict judge(const ModelPair& pair, const QueryOptions& options, PairMemory& memory,
                  NarrowScratch& scratch, QueryCounters& counters);

/// The same by looking at all pairs of facets. Reference for tests.
PairVerdict judge_by_brute_force(const ModelPair& pair, const QueryOptions& options,
                                 NarrowScratch& scratch, QueryCounters& counters);

/// Lower bound of the distance of the two solids without what is kept off the other one, up to
/// `cap_mm`; 0 where they touch or overlap.
double gap_lower_bound_mm(const ModelPair& pair, HoleMode holes, double cap_mm,
                          const KeptOff& kept_off_a, const KeptOff& kept_off_b,
                          NarrowScratch& scratch, QueryCounters& counters);

}  // namespace dowel
