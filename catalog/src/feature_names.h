#pragma once

#include <vector>

#include "dowel/catalog/feature.h"

namespace dowel {

/// The same holes, named and in canonical order: those of grids `A1`, `A2`, … (letter: row from
/// below, number: column from the left, seen against the opening direction), of further grids
/// `g2.A1`, …; then the others by position: `h1` … through, `b1` … blind, `cb1` … counterbored,
/// `cs1` … countersunk.
std::vector<Feature> named_holes(const std::vector<Feature>& holes);

/// The same shafts as `pin1`, …, the thinnest first.
std::vector<Feature> named_shafts(const std::vector<Feature>& shafts);

/// The same slots as `slot1`, …, by position.
std::vector<Feature> named_slots(const std::vector<Feature>& slots);

/// The same faces: the outermost towards +z, -z, +x, -x, +y, -y as `top`, `bottom`, `right`,
/// `left`, `back`, `front`; then the others as `f1`, …
std::vector<Feature> named_faces(const std::vector<Feature>& faces);

}  // namespace dowel
