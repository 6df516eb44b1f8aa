#include <array>
#include <cmath>
#include <utility>

#include <nlohmann/json.hpp>

#include "dowel/kernel/error.h"
#include "project_rows.h"

namespace dowel {
namespace {

using Json = nlohmann::ordered_json;

/// Rows of version 1 are flat; anything deep is somebody's attempt on the stack.
constexpr int kMaxDepth = 8;

Json to_json(const Eigen::Vector3d& v) {
  return Json::array({v.x(), v.y(), v.z()});
}

Eigen::Vector3d vector_from(const Json& json) {
  const auto values = json.get<std::array<double, 3>>();
  return {values[0], values[1], values[2]};
}

Json to_json(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation();
  return {{"q", Json::array({q.w(), q.x(), q.y(), q.z()})}, {"t", to_json(pose.translation())}};
}

Pose pose_from(const Json& json) {
  const auto q = json.at("q").get<std::array<double, 4>>();
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  const Eigen::Vector3d translation = vector_from(json.at("t"));
  // Written so that NaN is refused.
  if (!(std::abs(rotation.norm() - 1.0) <= kUnitQuaternionSlack) ||
      !(translation.cwiseAbs().maxCoeff() <= kMaxCoordinate_mm)) {
    throw Error(ErrorCode::FileMalformed, "a pose is not rigid or too far away");
  }
  return {rotation, translation};
}

Json to_json(const Instance& instance) {
  return {{"number", instance.number},
          {"name", instance.name},
          {"element", instance.element},
          {"pose", to_json(instance.X_WI)},
          {"grounded", instance.grounded}};
}

Instance instance_from(const Json& json) {
  return {.number = json.at("number").get<std::uint32_t>(),
          .name = json.at("name").get<std::string>(),
          .element = json.at("element").get<std::string>(),
          .X_WI = pose_from(json.at("pose")),
          .grounded = json.at("grounded").get<bool>()};
}

Json to_json(const FeatureName& name) {
  return Json::array({name.instance, name.feature});
}

FeatureName feature_name_from(const Json& json) {
  const auto values = json.get<std::array<std::string, 2>>();
  return {values[0], values[1]};
}

Json to_json(const Mate& mate) {
  Json json{{"number", mate.number},
            {"kind", to_string(mate.kind)},
            {"moving", to_json(mate.moving)},
            {"fixed", to_json(mate.fixed)},
            {"moving_face", to_json(mate.moving_face)},
            {"fixed_face", to_json(mate.fixed_face)},
            {"offset_mm", mate.offset_mm},
            {"flip", mate.flip},
            {"thread", mate.thread}};
  // Kinds of version 1 have neither, and are written as they were.
  if (mate.kind == MateKind::Angle) json["angle_rad"] = mate.angle_rad;
  if (mate.X_FM) json["held"] = to_json(*mate.X_FM);
  return json;
}

Mate mate_from(const Json& json) {
  const auto kind = mate_kind_from(json.at("kind").get<std::string>());
  if (!kind) throw Error(ErrorCode::FileMalformed, "a mate is of an unknown kind");
  Mate mate{.number = json.at("number").get<std::uint32_t>(),
            .kind = *kind,
            .moving = feature_name_from(json.at("moving")),
            .fixed = feature_name_from(json.at("fixed")),
            .moving_face = feature_name_from(json.at("moving_face")),
            .fixed_face = feature_name_from(json.at("fixed_face")),
            .offset_mm = json.at("offset_mm").get<double>(),
            .flip = json.at("flip").get<bool>(),
            .thread = json.at("thread").get<bool>(),
            .angle_rad = json.value("angle_rad", 0.0),
            .X_FM = std::nullopt};
  if (json.contains("held")) mate.X_FM = pose_from(json.at("held"));
  return mate;
}

Json to_json(const HoleSegment& segment) {
  return {{"type", to_string(segment.type)},
          {"diameter_mm", segment.diameter_mm},
          {"diameter_end_mm", segment.diameter_end_mm},
          {"from_mm", segment.from_mm},
          {"to_mm", segment.to_mm}};
}

/// The enumerator of `all` that `to_string` gives the name `text`.
template <class Enum, std::size_t N>
Enum enum_from(const std::string& text, const std::array<Enum, N>& all) {
  for (const Enum value : all) {
    if (to_string(value) == text) return value;
  }
  throw Error(ErrorCode::FileMalformed, "unknown word \"" + text + "\"");
}

HoleSegment segment_from(const Json& json) {
  using enum HoleSegment::Type;
  return {.type = enum_from(json.at("type").get<std::string>(), std::array{Cylinder, Cone}),
          .diameter_mm = json.at("diameter_mm").get<double>(),
          .diameter_end_mm = json.at("diameter_end_mm").get<double>(),
          .from_mm = json.at("from_mm").get<double>(),
          .to_mm = json.at("to_mm").get<double>()};
}

Json to_json(const SlotShape& slot) {
  return {{"type", to_string(slot.type)},
          {"run", to_json(slot.run)},
          {"length_mm", slot.length_mm},
          {"ends", {to_string(slot.ends[0]), to_string(slot.ends[1])}},
          {"throat_depth_mm", slot.throat_depth_mm},
          {"undercut_width_mm", slot.undercut_width_mm},
          {"undercut_height_mm", slot.undercut_height_mm},
          {"nominal_mm", slot.nominal_mm}};
}

SlotShape slot_from(const Json& json) {
  using enum SlotShape::Type;
  using enum SlotShape::End;
  SlotShape slot;
  slot.type = enum_from(json.at("type").get<std::string>(), std::array{Plain, Tee, Through});
  slot.run = vector_from(json.at("run"));
  slot.length_mm = json.at("length_mm").get<double>();
  const auto ends = json.at("ends").get<std::array<std::string, 2>>();
  for (const std::size_t i : {0U, 1U}) {
    slot.ends[i] = enum_from(ends[i], std::array{Open, Flat, Round});
  }
  slot.throat_depth_mm = json.at("throat_depth_mm").get<double>();
  slot.undercut_width_mm = json.at("undercut_width_mm").get<double>();
  slot.undercut_height_mm = json.at("undercut_height_mm").get<double>();
  slot.nominal_mm = json.at("nominal_mm").get<std::uint32_t>();
  return slot;
}

Json to_json(const Feature& feature) {
  Json segments = Json::array();
  for (const HoleSegment& segment : feature.segments) segments.push_back(to_json(segment));
  Json json{{"name", feature.name},
            {"kind", to_string(feature.kind)},
            {"origin", to_json(feature.origin)},
            {"direction", to_json(feature.direction)},
            {"diameter_mm", feature.diameter_mm},
            {"depth_mm", feature.depth_mm},
            {"through", feature.through},
            {"blind_end", feature.blind_end},
            {"entry", feature.entry},
            {"segments", std::move(segments)},
            {"area_mm2", feature.area_mm2},
            {"faces", feature.faces}};
  if (feature.slot) json["slot"] = to_json(*feature.slot);
  // What nobody states is left out, as it was in files written before it was kept.
  if (!feature.use.empty()) json["use"] = feature.use;
  if (!feature.thread.empty()) json["thread"] = feature.thread;
  if (feature.thread_is_guess) json["thread_is_guess"] = true;
  if (!feature.fit.empty()) json["fit"] = feature.fit;
  return json;
}

Feature feature_from(const Json& json) {
  using enum FeatureKind;
  Feature feature;
  feature.name = json.at("name").get<std::string>();
  feature.kind = enum_from(json.at("kind").get<std::string>(), std::array{Hole, Shaft, Face, Slot});
  feature.origin = vector_from(json.at("origin"));
  feature.direction = vector_from(json.at("direction"));
  feature.diameter_mm = json.at("diameter_mm").get<double>();
  feature.depth_mm = json.at("depth_mm").get<double>();
  feature.through = json.at("through").get<bool>();
  feature.blind_end = json.at("blind_end").get<std::string>();
  feature.entry = json.at("entry").get<std::string>();
  for (const Json& segment : json.at("segments")) feature.segments.push_back(segment_from(segment));
  if (json.contains("slot")) feature.slot = slot_from(json.at("slot"));
  feature.area_mm2 = json.at("area_mm2").get<double>();
  feature.faces = json.at("faces").get<std::vector<std::uint32_t>>();
  feature.use = json.value("use", std::string());
  feature.thread = json.value("thread", std::string());
  feature.thread_is_guess = json.value("thread_is_guess", false);
  feature.fit = json.value("fit", std::string());
  return feature;
}

Obb obb_from(const Json& json) {
  Obb obb;
  obb.center = vector_from(json.at("center"));
  for (int i = 0; i < 3; ++i) {
    obb.axes.col(i) = vector_from(json.at("axes").at(static_cast<std::size_t>(i)));
  }
  obb.half_extents_mm = vector_from(json.at("half_extents_mm"));
  return obb;
}

Json to_json(const Obb& obb) {
  Json axes = Json::array();
  for (int i = 0; i < 3; ++i) axes.push_back(to_json(Eigen::Vector3d(obb.axes.col(i))));
  return {{"center", to_json(obb.center)},
          {"axes", std::move(axes)},
          {"half_extents_mm", to_json(obb.half_extents_mm)}};
}

Json to_json(const BoltCircle& circle) {
  return {{"center", to_json(circle.center)},
          {"direction", to_json(circle.direction)},
          {"diameter_mm", circle.diameter_mm},
          {"hole_diameter_mm", circle.hole_diameter_mm},
          {"holes", circle.holes}};
}

BoltCircle bolt_circle_from(const Json& json) {
  return {.center = vector_from(json.at("center")),
          .direction = vector_from(json.at("direction")),
          .diameter_mm = json.at("diameter_mm").get<double>(),
          .hole_diameter_mm = json.at("hole_diameter_mm").get<double>(),
          .holes = json.at("holes").get<std::vector<std::string>>()};
}

/// What the maker of an element says of it, by key. `element` may be const.
template <class AnElement>
auto texts_of(AnElement& element) {
  return std::array{
      std::pair("role", &element.role), std::pair("description", &element.description),
      std::pair("material", &element.material), std::pair("dimensions_by", &element.dimensions_by)};
}

Element element_from(const Json& json) {
  using enum ShapeClass;
  Element element;
  element.name = json.at("name").get<std::string>();
  element.family = json.at("family").get<std::string>();
  element.source = json.at("source").get<std::string>();
  element.sha256 = json.at("sha256").get<std::string>();
  element.unit_in_file = json.at("unit_in_file").get<std::string>();
  element.licence = json.at("licence").get<std::string>();
  element.shape = enum_from(json.at("shape").get<std::string>(),
                            std::array{Block, Cylinder, BlockCylinder, Compound});
  element.solids = json.at("solids").get<std::uint32_t>();
  element.volume_mm3 = json.at("volume_mm3").get<double>();
  element.surface_mm2 = json.at("surface_mm2").get<double>();
  element.center_of_mass = vector_from(json.at("center_of_mass"));
  element.obb = obb_from(json.at("obb"));
  const auto triangles = json.at("triangles").get<std::array<std::uint32_t, 4>>();
  element.triangles = {triangles[0], triangles[1], triangles[2], triangles[3]};
  element.facet_error_mm = json.at("facet_error_mm").get<double>();
  if (!json.at("colour").is_null()) {
    element.colour = json.at("colour").get<std::array<double, 3>>();
  }
  for (const Json& feature : json.at("features")) element.features.push_back(feature_from(feature));
  for (const auto& [key, text] : texts_of(element)) *text = json.value(key, std::string());
  element.density_kg_per_m3 = json.value("density_kg_per_m3", 0.0);
  if (json.contains("bolt_circles")) {
    for (const Json& circle : json.at("bolt_circles")) {
      element.bolt_circles.push_back(bolt_circle_from(circle));
    }
  }
  return element;
}

/// Parses without following nesting down the stack.
Json parse(const std::string& text) {
  const auto shallow = [](int depth, Json::parse_event_t, Json&) {
    if (depth > kMaxDepth) throw Error(ErrorCode::FileMalformed, "JSON is nested too deeply");
    return true;
  };
  return Json::parse(text, shallow);
}

/// Text with what is not UTF-8 replaced: names come from files of any encoding.
std::string dump(const Json& json) {
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

/// Runs `body` and turns what goes wrong in it into an Error that begins with `what`.
template <class Body>
auto reading(const std::string& what, Body&& body) {
  try {
    return body();
  } catch (const Json::exception& error) {
    throw Error(ErrorCode::FileMalformed, what + " is damaged: " + error.what());
  } catch (const Error& error) {
    throw Error(ErrorCode::FileMalformed, what + " is damaged: " + error.what());
  }
}

}  // namespace

std::string to_text(const ProjectRows& rows) {
  Json json = Json::object();
  for (const SettingRow& row : rows.settings) json["settings"][row.name] = row.value;
  for (const Instance& instance : rows.instances) json["instances"].push_back(to_json(instance));
  for (const Mate& mate : rows.mates) json["mates"].push_back(to_json(mate));
  return dump(json);
}

ProjectRows rows_from_text(const std::string& text, const std::string& what) {
  return reading(what, [&] {
    const Json json = parse(text);
    const Json settings = json.value("settings", Json::object());
    const Json instances = json.value("instances", Json::array());
    const Json mates = json.value("mates", Json::array());
    ProjectRows rows;
    for (const auto& item : settings.items()) {
      rows.settings.push_back({item.key(), item.value().get<std::string>()});
    }
    for (const Json& row : instances) rows.instances.push_back(instance_from(row));
    for (const Json& row : mates) rows.mates.push_back(mate_from(row));
    return rows;
  });
}

std::string to_text(const Element& element) {
  Json features = Json::array();
  for (const Feature& feature : element.features) features.push_back(to_json(feature));
  const TriangleCounts& triangles = element.triangles;
  Json json{{"name", element.name},
            {"family", element.family},
            {"source", element.source},
            {"sha256", element.sha256},
            {"unit_in_file", element.unit_in_file},
            {"licence", element.licence},
            {"shape", to_string(element.shape)},
            {"solids", element.solids},
            {"volume_mm3", element.volume_mm3},
            {"surface_mm2", element.surface_mm2},
            {"center_of_mass", to_json(element.center_of_mass)},
            {"obb", to_json(element.obb)},
            {"triangles",
             Json::array({triangles.total, triangles.plane, triangles.hole, triangles.other})},
            {"facet_error_mm", element.facet_error_mm},
            {"colour", nullptr},
            {"features", std::move(features)}};
  if (element.colour) json["colour"] = *element.colour;
  // What nobody states is left out, as above.
  for (const auto& [key, text] : texts_of(element)) {
    if (!text->empty()) json[key] = *text;
  }
  if (element.density_kg_per_m3 != 0.0) json["density_kg_per_m3"] = element.density_kg_per_m3;
  for (const BoltCircle& circle : element.bolt_circles) {
    json["bolt_circles"].push_back(to_json(circle));
  }
  return dump(json);
}

Element element_from_text(const std::string& text, const std::string& what) {
  return reading(what, [&] {
    Element element = element_from(parse(text));
    if (const auto defect = find_defect(element)) throw Error(ErrorCode::FileMalformed, *defect);
    return element;
  });
}

}  // namespace dowel
