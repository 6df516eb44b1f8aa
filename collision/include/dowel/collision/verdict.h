#pragma once

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

struct QueryOptions {
  double tolerance_mm = kDefaultTolerance_mm;
  HoleMode holes = HoleMode::Exact;
  bool first_only = false;     ///< stop at the first interference
  bool measure_depth = false;  ///< improve the lower bound of an interference's depth
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
