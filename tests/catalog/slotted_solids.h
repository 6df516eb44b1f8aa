#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "solids.h"

/// Blocks with slots, made of cells: the parts of a plane that lines cut it into, each filled with
/// material or not in each layer.
namespace dowel::testing {

namespace detail {

/// Recognition does not need the edges between faces: none are made.
class CellSolid {
 public:
  explicit CellSolid(std::array<std::vector<double>, 3> cuts) : cuts_(std::move(cuts)) {}

  /// One face for each set of coplanar neighbouring sides of cells.
  template <class Filled>
  FacetedSolid build(Filled is_filled) {
    const auto count = [&](std::size_t axis) { return static_cast<int>(cuts_[axis].size()) - 1; };
    const auto has = [&](std::array<int, 3> cell) {
      for (const std::size_t axis : {0U, 1U, 2U}) {
        if (cell[axis] < 0 || cell[axis] >= count(axis)) return false;
      }
      Eigen::Vector3d middle;
      for (const std::size_t axis : {0U, 1U, 2U}) {
        const auto at = static_cast<std::size_t>(cell[axis]);
        middle[static_cast<Eigen::Index>(axis)] = 0.5 * (cuts_[axis][at] + cuts_[axis][at + 1]);
      }
      return static_cast<bool>(is_filled(middle));
    };
    for (const std::size_t axis : {0U, 1U, 2U}) {
      for (const int sense : {-1, 1}) {
        for (int level = 0; level < count(axis); ++level) {
          add_level(axis, sense, level, count((axis + 1) % 3), count((axis + 2) % 3), has);
        }
      }
    }
    return builder_.finish();
  }

 private:
  template <class Has>
  void add_level(std::size_t axis, int sense, int level, int nu, int nv, Has has) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    const auto is_side = [&](int i, int j) {
      if (i < 0 || j < 0 || i >= nu || j >= nv) return false;
      std::array<int, 3> cell{};
      cell[axis] = level;
      cell[u] = i;
      cell[v] = j;
      std::array<int, 3> next = cell;
      next[axis] += sense;
      return has(cell) && !has(next);
    };
    std::map<std::pair<int, int>, std::uint32_t> face_of;
    for (int i = 0; i < nu; ++i) {
      for (int j = 0; j < nv; ++j) {
        if (!is_side(i, j) || face_of.contains({i, j})) continue;
        const auto face = start_face(axis, sense, level);
        std::vector<std::pair<int, int>> open{{i, j}};
        face_of[{i, j}] = face;
        while (!open.empty()) {
          const auto [a, b] = open.back();
          open.pop_back();
          add_side(face, axis, sense, level, a, b);
          for (const auto& [p, q] : {std::pair{a + 1, b}, {a - 1, b}, {a, b + 1}, {a, b - 1}}) {
            if (is_side(p, q) && face_of.try_emplace({p, q}, face).second) open.emplace_back(p, q);
          }
        }
      }
    }
  }

  std::uint32_t start_face(std::size_t axis, int sense, int level) {
    const auto i = static_cast<Eigen::Index>(axis);
    const std::size_t at = static_cast<std::size_t>(level) + (sense > 0 ? 1U : 0U);
    return builder_.face(
        PlaneSurface{cuts_[axis][at] * Eigen::Vector3d::Unit(i), sense * Eigen::Vector3d::Unit(i)},
        1.0);
  }

  void add_side(std::uint32_t face, std::size_t axis, int sense, int level, int i, int j) {
    const std::size_t u = (axis + 1) % 3;
    const std::size_t v = (axis + 2) % 3;
    const auto corner = [&](int a, int b) {
      std::array<int, 3> at{};
      at[axis] = level + (sense > 0 ? 1 : 0);
      at[u] = a;
      at[v] = b;
      const auto [place, is_new] = vertices_.try_emplace(at, 0U);
      if (is_new) {
        Eigen::Vector3d p;
        for (const std::size_t k : {0U, 1U, 2U}) {
          p[static_cast<Eigen::Index>(k)] = cuts_[k][static_cast<std::size_t>(at[k])];
        }
        place->second = builder_.vertex(p);
      }
      return place->second;
    };
    const std::array<std::uint32_t, 4> c{corner(i, j), corner(i + 1, j), corner(i + 1, j + 1),
                                         corner(i, j + 1)};
    if (sense > 0) {
      builder_.quad(face, c[0], c[1], c[2], c[3]);
    } else {
      builder_.quad(face, c[0], c[3], c[2], c[1]);
    }
  }

