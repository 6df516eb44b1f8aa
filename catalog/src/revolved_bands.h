#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "axis.h"
#include "face_graph.h"

namespace dowel {

/// One end of a band and what lies beyond it.
struct BandEnd {
  double rim_mm = 0.0;     ///< height where the axis leaves the band, by the plane there if any
  double height_mm = 0.0;  ///< the same after the transition
  double reach_mm = 0.0;   ///< height of the outermost vertex of band and transition
  /// Length of the rim where the neighbour widens, less where it narrows, over its whole length.
  double lean = 0.0;
  std::vector<std::uint32_t> across;      ///< faces at the rim, longest rim first
  double inner_wall_share = 0.0;          ///< of the rim, along walls of holes about other axes
  std::vector<std::uint32_t> transition;  ///< fillet (coaxial torus) or ball end
  std::vector<std::uint32_t> beyond;      ///< faces after the transition; `across` without one
  bool is_ball = false;                   ///< the transition closes the band
};

/// Coaxial faces of one cylinder or cone that together go all the way round (or nearly so) and are
/// not parted along the axis. A bore of two halves is one band; one that a wider bore crosses, two.
struct Band {
  bool is_cylinder = true;
  bool is_inner = false;              ///< the wall of a hole
  std::array<double, 2> radius_mm{};  ///< at the rims
  std::array<BandEnd, 2> ends;        ///< low, high
  std::vector<std::uint32_t> faces;   ///< sorted

  double length_mm() const { return ends[1].rim_mm - ends[0].rim_mm; }
};

/// All bands about one axis of one solid, from the lowest up.
struct AxisBands {
  Axis axis;
  std::uint32_t solid = 0;
  std::vector<Band> bands;
};

/// Bands of all cylinders and cones of `solid`. Their axes and measures do not depend on the order
/// of its faces.
std::vector<AxisBands> revolved_bands(const FacetedSolid& solid,
                                      const std::vector<FaceNode>& graph);

}  // namespace dowel
