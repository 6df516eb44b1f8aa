#pragma once

#include <algorithm>
#include <array>
#include <optional>
#include <span>

#include "facet_pairs.h"
#include "kept_contact.h"
#include "narrow_phase.h"
#include "witness.h"

// The verdict on one pair. Private to collision: judge.cpp decides in which order to ask, and has
// what forbids interference; judge_contact.cpp and judge_interference.cpp look for either.

namespace dowel {

/// The last few places between two faces from which a search failed: the facets of a fan all begin
/// at the same corner.
class RefutedStarts {
 public:
  bool knows(std::uint32_t face_a, std::uint32_t face_b, const Eigen::Vector3d& start_B) const {
    const std::span known(entries_.data(), std::min(count_, entries_.size()));
    return std::ranges::any_of(known, [&](const Entry& entry) {
      return entry.face_a == face_a && entry.face_b == face_b &&
             (entry.start_B - start_B).squaredNorm() <= kSame_mm * kSame_mm;
    });
  }
  void add(std::uint32_t face_a, std::uint32_t face_b, const Eigen::Vector3d& start_B) {
    entries_[count_++ % entries_.size()] = {face_a, face_b, start_B};
  }

 private:
  static constexpr double kSame_mm = 1.0e-9;  ///< rounding: the corner is one

  struct Entry {
    std::uint32_t face_a = 0;
    std::uint32_t face_b = 0;
    Eigen::Vector3d start_B;
  };
  std::array<Entry, 8> entries_;
  std::size_t count_ = 0;
};

/// Collects the evidence on one pair at one pose.
class Judge {
 public:
  Judge(const ModelPair& pair, const QueryOptions& options, PairMemory& memory,
        NarrowScratch& scratch, QueryCounters& counters)
      : pair_(pair),
        X_AB_(pair.X_BA.inverse()),
        placement_(pair.X_BA),
        options_(options),
        memory_(memory),
        scratch_(scratch),
        counters_(counters),
        erosion_mm_(0.5 * options.tolerance_mm),
        contact_(pair.a, pair.b, options, memory, counters, result_) {}

  /// What was found out at the last pose, tested at this one, at a small part of the cost of
  /// `decide`. False where that decides nothing.
  bool recall();

  /// The verdict, after `recall` gave none.
  PairVerdict decide();

  /// The same by looking at all pairs of facets, without knowing of anything that forbids one or
  /// the other.
  PairVerdict decide_by_brute_force();

  const PairVerdict& result() const { return result_; }

 private:
  bool leaves_out(Skip skip) const { return options_.without.contains(skip); }

  // What forbids interference.

  bool boxes_are_shallow();

  /// Looks for a shaft of one body in a bore of the other. May decide the pair.
  bool shaft_fits();

  /// Whether a shaft's axis passes the middle of the bore within its largest radius.
  static bool may_hold(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                       const AxisProfile& bore);

  bool take_fit(bool shaft_is_in_a, std::uint32_t s, std::uint32_t v);

  /// How far a place is from both bodies, where it is no more than the tolerance: the end of a
  /// tilted shaft is short of the heights that its steps tell.
  std::optional<double> gap_at(const Eigen::Vector3d& place_B) const;

  /// Whether a witness of interference is found from where a shaft is too thick for its bore.
  bool is_deep_at(const Eigen::Vector3d& place_B);

  /// The reliefs as A sees them. Valid until the next call.
  std::span<const ThreadRelief> reliefs_A();

  // Contact.

  void touch(double gap_mm, const Eigen::Vector3d& place_B);

  /// Whether the facets that were in contact still are, or what they slid on.
  bool still_touches();

  /// The same where a place of either is known: there, on any facet near by, or else the two facets
  /// at another place.
  bool touches_at_place();

  /// The same where none is.
  bool touches_again();

  /// Whether a seat of one body is in contact on a plane of the other one.
  bool seat_touches();

  /// Whether facets of two nodes may face each other.
  bool may_face(const BvhNode& a, const BvhNode& b) const;

  /// Whether two flat facets that face each other within the tolerance have an area in common.
  bool faces_lie_on_each_other(std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j);

  /// Whether the exact faces behind two facets come within the tolerance there.
  bool touches(const NarrowScratch::FacetPair& near);

