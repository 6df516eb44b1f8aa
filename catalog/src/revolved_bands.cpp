#include "revolved_bands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <tuple>

#include "band_end.h"
#include "disjoint_sets.h"
#include "dowel/kernel/tolerance.h"
#include "facet_geometry.h"

namespace dowel {
namespace {

/// A band must cover this part of the turn: more than a half-hole in an edge (0.5) or the end of a
/// slot, less than a bore with a keyway or a shaft with a flat.
constexpr double kFullTurn = 0.75;

/// A cylinder or cone with the stretch of its own axis that its vertices span.
struct AxialFace {
  std::uint32_t face = 0;
  Axis axis;
  double low_mm = 0.0;
  double high_mm = 0.0;
  double span_mm() const { return high_mm - low_mm; }
};

/// A line has two directions; take the one that rises, so that equal lines agree.
Eigen::Vector3d rising(const Eigen::Vector3d& direction) {
  for (const Eigen::Index i : {2, 1, 0}) {
    if (std::abs(direction[i]) > kUnitVectorSlack) {
      return direction[i] > 0.0 ? direction : Eigen::Vector3d(-direction);
    }
  }
  return direction;
}

std::optional<AxialFace> axial_face(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                                    std::uint32_t face) {
  AxialFace result;
  result.face = face;
  if (const auto* cylinder = std::get_if<CylinderSurface>(&graph[face].surface)) {
    result.axis = {cylinder->origin, rising(cylinder->axis)};
  } else if (const auto* cone = std::get_if<ConeSurface>(&graph[face].surface)) {
    result.axis = {cone->apex, rising(cone->axis)};
  } else {
    return std::nullopt;
  }
  if (graph[face].vertices.empty()) return std::nullopt;
  result.low_mm = std::numeric_limits<double>::infinity();
  result.high_mm = -result.low_mm;
  for (const std::uint32_t v : graph[face].vertices) {
    const double height = result.axis.height_mm(solid.vertices[v]);
    result.low_mm = std::min(result.low_mm, height);
    result.high_mm = std::max(result.high_mm, height);
  }
  return result;
}

/// By where the axes are needed, at the faces, not by their angle: a short face's direction says
/// little about the far end of a long one.
bool are_coaxial(const AxialFace& a, const AxialFace& b) {
  const AxialFace& longer = a.span_mm() >= b.span_mm() ? a : b;
  const AxialFace& shorter = a.span_mm() >= b.span_mm() ? b : a;
  if (std::abs(a.axis.direction.dot(b.axis.direction)) < std::cos(kCoaxial_rad)) return false;
  return longer.axis.distance_mm(shorter.axis.at(shorter.low_mm)) <= kSameFeature_mm &&
         longer.axis.distance_mm(shorter.axis.at(shorter.high_mm)) <= kSameFeature_mm;
}

/// Sets of coaxial faces of one solid. Coaxial lines pass the middle of the part at the same
/// place, so that sorting by it along some direction leaves few pairs to look at.
std::vector<std::vector<AxialFace>> coaxial_groups(const FacetedSolid& solid,
                                                   const std::vector<FaceNode>& graph) {
  std::vector<AxialFace> faces;
  for (std::uint32_t f = 0; f < graph.size(); ++f) {
    if (auto face = axial_face(solid, graph, f)) faces.push_back(*face);
  }
  Eigen::Vector3d low = Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity());
  Eigen::Vector3d high = -low;
  for (const Eigen::Vector3d& p : solid.vertices) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const Eigen::Vector3d middle = 0.5 * (low + high);
  const double window_mm = kSameFeature_mm + kCoaxial_rad * (high - low).norm();
  const Eigen::Vector3d probe = Eigen::Vector3d(0.48, 0.60, 0.64);
  const auto key = [&](const AxialFace& face) {
    const Axis& axis = face.axis;
    return probe.dot(axis.at(axis.height_mm(middle)) - middle);
  };
  std::vector<std::pair<double, std::size_t>> order;
  for (std::size_t i = 0; i < faces.size(); ++i) order.emplace_back(key(faces[i]), i);
  std::sort(order.begin(), order.end());

