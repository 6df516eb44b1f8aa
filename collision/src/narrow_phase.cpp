#include "narrow_phase.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "facet_pairs.h"
#include "judge.h"
#include "kept_off.h"
#include "triangle_pair.h"

namespace dowel {
namespace {

/// Lower bound of the distance of what two facets stand for; `limit_mm` where it is no less.
double gap_below(double limit_mm, const ModelTriangle& a, const PlacedTriangle& a_B,
                 const ModelTriangle& b) {
  const double slack = a.slack_mm + b.slack_mm;
  const double reach = limit_mm + slack;
  if (apart_by_planes(a, a_B, b) > limit_mm || box_gap(a_B.corners_B, b.corners) > reach ||
      beyond_edges(b.corners, b.normal, a_B.corners_B) > reach ||
      beyond_edges(a_B.corners_B, a_B.normal_B, b.corners) > reach) {
    return limit_mm;
  }
  const ClosestPair closest = closest_points(a_B.corners_B, a_B.normal_B, b.corners, b.normal);
  return std::sqrt(closest.distance_squared_mm2) - slack;
}

}  // namespace

PairVerdict judge(const ModelPair& pair, const QueryOptions& options, PairMemory& memory,
                  NarrowScratch& scratch, QueryCounters& counters) {
  Judge judge(pair, options, memory, scratch, counters);
  return judge.recall() ? judge.result() : judge.decide();
}

PairVerdict judge_by_brute_force(const ModelPair& pair, const QueryOptions& options,
                                 NarrowScratch& scratch, QueryCounters& counters) {
  PairMemory memory;
  return Judge(pair, options, memory, scratch, counters).decide_by_brute_force();
}

double gap_lower_bound_mm(const ModelPair& pair, HoleMode holes, double cap_mm,
                          const KeptOff& kept_off_a, const KeptOff& kept_off_b,
                          NarrowScratch& scratch, QueryCounters& counters) {
  double best = cap_mm;
  const Placement placement(pair.X_BA);
  for_each_leaf_pair(
      pair, scratch, counters,
      [&](const BvhNode& a, const BvhNode& b) {
        return !kept_off_a.contains(a) && !kept_off_b.contains(b);
      },
      [&](double gap) { return gap < best && best > 0.0; },
      [&](const BvhNode& leaf_a, const BvhNode& leaf_b) {
        double left_out = std::numeric_limits<double>::infinity();  // is no less than best
        for_each_near_pair(
            pair, placement, leaf_a, leaf_b, best, left_out,
            [&](const ModelTriangle& t) { return holes == HoleMode::Exact || !t.is_hole; },
            [&](std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
              ++counters.triangle_tests;
              best = std::min(best,
                              gap_below(best, pair.a.triangles()[i], a_B, pair.b.triangles()[j]));
              return true;
            });
        return best > 0.0;
      });
  return std::max(best, 0.0);
}

}  // namespace dowel
