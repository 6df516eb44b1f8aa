#include "hole_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>

#include "canonical_order.h"
#include "dowel/kernel/tolerance.h"
#include "equal_holes.h"

namespace dowel {
namespace {

/// A grid has at least this many holes, 3 x 2 …
constexpr std::size_t kFewestHoles = 6;
constexpr long kFewestLines = 2;
constexpr long kFewestLongLines = 3;

/// … and holes in this part of its places: chequered grids (a little less than half) are grids, six
/// holes on a circle (6 of 15 places) are not.
constexpr double kFewestFilled = 0.45;

/// Pitches tried along each direction, the most frequent gaps first.
constexpr std::size_t kMaxPitches = 8;

/// A plane lies where its normal rises more than this: just over the sine of 45 degrees, so that a
/// bevel of 45 degrees stands whatever its rounding.
constexpr double kLying = 0.71;

struct Spot {
  std::size_t hole = 0;
  Eigen::Vector2d at = Eigen::Vector2d::Zero();
};

struct Cell {
  std::size_t hole = 0;
  std::array<long, 2> index{};  ///< column, row
};

struct Lattice {
  std::vector<Cell> cells;
  double places = 0.0;
};

bool are_equal_segments(const HoleSegment& a, const HoleSegment& b) {
  const auto near = [](double p, double q) { return std::abs(p - q) <= kSameFeature_mm; };
  return a.type == b.type && near(a.diameter_mm, b.diameter_mm) &&
         near(a.diameter_end_mm, b.diameter_end_mm) && near(a.from_mm, b.from_mm) &&
         near(a.to_mm, b.to_mm);
}

/// Gaps between neighbours along axis `d`: of all lines, and within the lines across it (where a
/// second grid stands between, the latter is the pitch). The most frequent first.
std::vector<double> pitches(const std::vector<Spot>& spots, Eigen::Index d) {
  std::vector<double> along;
  std::vector<double> across;
  for (const Spot& spot : spots) {
    along.push_back(spot.at[d]);
    across.push_back(spot.at[1 - d]);
  }
  const std::vector<std::size_t> line = ranks(across, kCoaxial_mm);
  std::vector<std::pair<std::size_t, double>> by_line;
  for (std::size_t i = 0; i < spots.size(); ++i) by_line.emplace_back(line[i], along[i]);
  std::sort(by_line.begin(), by_line.end());
  std::sort(along.begin(), along.end());
  std::vector<double> gaps;
  for (std::size_t i = 1; i < along.size(); ++i) gaps.push_back(along[i] - along[i - 1]);
  for (std::size_t i = 1; i < by_line.size(); ++i) {
    if (by_line[i].first == by_line[i - 1].first) {
      gaps.push_back(by_line[i].second - by_line[i - 1].second);
    }
  }
  std::sort(gaps.begin(), gaps.end());
  std::vector<std::pair<std::size_t, double>> counted;
  double last = 0.0;
  for (const double gap : gaps) {
    if (gap <= kCoaxial_mm) continue;
    if (counted.empty() || gap - last > kCoaxial_mm) counted.emplace_back(0, gap);
    ++counted.back().first;
    last = gap;
  }
  std::stable_sort(counted.begin(), counted.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<double> result;
  for (const auto& [count, gap] : counted) {
    if (result.size() < kMaxPitches) result.push_back(gap);
  }
  return result;
}

/// Lines of the lattice between its outermost cells along one axis.
struct Extent {
  long low = 0;
  long high = 0;
  long lines() const { return high - low + 1; }
};

std::array<Extent, 2> extents(const std::vector<Cell>& cells) {
  std::array<Extent, 2> result;
  for (const std::size_t d : {0U, 1U}) {
    const auto [low, high] =
        std::minmax_element(cells.begin(), cells.end(),
                            [d](const Cell& a, const Cell& b) { return a.index[d] < b.index[d]; });
    result[d] = {low->index[d], high->index[d]};
  }
  return result;
}

/// Takes the emptiest outer line away until enough places are filled; nothing where too little is
/// left. So a few equal holes outside a grid do not spoil it.
std::optional<Lattice> trimmed(std::vector<Cell> cells) {
  while (cells.size() >= kFewestHoles) {
    const std::array<Extent, 2> extent = extents(cells);
    const long fewer = std::min(extent[0].lines(), extent[1].lines());
    const long more = std::max(extent[0].lines(), extent[1].lines());
    if (fewer < kFewestLines || more < kFewestLongLines) return std::nullopt;
    const double places = static_cast<double>(fewer) * static_cast<double>(more);
    if (static_cast<double>(cells.size()) >= kFewestFilled * places) {
      for (Cell& cell : cells) {
        for (const std::size_t d : {0U, 1U}) cell.index[d] -= extent[d].low;
      }
      return Lattice{std::move(cells), places};
    }
    double emptiest = std::numeric_limits<double>::infinity();
    std::pair<std::size_t, long> line;
    for (const std::size_t d : {0U, 1U}) {
      for (const long index : {extent[d].high, extent[d].low}) {
        const auto count = std::count_if(cells.begin(), cells.end(),
                                         [&](const Cell& cell) { return cell.index[d] == index; });
        const double filled =
            static_cast<double>(count) / static_cast<double>(extent[1 - d].lines());
        if (filled < emptiest) {
          emptiest = filled;
          line = {d, index};
        }
      }
    }
    cells.erase(
        std::remove_if(cells.begin(), cells.end(),
                       [&](const Cell& cell) { return cell.index[line.first] == line.second; }),
        cells.end());
  }
  return std::nullopt;
}

bool is_better(const Lattice& a, const Lattice& b) {
  if (a.cells.size() != b.cells.size()) return a.cells.size() > b.cells.size();
  return a.places < b.places;
}

/// Whether the spots stand on one circle, one of them perhaps in its middle: a bolt circle, though
/// six around a seventh fill as many places of a lattice as a chequered grid does.
bool is_circle(const std::vector<Spot>& spots, const std::vector<Cell>& cells) {
  // A ring on more lines than three each way leaves too many places empty to come here.
  constexpr std::size_t kMostOnRing = 12;
  if (cells.size() > kMostOnRing) return false;
  std::vector<Eigen::Vector2d> at;
  Eigen::Vector2d center = Eigen::Vector2d::Zero();
  for (const Spot& spot : spots) {
    if (std::ranges::find(cells, spot.hole, &Cell::hole) == cells.end()) continue;
    at.push_back(spot.at);
    center += spot.at / static_cast<double>(cells.size());
  }
  double radius_mm = 0.0;
  for (const Eigen::Vector2d& p : at) radius_mm = std::max(radius_mm, (p - center).norm());
  const auto inside = std::ranges::count_if(at, [&](const Eigen::Vector2d& p) {
    return (p - center).norm() < radius_mm - 2.0 * kCoaxial_mm;
  });
  const bool has_center = std::ranges::any_of(
      at, [&](const Eigen::Vector2d& p) { return (p - center).norm() <= 2.0 * kCoaxial_mm; });
  return inside == 0 || (inside == 1 && has_center);
}

/// The best lattice of that pitch: spots that are whole pitches away from one of them.
std::optional<Lattice> best_of_pitch(const std::vector<Spot>& spots, const Eigen::Vector2d& pitch) {
  std::optional<Lattice> best;
  std::vector<bool> is_used(spots.size(), false);
  for (std::size_t anchor = 0; anchor < spots.size(); ++anchor) {
    if (is_used[anchor]) continue;
    std::vector<Cell> cells;
    for (std::size_t i = anchor; i < spots.size(); ++i) {
      if (is_used[i]) continue;
      const Eigen::Vector2d steps = (spots[i].at - spots[anchor].at).cwiseQuotient(pitch);
      const Eigen::Vector2d whole(std::round(steps.x()), std::round(steps.y()));
      if (((steps - whole).cwiseProduct(pitch).array().abs() > kCoaxial_mm).any()) continue;
      is_used[i] = true;
      cells.push_back({spots[i].hole, {std::lround(whole.x()), std::lround(whole.y())}});
    }
    if (cells.size() < kFewestHoles) continue;
    std::optional<Lattice> lattice = trimmed(std::move(cells));
    if (lattice && is_circle(spots, lattice->cells)) continue;
    if (lattice && (!best || is_better(*lattice, *best))) best = std::move(lattice);
  }
  return best;
}

std::optional<Lattice> best_lattice(const std::vector<Spot>& spots) {
  std::optional<Lattice> best;
  for (const double column : pitches(spots, 0)) {
    for (const double row : pitches(spots, 1)) {
      std::optional<Lattice> lattice = best_of_pitch(spots, {column, row});
      if (lattice && (!best || is_better(*lattice, *best))) best = std::move(lattice);
    }
  }
  return best;
}

/// All lattices whose rows run at `angle_rad` to the right.
std::vector<HoleGrid> grids_at_angle(std::vector<Spot> spots, double angle_rad) {
  const Eigen::Vector2d along(std::cos(angle_rad), std::sin(angle_rad));
  for (Spot& spot : spots) {
    spot.at =
        Eigen::Vector2d(along.dot(spot.at), along.x() * spot.at.y() - along.y() * spot.at.x());
  }
  std::vector<double> x;
  std::vector<double> y;
  for (const Spot& spot : spots) {
    x.push_back(spot.at.x());
    y.push_back(spot.at.y());
  }
  const std::vector<std::size_t> column = ranks(x, kCoaxial_mm);
  const std::vector<std::size_t> row = ranks(y, kCoaxial_mm);
  std::vector<std::tuple<std::size_t, std::size_t, std::size_t>> order;
  for (std::size_t i = 0; i < spots.size(); ++i) order.emplace_back(row[i], column[i], i);
  std::sort(order.begin(), order.end());
  std::vector<Spot> left;
  left.reserve(order.size());
  for (const auto& [r, c, i] : order) left.push_back(spots[i]);

  std::vector<HoleGrid> grids;
  while (left.size() >= kFewestHoles) {
    const std::optional<Lattice> lattice = best_lattice(left);
    if (!lattice) break;
    HoleGrid grid;
    for (const Cell& cell : lattice->cells) {
      grid.places.push_back({cell.hole, static_cast<std::size_t>(cell.index[1]),
                             static_cast<std::size_t>(cell.index[0])});
    }
    std::sort(grid.places.begin(), grid.places.end(), [](const GridPlace& a, const GridPlace& b) {
      return std::tie(a.row, a.column, a.hole) < std::tie(b.row, b.column, b.hole);
    });
    left.erase(std::remove_if(left.begin(), left.end(),
                              [&](const Spot& spot) {
                                return std::any_of(
                                    grid.places.begin(), grid.places.end(),
                                    [&](const GridPlace& p) { return p.hole == spot.hole; });
                              }),
               left.end());
    grids.push_back(std::move(grid));
  }
  return grids;
}

/// Direction of the shortest step between two spots, turned by quarters to within 45 degrees of the
/// right; among equal steps the one nearest to it.
double lattice_angle_rad(const std::vector<Spot>& spots) {
  double shortest_mm = std::numeric_limits<double>::infinity();
  double best_rad = 0.0;
  for (std::size_t i = 0; i < spots.size(); ++i) {
    for (std::size_t j = i + 1; j < spots.size(); ++j) {
      const Eigen::Vector2d step = spots[j].at - spots[i].at;
      const double length_mm = step.norm();
      if (length_mm > shortest_mm + kSameFeature_mm) continue;
      const double angle_rad =
          std::remainder(std::atan2(step.y(), step.x()), 0.5 * std::numbers::pi);
      if (length_mm < shortest_mm - kSameFeature_mm || std::abs(angle_rad) < std::abs(best_rad)) {
        best_rad = angle_rad;
      }
      shortest_mm = std::min(shortest_mm, length_mm);
    }
  }
  return best_rad;
}

std::vector<std::vector<std::size_t>> equal_holes(const std::vector<Feature>& holes) {
  std::vector<std::vector<std::size_t>> groups;
  for (const std::size_t i : canonical_order(holes, OrderBy::Direction)) {
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const auto& g) {
      return are_equal_holes(holes[g.front()], holes[i]);
    });
    if (group == groups.end()) {
      groups.push_back({i});
    } else {
      group->push_back(i);
    }
  }
  return groups;
}

}  // namespace

