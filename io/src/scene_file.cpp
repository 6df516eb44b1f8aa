#include "dowel/io/scene_file.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string_view>

#include <nlohmann/json.hpp>

#include "dowel/io/file.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"
#include "json_node.h"

namespace dowel {
namespace {

using Json = nlohmann::json;
using Node = JsonNode;

/// A pose from seven numbers, or what is wrong with them.
Pose checked_pose(const std::array<double, 4>& q, const std::array<double, 3>& t,
                  const std::string& place) {
  const Eigen::Quaterniond rotation(q[0], q[1], q[2], q[3]);
  if (!(std::abs(rotation.norm() - 1.0) <= kUnitQuaternionSlack)) {
    throw Error(ErrorCode::FileMalformed,
                place +
                    ": expected a quaternion [w, x, y, z] of unit length within 1e-6, found "
                    "length " +
                    std::to_string(rotation.norm()));
  }
  const Eigen::Vector3d translation(t[0], t[1], t[2]);
  if (!(translation.cwiseAbs().maxCoeff() <= kMaxCoordinate_mm)) {
    throw Error(ErrorCode::FileMalformed,
                place + ": expected a translation within 100 m of the origin");
  }
  return {rotation, translation};
}

Pose read_pose(const Node& node) {
  node.expect_object({"q", "t"});
  std::array<double, 4> q{1.0, 0.0, 0.0, 0.0};
  std::array<double, 3> t{};
  if (node.has("q")) q = node.at("q").numbers<4>();
  if (node.has("t")) t = node.at("t").numbers<3>();
  return checked_pose(q, t, node.place());
}

SceneBody read_body(const Node& node, const std::filesystem::path& folder) {
  node.expect_object({"id", "source", "element", "pose"});
  SceneBody body;
  body.id = node.require("id").text();
  if (node.has("source") == node.has("element")) {
    node.fail("expected either \"source\" (a file) or \"element\" (a name in the catalogue)");
  }
  if (node.has("source")) body.source = folder / node.at("source").text();
  if (node.has("element")) body.element = node.at("element").text();
  if (node.has("pose")) body.X_WB = read_pose(node.at("pose"));
  return body;
}

}  // namespace

SceneFile read_scene(const std::filesystem::path& file) {
  const Json json = parse_json_file(file);
  const Node scene{json, file.string() + ": ", "scene", ""};
  scene.expect_object({"format", "unit", "elements", "moving"});
  const Node format = scene.require("format");
  if (format.text() != "dowel-scene/1") {
    format.fail("expected \"dowel-scene/1\", found \"" + format.text() + "\"");
  }
  if (scene.has("unit") && scene.at("unit").text() != "mm") {
    scene.at("unit").fail("expected \"mm\", found \"" + scene.at("unit").text() + "\"");
  }
  const Node elements = scene.require("elements");
  if (!elements.value.is_array() || elements.value.empty()) {
    elements.fail("expected a list of at least one element");
  }
  SceneFile result;
  for (std::size_t i = 0; i < elements.value.size(); ++i) {
    const Node node = elements.at(i);
    result.bodies.push_back(read_body(node, file.parent_path()));
    const std::string& id = result.bodies.back().id;
    const auto same_id = [&id](const SceneBody& body) { return body.id == id; };
    if (std::ranges::count_if(result.bodies, same_id) > 1) {
      node.fail("the id \"" + id + "\" is used twice");
    }
  }
  const Node moving = scene.require("moving");
  const auto add_moving = [&](const Node& node) {
    const std::string id = node.text();
    const auto body = std::ranges::find(result.bodies, id, &SceneBody::id);
    if (body == result.bodies.end()) node.fail("no element has the id \"" + id + "\"");
    const auto index = static_cast<std::size_t>(body - result.bodies.begin());
    if (std::ranges::count(result.moving, index) > 0) node.fail("\"" + id + "\" is listed twice");
    result.moving.push_back(index);
  };
  result.moves_as_unit = moving.value.is_array();
  if (!result.moves_as_unit) {
    add_moving(moving);
  } else {
    if (moving.value.empty()) moving.fail("expected at least one id");
    for (std::size_t i = 0; i < moving.value.size(); ++i) add_moving(moving.at(i));
  }
  return result;
}

std::vector<Pose> read_poses(const std::filesystem::path& file) {
  constexpr std::string_view kHeader = "qw,qx,qy,qz,tx,ty,tz";
  const std::string text = read_file(file);
  std::vector<Pose> poses;
  std::string_view rest = text;
  for (std::size_t line_number = 1; !rest.empty() || line_number == 1; ++line_number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    const std::string place = file.string() + ":" + std::to_string(line_number);
    if (line_number == 1) {
      if (line != kHeader) {
        throw Error(ErrorCode::FileMalformed,
                    place + ": expected the header \"" + std::string(kHeader) + "\"");
      }
      continue;
    }
    if (line.empty() && rest.empty()) break;
    std::array<double, 7> values{};
    const char* cursor = line.data();
    const char* const line_end = line.data() + line.size();
    for (std::size_t i = 0; i < values.size(); ++i) {
      while (cursor != line_end && *cursor == ' ') ++cursor;
      const auto [after, status] = std::from_chars(cursor, line_end, values[i]);
      const bool ends_well =
          i + 1 == values.size() ? after == line_end : after != line_end && *after == ',';
      if (status != std::errc() || !std::isfinite(values[i]) || !ends_well) {
        throw Error(ErrorCode::FileMalformed, place + ": expected seven finite numbers \"" +
                                                  std::string(kHeader) + "\", found \"" +
                                                  std::string(line.substr(0, 80)) + "\"");
      }
      cursor = after + 1;
    }
    poses.push_back(checked_pose({values[0], values[1], values[2], values[3]},
                                 {values[4], values[5], values[6]}, place));
  }
  return poses;
}

}  // namespace dowel
