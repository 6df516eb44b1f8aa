#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "known_pair.h"

namespace dowel::bench {

/// Exact solids like those of fixtures (plates with holes, pins, nuts, cones, tori, rounded blocks)
/// in pairs that OpenCascade has judged: from 1 mm apart to 1 mm moved into each other along the
/// shortest way between them. Made once, then faceted as finely as asked.
class SolidPairs {
 public:
  /// Throws Error where OpenCascade cannot mesh a solid.
  explicit SolidPairs(std::size_t count);
  ~SolidPairs();
  SolidPairs(const SolidPairs&) = delete;
  SolidPairs& operator=(const SolidPairs&) = delete;

  /// The paths' gaps are OpenCascade's distances; where the Boolean's volume holds a ball, minus
  /// the diameter of the largest that was found, which is no more than the depth. Poses that
  /// OpenCascade leaves open within twice `kTolerance_mm` are not among them.
  std::vector<PlacedPair> faceted(double facet_error_mm) const;

  static constexpr double kTolerance_mm = 1.0e-3;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace dowel::bench
