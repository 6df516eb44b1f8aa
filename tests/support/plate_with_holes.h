#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <stdexcept>
#include <utility>
#include <vector>

#include "solid_builder.h"

namespace dowel::testing {

/// A hole drilled from the top of a plate.
struct DrilledHole {
  double x = 0.0;
  double y = 0.0;
  double radius_mm = 0.0;
  double depth_mm = 0.0;               ///< from the top, flat bottom; 0: through
  double counterbore_radius_mm = 0.0;  ///< 0: none
  double counterbore_depth_mm = 0.0;
};

namespace detail {

/// A rectangle of the plate with one hole at most; the rectangles tile the plate.
struct Cell {
  Eigen::Vector2d min;
  Eigen::Vector2d max;
  std::vector<DrilledHole> holes;
};

inline double mouth_radius_mm(const DrilledHole& hole) {
  return std::max(hole.radius_mm, hole.counterbore_radius_mm);
}

/// The widest gap between the holes along `axis`: its middle and its width (0: there is none).
inline std::pair<double, double> widest_gap(const Cell& cell, int axis) {
  std::vector<std::pair<double, double>> spans;
  for (const DrilledHole& hole : cell.holes) {
    const double at = axis == 0 ? hole.x : hole.y;
    spans.emplace_back(at - mouth_radius_mm(hole), at + mouth_radius_mm(hole));
  }
  std::sort(spans.begin(), spans.end());
  std::pair<double, double> best{0.0, 0.0};
  double reach = spans.front().second;
  for (const auto& [low, high] : spans) {
    if (low - reach > best.second) best = {0.5 * (low + reach), low - reach};
    reach = std::max(reach, high);
  }
  return best;
}

inline std::vector<Cell> split_into_cells(const Cell& plate) {
  std::vector<Cell> open{plate};
  std::vector<Cell> done;
  while (!open.empty()) {
    Cell cell = std::move(open.back());
    open.pop_back();
    if (cell.holes.size() <= 1) {
      done.push_back(std::move(cell));
      continue;
    }
    const auto gap_x = widest_gap(cell, 0);
    const auto gap_y = widest_gap(cell, 1);
    const int axis = gap_x.second >= gap_y.second ? 0 : 1;
    const auto& [cut, width_mm] = axis == 0 ? gap_x : gap_y;
    if (width_mm <= 0.0) throw std::logic_error("no straight cut parts these holes");
    Cell low{cell.min, cell.max, {}};
    Cell high = low;
    low.max[axis] = cut;
    high.min[axis] = cut;
    for (const DrilledHole& hole : cell.holes) {
      ((axis == 0 ? hole.x : hole.y) < cut ? low : high).holes.push_back(hole);
    }
    open.push_back(std::move(high));
    open.push_back(std::move(low));
  }
  return done;
}

/// Triangles between two convex loops, `inner` strictly inside `outer` (which may have straight
/// angles), both counter-clockwise. Goes round both at once along the shorter diagonal that does
/// not cut `inner`; one of the two never does.
inline void fill_between(Builder& builder, std::uint32_t face, bool facing_up,
                         const std::vector<std::uint32_t>& inner,
                         const std::vector<std::uint32_t>& outer) {
  const std::size_t n = inner.size();
  const std::size_t m = outer.size();
  if (n == 0 || m == 0) throw std::logic_error("a loop without vertices");
  const auto in = [&](std::size_t i) { return inner[i % n]; };
  const auto out = [&](std::size_t j) { return outer[j % m]; };
  const auto is_outside = [&](std::size_t chord, std::size_t j) {
    return cross(builder.flat(in(chord)), builder.flat(in(chord + 1)), builder.flat(out(j))) < 0.0;
  };
  // True where the triangle from inner i to the outer piece after j would swallow inner i + 1.
  const auto is_passed = [&](std::size_t inner_index, std::size_t piece) {
    const Eigen::Vector2d apex = builder.flat(in(inner_index));
    const Eigen::Vector2d next = builder.flat(in(inner_index + 1));
    return cross(apex, builder.flat(out(piece)), next) > 0.0 &&
           cross(apex, next, builder.flat(out(piece + 1))) > 0.0;
  };
  const auto length = [&](std::size_t i, std::size_t j) {
    return (builder.flat(in(i)) - builder.flat(out(j))).norm();
  };
  // The closest pair sees each other.
  std::size_t i = 0;
  std::size_t j = 0;
  for (std::size_t a = 0; a < n; ++a) {
    for (std::size_t b = 0; b < m; ++b) {
      if (length(a, b) < length(i, j)) {
        i = a;
        j = b;
      }
    }
  }
  const std::size_t last_i = i + n;
  const std::size_t last_j = j + m;
  while (i < last_i || j < last_j) {
    const bool can_inner = i < last_i && (j == last_j || is_outside(i, j));
    const bool can_outer = j < last_j && (i == last_i || !is_passed(i, j));
    if (!can_inner && !can_outer) throw std::logic_error("a hole reaches over its cell");
    const bool go_inner = can_inner && (!can_outer || length(i + 1, j) < length(i, j + 1));
    Triangle t =
        go_inner ? Triangle{in(i), out(j), in(i + 1)} : Triangle{in(i), out(j), out(j + 1)};
    if (!facing_up) std::swap(t[1], t[2]);
    builder.triangle(face, t[0], t[1], t[2]);
    ++(go_inner ? i : j);
  }
}

/// The plate under construction: faces bottom and top, cell by cell, then holes and sides.
class PlateBuilder {
 public:
  PlateBuilder(const Eigen::Vector3d& size, const std::vector<DrilledHole>& holes,
               std::uint32_t segments)
      : size_(size), segments_(segments) {
    const Eigen::Vector2d reach = 0.5 * size.head<2>();
    cells_ = split_into_cells({-reach, reach, holes});
    for (const Cell& cell : cells_) {
      add_corner({cell.min.x(), cell.min.y()});
      add_corner({cell.max.x(), cell.min.y()});
      add_corner({cell.max.x(), cell.max.y()});
      add_corner({cell.min.x(), cell.max.y()});
    }
    low_.resize(corners_.size());
    high_.resize(corners_.size());
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      low_[i] = builder_.vertex({corners_[i].x(), corners_[i].y(), 0.0});
      high_[i] = builder_.vertex({corners_[i].x(), corners_[i].y(), size.z()});
    }
  }

