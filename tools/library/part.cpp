#include "part.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "systems.h"

namespace dowel::library {
namespace {

/// A mouth cone of so many bores makes a hole a countersunk one (catalog/README.md).
constexpr double kCountersinkRatio = 1.5;

/// What stands before the number of a hole's name.
std::string hole_prefix(const Feature& hole) {
  const HoleSegment& mouth = hole.segments.front();
  if (mouth.type == HoleSegment::Type::Cylinder && mouth.diameter_mm > hole.diameter_mm) {
    return "cb";
  }
  if (mouth.type == HoleSegment::Type::Cone &&
      mouth.diameter_mm >= kCountersinkRatio * hole.diameter_mm) {
    return "cs";
  }
  return hole.through ? "h" : "b";
}

std::string prefix_of(const Feature& feature) {
  switch (feature.kind) {
    case FeatureKind::Hole:
      return hole_prefix(feature);
    case FeatureKind::Shaft:
      return "pin";
    case FeatureKind::Slot:
      return "slot";
    case FeatureKind::Face:
      break;
  }
  return "";
}

/// Shafts by diameter; then by the side from which a feature is seen, +z, +y, +x first; then from
/// the top, the front, the left; slots in one place by the way they run, +x first. To a nanometre.
std::array<double, 10> order_key(const Feature& feature) {
  constexpr double kSteps_per_mm = 1.0e6;
  const bool is_shaft = feature.kind == FeatureKind::Shaft;
  const Eigen::Vector3d out = is_shaft ? feature.direction : Eigen::Vector3d(-feature.direction);
  const Eigen::Vector3d& at = feature.origin;
  const double run_x = feature.slot ? feature.slot->run.x() : 0.0;
  std::array<double, 10> key{is_shaft ? feature.diameter_mm : 0.0,
                             -out.z(),
                             -out.y(),
                             -out.x(),
                             -at.z(),
                             at.y(),
                             at.x(),
                             feature.diameter_mm,
                             feature.depth_mm,
                             -run_x};
  for (double& value : key) value = std::round(value * kSteps_per_mm);
  return key;
}

}  // namespace

std::string element_name(const System& system, const std::string& name) {
  return std::string(system.name) + "/" + name;
}

std::string plain(double value) {
  std::array<char, 32> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.6g", value);
  return {text.data(), static_cast<std::size_t>(length)};
}

Feature shaft(std::string use, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
              double diameter_mm, double length_mm) {
  Feature feature;
  feature.use = std::move(use);
  feature.kind = FeatureKind::Shaft;
  feature.origin = origin;
  feature.direction = direction;
  feature.diameter_mm = diameter_mm;
  feature.depth_mm = length_mm;
  return feature;
}

Feature shaft_down(std::string use, double top_z_mm, double diameter_mm, double length_mm) {
  return shaft(std::move(use), {0.0, 0.0, top_z_mm}, kDown, diameter_mm, length_mm);
}

Feature face(std::string use, const Eigen::Vector3d& origin, const Eigen::Vector3d& normal) {
  Feature feature;
  feature.use = std::move(use);
  feature.kind = FeatureKind::Face;
  feature.origin = origin;
  feature.direction = normal;
  return feature;
}

Feature threaded(Feature feature, std::string_view thread) {
  feature.thread = thread;
  return feature;
}

Feature fitted(Feature feature, std::string fit) {
  feature.fit = std::move(fit);
  return feature;
}

Feature named(Feature feature, std::string name) {
  feature.name = std::move(name);
  return feature;
}

void name_features(Part& part) {
  std::vector<Feature*> unnamed;
  for (Feature& feature : part.features) {
    if (feature.kind == FeatureKind::Face) {
      feature.name = feature.use;
    } else if (feature.name.empty()) {
      unnamed.push_back(&feature);
    }
  }
  std::ranges::sort(unnamed, {}, [](const Feature* feature) { return order_key(*feature); });
  std::map<std::string, int> counts;
  for (Feature* const feature : unnamed) {
    const std::string prefix = prefix_of(*feature);
    feature->name = prefix + std::to_string(++counts[prefix]);
  }
}

}  // namespace dowel::library
