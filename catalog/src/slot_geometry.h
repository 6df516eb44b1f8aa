#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "dowel/catalog/feature.h"
#include "plane_patches.h"

namespace dowel {

/// A solid and what is known of its faces.
struct SolidView {
  const FacetedSolid& solid;
  const std::vector<FaceNode>& graph;
  const PatchGraph& patches;
};

/// A slot without its name.
struct SlotFinding {
  Feature feature;
  std::array<std::vector<std::size_t>, 2> walls;  ///< patches of each side, sorted
  std::vector<std::uint32_t> mouth_faces;         ///< faces that its mouth opens on
};

struct Extent {
  double low_mm = 0.0;
  double high_mm = 0.0;
  double length_mm() const { return high_mm - low_mm; }
};

/// Of the vertices, along a direction from the origin. Expects: not empty.
Extent extent_along(const FacetedSolid& solid, const std::vector<std::uint32_t>& vertices,
                    const Eigen::Vector3d& direction);

/// The largest of parallel patches. Which of two that are equal does not matter to its normal.
std::size_t largest_patch(const SolidView& view, const std::vector<std::size_t>& patches);

/// The unit vectors are square to each other, or parallel, as recognition counts it.
bool are_square(const Eigen::Vector3d& a, const Eigen::Vector3d& b);
bool are_opposite(const Eigen::Vector3d& a, const Eigen::Vector3d& b);

/// The sense of a line that points to +x, else +y, else +z.
Eigen::Vector3d rightward(const Eigen::Vector3d& direction);
/// The sense of a line that points to +z, else +y, else +x.
Eigen::Vector3d upward(const Eigen::Vector3d& direction);

/// Where a wall ends at its top.
struct WallTop {
  double height_mm = 0.0;             ///< along `up`, after a chamfer or rounding
  std::vector<std::uint32_t> beyond;  ///< faces that begin there
};

/// Chamfers and roundings reach back from the wall by `widest_bevel_mm` at most.
WallTop top_of_wall(const SolidView& view, const PlanePatch& wall, const Eigen::Vector3d& up,
                    double widest_bevel_mm);

/// Whether the line from `from` to `to`, moved sideways by about `offset_mm`, runs in the void.
bool is_void_between(const FacetedSolid& solid, std::uint32_t lump, const Eigen::Vector3d& from,
                     const Eigen::Vector3d& to, double offset_mm);

void sort_unique(std::vector<std::uint32_t>& values);
void sort_unique(std::vector<std::size_t>& values);

}  // namespace dowel
