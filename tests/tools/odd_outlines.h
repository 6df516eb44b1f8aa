#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "dowel/catalog/face_outline.h"

namespace dowel::testing {

inline bool has_chord(const OutlineLoop& loop) {
  return std::ranges::count(loop, OutlineEdge::Type::Chord, &OutlineEdge::type) > 0;
}

/// One line for each planar face whose loops do not close, or do not enclose the area that
/// OpenCascade integrates over its exact faces. Chords leave something out and are not compared.
inline std::vector<std::string> odd_outlines(const FacetedSolid& solid, const Element& element) {
  constexpr double kAreaSlackRatio = 1.0e-7;
  const std::vector<FaceOutline> outlines = face_outlines(solid, element.features);
  std::vector<std::string> lines;
  auto outline = outlines.begin();
  for (const Feature& face : element.features) {
    if (face.kind != FeatureKind::Face) continue;
    const FaceOutline& here = *outline++;
    const std::string place = element.name + " " + face.name + ": ";
    if (here.outer.empty()) lines.push_back(place + "no outline");
    if (has_chord(here.outer) || std::ranges::any_of(here.inner, has_chord)) continue;
    double area_mm2 = 0.0;
    for (const std::uint32_t f : face.faces) area_mm2 += solid.faces[f].area_mm2;
    for (const double found_mm2 : {here.area_mm2(face.direction), face.area_mm2}) {
      if (std::abs(found_mm2 - area_mm2) <= kAreaSlackRatio * area_mm2) continue;
      lines.push_back(place + std::to_string(found_mm2) + " mm2, expected " +
                      std::to_string(area_mm2));
    }
  }
  return lines;
}

}  // namespace dowel::testing