  FacetedSolid build() {
    double bottom_area = size_.x() * size_.y();
    double top_area = bottom_area;
    for (const Cell& cell : cells_) {
      for (const DrilledHole& hole : cell.holes) {
        top_area -= disc_area(mouth_radius_mm(hole));
        if (hole.depth_mm == 0.0) bottom_area -= disc_area(hole.radius_mm);
      }
    }
    bottom_ = builder_.face(PlaneSurface{Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitZ()},
                            bottom_area);
    top_ = builder_.face(PlaneSurface{{0.0, 0.0, size_.z()}, Eigen::Vector3d::UnitZ()}, top_area);
    for (const Cell& cell : cells_) fill_cell(cell);
    add_sides();
    return builder_.finish();
  }

 private:
  static double disc_area(double radius) { return std::numbers::pi * radius * radius; }

  void add_corner(const Eigen::Vector2d& p) {
    if (std::find(corners_.begin(), corners_.end(), p) == corners_.end()) corners_.push_back(p);
  }

  /// All corners of cells on the rectangle's outline, counter-clockwise: neighbours that meet there
  /// share them.
  std::vector<std::size_t> outline(const Eigen::Vector2d& min, const Eigen::Vector2d& max) const {
    std::vector<std::pair<double, std::size_t>> found;
    for (std::size_t i = 0; i < corners_.size(); ++i) {
      const Eigen::Vector2d& p = corners_[i];
      if ((p.array() < min.array()).any() || (p.array() > max.array()).any()) continue;
      const Eigen::Vector2d s = (p - min).cwiseQuotient(max - min);
      if (p.y() == min.y() && p.x() < max.x()) {
        found.emplace_back(s.x(), i);
      } else if (p.x() == max.x() && p.y() < max.y()) {
        found.emplace_back(1.0 + s.y(), i);
      } else if (p.y() == max.y() && p.x() > min.x()) {
        found.emplace_back(3.0 - s.x(), i);
      } else if (p.x() == min.x()) {
        found.emplace_back(4.0 - s.y(), i);
      }
    }
    std::sort(found.begin(), found.end());
    std::vector<std::size_t> result;
    result.reserve(found.size());
    for (const auto& [along, i] : found) result.push_back(i);
    return result;
  }

