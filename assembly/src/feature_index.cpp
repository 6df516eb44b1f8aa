#include "dowel/assembly/feature_index.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dowel/catalog/metric_thread.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// A grid pitch: a search near a feature looks into few cells, and a cell has few features.
constexpr double kCell_mm = 50.0;

/// A bore this much wider than a shaft still is for it.
constexpr double kFitClearance_mm = 0.1;

/// A clearance hole is no wider than this many diameters: ISO 273, coarse, has 1.25 at M4.
constexpr double kWidestClearance = 1.25;

/// A core hole is no narrower than this many diameters: M3 has 0.82, M24 more.
constexpr double kNarrowestCore = 0.75;

/// Diameters of a hole's cylinders, each once; of a shaft or slot, its own.
std::vector<double> sizes_of(const Feature& feature) {
  std::vector<double> sizes;
  if (feature.kind == FeatureKind::Hole) {
    for (const HoleSegment& segment : feature.segments) {
      if (segment.type == HoleSegment::Type::Cylinder) sizes.push_back(segment.diameter_mm);
    }
  }
  if (sizes.empty()) sizes.push_back(feature.diameter_mm);
  std::ranges::sort(sizes);
  sizes.erase(std::unique(sizes.begin(), sizes.end()), sizes.end());
  return sizes;
}

bool goes_in(double shaft_mm, double bore_mm, double most_play_mm) {
  return shaft_mm <= bore_mm + kShaftExcess_mm && bore_mm <= shaft_mm + most_play_mm;
}

std::optional<FeatureMatch> shaft_in_hole(const Feature& shaft, const Feature& hole) {
  const double d_mm = shaft.diameter_mm;
  std::optional<FeatureMatch> best;
  for (const double bore_mm : sizes_of(hole)) {
    std::optional<FeatureMatch> match;
    if (forms_thread(d_mm, bore_mm)) {
      match = FeatureMatch::Thread;
    } else if (goes_in(d_mm, bore_mm, kFitClearance_mm)) {
      match = FeatureMatch::Fit;
    } else if (goes_in(d_mm, bore_mm, (kWidestClearance - 1.0) * d_mm)) {
      match = FeatureMatch::Clearance;
    }
    if (match && (!best || *match < *best)) best = match;
  }
  return best;
}

bool takes(const Feature& hole, double nominal_mm) {
  return std::ranges::any_of(sizes_of(hole), [=](double bore_mm) {
    return forms_thread(nominal_mm, bore_mm) ||
           goes_in(nominal_mm, bore_mm, (kWidestClearance - 1.0) * nominal_mm);
  });
}

std::optional<FeatureMatch> hole_on_hole(const Feature& a, const Feature& b) {
  for (const double one_mm : sizes_of(a)) {
    for (const double other_mm : sizes_of(b)) {
      if (std::abs(one_mm - other_mm) <= kFitClearance_mm) return FeatureMatch::Bore;
    }
  }
  for (const MetricThread& thread : metric_threads()) {
    if (takes(a, thread.nominal_mm) && takes(b, thread.nominal_mm)) return FeatureMatch::Bore;
  }
  return std::nullopt;
}

}  // namespace

std::string_view to_string(FeatureMatch match) {
  switch (match) {
    case FeatureMatch::Thread:
      return "thread";
    case FeatureMatch::Fit:
      return "fit";
    case FeatureMatch::Clearance:
      return "clearance";
    case FeatureMatch::Bore:
      return "hole on hole";
    case FeatureMatch::Seat:
      return "seat";
  }
  DOWEL_EXPECTS(false && "a known match");
  return {};
}

std::optional<FeatureMatch> match_of(const Feature& moving, const Feature& fixed) {
  using enum FeatureKind;
  if (moving.kind == Shaft && fixed.kind == Hole) return shaft_in_hole(moving, fixed);
  if (moving.kind == Hole && fixed.kind == Shaft) return shaft_in_hole(fixed, moving);
  if (moving.kind == Hole && fixed.kind == Hole) return hole_on_hole(moving, fixed);
  if (moving.kind == Face && fixed.kind == Face) return FeatureMatch::Seat;
  return std::nullopt;
}

void FeatureIndex::file(FeatureKind kind, double size_mm, std::size_t entry) {
  Bucket& bucket = by_size_[kind][size_mm];
  const Vector3d cell =
      (entries_[entry].X_WI * entries_[entry].feature->origin / kCell_mm).array().floor();
  bucket.all.push_back(entry);
  bucket
      .cells[{static_cast<std::int64_t>(cell.x()), static_cast<std::int64_t>(cell.y()),
              static_cast<std::int64_t>(cell.z())}]
      .push_back(entry);
}

