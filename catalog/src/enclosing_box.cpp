#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <variant>

#include <Eigen/Geometry>

#include "axis.h"
#include "dowel/catalog/recognition.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/minimum_box.h"
#include "face_graph.h"
#include "facet_geometry.h"

namespace dowel {
namespace {

/// Part of the smallest half extent that is left to an exact reach: five digits of a size are true
/// with room to spare, and searching longer would show nowhere.
constexpr double kReachSlackRatio = 1.0e-7;

/// A quarter of what a box may be larger than the best one known. A box flush with faces is worth
/// that much, too.
constexpr double kWorthTurning = 2.5e-4;

// The search for a better turn: how far it goes and how precisely it looks.
constexpr double kFirstTurn_rad = 0.2;
constexpr double kLastTurn_rad = 1.0e-4;
constexpr double kTurnedSlackRatio = 1.0e-5;
constexpr int kMostTurns = 64;

struct Range {
  double low_mm = std::numeric_limits<double>::infinity();
  double high_mm = -std::numeric_limits<double>::infinity();
  void extend(double value_mm) {
    low_mm = std::min(low_mm, value_mm);
    high_mm = std::max(high_mm, value_mm);
  }
};

/// Heights along `axis` that the exact face can reach. Where its rim is level at an end (both
/// corners of a rim edge at the extreme), a plane square to the axis bounds it and the vertices
/// tell; a wavy rim may pass them by the facet error.
Range heights(const FacetedSolid& solid, const FaceNode& node, double facet_error_mm,
              const Axis& axis) {
  Range range;
  for (const std::uint32_t v : node.vertices) range.extend(axis.height_mm(solid.vertices[v]));
  bool low_is_level = false;
  bool high_is_level = false;
  for (const RimEdge& edge : node.rim) {
    const double a = axis.height_mm(solid.vertices[edge.from]);
    const double b = axis.height_mm(solid.vertices[edge.to]);
    if (std::abs(a - b) > kMinTolerance_mm) continue;
    low_is_level = low_is_level || std::abs(a - range.low_mm) <= kMinTolerance_mm;
    high_is_level = high_is_level || std::abs(a - range.high_mm) <= kMinTolerance_mm;
  }
  if (!low_is_level) range.low_mm -= facet_error_mm;
  if (!high_is_level) range.high_mm += facet_error_mm;
  return range;
}

/// Length of the part of the unit vector `direction` across `axis`.
double sine(const Eigen::Vector3d& direction, const Eigen::Vector3d& axis) {
  return direction.cross(axis).norm();
}

/// Upper bound of `direction . p` over the exact face, by its surface; infinite for a free-form
/// one.
struct SurfaceReach {
  const FacetedSolid& solid;
  const FaceNode& node;
  double facet_error_mm;
  Eigen::Vector3d direction;