bool are_equal_holes(const Feature& a, const Feature& b) {
  return a.through == b.through && a.blind_end == b.blind_end &&
         a.direction.dot(b.direction) > 0.0 &&
         a.direction.cross(b.direction).norm() <= kCoaxial_rad &&
         std::abs(a.direction.dot(b.origin - a.origin)) <= kSameFeature_mm &&
         std::abs(a.depth_mm - b.depth_mm) <= kSameFeature_mm &&
         std::equal(a.segments.begin(), a.segments.end(), b.segments.begin(), b.segments.end(),
                    are_equal_segments);
}

ViewFrame view_frame(const Eigen::Vector3d& normal) {
  const Eigen::Vector3d up =
      std::abs(normal.z()) > kLying ? Eigen::Vector3d::UnitY() : Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d right = up.cross(normal).normalized();
  return {right, normal.cross(right)};
}

std::vector<HoleGrid> find_hole_grids(const std::vector<Feature>& holes) {
  std::vector<HoleGrid> grids;
  for (const std::vector<std::size_t>& group : equal_holes(holes)) {
    if (group.size() < kFewestHoles) continue;
    const ViewFrame view = view_frame(-holes[group.front()].direction);
    std::vector<Spot> spots;
    spots.reserve(group.size());
    for (const std::size_t i : group) {
      spots.push_back({i, {view.right.dot(holes[i].origin), view.up.dot(holes[i].origin)}});
    }
    std::vector<HoleGrid> found = grids_at_angle(spots, 0.0);
    if (found.empty()) found = grids_at_angle(spots, lattice_angle_rad(spots));
    for (HoleGrid& grid : found) grids.push_back(std::move(grid));
  }
  std::vector<double> diameters_mm;
  diameters_mm.reserve(grids.size());
  for (const HoleGrid& grid : grids) {
    diameters_mm.push_back(holes[grid.places.front().hole].diameter_mm);
  }
  const std::vector<std::size_t> diameter = ranks(diameters_mm, kSameFeature_mm);
  // Groups come in canonical order, so that their number breaks ties.
  std::vector<std::tuple<std::size_t, std::size_t, std::size_t>> order;
  for (std::size_t i = 0; i < grids.size(); ++i) {
    order.emplace_back(holes.size() - grids[i].places.size(), diameter[i], i);
  }
  std::sort(order.begin(), order.end());
  std::vector<HoleGrid> sorted;
  sorted.reserve(order.size());
  for (const auto& [size, rank, i] : order) sorted.push_back(std::move(grids[i]));
  return sorted;
}

}  // namespace dowel
