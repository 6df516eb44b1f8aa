#pragma once

#include <cstddef>
#include <vector>

#include "dowel/catalog/feature.h"

namespace dowel {

/// Rank of every value among the others: 0 for the smallest, equal for values that a chain of gaps
/// of at most `tolerance` connects. Rounding noise changes no rank.
std::vector<std::size_t> ranks(const std::vector<double>& values, double tolerance);

enum class OrderBy { Direction, Diameter };

/// Order of features of one kind, as indices: (with OrderBy::Diameter, the smallest first, then) by
/// the side from which they are seen, +z first, then +y, then +x; then from the top (z), from the
/// front (y), from the left (x).
std::vector<std::size_t> canonical_order(const std::vector<Feature>& features, OrderBy first);

}  // namespace dowel
