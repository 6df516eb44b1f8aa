#include "manifest.h"

#include <nlohmann/json.hpp>

#include "dowel/catalog/element.h"
#include "write_library.h"

namespace dowel::library {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Eigen::Vector3d& v) {
  // Adding zero turns -0 into 0.
  return Json::array({v.x() + 0.0, v.y() + 0.0, v.z() + 0.0});
}

Json to_json(const HoleSegment& segment) {
  Json json;
  json["type"] = to_string(segment.type);
  json["diameter"] = segment.diameter_mm;
  if (segment.type == HoleSegment::Type::Cone) json["diameter_end"] = segment.diameter_end_mm;
  json["from"] = segment.from_mm;
  json["to"] = segment.to_mm;
  return json;
}

Json to_json(const DesignedFeature& feature) {
  const Feature& geometry = feature.geometry;
  Json json;
  json["name"] = geometry.name;
  json["kind"] = to_string(geometry.kind);
  if (geometry.kind != FeatureKind::Face) {
    json["diameter"] = geometry.diameter_mm;
    json["depth"] = geometry.depth_mm;
  }
  if (geometry.kind == FeatureKind::Hole) {
    json["through"] = geometry.through;
    json["blind_end"] = geometry.through ? Json() : Json(geometry.blind_end);
  }
  json["axis"] = {{"origin", to_json(geometry.origin)}, {"direction", to_json(geometry.direction)}};
  if (!feature.thread.empty()) json["thread"] = feature.thread;
  if (!feature.fit.empty()) json["fit"] = feature.fit;
  if (geometry.kind == FeatureKind::Hole) {
    json["segments"] = Json::array();
    for (const HoleSegment& segment : geometry.segments) {
      json["segments"].push_back(to_json(segment));
    }
  }
  return json;
}

Json to_json(const Part& part) {
  Json json;
  json["name"] = part.name;
  json["file"] = file_name(part);
  json["role"] = part.role;
  json["description"] = part.description;
  json["source"] = part.source;
  json["dimensions"] = Json::object();
  for (const Dimension& dimension : part.dimensions) {
    json["dimensions"][dimension.name] = dimension.value_mm;
  }
  json["features"] = Json::array();
  for (const DesignedFeature& feature : part.features) {
    json["features"].push_back(to_json(feature));
  }
  return json;
}

}  // namespace

std::string manifest_json(const std::vector<Part>& parts) {
  Json json;
  json["format"] = "dowel-library/1";
  json["unit"] = "mm";
  json["elements"] = Json::array();
  for (const Part& part : parts) json["elements"].push_back(to_json(part));
  return json.dump(1) + "\n";
}

}  // namespace dowel::library