  double operator()(const OtherSurface& /*surface*/) const {
    return std::numeric_limits<double>::infinity();
  }
  double operator()(const PlaneSurface& /*surface*/) const {
    return -std::numeric_limits<double>::infinity();
  }
  double operator()(const CylinderSurface& cylinder) const {
    const Axis axis{cylinder.origin, cylinder.axis};
    const Range range = heights(solid, node, facet_error_mm, axis);
    const double slope = direction.dot(cylinder.axis);
    return direction.dot(cylinder.origin) + std::max(slope * range.low_mm, slope * range.high_mm) +
           cylinder.radius_mm * sine(direction, cylinder.axis);
  }
  double operator()(const ConeSurface& cone) const {
    const Axis axis{cone.apex, cone.axis};
    const Range range = heights(solid, node, facet_error_mm, axis);
    double reach = -std::numeric_limits<double>::infinity();
    for (const double height : {std::max(0.0, range.low_mm), range.high_mm}) {
      reach =
          std::max(reach, direction.dot(axis.at(height)) +
                              height * std::tan(cone.half_angle_rad) * sine(direction, cone.axis));
    }
    return reach;
  }
  double operator()(const SphereSurface& sphere) const {
    return direction.dot(sphere.center) + sphere.radius_mm;
  }
  double operator()(const TorusSurface& torus) const {
    return direction.dot(torus.center) + torus.major_radius_mm * sine(direction, torus.axis) +
           torus.minor_radius_mm;
  }
};

/// A wall that curves around void between flat faces lies behind its own rim, which those bound.
bool is_behind_its_rim(const std::vector<FaceNode>& graph, const FaceNode& node) {
  if (!node.reversed || std::holds_alternative<TorusSurface>(node.surface)) return false;
  return std::all_of(node.neighbours.begin(), node.neighbours.end(),
                     [&](std::uint32_t next) { return is_plane(graph[next].surface); });
}

/// Reach of the exact solid along `direction`, from above and no further than the facet errors.
double reach_mm(const FacetedSolid& solid, const std::vector<FaceNode>& graph,
                const Eigen::Vector3d& direction) {
  std::vector<double> along;
  along.reserve(solid.vertices.size());
  double reach = -std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& p : solid.vertices) {
    along.push_back(direction.dot(p));
    reach = std::max(reach, along.back());
  }
  const double facets = reach;
  for (std::size_t f = 0; f < graph.size(); ++f) {
    const FaceNode& node = graph[f];
    const double error = solid.faces[f].facet_error_mm;
    if (!(error > 0.0)) continue;
    double face = -std::numeric_limits<double>::infinity();
    for (const std::uint32_t v : node.vertices) face = std::max(face, along[v]);
    if (!(face + error > facets) || is_behind_its_rim(graph, node)) continue;
    const double exact = std::visit(SurfaceReach{solid, node, error, direction}, node.surface);
    reach = std::max(reach, std::min(face + error, std::max(exact, face)));
  }
  return reach;
}

/// Box along `axes` around what reaches as far as `reach_mm(direction)` says.
template <class Reach>
Obb box_along(const Eigen::Matrix3d& axes, const Reach& reach_mm) {
  Obb box;
  box.axes = axes;
  Eigen::Vector3d center;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double high = reach_mm(axes.col(i));
    const double low = -reach_mm(-axes.col(i));
    center[i] = 0.5 * (low + high);
    box.half_extents_mm[i] = 0.5 * (high - low);
  }
  box.center = axes * center;
  return box;
}

/// The frame of the same axes that is closest to the identity.
Eigen::Matrix3d nearest_identity(const Eigen::Matrix3d& axes) {
  Eigen::Matrix3d best = axes;
  std::array<Eigen::Index, 3> order{0, 1, 2};
  do {
    for (unsigned signs = 0; signs < 8; ++signs) {
      Eigen::Matrix3d frame;
      for (Eigen::Index i = 0; i < 3; ++i) {
        const double sign = ((signs >> static_cast<unsigned>(i)) & 1U) != 0 ? -1.0 : 1.0;
        frame.col(i) = sign * axes.col(order[static_cast<std::size_t>(i)]);
      }
      if (frame.determinant() > 0.0 && frame.trace() > best.trace() + kUnitVectorSlack) {
        best = frame;
      }
    }
  } while (std::next_permutation(order.begin(), order.end()));
  return best;
}

/// Frame of the largest planar face and the largest one square to it.
std::optional<Eigen::Matrix3d> planar_frame(const std::vector<FaceNode>& graph) {
  std::vector<std::pair<double, Eigen::Vector3d>> planes;
  for (const FaceNode& node : graph) {
    if (const auto* plane = std::get_if<PlaneSurface>(&node.surface)) {
      planes.emplace_back(node.area_mm2, plane->normal);
    }
  }
  std::sort(planes.begin(), planes.end(), [](const auto& a, const auto& b) {
    if (a.first != b.first) return a.first > b.first;
    return less_by_coordinates(a.second, b.second);
  });
  for (std::size_t i = 1; i < planes.size(); ++i) {
    const Eigen::Vector3d& first = planes.front().second;
    const Eigen::Vector3d& second = planes[i].second;
    if (std::abs(first.dot(second)) > kCoaxial_rad) continue;
    Eigen::Matrix3d frame;
    frame.col(0) = first;
    frame.col(2) = first.cross(second).normalized();
    frame.col(1) = frame.col(2).cross(first);
    return nearest_identity(frame);
  }
  return std::nullopt;
}