  void fill_cell(const Cell& cell) {
    std::vector<std::uint32_t> low;
    std::vector<std::uint32_t> high;
    for (const std::size_t i : outline(cell.min, cell.max)) {
      low.push_back(low_[i]);
      high.push_back(high_[i]);
    }
    std::vector<std::uint32_t> low_hole;
    std::vector<std::uint32_t> high_hole;
    if (!cell.holes.empty()) drill(cell.holes.front(), low_hole, high_hole);
    const Eigen::Vector2d middle = 0.5 * (cell.min + cell.max);
    if (low_hole.empty()) {
      builder_.band(bottom_, {builder_.vertex({middle.x(), middle.y(), 0.0})}, low);
    } else {
      fill_between(builder_, bottom_, false, low_hole, low);
    }
    if (high_hole.empty()) {
      builder_.band(top_, high, {builder_.vertex({middle.x(), middle.y(), size_.z()})});
    } else {
      fill_between(builder_, top_, true, high_hole, high);
    }
  }

  /// One wall from loop `high` down to a new loop at `low_z`, which it returns.
  std::vector<std::uint32_t> wall(const Eigen::Vector2d& axis, double radius, double high_z,
                                  double low_z, const std::vector<std::uint32_t>& high,
                                  std::uint32_t& face) {
    face = builder_.face(
        CylinderSurface{{axis.x(), axis.y(), high_z}, Eigen::Vector3d::UnitZ(), radius},
        2.0 * std::numbers::pi * radius * (high_z - low_z), true);
    std::vector<std::uint32_t> low = builder_.ring(axis, low_z, radius, segments_, 0.0);
    builder_.band(face, high, low);
    return low;
  }

  void drill(const DrilledHole& hole, std::vector<std::uint32_t>& low_hole,
             std::vector<std::uint32_t>& high_hole) {
    const Eigen::Vector2d axis(hole.x, hole.y);
    const auto at = [&](double z) { return Eigen::Vector3d(hole.x, hole.y, z); };
    double z = size_.z();
    high_hole = builder_.ring(axis, z, mouth_radius_mm(hole), segments_, 0.0);
    std::vector<std::uint32_t> loop = high_hole;
    std::uint32_t above = top_;
    if (hole.counterbore_radius_mm > hole.radius_mm) {
      const double r = hole.counterbore_radius_mm;
      const double floor_z = z - hole.counterbore_depth_mm;
      std::uint32_t wall_face = 0;
      loop = wall(axis, r, z, floor_z, loop, wall_face);
      builder_.circle_edge(above, wall_face, Convexity::Convex, at(z), r, high_hole[0]);
      const std::uint32_t floor = builder_.face(PlaneSurface{at(floor_z), Eigen::Vector3d::UnitZ()},
                                                disc_area(r) - disc_area(hole.radius_mm));
      builder_.circle_edge(wall_face, floor, Convexity::Concave, at(floor_z), r, loop[0]);
      const std::vector<std::uint32_t> bore =
          builder_.ring(axis, floor_z, hole.radius_mm, segments_, 0.0);
      builder_.band(floor, loop, bore);
      loop = bore;
      above = floor;
      z = floor_z;
    }
    const bool is_through = hole.depth_mm == 0.0;
    const double end_z = is_through ? 0.0 : size_.z() - hole.depth_mm;
    std::uint32_t wall_face = 0;
    const std::vector<std::uint32_t> end = wall(axis, hole.radius_mm, z, end_z, loop, wall_face);
    builder_.circle_edge(above, wall_face, Convexity::Convex, at(z), hole.radius_mm, loop[0]);
    if (is_through) {
      builder_.circle_edge(bottom_, wall_face, Convexity::Convex, at(0.0), hole.radius_mm, end[0]);
      low_hole = end;
    } else {
      const std::uint32_t floor = builder_.face(PlaneSurface{at(end_z), Eigen::Vector3d::UnitZ()},
                                                disc_area(hole.radius_mm));
      builder_.band(floor, end, {builder_.vertex(at(end_z))});
      builder_.circle_edge(wall_face, floor, Convexity::Concave, at(end_z), hole.radius_mm, end[0]);
    }
  }