void FeatureIndex::add(const std::string& instance, const Element& element, const Pose& X_WI) {
  for (const Feature& feature : element.features) {
    entries_.push_back({instance, &feature, X_WI});
    const std::size_t entry = entries_.size() - 1;
    if (feature.kind == FeatureKind::Face) {
      file(feature.kind, 0.0, entry);
      continue;
    }
    for (const double size_mm : sizes_of(feature)) file(feature.kind, size_mm, entry);
  }
}

std::vector<const FeatureIndex::Bucket*> FeatureIndex::buckets_for(const Feature& moving) const {
  using enum FeatureKind;
  std::vector<const Bucket*> buckets;
  const auto add_range = [&](FeatureKind kind, double low_mm, double high_mm) {
    const auto sizes = by_size_.find(kind);
    if (sizes == by_size_.end()) return;
    for (auto it = sizes->second.lower_bound(low_mm); it != sizes->second.end(); ++it) {
      if (it->first > high_mm) break;
      buckets.push_back(&it->second);
    }
  };
  if (moving.kind == Face) add_range(Face, 0.0, 0.0);
  for (const double size_mm : sizes_of(moving)) {
    // Whatever goes with it by size is in this range, and more that `match_of` sorts out.
    const double low_mm = kNarrowestCore * size_mm;
    const double high_mm = kWidestClearance * size_mm + kFitClearance_mm;
    if (moving.kind == Shaft) {
      add_range(Hole, low_mm, high_mm);
    } else if (moving.kind == Hole) {
      add_range(Shaft, size_mm / kWidestClearance - kFitClearance_mm,
                size_mm / kNarrowestCore + kFitClearance_mm);
      // Core and clearance hole of one screw.
      add_range(Hole, size_mm * kNarrowestCore / kWidestClearance - kFitClearance_mm,
                size_mm * kWidestClearance / kNarrowestCore + kFitClearance_mm);
    }
  }
  std::ranges::sort(buckets);
  buckets.erase(std::unique(buckets.begin(), buckets.end()), buckets.end());
  return buckets;
}

bool FeatureIndex::is_near(const Entry& entry, const Vector3d& center_W, double reach_mm) const {
  const Vector3d off_W = center_W - entry.X_WI * entry.feature->origin;
  if (!entry.feature->slot) return off_W.norm() <= reach_mm;
  const Vector3d run_W = entry.X_WI.rotation() * entry.feature->slot->run;
  const double half_mm = 0.5 * entry.feature->slot->length_mm;
  return (off_W - std::clamp(run_W.dot(off_W), -half_mm, half_mm) * run_W).norm() <= reach_mm;
}

std::vector<std::size_t> FeatureIndex::near(const Feature& moving, const Vector3d& center_W,
                                            double reach_mm) const {
  std::vector<std::size_t> found;
  const auto look_at = [&](const std::vector<std::size_t>& some) {
    for (const std::size_t i : some) {
      if (is_near(entries_[i], center_W, reach_mm) && match_of(moving, *entries_[i].feature)) {
        found.push_back(i);
      }
    }
  };
  const Vector3d low = ((center_W.array() - reach_mm) / kCell_mm).floor();
  const Vector3d high = ((center_W.array() + reach_mm) / kCell_mm).floor();
  for (const Bucket* bucket : buckets_for(moving)) {
    // Where the cells are more than the features, these are looked at one by one.
    if ((high - low).array().prod() > static_cast<double>(bucket->all.size())) {
      look_at(bucket->all);
      continue;
    }
    for (auto x = static_cast<std::int64_t>(low.x()); x <= static_cast<std::int64_t>(high.x());
         ++x) {
      for (auto y = static_cast<std::int64_t>(low.y()); y <= static_cast<std::int64_t>(high.y());
           ++y) {
        const auto cell = [&](double z) { return Cell{x, y, static_cast<std::int64_t>(z)}; };
        for (auto it = bucket->cells.lower_bound(cell(low.z()));
             it != bucket->cells.end() && it->first <= cell(high.z()); ++it) {
          look_at(it->second);
        }
      }
    }
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<std::size_t> FeatureIndex::anywhere(const Feature& moving) const {
  std::vector<std::size_t> found;
  for (const Bucket* bucket : buckets_for(moving)) {
    for (const std::size_t i : bucket->all) {
      if (match_of(moving, *entries_[i].feature)) found.push_back(i);
    }
  }
  std::ranges::sort(found);
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

std::vector<std::size_t> FeatureIndex::near_brute_force(const Feature& moving,
                                                        const Vector3d& center_W,
                                                        double reach_mm) const {
  std::vector<std::size_t> found;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    if (match_of(moving, *entries_[i].feature) && is_near(entries_[i], center_W, reach_mm)) {
      found.push_back(i);
    }
  }
  return found;
}

}  // namespace dowel
