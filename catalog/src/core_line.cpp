#include "core_line.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "dowel/kernel/predicates.h"
#include "dowel/kernel/tolerance.h"
#include "facet_geometry.h"

namespace dowel {
namespace {

/// Directions that are kept at a time: a fixture's holes have three, and each takes memory.
constexpr std::size_t kMostKnown = 4;

/// Height of a crossing, and whether the line leaves the material there.
using Crossing = std::pair<double, bool>;

/// All crossings with the line through `point` of the plane, at heights from `base_mm`; nothing
/// where it meets an edge of a facet (then the crossing would count twice or not at all).
std::optional<std::vector<Crossing>> crossings(const FacetedSolid& solid, std::uint32_t lump,
                                               const ProjectedFacets& facets,
                                               const Eigen::Vector2d& point, double base_mm) {
  std::vector<Crossing> result;
  for (const std::uint32_t t : facets.facets_near(point)) {
    const Triangle& triangle = solid.triangles[t];
    const Eigen::Vector2d& a = facets.flat(triangle[0]);
    const Eigen::Vector2d& b = facets.flat(triangle[1]);
    const Eigen::Vector2d& c = facets.flat(triangle[2]);
    if (point.x() < std::min({a.x(), b.x(), c.x()}) ||
        point.x() > std::max({a.x(), b.x(), c.x()}) ||
        point.y() < std::min({a.y(), b.y(), c.y()}) ||
        point.y() > std::max({a.y(), b.y(), c.y()})) {
      continue;
    }
    if (solid.faces[solid.face_of[t]].solid != lump) continue;
    const std::array<int, 3> side{orient2d(b, c, point), orient2d(c, a, point),
                                  orient2d(a, b, point)};
    const bool has_left = side[0] > 0 || side[1] > 0 || side[2] > 0;
    const bool has_right = side[0] < 0 || side[1] < 0 || side[2] < 0;
    if (has_left && has_right) continue;
    if (side[0] == 0 || side[1] == 0 || side[2] == 0) return std::nullopt;
    const auto weight = [&](const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
      return (p.x() - point.x()) * (q.y() - point.y()) - (p.y() - point.y()) * (q.x() - point.x());
    };
    const double wa = weight(b, c);
    const double wb = weight(c, a);
    const double wc = weight(a, b);
    const double sum = wa + wb + wc;
    if (sum == 0.0) return std::nullopt;
    const double height_mm =
        (wa * facets.height_mm(triangle[0]) + wb * facets.height_mm(triangle[1]) +
         wc * facets.height_mm(triangle[2])) /
        sum;
    result.emplace_back(height_mm - base_mm, has_left);  // counter-clockwise: the facet faces up
  }
  std::sort(result.begin(), result.end());
  return result;
}

std::vector<VoidStretch> stretches(const std::vector<Crossing>& crossings) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::vector<VoidStretch> result{{-kInfinity, kInfinity}};
  for (const auto& [height, leaves] : crossings) {
    if (leaves) {
      result.push_back({height, kInfinity});
    } else {
      result.back().high_mm = std::min(result.back().high_mm, height);
    }
  }
  return result;
}

}  // namespace