  void add_sides() {
    const Eigen::Vector2d reach = 0.5 * size_.head<2>();
    const std::vector<std::size_t> loop = outline(-reach, reach);
    const std::array<Eigen::Vector2d, 4> corner{
        Eigen::Vector2d(-reach.x(), -reach.y()), Eigen::Vector2d(reach.x(), -reach.y()),
        Eigen::Vector2d(reach.x(), reach.y()), Eigen::Vector2d(-reach.x(), reach.y())};
    std::array<std::uint32_t, 4> face{};
    std::array<std::size_t, 4> corner_index{};
    for (std::size_t k = 0; k < 4; ++k) {
      const Eigen::Vector2d along = corner[(k + 1) % 4] - corner[k];
      const Eigen::Vector3d normal = Eigen::Vector3d(along.y(), -along.x(), 0.0).normalized();
      face[k] = builder_.face(PlaneSurface{{corner[k].x(), corner[k].y(), 0.0}, normal},
                              along.norm() * size_.z());
    }
    std::size_t side = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      if (side + 1 < 4 && corners_[loop[i]] == corner[side + 1]) ++side;
      if (corners_[loop[i]] == corner[side]) corner_index[side] = loop[i];
      const std::size_t next = loop[(i + 1) % loop.size()];
      builder_.quad(face[side], low_[loop[i]], low_[next], high_[next], high_[loop[i]]);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      const std::size_t a = corner_index[k];
      const std::size_t b = corner_index[(k + 1) % 4];
      builder_.line_edge(bottom_, face[k], Convexity::Convex, low_[a], low_[b]);
      builder_.line_edge(top_, face[k], Convexity::Convex, high_[a], high_[b]);
      builder_.line_edge(face[(k + 3) % 4], face[k], Convexity::Convex, low_[a], high_[a]);
    }
  }

  Eigen::Vector3d size_;
  std::uint32_t segments_;
  std::vector<Cell> cells_;
  std::vector<Eigen::Vector2d> corners_;  ///< of all cells, without repetition
  std::vector<std::uint32_t> low_;        ///< their vertices on the bottom
  std::vector<std::uint32_t> high_;       ///< and on the top
  Builder builder_;
  std::uint32_t bottom_ = 0;
  std::uint32_t top_ = 0;
};

}  // namespace detail

/// Centred on the z axis, from z = 0 to `size.z()`. Faces: bottom, top, the walls and floors of the
/// holes, the four sides (-y, +x, +y, -x) last. Holes must keep clear of each other and of the
/// sides, and straight cuts must be able to part them (grids and bolt circles with one row apart
/// do).
inline FacetedSolid plate_with_holes(const Eigen::Vector3d& size,
                                     const std::vector<DrilledHole>& holes,
                                     std::uint32_t segments) {
  return detail::PlateBuilder(size, holes, segments).build();
}

/// A grid of through holes, centred on the z axis.
inline std::vector<DrilledHole> hole_grid(std::uint32_t columns, std::uint32_t rows,
                                          double pitch_mm, double radius_mm) {
  std::vector<DrilledHole> holes;
  for (std::uint32_t row = 0; row < rows; ++row) {
    for (std::uint32_t column = 0; column < columns; ++column) {
      DrilledHole hole;
      hole.x = pitch_mm * (column - 0.5 * (columns - 1.0));
      hole.y = pitch_mm * (row - 0.5 * (rows - 1.0));
      hole.radius_mm = radius_mm;
      holes.push_back(hole);
    }
  }
  return holes;
}

}  // namespace dowel::testing
