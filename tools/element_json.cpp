#include "element_json.h"

#include <algorithm>
#include <numbers>
#include <optional>

namespace dowel::tools {
namespace {

Json text_or_null(const std::string& text) {
  return text.empty() ? Json() : Json(text);
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
  json["run"] = tools::to_json(slot.run);
  json["length"] = slot.length_mm;
  json["ends"] = {to_string(slot.ends[0]), to_string(slot.ends[1])};
  if (slot.type != SlotShape::Type::Tee) return;
  json["throat_depth"] = slot.throat_depth_mm;
  json["undercut_width"] = slot.undercut_width_mm;
  json["undercut_height"] = slot.undercut_height_mm;
  json["nominal"] = slot.nominal_mm == 0 ? Json() : Json(slot.nominal_mm);
}

Json to_json(const Feature& feature) {
  Json json;
  json["name"] = feature.name;
  json["kind"] = to_string(feature.kind);
  if (feature.slot) json["type"] = to_string(feature.slot->type);
  if (feature.kind == FeatureKind::Slot) {
    json["width"] = feature.diameter_mm;
  } else if (feature.kind != FeatureKind::Face) {
    json["diameter"] = feature.diameter_mm;
  }
  if (feature.kind != FeatureKind::Face) json["depth"] = feature.depth_mm;
  if (feature.kind == FeatureKind::Hole) {
    json["through"] = feature.through;
    json["blind_end"] = text_or_null(feature.blind_end);
  }
  Json axis;
  axis["origin"] = tools::to_json(feature.origin);
  axis["direction"] = tools::to_json(feature.direction);
  json["axis"] = std::move(axis);
  if (feature.kind == FeatureKind::Hole) {
    json["entry"] = text_or_null(feature.entry);
    json["segments"] = Json::array();
    for (const HoleSegment& segment : feature.segments) {
      json["segments"].push_back(to_json(segment));
    }
  }
  if (feature.kind == FeatureKind::Slot) {
    json["through"] = feature.through;
    json["entry"] = text_or_null(feature.entry);
  }
  if (feature.slot) add_slot(*feature.slot, json);
  if (feature.kind == FeatureKind::Face) json["area_mm2"] = feature.area_mm2;
  if (!feature.use.empty()) json["use"] = feature.use;
  if (!feature.thread.empty()) {
    json["thread"] = feature.thread;
    json["thread_is_guess"] = feature.thread_is_guess;
  }
  if (!feature.fit.empty()) json["fit"] = feature.fit;
  return json;
}

Json to_json(const OutlineLoop& loop) {
  Json json = Json::array();
  for (const OutlineEdge& edge : loop) {
    Json item;
    item["type"] = edge.type == OutlineEdge::Type::Line  ? "line"
                   : edge.type == OutlineEdge::Type::Arc ? "arc"
                                                         : "chord";
    item["from"] = tools::to_json(edge.from);
    item["to"] = tools::to_json(edge.to);
    if (edge.type == OutlineEdge::Type::Arc) {
      item["center"] = tools::to_json(edge.center);
      item["radius"] = edge.radius_mm;
      item["turn"] = edge.turn_rad * 180.0 / std::numbers::pi;
    }
    json.push_back(std::move(item));
  }
  return json;
}

void add_outline(const FaceOutline& outline, Json& json) {
  json["on_hull"] = outline.on_hull;
  json["outline"]["outer"] = to_json(outline.outer);
  json["outline"]["inner"] = Json::array();
  for (const OutlineLoop& loop : outline.inner) json["outline"]["inner"].push_back(to_json(loop));
}

void add_design(const Element& element, Json& json) {
  json["role"] = element.role;
  json["description"] = element.description;
  json["material"] = element.material;
  json["dimensions_by"] = element.dimensions_by;
  const std::optional<double> mass_kg = element.mass_kg();
  json["density_kg_per_m3"] = mass_kg ? Json(element.density_kg_per_m3) : Json();
  json["mass_kg"] = mass_kg ? Json(*mass_kg) : Json();
}

Json to_json(const BoltCircle& circle) {
  Json json;
  json["diameter"] = circle.diameter_mm;
  json["hole_diameter"] = circle.hole_diameter_mm;
  json["count"] = circle.holes.size();
  json["holes"] = circle.holes;
  json["axis"]["origin"] = tools::to_json(circle.center);
  json["axis"]["direction"] = tools::to_json(circle.direction);
  return json;
}

Json to_json(const Obb& box) {
  Json json;
  json["center"] = tools::to_json(box.center);
  json["axes"] = Json::array();
  for (int axis = 0; axis < 3; ++axis) {
    json["axes"].push_back(tools::to_json(Eigen::Vector3d(box.axes.col(axis))));
  }
  json["half_extents"] = tools::to_json(box.half_extents_mm);
  return json;
}

Json to_json(const TriangleCounts& counts) {
  Json json;
  json["total"] = counts.total;
  json["plane"] = counts.plane;
  json["hole"] = counts.hole;
  json["other"] = counts.other;
  return json;
}

}  // namespace

Eigen::Vector3d box_size_mm(const Element& element) {
  return 2.0 * element.obb.half_extents_mm;
}

std::size_t count_features(const Element& element, FeatureKind kind) {
  return static_cast<std::size_t>(std::ranges::count(element.features, kind, &Feature::kind));
}

Json to_json(const Element& element, const std::vector<FaceOutline>& outlines) {
  Json json;
  json["name"] = element.name;
  json["family"] = element.family;
  json["shape"] = to_string(element.shape);
  json["unit_in_file"] = element.unit_in_file;
  json["source"] = element.source;
  json["sha256"] = element.sha256;
  json["solids"] = element.solids;
  json["volume_mm3"] = element.volume_mm3;
  json["surface_mm2"] = element.surface_mm2;
  json["obb"] = to_json(element.obb);
  json["triangles"] = to_json(element.triangles);
  json["facet_error_mm"] = element.facet_error_mm;
  json["features"] = Json::array();
  auto outline = outlines.begin();
  for (const Feature& feature : element.features) {
    json["features"].push_back(to_json(feature));
    if (feature.kind != FeatureKind::Face || outline == outlines.end()) continue;
    add_outline(*outline++, json["features"].back());
  }
  json["center_of_mass"] = to_json(element.center_of_mass);
  json["licence"] = element.licence;
  add_design(element, json);
  json["bolt_circles"] = Json::array();
  for (const BoltCircle& circle : element.bolt_circles) {
    json["bolt_circles"].push_back(to_json(circle));
  }
  if (element.colour) json["colour"] = *element.colour;
  return json;
}

Json to_summary_json(const Element& element) {
  Json json;
  json["name"] = element.name;
  json["family"] = element.family;
  json["shape"] = to_string(element.shape);
  json["size"] = to_json(box_size_mm(element));
  json["volume_mm3"] = element.volume_mm3;
  json["role"] = element.role;
  const std::optional<double> mass_kg = element.mass_kg();
  json["mass_kg"] = mass_kg ? Json(*mass_kg) : Json();
  json["holes"] = count_features(element, FeatureKind::Hole);
  json["shafts"] = count_features(element, FeatureKind::Shaft);
  json["faces"] = count_features(element, FeatureKind::Face);
  json["slots"] = count_features(element, FeatureKind::Slot);
  json["source"] = element.source;
  return json;
}

}  // namespace dowel::tools
