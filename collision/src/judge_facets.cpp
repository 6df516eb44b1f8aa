// What two bodies' facets say of them where nothing else decides.

#include <algorithm>
#include <cmath>
#include <limits>

#include "judge.h"
#include "kept_off.h"
#include "triangle_pair.h"

namespace dowel {
namespace {

/// Facets that cross are asked while the trees are walked, but no more of them than this: bodies
/// that are no deeper in each other than the tolerance have many.
constexpr int kEarlyCrossings = 4;

/// Lower bound of a box's height before a plane.
double height_of(const Obb& box, const PlaneSurface& plane) {
  const double reach = (box.axes.transpose() * plane.normal).cwiseAbs().dot(box.half_extents_mm);
  return plane.normal.dot(box.center - plane.origin) - reach;
}

}  // namespace

void Judge::look_among_facets(bool may_interfere) {
  double apart = std::numeric_limits<double>::infinity();
  scratch_.leaves.clear();
  scratch_.facets.clear();
  list_near_leaves(may_interfere, apart);
  if (is_interference() || (!may_interfere && !is_clear())) return;
  look_at_listed_leaves(may_interfere, apart);
  for (const NarrowScratch::FacetPair& near : scratch_.facets) {
    if (!is_clear() || touches(near)) return;
  }
  if (is_clear()) result_.gap_mm = std::max(apart, options_.tolerance_mm);
}

void Judge::list_near_leaves(bool may_interfere, double& apart) {
  const double tolerance_mm = options_.tolerance_mm;
  KeptOff kept_off_a;
  KeptOff kept_off_b;
  if (may_interfere && !leaves_out(Skip::KeptOff)) {
    const auto heights = [](const Obb& box) {
      return [box](const PlaneSurface& plane) { return height_of(box, plane); };
    };
    kept_off_a = KeptOff(pair_.a, tolerance_mm, heights(transformed(X_AB_, pair_.obb_b)));
    kept_off_b = KeptOff(pair_.b, tolerance_mm, heights(transformed(pair_.X_BA, pair_.obb_a)));
    if (!kept_off_a.is_empty() || !kept_off_b.is_empty()) counters_.note(Skip::KeptOff);
  }
  const auto may_cross = [&](const BvhNode& a, const BvhNode& b) {
    return may_interfere && !kept_off_a.contains(a) && !kept_off_b.contains(b);
  };
  int early_crossings = kEarlyCrossings;
  for_each_leaf_pair(
      pair_, scratch_, counters_,
      [&](const BvhNode& a, const BvhNode& b) { return is_clear() || may_cross(a, b); },
      [&](double gap_mm) {
        if (gap_mm > tolerance_mm) apart = std::min(apart, gap_mm);
        return gap_mm <= tolerance_mm;
      },
      [&](const BvhNode& leaf_a, const BvhNode& leaf_b) {
        const bool cross = may_cross(leaf_a, leaf_b);
        scratch_.leaves.push_back({&leaf_a, &leaf_b, cross});
        const bool face = is_clear() && may_face(leaf_a, leaf_b);
        if (!face && !(cross && early_crossings > 0)) return true;
        return for_each_near_pair(
            pair_, placement_, leaf_a, leaf_b, tolerance_mm, apart,
            [this](const ModelTriangle& t) { return takes_part(t); },
            [&](std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
              if (face && is_clear() && faces_lie_on_each_other(i, a_B, j)) return may_interfere;
              return !(cross && early_crossings > 0 &&
                       crosses_in_the_middle(i, a_B, j, early_crossings));
            });
      });
}

void Judge::look_at_listed_leaves(bool may_interfere, double& apart) {
  for (const NarrowScratch::LeafPair& leaves : scratch_.leaves) {
    if (!is_clear() && !leaves.may_cross) continue;
    const bool go_on = for_each_near_pair(
        pair_, placement_, *leaves.a, *leaves.b, options_.tolerance_mm, apart,
        [this](const ModelTriangle& t) { return takes_part(t); },
        [&](std::uint32_t i, const PlacedTriangle& a_B, std::uint32_t j) {
          const auto near = near_facets(i, a_B, j, apart);
          if (!near) return true;
          if (leaves.may_cross && crosses(*near, a_B)) return false;
          if (!is_clear()) return true;
          if (near->is_flat || !may_interfere) {
            return !touches(*near) || may_interfere;
          }
          scratch_.facets.push_back(*near);
          return true;
        });
    if (!go_on) return;
  }
}

std::optional<NarrowScratch::FacetPair> Judge::near_facets(std::uint32_t i,
                                                           const PlacedTriangle& a_B,
                                                           std::uint32_t j, double& apart) {
  const ModelTriangle& a = pair_.a.triangles()[i];
  const ModelTriangle& b = pair_.b.triangles()[j];
  ++counters_.triangle_tests;
  const double slack = a.slack_mm + b.slack_mm;
  const double margin = options_.tolerance_mm + slack;
  const auto is_out = [&](double gap, double limit, double bound) {
    if (gap <= limit) return false;
    apart = std::min(apart, bound);
    return true;
  };
  const double between = apart_by_planes(a, a_B, b);
  if (is_out(between, options_.tolerance_mm, between)) return {};
  const double boxes = box_gap(a_B.corners_B, b.corners);
  if (is_out(boxes, margin, boxes - slack)) return {};
  note_method(i, j);
  const double beyond = std::max(beyond_edges(b.corners, b.normal, a_B.corners_B),
                                 beyond_edges(a_B.corners_B, a_B.normal_B, b.corners));
  if (is_out(beyond, margin, beyond - slack)) return {};
  const ClosestPair closest = closest_points(a_B.corners_B, a_B.normal_B, b.corners, b.normal);
  const double gap = std::sqrt(closest.distance_squared_mm2);
  if (is_out(gap, margin, gap - slack)) return {};
  apart = std::min(apart, options_.tolerance_mm);
  return NarrowScratch::FacetPair{i, j, slack == 0.0, closest.on_a, closest.on_b};
}

}  // namespace dowel