  std::array<std::vector<double>, 3> cuts_;
  std::map<std::array<int, 3>, std::uint32_t> vertices_;
  Builder builder_;
};

}  // namespace detail

/// An upright box.
struct Block {
  Eigen::Vector3d min;
  Eigen::Vector3d max;

  bool contains(const Eigen::Vector3d& p) const {
    return (p.array() > min.array()).all() && (p.array() < max.array()).all();
  }
};

/// What is left of `body` after `removed`. Faces have the area of their facets.
inline FacetedSolid carved(const Block& body, const std::vector<Block>& removed) {
  std::array<std::vector<double>, 3> cuts;
  for (const std::size_t axis : {0U, 1U, 2U}) {
    const auto i = static_cast<Eigen::Index>(axis);
    std::vector<double>& of_axis = cuts[axis];
    of_axis = {body.min[i], body.max[i]};
    for (const Block& block : removed) {
      for (const double at : {block.min[i], block.max[i]}) {
        if (at > body.min[i] && at < body.max[i]) of_axis.push_back(at);
      }
    }
    std::sort(of_axis.begin(), of_axis.end());
    of_axis.erase(std::unique(of_axis.begin(), of_axis.end()), of_axis.end());
  }
  FacetedSolid solid = detail::CellSolid(std::move(cuts)).build([&](const Eigen::Vector3d& p) {
    return std::none_of(removed.begin(), removed.end(),
                        [&](const Block& block) { return block.contains(p); });
  });
  for (Face& face : solid.faces) face.area_mm2 = 0.0;
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const auto c = solid.corners(t);
    solid.faces[solid.face_of[t]].area_mm2 += 0.5 * (c[1] - c[0]).cross(c[2] - c[0]).norm();
  }
  return solid;
}

