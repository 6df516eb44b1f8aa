#include "drive.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include "dowel/catalog/metric_thread.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// Flats of a hexagon are as far from its axis as each other to this.
constexpr double kEqualFlats_mm = 0.02;

/// A head is wider than its thread by more than this all around.
constexpr double kHeadStep_mm = 0.5;

struct Flat {
  std::size_t face = 0;
  double distance_mm = 0.0;  ///< from the axis along the normal: below 0, it faces the axis
  Eigen::Vector3d normal;
};

std::vector<Flat> flats_about(const FacetedSolid& solid, const Drive& drive) {
  std::vector<Flat> flats;
  for (std::size_t face = 0; face < solid.faces.size(); ++face) {
    const auto* const plane = std::get_if<PlaneSurface>(&solid.faces[face].surface);
    if (plane == nullptr || std::abs(plane->normal.dot(drive.axis)) > kCoaxial_rad) continue;
    flats.push_back({face, plane->normal.dot(plane->origin - drive.axis_origin), plane->normal});
  }
  return flats;
}

/// Six flats as far from the axis as `first`, every 60 degrees from it.
std::vector<Flat> hexagon_with(const std::vector<Flat>& flats, const Flat& first) {
  std::vector<Flat> hexagon;
  for (const Flat& flat : flats) {
    if (std::abs(flat.distance_mm - first.distance_mm) > kEqualFlats_mm) continue;
    const double angle_rad = std::acos(std::clamp(first.normal.dot(flat.normal), -1.0, 1.0));
    const double sixths = angle_rad / (std::numbers::pi / 3.0);
    if (std::abs(sixths - std::round(sixths)) > kTangent_rad) continue;
    hexagon.push_back(flat);
  }
  const bool has_all = std::ranges::all_of(hexagon, [&](const Flat& flat) {
    return std::ranges::any_of(hexagon, [&](const Flat& other) {
      return flat.normal.dot(other.normal) < kTangent_rad - 1.0;
    });
  });
  return hexagon.size() == 6 && has_all ? hexagon : std::vector<Flat>();
}

void measure(Drive& drive, const FacetedSolid& solid, const std::vector<Flat>& hexagon,
             double thread_mm) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  drive.from_mm = drive.low_mm = drive.seat_mm = kInfinity;
  drive.to_mm = drive.high_mm = -kInfinity;
  const auto height_mm = [&](std::uint32_t vertex) {
    return drive.axis.dot(solid.vertices[vertex] - drive.axis_origin);
  };
  for (std::uint32_t vertex = 0; vertex < solid.vertices.size(); ++vertex) {
    drive.low_mm = std::min(drive.low_mm, height_mm(vertex));
    drive.high_mm = std::max(drive.high_mm, height_mm(vertex));
    const Eigen::Vector3d off = solid.vertices[vertex] - drive.axis_origin;
    const double radius_mm = off.cross(drive.axis).norm();
    drive.radius_mm = std::max(drive.radius_mm, radius_mm);
    if (radius_mm > 0.5 * thread_mm + kHeadStep_mm) {
      drive.seat_mm = std::min(drive.seat_mm, height_mm(vertex));
    }
  }
  for (std::size_t t = 0; t < solid.triangles.size(); ++t) {
    if (std::ranges::find(hexagon, std::size_t{solid.face_of[t]}, &Flat::face) == hexagon.end()) {
      continue;
    }
    for (const std::uint32_t vertex : solid.triangles[t]) {
      drive.from_mm = std::min(drive.from_mm, height_mm(vertex));
      drive.to_mm = std::max(drive.to_mm, height_mm(vertex));
    }
  }
}

}  // namespace

namespace {

/// Holes and shafts with a thread, those first of which it is stated.
std::vector<const Feature*> threaded(const Element& element) {
  std::vector<const Feature*> features;
  for (const Feature& feature : element.features) {
    const bool is_shaft = feature.kind == FeatureKind::Shaft;
    const bool is_hole = feature.kind == FeatureKind::Hole;
    if ((is_shaft || is_hole) &&
        (!feature.thread.empty() || (is_shaft && thread_of_shaft(feature.diameter_mm) != nullptr) ||
         (is_hole && thread_of_core_hole(feature.diameter_mm) != nullptr))) {
      features.push_back(&feature);
    }
  }
  std::ranges::stable_sort(features, {}, [](const Feature* f) { return f->thread.empty(); });
  return features;
}

}  // namespace

std::optional<Drive> drive_of(const Element& element, const FacetedSolid& solid) {
  for (const Feature* threads : threaded(element)) {
    const Feature& feature = *threads;
    const bool is_shaft = feature.kind == FeatureKind::Shaft;
    Drive drive;
    drive.is_nut = !is_shaft;
    drive.axis_origin = feature.origin;
    drive.axis = -feature.direction;
    const std::vector<Flat> flats = flats_about(solid, drive);
    for (const Flat& first : flats) {
      const std::vector<Flat> hexagon = hexagon_with(flats, first);
      if (hexagon.empty()) continue;
      drive.kind = first.distance_mm < 0.0 ? Drive::Kind::Socket : Drive::Kind::Hexagon;
      drive.across_flats_mm = 2.0 * std::abs(first.distance_mm);
      measure(drive, solid, hexagon, feature.diameter_mm);
      return drive;
    }
  }
  return std::nullopt;
}

}  // namespace dowel
