#include "band_end.h"

#include <algorithm>
#include <limits>
#include <map>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "disjoint_sets.h"
#include "facet_geometry.h"

namespace dowel {
namespace {

/// A rim is "in one plane" where planes take up this much of it: a slot may nick it.
constexpr double kMostOfRim = 0.9;

/// A transition (fillet) must take up more than this part of the rim.
constexpr double kHalfOfRim = 0.5;

/// One piece of the rim: an edge of the mesh, seen from the band.
struct Piece {
  RimEdge edge;
  double turn_rad = 0.0;   ///< signed, about the axis
  double length_mm = 0.0;  ///< around the axis
  double middle_mm = 0.0;  ///< height
  bool widens = false;     ///< beyond it the material or void reaches further out
};

struct HeightRange {
  double low_mm = std::numeric_limits<double>::infinity();
  double high_mm = -std::numeric_limits<double>::infinity();
  void extend(double height_mm) {
    low_mm = std::min(low_mm, height_mm);
    high_mm = std::max(high_mm, height_mm);
  }
};

bool is_among(const std::vector<std::uint32_t>& sorted, std::uint32_t value) {
  return std::binary_search(sorted.begin(), sorted.end(), value);
}

HeightRange height_range(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                         const Axis& axis, const std::vector<std::uint32_t>& faces) {
  HeightRange range;
  for (const std::uint32_t face : faces) {
    for (const std::uint32_t v : graph[face].vertices) {
      range.extend(axis.height_mm(solid.vertices[v]));
    }
  }
  return range;
}

std::vector<Piece> rim_pieces(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                              const Axis& axis, const Band& band) {
  const Eigen::Vector3d u = any_perpendicular(axis.direction);
  const Eigen::Vector3d v = axis.direction.cross(u);
  std::vector<Piece> pieces;
  for (const std::uint32_t face : band.faces) {
    for (const RimEdge& edge : graph[face].rim) {
      if (is_among(band.faces, edge.face_across)) continue;
      const Eigen::Vector3d a = solid.vertices[edge.from] - axis.origin;
      const Eigen::Vector3d b = solid.vertices[edge.to] - axis.origin;
      const Eigen::Vector2d flat_a(u.dot(a), v.dot(a));
      const Eigen::Vector2d flat_b(u.dot(b), v.dot(b));
      Piece piece;
      piece.edge = edge;
      piece.turn_rad =
          std::atan2(flat_a.x() * flat_b.y() - flat_a.y() * flat_b.x(), flat_a.dot(flat_b));
      piece.length_mm = (flat_b - flat_a).norm();
      piece.middle_mm = 0.5 * axis.direction.dot(a + b);
      // A facet whose corners all lie on the rim's circle is a chord of the disc inside it.
      piece.widens = axis.distance_mm(solid.vertices[edge.apex_across]) >
                     std::max(flat_a.norm(), flat_b.norm()) + kSameFeature_mm;
      pieces.push_back(piece);
    }
  }
  return pieces;
}

/// Pieces that hang together, as indices.
std::vector<std::vector<std::size_t>> loops(const std::vector<Piece>& pieces) {
  DisjointSets sets(pieces.size());
  std::vector<std::pair<std::uint32_t, std::size_t>> piece_at;
  piece_at.reserve(2 * pieces.size());
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    piece_at.emplace_back(pieces[i].edge.from, i);
    piece_at.emplace_back(pieces[i].edge.to, i);
  }
  std::sort(piece_at.begin(), piece_at.end());
  for (std::size_t i = 1; i < piece_at.size(); ++i) {
    if (piece_at[i].first == piece_at[i - 1].first) {
      sets.join(piece_at[i - 1].second, piece_at[i].second);
    }
  }
  return sets.sets();
}

/// Sorts the pieces into those at the low and those at the high end. A loop that runs round the
/// axis is an end, and its sense tells which: the band lies to its left, seen from outside the
/// material. One that does not is the mouth of a crossing hole, or, where a keyway slits the band,
/// the whole rim.
std::array<std::vector<Piece>, 2> end_pieces(const std::vector<Piece>& pieces, const Band& band,
                                             const HeightRange& range) {
  std::array<std::vector<Piece>, 2> ends;
  for (const std::vector<std::size_t>& loop : loops(pieces)) {
    double turn_rad = 0.0;
    HeightRange reach;
    for (const std::size_t i : loop) {
      turn_rad += pieces[i].turn_rad;
      reach.extend(pieces[i].middle_mm);
    }
    const bool goes_round = std::abs(turn_rad) > std::numbers::pi;
    const bool is_low = (turn_rad > 0.0) != band.is_inner;
    const bool meets_low = reach.low_mm <= range.low_mm + kSameFeature_mm;
    const bool meets_high = reach.high_mm >= range.high_mm - kSameFeature_mm;
    for (const std::size_t i : loop) {
      if (goes_round) {
        ends[is_low ? 0 : 1].push_back(pieces[i]);
      } else if (meets_low && meets_high) {
        const bool nearer_low =
            pieces[i].middle_mm - range.low_mm < range.high_mm - pieces[i].middle_mm;
        ends[nearer_low ? 0 : 1].push_back(pieces[i]);
      } else if (meets_low || meets_high) {
        ends[meets_low ? 0 : 1].push_back(pieces[i]);
      }
    }
  }
  return ends;
}

/// A fillet's torus about the axis, or the ball that ends a bore.
bool is_transition(const FaceNode& node, const Axis& axis, double lean) {
  if (const auto* torus = std::get_if<TorusSurface>(&node.surface)) {
    return axis.is_parallel(torus->axis) && axis.distance_mm(torus->center) <= kSameFeature_mm;
  }
  if (const auto* sphere = std::get_if<SphereSurface>(&node.surface)) {
    return lean < 0.0 && axis.distance_mm(sphere->center) <= kSameFeature_mm;
  }
  return false;
}

/// Height where all planes in `faces` cut the axis; nothing where they do not agree.
std::optional<double> common_cut(const std::vector<FaceNode>& graph, const Axis& axis,
                                 const std::vector<std::uint32_t>& faces) {
  std::optional<double> cut_mm;
  for (const std::uint32_t face : faces) {
    const auto* plane = std::get_if<PlaneSurface>(&graph[face].surface);
    if (plane == nullptr || std::abs(plane->normal.dot(axis.direction)) < kCoaxial_rad) continue;
    const double height = axis.height_mm(*plane);
    if (cut_mm && std::abs(*cut_mm - height) > kSameFeature_mm) return std::nullopt;
    // Of planes that are the same within the tolerance, none may win by its place.
    cut_mm = cut_mm ? std::max(*cut_mm, height) : height;
  }
  return cut_mm;
}

void add_transition(const FacetedSolid& solid, const std::vector<FaceNode>& graph, const Axis& axis,
                    const Band& band, bool is_high, BandEnd& end) {
  const HeightRange range = height_range(solid, graph, axis, end.transition);
  end.height_mm = is_high ? range.high_mm : range.low_mm;
  end.beyond.clear();
  for (const std::uint32_t face : end.transition) {
    for (const std::uint32_t next : graph[face].neighbours) {
      if (is_among(band.faces, next) || is_among(end.transition, next)) continue;
      end.beyond.push_back(next);
    }
  }
  std::sort(end.beyond.begin(), end.beyond.end());
  end.beyond.erase(std::unique(end.beyond.begin(), end.beyond.end()), end.beyond.end());
  const auto* sphere = std::get_if<SphereSurface>(&graph[end.transition.front()].surface);
  if (sphere != nullptr && end.beyond.empty()) {
    end.is_ball = true;
    end.height_mm =
        axis.height_mm(sphere->center) + (is_high ? sphere->radius_mm : -sphere->radius_mm);
  }
  end.reach_mm =
      is_high ? std::max(end.reach_mm, end.height_mm) : std::min(end.reach_mm, end.height_mm);
}

BandEnd make_end(const FacetedSolid& solid, const std::vector<FaceNode>& graph, const Axis& axis,
                 const Band& band, const std::vector<Piece>& pieces, const HeightRange& range,
                 bool is_high) {
  BandEnd end;
  end.reach_mm = is_high ? range.high_mm : range.low_mm;
  end.rim_mm = end.reach_mm;
  std::map<std::uint32_t, double> rim_mm;
  double total_mm = 0.0;
  double widening_mm = 0.0;
  double planar_mm = 0.0;
  double inner_wall_mm = 0.0;
  for (const Piece& piece : pieces) {
    const FaceNode& across = graph[piece.edge.face_across];
    rim_mm[piece.edge.face_across] += piece.length_mm;
    total_mm += piece.length_mm;
    widening_mm += piece.widens ? piece.length_mm : -piece.length_mm;
    if (is_plane(across.surface)) planar_mm += piece.length_mm;
    if (const auto* wall = std::get_if<CylinderSurface>(&across.surface)) {
      if (across.reversed && !axis.is_parallel(wall->axis)) inner_wall_mm += piece.length_mm;
    }
  }
  for (const auto& [face, length] : rim_mm) end.across.push_back(face);
  std::stable_sort(end.across.begin(), end.across.end(),
                   [&](std::uint32_t a, std::uint32_t b) { return rim_mm.at(a) > rim_mm.at(b); });
  if (total_mm > 0.0) {
    end.lean = widening_mm / total_mm;
    end.inner_wall_share = inner_wall_mm / total_mm;
  }
  if (planar_mm > kMostOfRim * total_mm) {
    const std::optional<double> cut_mm = common_cut(graph, axis, end.across);
    if (cut_mm && *cut_mm > range.low_mm - kSameFeature_mm &&
        *cut_mm < range.high_mm + kSameFeature_mm) {
      end.rim_mm = *cut_mm;
    }
  }
  end.height_mm = end.rim_mm;
  end.beyond = end.across;

  double transition_mm = 0.0;
  for (const std::uint32_t face : end.across) {
    if (!is_transition(graph[face], axis, end.lean)) continue;
    end.transition.push_back(face);
    transition_mm += rim_mm.at(face);
  }
  std::sort(end.transition.begin(), end.transition.end());
  if (transition_mm > kHalfOfRim * total_mm) {
    add_transition(solid, graph, axis, band, is_high, end);
  } else {
    end.transition.clear();
  }
  return end;
}

}  // namespace

void find_ends(const FacetedSolid& solid, const std::vector<FaceNode>& graph, const Axis& axis,
               Band& band) {
  const HeightRange range = height_range(solid, graph, axis, band.faces);
  const std::array<std::vector<Piece>, 2> pieces =
      end_pieces(rim_pieces(solid, graph, axis, band), band, range);
  for (const std::size_t i : {0U, 1U}) {
    band.ends[i] = make_end(solid, graph, axis, band, pieces[i], range, i == 1);
  }
}

}  // namespace dowel
