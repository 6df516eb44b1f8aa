#pragma once

#include <string>
#include <vector>

#include "dowel/catalog/element.h"
#include "dowel/kernel/pose.h"

namespace dowel {

/// A feature of an element and the one of another part that it goes with.
struct FeaturePair {
  std::string moving;
  std::string fixed;

  bool operator==(const FeaturePair&) const = default;
};

/// One way of standing an element on a part B with all its holes on holes.
struct PatternWay {
  Pose X_BE;
  /// By which it is turned on B against the way in which its x axis is that of B, or as near to it
  /// as B's face allows; counter-clockwise from above, in [0, 2 pi).
  double turn_rad = 0.0;
  std::vector<FeaturePair> pairs;  ///< by the order of the element's holes
};

/// The planar face that looks down (against z) and lies lowest, the larger of two at one height;
/// nothing where there is none.
const Feature* bottom_face(const Element& element);

/// The holes and shafts by which an element is held on what it stands on: square to its bottom and
/// reaching it, but for what is surely the core hole of a thread, which holds what stands on it.
std::vector<const Feature*> feet_of(const Element& element);

/// All ways of standing `element` on `part` so that each of its feet is on a hole that opens in the
/// plane of hole `at`, and one of them on `at` itself. Sorted by turn, then by the foot on `at`. An
/// element with one foot has one way, and can be turned. Where no way has all feet on holes, those
/// that could be core holes of threads need not be. None where it has no bottom or no feet, or
/// where the holes do not match within kCoaxial_mm.
std::vector<PatternWay> pattern_ways(const Element& element, const Element& part,
                                     const Feature& at);

/// Holes and shafts of `element` at X_BE that go with those of `part`, as `insert` would place
/// them: on one axis (within kCoaxial_mm, kCoaxial_rad), end on end, and fitting.
std::vector<FeaturePair> matching_pairs(const Element& element, const Pose& X_BE,
                                        const Element& part);

/// Of several pairs those by which a part is mated: `first`, if it is among them, and the one
/// farthest from it.
std::vector<FeaturePair> holding_pairs(const std::vector<FeaturePair>& pairs,
                                       const Element& element, const std::string& first_fixed);

}  // namespace dowel