/// `box`, or that of the largest planar faces where it is smaller.
template <class Reach>
Obb smaller_square(const Obb& box, const std::vector<FaceNode>& graph, const Reach& reach_mm) {
  const std::optional<Eigen::Matrix3d> frame = planar_frame(graph);
  if (!frame) return box;
  const Obb square = box_along(*frame, reach_mm);
  return square.volume_mm3() < box.volume_mm3() * (1.0 - kBoxSlackRatio) ? square : box;
}

/// Turns the box about its own axes, by less and less, as long as it shrinks.
template <class Reach>
Eigen::Matrix3d turned_axes(Eigen::Matrix3d axes, const Reach& reach_mm) {
  double volume_mm3 = box_along(axes, reach_mm).volume_mm3();
  int turns = 0;
  for (double step_rad = kFirstTurn_rad; step_rad > kLastTurn_rad; step_rad *= 0.5) {
    bool is_improving = true;
    while (is_improving && turns < kMostTurns) {
      is_improving = false;
      for (Eigen::Index i = 0; i < 3; ++i) {
        for (const double angle_rad : {-step_rad, step_rad}) {
          const Eigen::AngleAxisd turn(angle_rad, axes.col(i).normalized());
          const Eigen::Matrix3d turned = turn.toRotationMatrix() * axes;
          const double turned_mm3 = box_along(turned, reach_mm).volume_mm3();
          if (turned_mm3 >= volume_mm3 * (1.0 - kTurnedSlackRatio)) continue;
          volume_mm3 = turned_mm3;
          axes = turned;
          is_improving = true;
          ++turns;
        }
      }
    }
  }
  // Products of turns drift from right angles by rounding.
  return Eigen::Quaterniond(axes).normalized().toRotationMatrix();
}

}  // namespace

Obb enclosing_box(const FacetedSolid& solid) {
  DOWEL_EXPECTS(!solid.vertices.empty());
  const std::vector<FaceNode> graph = face_graph(solid);
  const auto reach = [&](const Eigen::Vector3d& d) { return reach_mm(solid, graph, d); };
  const Obb facets = minimum_box(solid.vertices);
  Obb best = box_along(facets.axes, reach);
  // Never smaller than the box found, whose own rounding is its maker's business.
  best.half_extents_mm = best.half_extents_mm.cwiseMax(facets.half_extents_mm);
  // The facets' box may stand askew by what they leave out of a rounded corner.
  return smaller_square(best, graph, reach);
}

Obb enclosing_box(const FacetedSolid& solid, const ExactReachFunction& reach_mm) {
  DOWEL_EXPECTS(!solid.vertices.empty());
  const Obb facets = minimum_box(solid.vertices);
  const double slack_mm =
      std::max(kMinTolerance_mm, kReachSlackRatio * facets.half_extents_mm.minCoeff());
  const auto reach = [&](const Eigen::Vector3d& d) { return reach_mm(d, slack_mm); };
  Obb box = box_along(facets.axes, reach);
  box.half_extents_mm = box.half_extents_mm.cwiseMax(facets.half_extents_mm);
  box = smaller_square(box, face_graph(solid), reach);
  // No box of the solid is smaller than that of points on it: where it is hardly larger, none is
  // worth looking for.
  if (box.volume_mm3() <= (1.0 + kWorthTurning) * facets.volume_mm3()) return box;
  const double coarse_mm = std::max(slack_mm, kTurnedSlackRatio * box.half_extents_mm.minCoeff());
  const Obb turned = box_along(
      turned_axes(box.axes, [&](const Eigen::Vector3d& d) { return reach_mm(d, coarse_mm); }),
      reach);
  return turned.volume_mm3() < (1.0 - kWorthTurning) * box.volume_mm3() ? turned : box;
}

}  // namespace dowel
