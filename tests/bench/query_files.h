#pragma once

#include <cstddef>
#include <filesystem>

#include "table.h"

namespace dowel::bench {

struct QueryStudy {
  Table table;
  std::size_t wrong = 0;  ///< answers of dowel
};

/// Public test data that the user has in `folder`, judged by dowel:
///
/// - `edge-edge/*.csv` and `vertex-face/*.csv` in any folder below, as the Sample-Queries of Wang
/// et
///   al., "A Large Scale Benchmark and an Inclusion-Based Algorithm for Continuous Collision
///   Detection", 2021, have them: eight lines a query (four vertices before, then after), each of
///   three pairs numerator,denominator and the truth, 0 or 1.
/// - `*.tri`: pairs of triangles, a line each: 18 numbers and whether they meet, 0 or 1; "#" begins
///   a comment.
///
/// dowel knows solids that move as a whole. So each vertex, edge or triangle becomes the convex
/// hull of small cubes about its vertices, and a query counts where the vertices of each of the two
/// move alike. Where the truth is a collision, the solids must meet on the way; where it is none,
/// they must not, if the two keep further apart than the cubes reach, which is proven here.
///
/// Throws std::runtime_error, naming file and line, at what cannot be read, and where there is
/// none.
QueryStudy run_query_files(const std::filesystem::path& folder);

}  // namespace dowel::bench
