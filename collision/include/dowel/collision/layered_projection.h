#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "dowel/kernel/box.h"

namespace dowel {

/// The paper's layered projection model: finds the placed boxes that a moving box may meet.
///
/// The space over the base plate (Omega: the box around everything placed) is cut into layers by
/// planes normal to z, and each layer into cells by lines normal to x and y. Cut planes are tops
/// and bottoms of boxes, cut lines are ends of their silhouettes' intervals, both chosen where they
/// cut fewest boxes. A box is listed in every cell that it reaches into. A query looks at the cells
/// that the moving box reaches into and compares intervals on z, x and y.
///
/// Insert and remove touch only the cells concerned; the cuts are found anew when the model has
/// grown or shrunk by half, so that n inserts cost O(n log n). Boxes outside the present cuts go to
/// the outermost layers and cells, which have no end.
///
/// Source: Peng et al. 2009, sections 4 and 5.1. Departs: the paper's cells only end where no
/// silhouette is cut, so a dense fixture has one cell; here a cell may cut silhouettes once it
/// would hold more than a few.
class LayeredProjection {
 public:
  /// Adds box `id`. Expects: not in the model; finite.
  void insert(std::uint32_t id, const Aabb& box);

  /// Expects: in the model.
  void remove(std::uint32_t id);

  /// Ids whose boxes overlap `box` (closed: touching counts), sorted, into `found` (cleared first).
  /// Boxes are kept in single precision, rounded outwards: one that misses by no more than that may
  /// be among them. A box without end along x and y asks by layer, along z by column, and one with
  /// an end along a single axis by interval. No allocation once `found` and the model have seen
  /// their largest query.
  void query(const Aabb& box, std::vector<std::uint32_t>& found);

  /// The same answer by looking at every box. Reference for tests.
  void query_brute_force(const Aabb& box, std::vector<std::uint32_t>& found) const;

  std::size_t size() const noexcept { return count_; }
  std::size_t layer_count() const noexcept { return layers_.size(); }
  std::size_t cell_count() const;
  std::size_t memory_bytes() const;
  const Aabb& omega() const noexcept { return omega_; }

 private:
  /// A box in half the memory; contains the one that it was made from.
  struct Extent {
    Eigen::Array3f min = Eigen::Array3f::Constant(std::numeric_limits<float>::infinity());
    Eigen::Array3f max = Eigen::Array3f::Constant(-std::numeric_limits<float>::infinity());

    Extent() = default;
    explicit Extent(const Aabb& box);
    Aabb box() const { return {min.cast<double>(), max.cast<double>()}; }
    bool is_empty() const { return !(min <= max).all(); }
    bool overlaps(const Extent& other) const {
      return (min <= other.max).all() && (other.min <= max).all();
    }
  };
  struct Layer {
    std::vector<double> x_cuts;  ///< ascending; n cuts make n + 1 columns
    std::vector<double> y_cuts;
    std::vector<std::vector<std::uint32_t>> cells;  ///< column-major: x * rows + y
  };

  template <class Reach, class Visit>
  void for_each_cell(const Extent& box, const Reach& reach, const Visit& visit);
  void rebuild();

  std::vector<double> z_cuts_;  ///< ascending; n cuts make n + 1 layers
  std::vector<Layer> layers_;
  std::vector<Extent> boxes_;           ///< by id; empty where there is none
  std::vector<std::uint32_t> seen_in_;  ///< by id: last query that met it
  std::uint32_t query_number_ = 0;
  Aabb omega_;
  std::size_t count_ = 0;
  std::size_t count_at_rebuild_ = 0;
};

}  // namespace dowel
