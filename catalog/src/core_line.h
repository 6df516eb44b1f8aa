#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "axis.h"
#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Stretch of a line outside the material; ends may be infinite.
struct VoidStretch {
  double low_mm = 0.0;
  double high_mm = 0.0;
};

/// The facets of a solid as lines of one direction see them, sorted into the cells of a grid across
/// that direction.
class ProjectedFacets {
 public:
  ProjectedFacets(const FacetedSolid& solid, const Eigen::Vector3d& direction);

  const Eigen::Vector3d& direction() const { return direction_; }
  /// Across the direction; the same for all lines of it.
  Eigen::Vector2d flat(const Eigen::Vector3d& point) const {
    return {u_.dot(point), v_.dot(point)};
  }
  const Eigen::Vector2d& flat(std::uint32_t vertex) const { return flat_[vertex]; }
  double height_mm(const Eigen::Vector3d& point) const { return direction_.dot(point); }
  double height_mm(std::uint32_t vertex) const { return height_[vertex]; }
  /// All facets that a line through there may meet, and others, ascending.
  std::span<const std::uint32_t> facets_near(const Eigen::Vector2d& point) const;

 private:
  struct Cells {
    std::array<std::size_t, 2> low{};
    std::array<std::size_t, 2> high{};
  };
  std::size_t cell_along(double coordinate, Eigen::Index axis) const;
  Cells cells_of(const Triangle& triangle) const;

  Eigen::Vector3d direction_;
  Eigen::Vector3d u_;
  Eigen::Vector3d v_;
  std::vector<Eigen::Vector2d> flat_;
  std::vector<double> height_;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  Eigen::Vector2d cells_per_mm_ = Eigen::Vector2d::Zero();
  std::size_t side_ = 1;               ///< cells along either side of the grid
  std::vector<std::uint32_t> begin_;   ///< of each cell in `facets_`, and one beyond the last
  std::vector<std::uint32_t> facets_;  ///< by cell
};

/// Finds the void along many lines of one solid; those of one direction share their projection.
class VoidFinder {
 public:
  explicit VoidFinder(const FacetedSolid& solid) : solid_(solid) {}

  /// Where the line along `axis`, moved sideways by about `offset_mm`, runs outside solid number
  /// `lump`: heights, from the lowest up. The offset keeps it off the vertices and edges that
  /// bodies of revolution have on their axes; should it meet one all the same, another is tried.
  /// Predicate: exact for the facets up to the rounding of their projection. O(triangles) for a
  /// new direction, else about O(triangles met).
  std::vector<VoidStretch> along(std::uint32_t lump, const Axis& axis, double offset_mm);

 private:
  const ProjectedFacets& projected(const Eigen::Vector3d& direction);

  const FacetedSolid& solid_;
  std::vector<ProjectedFacets> known_;  ///< of the last few directions
  std::size_t next_ = 0;                ///< which of them gives way
};

}  // namespace dowel
