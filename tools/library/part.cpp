#include "part.h"

#include <array>
#include <cstdio>
#include <utility>

#include "dimensions.h"

namespace dowel::library {

std::string element_name(const std::string& name) {
  return std::string(kSystem) + "/" + name;
}

std::string plain(double value) {
  std::array<char, 32> text{};
  const int length = std::snprintf(text.data(), text.size(), "%.6g", value);
  return {text.data(), static_cast<std::size_t>(length)};
}

DesignedFeature shaft(std::string name, const Eigen::Vector3d& origin,
                      const Eigen::Vector3d& direction, double diameter_mm, double length_mm) {
  DesignedFeature feature;
  feature.geometry.name = std::move(name);
  feature.geometry.kind = FeatureKind::Shaft;
  feature.geometry.origin = origin;
  feature.geometry.direction = direction;
  feature.geometry.diameter_mm = diameter_mm;
  feature.geometry.depth_mm = length_mm;
  return feature;
}

DesignedFeature face(std::string name, const Eigen::Vector3d& origin,
                     const Eigen::Vector3d& normal) {
  DesignedFeature feature;
  feature.geometry.name = std::move(name);
  feature.geometry.kind = FeatureKind::Face;
  feature.geometry.origin = origin;
  feature.geometry.direction = normal;
  return feature;
}

DesignedFeature threaded(DesignedFeature feature, std::string thread) {
  feature.thread = std::move(thread);
  return feature;
}

DesignedFeature fitted(DesignedFeature feature, std::string fit) {
  feature.fit = std::move(fit);
  return feature;
}

}  // namespace dowel::library
