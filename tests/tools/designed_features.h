#pragma once

// Features as they were designed beside those that a catalogue has.

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "dowel/catalog/element.h"

namespace dowel::testing {

/// Of positions and sizes in mm; directions, too. Recognition works on doubles from a text file.
inline constexpr double kDesignSlack = 1e-5;

inline bool same(double a, double b) {
  return std::abs(a - b) <= kDesignSlack;
}

inline bool same(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return (a - b).norm() <= kDesignSlack;
}

inline bool same(const HoleSegment& a, const HoleSegment& b) {
  return a.type == b.type && same(a.diameter_mm, b.diameter_mm) &&
         same(a.diameter_end_mm, b.diameter_end_mm) && same(a.from_mm, b.from_mm) &&
         same(a.to_mm, b.to_mm);
}

inline bool same(const SlotShape& a, const SlotShape& b) {
  return a.type == b.type && same(a.run, b.run) && same(a.length_mm, b.length_mm) &&
         a.ends == b.ends && same(a.throat_depth_mm, b.throat_depth_mm) &&
         same(a.undercut_width_mm, b.undercut_width_mm) &&
         same(a.undercut_height_mm, b.undercut_height_mm) && a.nominal_mm == b.nominal_mm;
}

/// What differs between a designed hole, shaft or slot and a catalogue's; empty where nothing does.
inline std::string difference(const Feature& designed, const Feature& found) {
  if (designed.kind != found.kind) return "kind";
  if (!same(designed.origin, found.origin)) return "origin";
  if (!same(designed.direction, found.direction)) return "direction";
  if (!same(designed.diameter_mm, found.diameter_mm)) return "diameter or width";
  if (!same(designed.depth_mm, found.depth_mm)) return "depth";
  if (designed.through != found.through || designed.blind_end != found.blind_end) return "end";
  if (!std::equal(designed.segments.begin(), designed.segments.end(), found.segments.begin(),
                  found.segments.end(), [](const auto& a, const auto& b) { return same(a, b); })) {
    return "segments";
  }
  if (designed.slot.has_value() != found.slot.has_value()) return "shape of the slot";
  if (designed.slot && !same(*designed.slot, *found.slot)) return "shape of the slot";
  if (designed.thread != found.thread) return "thread";
  if (designed.fit != found.fit) return "fit";
  if (designed.use != found.use) return "use";
  return "";
}

/// One line for each hole, shaft or slot in which the two lists differ, by name.
inline std::vector<std::string> differences(const std::vector<Feature>& designed,
                                            const Element& element) {
  std::vector<std::string> lines;
  std::set<std::string> names;
  for (const Feature& feature : designed) {
    if (feature.kind == FeatureKind::Face) continue;
    names.insert(feature.name);
    const Feature* const found = element.find_feature(feature.name);
    const std::string what = found == nullptr ? "missing" : difference(feature, *found);
    if (!what.empty()) lines.push_back(element.name + " " + feature.name + ": " + what);
  }
  for (const Feature& feature : element.features) {
    if (feature.kind == FeatureKind::Face || names.count(feature.name) == 1) continue;
    lines.push_back(element.name + " " + feature.name + ": not designed");
  }
  return lines;
}

}  // namespace dowel::testing
