#pragma once

#include <optional>

#include "narrow_phase.h"

// The search for a point that proves interference. Private to collision.

namespace dowel {

struct Witness {
  Eigen::Vector3d point_B;
  double depth_a_mm;  ///< in each solid
  double depth_b_mm;
};

/// A point at least `depth_mm` (less one part in 10^4) deep in both exact solids, sought from
/// `start_B` within `reach_mm`; nothing where none is found. `triangle_a`, `triangle_b`: the facets
/// that made the start interesting.
///
/// The point is moved by least-squares steps to where it is `depth_mm` behind both exact faces;
/// then the boundary nearest to it in each solid is asked, and a face that it is not deep enough
/// behind joins the set (at most four). Two faces that leave no room between them end the search at
/// once.
std::optional<Witness> find_witness(const ModelPair& pair, const Eigen::Vector3d& start_B,
                                    std::uint32_t triangle_a, std::uint32_t triangle_b,
                                    double depth_mm, double reach_mm);

/// A point no further than `gap_mm` / 2 from both exact solids: there they touch at that gap. The
/// same search, for solids that are grown instead of shrunk; depths are negative outside.
std::optional<Witness> find_touch(const ModelPair& pair, const Eigen::Vector3d& start_B,
                                  std::uint32_t triangle_a, std::uint32_t triangle_b, double gap_mm,
                                  double reach_mm);

/// A witness from a start that was one in another pose.
std::optional<Witness> find_witness(const ModelPair& pair, const Eigen::Vector3d& start_B,
                                    double depth_mm, double reach_mm);

/// The depth of the point in both solids, as it stands.
std::optional<Witness> test_witness(const ModelPair& pair, const Eigen::Vector3d& point_B,
                                    double depth_mm);

/// Makes a witness deeper: a better lower bound of the depth, and a ball that outlasts more moves.
/// In coarse steps while that is easy, or `thoroughly`.
Witness deepen(const ModelPair& pair, const Witness& witness, bool thoroughly);

}  // namespace dowel