/// An oblong of that width and overall length in a plate of `size` standing on z = 0, along x about
/// the plate's middle, from the top: `depth_mm` deep, or through where it is 0. Half cylinders of
/// `segments` facets.
inline FacetedSolid oblong_plate(const Eigen::Vector3d& size, double width_mm, double length_mm,
                                 double depth_mm, std::uint32_t segments = 12) {
  const double r = 0.5 * width_mm;
  const double half_mm = 0.5 * length_mm - r;
  const double x = 0.5 * size.x();
  const double y = 0.5 * size.y();
  const double floor_mm = depth_mm > 0.0 ? size.z() - depth_mm : 0.0;
  detail::Builder b;
  // The loop of the oblong, counter-clockwise from the right end's lower corner.
  std::vector<Eigen::Vector2d> loop;
  for (const double sense : {1.0, -1.0}) {
    for (std::uint32_t i = 0; i <= segments; ++i) {
      const double a = std::numbers::pi * (static_cast<double>(i) / segments - 0.5);
      loop.emplace_back(sense * (half_mm + r * std::cos(a)), sense * r * std::sin(a));
    }
  }
  const auto ring = [&](double z) {
    std::vector<std::uint32_t> result;
    result.reserve(loop.size());
    for (const Eigen::Vector2d& p : loop) result.push_back(b.vertex({p.x(), p.y(), z}));
    return result;
  };
  const auto outer = [&](double z) {
    std::vector<std::uint32_t> result;
    for (const Eigen::Vector2d& p : {Eigen::Vector2d(x, -y), Eigen::Vector2d(x, y),
                                     Eigen::Vector2d(-x, y), Eigen::Vector2d(-x, -y)}) {
      result.push_back(b.vertex({p.x(), p.y(), z}));
    }
    return result;
  };
  const std::vector<std::uint32_t> top = ring(size.z());
  const std::vector<std::uint32_t> low = ring(floor_mm);
  const std::vector<std::uint32_t> outer_top = outer(size.z());
  const std::vector<std::uint32_t> outer_low = outer(0.0);
  const double oblong_mm2 = std::numbers::pi * r * r + 4.0 * half_mm * r;
  const double rim_mm2 = 4.0 * x * y - oblong_mm2;
  const std::uint32_t above = b.face(PlaneSurface{{0.0, 0.0, size.z()}, {0.0, 0.0, 1.0}}, rim_mm2);
  const std::uint32_t below = b.face(PlaneSurface{{0.0, 0.0, 0.0}, {0.0, 0.0, -1.0}},
                                     depth_mm > 0.0 ? 4.0 * x * y : rim_mm2);
  detail::fill_between(b, above, true, top, outer_top);
  if (depth_mm > 0.0) {
    b.quad(below, outer_low[0], outer_low[3], outer_low[2], outer_low[1]);
    const std::uint32_t floor =
        b.face(PlaneSurface{{0.0, 0.0, floor_mm}, {0.0, 0.0, 1.0}}, oblong_mm2);
    for (std::size_t i = 1; i + 1 < low.size(); ++i) b.triangle(floor, low[0], low[i], low[i + 1]);
  } else {
    detail::fill_between(b, below, false, low, outer_low);
  }
  const double height_mm = size.z() - floor_mm;
  const std::size_t n = loop.size();
  const std::size_t half = n / 2;
  for (const std::size_t end : {std::size_t{0}, half}) {
    const double sense = end == 0 ? 1.0 : -1.0;
    const std::uint32_t round =
        b.face(CylinderSurface{{sense * half_mm, 0.0, 0.0}, Eigen::Vector3d::UnitZ(), r},
               std::numbers::pi * r * height_mm, true);
    for (std::size_t i = end; i + 1 < end + half; ++i) {
      b.quad(round, low[i], top[i], top[i + 1], low[i + 1]);
    }
    const std::uint32_t wall =
        b.face(PlaneSurface{{0.0, sense * r, 0.0}, {0.0, -sense, 0.0}}, 2.0 * half_mm * height_mm);
    const std::size_t from = end + half - 1;
    const std::size_t to = (end + half) % n;
    b.quad(wall, low[from], top[from], top[to], low[to]);
  }
  for (std::size_t i = 0; i < 4; ++i) {
    const std::size_t j = (i + 1) % 4;
    const Eigen::Vector3d along = b.position(outer_low[j]) - b.position(outer_low[i]);
    const Eigen::Vector3d normal = Eigen::Vector3d(along.y(), -along.x(), 0.0).normalized();
    const std::uint32_t side =
        b.face(PlaneSurface{b.position(outer_low[i]), normal}, along.norm() * size.z());
    b.quad(side, outer_low[i], outer_low[j], outer_top[j], outer_top[i]);
  }
  return b.finish();
}

/// A T-slot's outline from the left end of a plate's top to its right end, as (across, up) points:
/// `at_mm` is its middle; the plate's top is `top_mm`.
struct TeeOutline {
  double throat_mm = 14.0;
  double undercut_mm = 24.0;
  double undercut_height_mm = 10.0;
  double depth_mm = 26.0;
};

/// A bar along z with T-slots in its top (+y), `width_mm` wide and `height_mm` high.
inline FacetedSolid tee_bar(double width_mm, double height_mm, double length_mm,
                            const TeeOutline& tee, const std::vector<double>& at_mm) {
  std::vector<Eigen::Vector2d> polygon{{0.0, 0.0}, {width_mm, 0.0}, {width_mm, height_mm}};
  const double floor = height_mm - tee.depth_mm;
  const double ledge = floor + tee.undercut_height_mm;
  for (auto at = at_mm.rbegin(); at != at_mm.rend(); ++at) {
    const double a = 0.5 * tee.throat_mm;
    const double b = 0.5 * tee.undercut_mm;
    for (const Eigen::Vector2d& p :
         {Eigen::Vector2d(a, height_mm), Eigen::Vector2d(a, ledge), Eigen::Vector2d(b, ledge),
          Eigen::Vector2d(b, floor), Eigen::Vector2d(-b, floor), Eigen::Vector2d(-b, ledge),
          Eigen::Vector2d(-a, ledge), Eigen::Vector2d(-a, height_mm)}) {
      polygon.emplace_back(*at + p.x(), p.y());
    }
  }
  polygon.emplace_back(0.0, height_mm);
  return prism(polygon, length_mm);
}

}  // namespace dowel::testing
