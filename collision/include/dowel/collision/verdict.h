#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

#include <Eigen/Core>

#include "dowel/kernel/tolerance.h"

namespace dowel {

/// Ordered by severity, with tolerance t: Interference: depth > t. Contact: not interference and
/// gap <= t. Clear: otherwise. Gap is the smallest distance between the solids; depth the diameter
/// of the largest ball that fits into both at once.
enum class Verdict : std::uint8_t { Clear, Contact, Interference };

std::string_view to_string(Verdict verdict);

/// Which layer of the pipeline decided.
enum class Method : std::uint8_t { Boxes, Facets, Exact };

std::string_view to_string(Method method);

/// How hole triangles take part. Exact: wherever they could change a verdict. Paper: never, as in
/// Peng et al. 2009 (a pin in a hole that is too small goes unseen).
enum class HoleMode : std::uint8_t { Exact, Paper };

/// What spares a query work, and never changes a verdict.
enum class Skip : std::uint8_t {
  Way,           ///< who is further than a body has gone since is not asked about
  Layers,        ///< layers, cells and intervals: only who is there is a candidate
  Silhouettes,   ///< candidates whose silhouettes are apart are none
  Planes,        ///< a plane that keeps the boxes apart
  Memory,        ///< what decided on a pair last time is tried first
  ShallowBoxes,  ///< no interference is sought where the boxes have no room for one
  Fits,          ///< a shaft in its bore is judged by their profiles
  Cores,         ///< blocks and bars inside the solids that overlap tell an interference
  Seats,         ///< places of planar faces tell a contact
  KeptOff,       ///< no interference is sought behind planes that have the other body before them
};
inline constexpr std::size_t kSkipCount = 10;

std::string_view to_string(Skip skip);

/// A set of skips.
class SkipSet {
 public:
  constexpr SkipSet() = default;
  constexpr explicit SkipSet(Skip skip) : bits_(1U << static_cast<unsigned>(skip)) {}

  static constexpr SkipSet all() {
    SkipSet result;
    result.bits_ = (1U << kSkipCount) - 1U;
    return result;
  }

  constexpr bool contains(Skip skip) const {
    return (bits_ >> static_cast<unsigned>(skip) & 1U) != 0;
  }
  constexpr SkipSet operator|(SkipSet other) const {
    other.bits_ |= bits_;
    return other;
  }
  constexpr bool operator==(const SkipSet&) const = default;

 private:
  std::uint32_t bits_ = 0;
};

struct QueryOptions {
  double tolerance_mm = kDefaultTolerance_mm;
  HoleMode holes = HoleMode::Exact;
  bool first_only = false;     ///< stop at the first interference
  bool measure_depth = false;  ///< improve the lower bound of an interference's depth
  /// Left out, to measure what a skip is worth and to test that no verdict depends on it. Sweeps
  /// and checks of a whole scene leave out what spares work within a pair.
  SkipSet without = {};
};

/// Answer for one pair of bodies.
struct PairVerdict {
  Verdict verdict = Verdict::Clear;
  Method method = Method::Boxes;
  /// Interference: a lower bound of the depth, proven by `witness`. Else 0.
  double depth_mm = 0.0;
  /// Contact: distance at `witness`. Clear: a lower bound of the gap. Interference: 0.
  double gap_mm = 0.0;
  /// Interference: a point inside both solids, depth_mm / 2 or more from both boundaries. Contact:
  /// a point within gap_mm of both. Clear: unspecified. World frame.
  Eigen::Vector3d witness_W = Eigen::Vector3d::Zero();
  /// How far the geometry that decided may be off the exact solids: 0 but for faces that are known
  /// by their facets alone.
  double bound_mm = 0.0;
};

}  // namespace dowel