  DisjointSets sets(faces.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      if (order[j].first - order[i].first > window_mm) break;
      const AxialFace& a = faces[order[i].second];
      const AxialFace& b = faces[order[j].second];
      if (graph[a.face].solid != graph[b.face].solid) continue;
      if (!sets.are_joined(order[i].second, order[j].second) && are_coaxial(a, b)) {
        sets.join(order[i].second, order[j].second);
      }
    }
  }
  std::vector<std::vector<AxialFace>> groups;
  for (const std::vector<std::size_t>& members : sets.sets()) {
    groups.emplace_back();
    for (const std::size_t i : members) groups.back().push_back(faces[i]);
  }
  return groups;
}

/// The axis of the longest face; among equals the first by its numbers, not by its place.
Axis common_axis(const std::vector<AxialFace>& faces) {
  const auto before = [](const AxialFace& a, const AxialFace& b) {
    if (a.span_mm() != b.span_mm()) return a.span_mm() > b.span_mm();
    if (a.axis.direction != b.axis.direction) {
      return less_by_coordinates(a.axis.direction, b.axis.direction);
    }
    return less_by_coordinates(a.axis.origin, b.axis.origin);
  };
  return std::min_element(faces.begin(), faces.end(), before)->axis;
}

/// A cylinder's or cone's profile: radius over height of the common axis, and where it is used.
struct Profile {
  std::uint32_t face = 0;
  bool is_cylinder = true;
  bool is_inner = false;
  double base_mm = 0.0;  ///< radius at height 0
  double growth = 0.0;
  double low_mm = 0.0;
  double high_mm = 0.0;
  double radius_mm(double height_mm) const { return base_mm + growth * height_mm; }
};

Profile profile_of(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                   std::uint32_t face, const Axis& axis) {
  const FaceNode& node = graph[face];
  Profile profile;
  profile.face = face;
  profile.is_inner = node.reversed;
  if (const auto* cylinder = std::get_if<CylinderSurface>(&node.surface)) {
    profile.base_mm = cylinder->radius_mm;
  } else {
    const auto& cone = std::get<ConeSurface>(node.surface);
    profile.is_cylinder = false;
    profile.growth = std::copysign(std::tan(cone.half_angle_rad), cone.axis.dot(axis.direction));
    profile.base_mm = -profile.growth * axis.height_mm(cone.apex);
  }
  profile.low_mm = std::numeric_limits<double>::infinity();
  profile.high_mm = -profile.low_mm;
  for (const std::uint32_t v : node.vertices) {
    const double height = axis.height_mm(solid.vertices[v]);
    profile.low_mm = std::min(profile.low_mm, height);
    profile.high_mm = std::max(profile.high_mm, height);
  }
  return profile;
}

/// The same cylinder or cone, over heights that meet.
bool continue_each_other(const Profile& a, const Profile& b) {
  if (a.is_cylinder != b.is_cylinder || a.is_inner != b.is_inner) return false;
  if (a.low_mm > b.high_mm + kSameFeature_mm || b.low_mm > a.high_mm + kSameFeature_mm) {
    return false;
  }
  for (const double height : {a.low_mm, a.high_mm, b.low_mm, b.high_mm}) {
    if (std::abs(a.radius_mm(height) - b.radius_mm(height)) > kSameFeature_mm) return false;
  }
  return true;
}

