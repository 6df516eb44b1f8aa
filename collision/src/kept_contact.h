#pragma once

#include <cstdint>

#include "narrow_phase.h"

// The contact of the last pose at this one. Private to collision.

namespace dowel {

/// Notes what facets `i` of A and `j` of B are known by, and how far they may be off the solids.
void note_method(const CollisionModel& a, std::uint32_t i, const CollisionModel& b, std::uint32_t j,
                 PairVerdict& verdict);

/// Asks places of either body that touched the other one whether they do so still.
class KeptContact {
 public:
  KeptContact(const CollisionModel& a, const CollisionModel& b, const QueryOptions& options,
              PairMemory& memory, QueryCounters& counters, PairVerdict& verdict)
      : a_(a), b_(b), options_(options), memory_(memory), counters_(counters), verdict_(verdict) {}

  /// Whether the places remembered still touch: that of A on the facet of B or on what it slid to,
  /// or that of B on A. Then the verdict is contact, its witness in the frame of B. `in_B` and
  /// `in_A` bring a point of the one frame to the other.
  template <class InB, class InA>
  bool holds(const InB& in_B, const InA& in_A) const {
    const std::uint32_t i = memory_.contact_a;
    const std::uint32_t j = memory_.contact_b;
    const Eigen::Vector3d& place_A = memory_.contact_A;
    const Eigen::Vector3d& place_B = memory_.contact_B;
    const bool may_slide = options_.holes == HoleMode::Exact;
    const Eigen::Vector3d on_a_B = in_B(place_A);
    const Footing on_b = may_slide ? b_.walk_towards(j, on_a_B) : Footing{j};
    if (touches_at(i, place_A, on_a_B, on_b)) return true;
    const Eigen::Vector3d on_b_A = in_A(place_B);
    const Footing on_a = may_slide ? a_.walk_towards(i, on_b_A) : Footing{i};
    return touched_at(on_a, on_b_A, j, place_B, in_B);
  }

  /// Whether a place of A's facet `i` is within the tolerance of what a facet of B stands for.
  bool touches_at(std::uint32_t i, const Eigen::Vector3d& on_a_A, const Eigen::Vector3d& on_a_B,
                  const Footing& on_b) const;

  /// The same for a place of B's facet `j`.
  template <class InB>
  bool touched_at(const Footing& on_a, const Eigen::Vector3d& on_b_A, std::uint32_t j,
                  const Eigen::Vector3d& on_b_B, const InB& in_B) const {
    const auto on_a_A = place_near(a_, on_a, on_b_A);
    if (on_a_A) touch(on_a.triangle, *on_a_A, in_B(*on_a_A), j, on_b_B);
    return on_a_A.has_value();
  }

  /// Contact of facets `i` and `j`, at a place of either's face.
  void touch(std::uint32_t i, const Eigen::Vector3d& on_a_A, const Eigen::Vector3d& on_a_B,
             std::uint32_t j, const Eigen::Vector3d& on_b_B) const;

 private:
  /// The place of what a facet stands for that is nearest to `p`, where it is within the tolerance.
  std::optional<Eigen::Vector3d> place_near(const CollisionModel& model, const Footing& footing,
                                            const Eigen::Vector3d& p) const;

  const CollisionModel& a_;
  const CollisionModel& b_;
  const QueryOptions& options_;
  PairMemory& memory_;
  QueryCounters& counters_;
  PairVerdict& verdict_;
};

/// A body where it is asked about: its pose as a matrix and a vector, as its places go to the world
/// and back at each move.
struct PlacedModel {
  const CollisionModel& model;
  const Eigen::Matrix3d& rotation_WM;
  const Eigen::Vector3d& translation_WM;
  const Obb& obb_W;

  Eigen::Vector3d in_world(const Eigen::Vector3d& p_M) const {
    return rotation_WM * p_M + translation_WM;
  }
  Eigen::Vector3d seen_from(const Eigen::Vector3d& p_W) const {
    return rotation_WM.transpose() * (p_W - translation_WM);
  }
};

/// Whether a pair that may rest does so, before anything is set up for it: the plane along which
/// the boxes overlapped by less than the tolerance tells so again, and the places remembered still
/// touch. Then `verdict` is contact, its witness in the world. Expects: `memory.may_rest()`.
bool still_rests(const PlacedModel& a, const PlacedModel& b, const QueryOptions& options,
                 PairMemory& memory, QueryCounters& counters, PairVerdict& verdict);

}  // namespace dowel