ProjectedFacets::ProjectedFacets(const FacetedSolid& solid, const Eigen::Vector3d& direction)
    : direction_(direction), u_(any_perpendicular(direction)), v_(direction.cross(u_)) {
  if (solid.vertices.empty()) return;
  flat_.reserve(solid.vertices.size());
  height_.reserve(solid.vertices.size());
  Eigen::Vector2d high = flat(solid.vertices.front());
  low_ = high;
  for (const Eigen::Vector3d& p : solid.vertices) {
    flat_.push_back(flat(p));
    height_.push_back(height_mm(p));
    low_ = low_.cwiseMin(flat_.back());
    high = high.cwiseMax(flat_.back());
  }
  // Some four facets a cell, were they all small.
  side_ =
      static_cast<std::size_t>(0.5 * std::sqrt(static_cast<double>(solid.triangles.size()))) + 1;
  for (const Eigen::Index axis : {0, 1}) {
    const double length_mm = high[axis] - low_[axis];
    if (length_mm > 0.0) cells_per_mm_[axis] = static_cast<double>(side_) / length_mm;
  }
  // Counted, then placed.
  begin_.assign(side_ * side_ + 1, 0);
  const auto for_each_cell = [&](const auto& visit) {
    for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
      const Cells cells = cells_of(solid.triangles[t]);
      for (std::size_t y = cells.low[1]; y <= cells.high[1]; ++y) {
        for (std::size_t x = cells.low[0]; x <= cells.high[0]; ++x) visit(y * side_ + x, t);
      }
    }
  };
  for_each_cell([this](std::size_t cell, std::uint32_t) { ++begin_[cell + 1]; });
  for (std::size_t cell = 1; cell < begin_.size(); ++cell) begin_[cell] += begin_[cell - 1];
  facets_.resize(begin_.back());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for_each_cell([&](std::size_t cell, std::uint32_t t) { facets_[next[cell]++] = t; });
}

/// Monotone, so that a point between two others lies in a cell between theirs.
std::size_t ProjectedFacets::cell_along(double coordinate, Eigen::Index axis) const {
  const double cell = (coordinate - low_[axis]) * cells_per_mm_[axis];
  return static_cast<std::size_t>(std::clamp(cell, 0.0, static_cast<double>(side_ - 1)));
}

ProjectedFacets::Cells ProjectedFacets::cells_of(const Triangle& triangle) const {
  const Eigen::Vector2d& a = flat_[triangle[0]];
  const Eigen::Vector2d& b = flat_[triangle[1]];
  const Eigen::Vector2d& c = flat_[triangle[2]];
  const Eigen::Vector2d low = a.cwiseMin(b).cwiseMin(c);
  const Eigen::Vector2d high = a.cwiseMax(b).cwiseMax(c);
  return {{cell_along(low.x(), 0), cell_along(low.y(), 1)},
          {cell_along(high.x(), 0), cell_along(high.y(), 1)}};
}

std::span<const std::uint32_t> ProjectedFacets::facets_near(const Eigen::Vector2d& point) const {
  if (flat_.empty()) return {};
  const std::size_t cell = cell_along(point.y(), 1) * side_ + cell_along(point.x(), 0);
  return std::span(facets_).subspan(begin_[cell], begin_[cell + 1] - begin_[cell]);
}

const ProjectedFacets& VoidFinder::projected(const Eigen::Vector3d& direction) {
  for (const ProjectedFacets& facets : known_) {
    if ((facets.direction() - direction).norm() <= kUnitVectorSlack) return facets;
  }
  if (known_.size() < kMostKnown) return known_.emplace_back(solid_, direction);
  ProjectedFacets& oldest = known_[next_];
  next_ = (next_ + 1) % kMostKnown;
  oldest = ProjectedFacets(solid_, direction);
  return oldest;
}

std::vector<VoidStretch> VoidFinder::along(std::uint32_t lump, const Axis& axis, double offset_mm) {
  const ProjectedFacets& facets = projected(axis.direction);
  const Eigen::Vector2d middle = facets.flat(axis.origin);
  const double base_mm = facets.height_mm(axis.origin);
  // Directions without a simple ratio to any drawn angle.
  constexpr std::array<std::array<double, 2>, 5> kOffsets{
      {{0.877, 0.479}, {-0.353, 0.917}, {0.211, -0.871}, {-0.733, -0.293}, {0.419, 0.607}}};
  for (const auto& [x, y] : kOffsets) {
    const auto found =
        crossings(solid_, lump, facets, middle + offset_mm * Eigen::Vector2d(x, y), base_mm);
    if (found) return stretches(*found);
  }
  return {};
}

}  // namespace dowel
