#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "dowel/kernel/pose.h"
#include "element.h"

namespace dowel::bench {

/// Two elements whose gap, or depth in each other, is known exactly by how they are placed.
struct KnownPair {
  std::string name;
  ElementPtr moving;
  ElementPtr still;
  /// Places the moving element in the still one's frame `gap_mm` apart; negative: as deep in each
  /// other, by the largest ball in both. `turn_rad` changes the pose but not the gap.
  std::function<Pose(double gap_mm, double turn_rad)> X_SM;
  bool is_flat = false;  ///< only planes decide, so that facets are exact
};

/// Two elements in a row of poses, with the gap in each; negative: as deep in each other.
struct PlacedPair {
  std::string name;
  ElementPtr moving;
  ElementPtr still;
  std::vector<Pose> X_SM;
  std::vector<double> gaps_mm;
};

/// How the elements of known pairs are made. Radii and lengths are those of fixture elements at
/// `scale` 1; gaps are not scaled.
struct PairMesh {
  double facet_error_mm = 0.1;  ///< of curved faces, at scale 1
  double scale = 1.0;
};

/// Pin in a hole, cylinder lying on a plane, beside and across a post, ball on a plane, cone in its
/// countersink; block and drilled riser on a plane.
std::vector<KnownPair> known_pairs(const PairMesh& mesh);

/// The flat ones, and harder: faces made of slivers `sliver_mm` wide.
KnownPair sliver_pair(double sliver_mm);

/// Edges of two square bars that cross at `angle_rad`, one above the other.
KnownPair crossed_edges(double angle_rad);

/// A gap from `-reach_mm` to `reach_mm` and back, again and again, all magnitudes from `least_mm`
/// on for equally long: `s` from 0 to 1.
double swept_gap_mm(double s, double least_mm, double reach_mm);

}  // namespace dowel::bench