  /// Whether the exact faces behind two facets are found within the tolerance of each other, both
  /// places of the boundary, from `on_b` on.
  bool is_between_faces(std::uint32_t i, std::uint32_t j, const Eigen::Vector3d& on_b);

  /// Places of two faces and their distance.
  struct FaceGap {
    Eigen::Vector3d on_a_A;
    Eigen::Vector3d on_a_B;
    Eigen::Vector3d on_b;
    double gap_mm;
  };

  /// Projects to and fro between the exact faces behind two facets until they are within the
  /// tolerance or come no nearer.
  std::optional<FaceGap> gap_between_faces(std::uint32_t i, std::uint32_t j,
                                           Eigen::Vector3d on_b) const;

  // Interference.

  bool is_clear() const { return result_.verdict == Verdict::Clear; }
  bool is_interference() const { return result_.verdict == Verdict::Interference; }

  /// The cores that overlapped still do.
  bool knows_cores();

  /// Whether cores overlap.
  bool cores_overlap();

  bool take_overlap(const CoreOverlap& overlap);

  /// The ball that the last query found, moved with A, is still deep enough in both, or one close
  /// to it is.
  bool knows_ball();

  /// Whether the facets that led to interference last time do so again.
  bool still_crosses();

  /// Whether a witness of interference is found from the middle of the crossing of two facets moved
  /// inwards. Counts down `tries` where they cross.
  bool crosses_in_the_middle(std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j,
                             int& tries);

  /// Whether a witness of interference is found from two facets.
  bool crosses(const NarrowScratch::FacetPair& near, const PlacedTriangle& a_B);

  /// Where two facets cross that were moved inwards by half the tolerance.
  std::optional<Segment> eroded_crossing(const PlacedTriangle& a_B, const ModelTriangle& b) const;

  /// How far a witness may lie from its start.
  double reach_mm(const ModelTriangle& a, const ModelTriangle& b) const;

  bool try_start(const Eigen::Vector3d& start_B, std::uint32_t i, std::uint32_t j, double reach);

  bool try_witness(const std::optional<Witness>& witness);

  /// Interference, by a ball in both solids. `bound_mm`: how far their faces may be off.
  void tell_interference(double radius_mm, const Eigen::Vector3d& center_B, double bound_mm);

  /// How far faces that are known by their facets alone may be off.
  double unknown_mm() const;

  /// Points stored deep in each solid, against the other.
  void look_for_containment();

  bool try_inner_point(const Eigen::Vector3d& point_B, double depth_mm);

  static bool in_box(const CollisionModel& model, const Eigen::Vector3d& point);

  // Both.

  /// Looks for facets of which one leads to interference, and else for such that are in contact.
  void look_among_facets(bool may_interfere);

  /// Tree against tree: lists the leaves that are near each other. May find flat facets that face
  /// each other, as in most contacts, or facets that cross.
  void list_near_leaves(bool may_interfere, double& apart);

  /// The facets of the listed leaves, one pair after the other.
  void look_at_listed_leaves(bool may_interfere, double& apart);

  /// Two facets that are close enough to stand for places within the tolerance of each other. Else
  /// lowers `apart` to a bound of the distance of these.
  std::optional<NarrowScratch::FacetPair> near_facets(std::uint32_t i, const PlacedTriangle& a_B,
                                                      std::uint32_t j, double& apart);

  bool takes_part(const ModelTriangle& t) const;

  /// Calls `visit(i, facet i of A in B, j)` for all facets until it returns false.
  template <class Visit>
  void for_each_pair(const Visit& visit) const;

  void note_method(std::uint32_t i, std::uint32_t j);

  const ModelPair& pair_;
  Pose X_AB_;
  Placement placement_;
  const QueryOptions& options_;
  PairMemory& memory_;
  NarrowScratch& scratch_;
  QueryCounters& counters_;
  double erosion_mm_;

  /// From where no touch, and no witness of interference, was found.
  RefutedStarts no_touch_from_;
  RefutedStarts no_witness_from_;

  bool is_decided_ = false;
  bool cores_were_asked_ = false;
  std::optional<Eigen::Vector3d> overfull_B_;  // where a shaft is too thick for its bore
  PairVerdict result_;
  KeptContact contact_;
};

}  // namespace dowel
