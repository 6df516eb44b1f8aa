#include "snap_fit.h"

#include "dowel/assembly/thread.h"

namespace dowel {
namespace {

/// The first stretch of the bore that the shaft is too thick for, with the moving one at X_WA.
const HoleSegment* obstacle(const PlacedFeature& moving, const Pose& X_WA,
                            const PlacedFeature& fixed) {
  using enum FeatureKind;
  const Feature& a = *moving.feature;
  const Feature& b = *fixed.feature;
  if (a.kind == Shaft && b.kind == Hole) return fit_on_axis(a, X_WA, b, fixed.X_WI).obstacle;
  if (a.kind == Hole && b.kind == Shaft) return fit_on_axis(b, fixed.X_WI, a, X_WA).obstacle;
  return nullptr;
}

}  // namespace

std::optional<FittedPlace> fitted_place(const PlacedFeature& moving, const PlacedFeature& fixed) {
  FittedPlace place{place_by_mate(moving, fixed, {}, {}), 0.0};
  const HoleSegment* step = obstacle(moving, place.placement.X_WA, fixed);
  if (step == nullptr) return place;
  if (place.placement.kind != MateKind::ShaftInHole || step->from_mm <= 0.0) return std::nullopt;
  MateOptions options;
  options.offset_mm = moving.feature->depth_mm - step->from_mm;
  if (options.offset_mm <= 0.0) return std::nullopt;
  place = {place_by_mate(moving, fixed, {}, options), options.offset_mm};
  if (obstacle(moving, place.placement.X_WA, fixed) != nullptr) return std::nullopt;
  return place;
}

}  // namespace dowel
