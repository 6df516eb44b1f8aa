#include "manifest.h"

#include <nlohmann/json.hpp>

#include "dowel/catalog/element.h"
#include "solids.h"
#include "write_library.h"

namespace dowel::library {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const Eigen::Vector3d& v) {
  // Adding zero turns -0 into 0.
  return Json::array({v.x() + 0.0, v.y() + 0.0, v.z() + 0.0});
}

/// By the volume of the exact solid.
double mass_kg(const Part& part) {
  constexpr double kCubicMetres_per_mm3 = 1.0e-9;
  return volume_mm3(part.solid) * kCubicMetres_per_mm3 * part.material.density_kg_per_m3;
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

void add_slot(const SlotShape& slot, Json& json) {
  json["type"] = to_string(slot.type);
  json["run"] = to_json(slot.run);
  json["length"] = slot.length_mm;
  json["ends"] = {to_string(slot.ends[0]), to_string(slot.ends[1])};
  if (slot.type != SlotShape::Type::Tee) return;
  json["throat_depth"] = slot.throat_depth_mm;
  json["undercut_width"] = slot.undercut_width_mm;
  json["undercut_height"] = slot.undercut_height_mm;
  json["nominal"] = slot.nominal_mm;
}

Json to_json(const Feature& feature) {
  Json json;
  json["name"] = feature.name;
  json["kind"] = to_string(feature.kind);
  json["use"] = feature.use;
  if (feature.kind != FeatureKind::Face) {
    json[feature.kind == FeatureKind::Slot ? "width" : "diameter"] = feature.diameter_mm;
    json["depth"] = feature.depth_mm;
  }
  if (feature.kind == FeatureKind::Hole) {
    json["through"] = feature.through;
    json["blind_end"] = feature.through ? Json() : Json(feature.blind_end);
  }
  json["axis"] = {{"origin", to_json(feature.origin)}, {"direction", to_json(feature.direction)}};
  if (!feature.thread.empty()) json["thread"] = feature.thread;
  if (!feature.fit.empty()) json["fit"] = feature.fit;
  if (feature.slot) add_slot(*feature.slot, json);
  if (feature.kind == FeatureKind::Hole) {
    json["segments"] = Json::array();
    for (const HoleSegment& segment : feature.segments) {
      json["segments"].push_back(to_json(segment));
    }
  }
  return json;
}

std::string family_of(const std::string& name) {
  return name.substr(0, name.rfind('/'));
}

Json to_json(const Part& part) {
  Json json;
  json["name"] = part.name;
  json["file"] = file_name(part);
  json["family"] = family_of(part.name);
  json["role"] = part.role;
  json["description"] = part.description;
  json["source"] = part.source;
  json["licence"] = "Apache-2.0";
  json["material"] = part.material.name;
  json["density_kg_per_m3"] = part.material.density_kg_per_m3;
  json["mass_kg"] = mass_kg(part);
  json["dimensions"] = Json::object();
  for (const Dimension& dimension : part.dimensions) {
    json["dimensions"][dimension.name] = dimension.value_mm;
  }
  json["features"] = Json::array();
  for (const Feature& feature : part.features) json["features"].push_back(to_json(feature));
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