/// Part of the turn about the axis that the facets of `faces` cover, 0 to 1.
double turn_covered(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                    const std::vector<std::uint32_t>& faces, const Axis& axis) {
  constexpr double kTurn_rad = 2.0 * std::numbers::pi;
  const Eigen::Vector3d u = any_perpendicular(axis.direction);
  const Eigen::Vector3d v = axis.direction.cross(u);
  std::vector<std::pair<double, double>> arcs;  // from [0, turn), to
  std::vector<double> angles;                   // of one facet's corners; kept, for there are many
  for (const std::uint32_t face : faces) {
    for (const std::uint32_t t : graph[face].triangles) {
      // A facet covers the turn between its corners without their widest gap; a corner on the axis
      // has no angle.
      angles.clear();
      for (const Eigen::Vector3d& p : solid.corners(t)) {
        if (axis.distance_mm(p) <= kSameFeature_mm) continue;
        const double angle = std::atan2(v.dot(p - axis.origin), u.dot(p - axis.origin));
        angles.push_back(angle < 0.0 ? angle + kTurn_rad : angle);
      }
      if (angles.size() < 2) continue;
      std::sort(angles.begin(), angles.end());
      double widest = angles.front() + kTurn_rad - angles.back();
      double from = angles.front();
      for (std::size_t i = 0; i + 1 < angles.size(); ++i) {
        if (angles[i + 1] - angles[i] <= widest) continue;
        widest = angles[i + 1] - angles[i];
        from = angles[i + 1];
      }
      const double to = from + kTurn_rad - widest;
      arcs.emplace_back(from, std::min(to, kTurn_rad));
      if (to > kTurn_rad) arcs.emplace_back(0.0, to - kTurn_rad);
    }
  }
  std::sort(arcs.begin(), arcs.end());
  double covered = 0.0;
  double reached = 0.0;
  for (const auto& [from, to] : arcs) {
    covered += std::max(0.0, to - std::max(from, reached));
    reached = std::max(reached, to);
  }
  return covered / kTurn_rad;
}

std::vector<Band> bands_about(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                              const std::vector<AxialFace>& group, const Axis& axis) {
  std::vector<Profile> profiles;
  profiles.reserve(group.size());
  for (const AxialFace& face : group) {
    profiles.push_back(profile_of(solid, graph, face.face, axis));
  }
  DisjointSets sets(profiles.size());
  for (std::size_t i = 0; i < profiles.size(); ++i) {
    for (std::size_t j = i + 1; j < profiles.size(); ++j) {
      if (continue_each_other(profiles[i], profiles[j])) sets.join(i, j);
    }
  }
  std::vector<Band> bands;
  for (const std::vector<std::size_t>& members : sets.sets()) {
    Profile profile = profiles[members.front()];
    Band band;
    for (const std::size_t i : members) {
      const Profile& other = profiles[i];
      band.faces.push_back(other.face);
      // Of profiles that are the same within the tolerance, none may win by its place.
      if (std::tie(other.base_mm, other.growth) < std::tie(profile.base_mm, profile.growth)) {
        profile = other;
      }
    }
    std::sort(band.faces.begin(), band.faces.end());
    if (turn_covered(solid, graph, band.faces, axis) < kFullTurn) continue;
    band.is_cylinder = profile.is_cylinder;
    band.is_inner = profile.is_inner;
    find_ends(solid, graph, axis, band);
    for (const std::size_t i : {0U, 1U}) {
      const double radius_mm = profile.radius_mm(band.ends[i].rim_mm);
      band.radius_mm[i] = radius_mm > kSameFeature_mm ? radius_mm : 0.0;
    }
    bands.push_back(std::move(band));
  }
  std::sort(bands.begin(), bands.end(), [](const Band& a, const Band& b) {
    return std::tie(a.ends[0].rim_mm, a.ends[1].rim_mm, a.radius_mm) <
           std::tie(b.ends[0].rim_mm, b.ends[1].rim_mm, b.radius_mm);
  });
  return bands;
}

}  // namespace

std::vector<AxisBands> revolved_bands(const FacetedSolid& solid,
                                      const std::vector<FaceNode>& graph) {
  std::vector<AxisBands> result;
  for (const std::vector<AxialFace>& group : coaxial_groups(solid, graph)) {
    AxisBands about;
    about.axis = common_axis(group);
    about.solid = graph[group.front().face].solid;
    about.bands = bands_about(solid, graph, group, about.axis);
    if (!about.bands.empty()) result.push_back(std::move(about));
  }
  return result;
}

}  // namespace dowel
