#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

#include <nlohmann/json.hpp>

#include "display_colour.h"
#include "dowel/io/file.h"
#include "dowel/io/scene_page.h"
#include "dowel/kernel/check.h"
#include "dowel/kernel/error.h"
#include "shaded_mesh.h"

// glTF 2.0 is written by hand: it is little, and the writers at hand either lose placements or
// write millimetres where the format says metres.

namespace dowel {
namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian");

// Numbers that the glTF 2.0 specification gives to what they are named after.
constexpr std::uint32_t kGlbMagic = 0x46546C67;
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;
constexpr std::uint32_t kBinaryChunk = 0x004E4942;
constexpr int kArrayBuffer = 34962;
constexpr int kElementArrayBuffer = 34963;
constexpr int kUnsignedShort = 5123;
constexpr int kUnsignedInt = 5125;
constexpr int kFloat = 5126;
constexpr int kLines = 1;
constexpr int kTriangles = 4;

constexpr double kMetresPerMillimetre = 1.0e-3;

/// From z up to y up: x stays, z becomes y.
Eigen::Vector3d y_up(const Eigen::Vector3d& v) {
  return {v.x(), v.z(), -v.y()};
}

/// Adding zero turns -0 into 0: one spelling of each number.
json to_json(const Eigen::Vector3d& v) {
  return {v.x() + 0.0, v.y() + 0.0, v.z() + 0.0};
}

void append_bytes(std::string& bytes, const void* data, std::size_t size) {
  bytes.append(static_cast<const char*>(data), size);
}

void append_uint32(std::string& bytes, std::uint32_t value) {
  append_bytes(bytes, &value, sizeof value);
}

void pad_to_four(std::string& bytes, char filler) {
  bytes.append((4 - bytes.size() % 4) % 4, filler);
}

std::string_view to_string(DisplayState state) {
  switch (state) {
    case DisplayState::Contact:
      return "contact";
    case DisplayState::Colliding:
      return "colliding";
    case DisplayState::Normal:
      break;
  }
  return "normal";
}

/// Fills the two chunks of a GLB: the JSON document and the binary buffer.
class GlbBuilder {
 public:
  explicit GlbBuilder(const DisplayScene& scene) : scene_(scene), geometry_(scene.meshes.size()) {
    document_["asset"] = {{"generator", "dowel"}, {"version", "2.0"}};
    document_["scene"] = 0;
    json root = {{"name", scene.title}};
    for (const DisplayInstance& instance : scene.instances) {
      root["nodes"].push_back(add("nodes", node(instance)));
    }
    document_["scenes"] = json::array({std::move(root)});
    if (!buffer_.empty()) {
      document_["buffers"] = json::array({{{"byteLength", buffer_.size()}}});
    }
  }

  std::vector<std::byte> bytes() const {
    // Names come from files: whatever in them is not UTF-8 becomes U+FFFD.
    std::string text = document_.dump(-1, ' ', false, json::error_handler_t::replace);
    pad_to_four(text, ' ');
    const std::size_t binary_size = buffer_.empty() ? 0 : 8 + buffer_.size();
    const std::size_t total = 12 + 8 + text.size() + binary_size;
    if (total > std::numeric_limits<std::uint32_t>::max()) {
      throw Error(ErrorCode::InvalidInput, "the scene takes " + std::to_string(total) +
                                               " bytes as GLB, expected less than 4 GiB");
    }
    std::string glb;
    glb.reserve(total);
    append_uint32(glb, kGlbMagic);
    append_uint32(glb, 2);
    append_uint32(glb, static_cast<std::uint32_t>(total));
    append_chunk(glb, kJsonChunk, text);
    if (!buffer_.empty()) append_chunk(glb, kBinaryChunk, buffer_);
    std::vector<std::byte> result(glb.size());
    std::memcpy(result.data(), glb.data(), glb.size());
    return result;
  }

 private:
  /// Accessors of one shared mesh. A mesh without facets has none: glTF knows no empty accessor.
  struct Geometry {
    std::optional<std::size_t> positions;
    std::size_t normals = 0;
    std::size_t triangles = 0;
    std::optional<std::size_t> lines;
  };

  static void append_chunk(std::string& glb, std::uint32_t type, const std::string& data) {
    append_uint32(glb, static_cast<std::uint32_t>(data.size()));
    append_uint32(glb, type);
    glb += data;
  }

  std::size_t add(const char* list, json entry) {
    json& entries = document_[list];
    entries.push_back(std::move(entry));
    return entries.size() - 1;
  }

  json node(const DisplayInstance& instance) {
    const Eigen::Quaterniond& q = instance.X_WI.rotation();
    const Eigen::Vector3d axis_part = y_up(q.vec());
    json entry = {
        {"name", instance.name},
        {"rotation", {axis_part.x() + 0.0, axis_part.y() + 0.0, axis_part.z() + 0.0, q.w() + 0.0}},
        {"translation", to_json(kMetresPerMillimetre * y_up(instance.X_WI.translation()))},
        {"extras", {{"state", to_string(instance.state)}}}};
    if (!instance.note.empty()) entry["extras"]["note"] = instance.note;
    if (const auto mesh = mesh_of(instance)) entry["mesh"] = *mesh;
    return entry;
  }

  /// The glTF mesh of an instance: in glTF the material belongs to the mesh, so that each state of
  /// a part is a mesh of its own, on the same accessors.
  std::optional<std::size_t> mesh_of(const DisplayInstance& instance) {
    const auto [known, is_new] = meshes_.emplace(std::pair(instance.mesh, instance.state), 0);
    if (!is_new) return known->second;
    const Geometry& geometry = geometry_of(instance.mesh);
    if (!geometry.positions) {
      meshes_.erase(known);
      return std::nullopt;
    }
    const DisplayMesh& mesh = scene_.meshes[instance.mesh];
    json primitives = json::array();
    primitives.push_back(
        {{"attributes", {{"NORMAL", geometry.normals}, {"POSITION", *geometry.positions}}},
         {"indices", geometry.triangles},
         {"material", material(surface_colour(mesh.colour, instance.state), instance.state)},
         {"mode", kTriangles}});
    if (geometry.lines) {
      primitives.push_back({{"attributes", {{"POSITION", *geometry.positions}}},
                            {"indices", *geometry.lines},
                            {"material", material(line_colour(instance.state), std::nullopt)},
                            {"mode", kLines}});
    }
    known->second = add("meshes", {{"name", mesh.name}, {"primitives", std::move(primitives)}});
    return known->second;
  }

  /// `state`: of a surface; nothing for lines.
  std::size_t material(const Colour& colour, std::optional<DisplayState> state) {
    const std::string name =
        (state ? std::string(to_string(*state)) : std::string("edges")) + " " + to_hex(colour);
    const auto [known, is_new] = materials_.emplace(name, 0);
    if (!is_new) return known->second;
    const Colour linear = linear_from_srgb(colour);
    known->second = add("materials", {{"name", name},
                                      {"doubleSided", true},
                                      {"pbrMetallicRoughness",
                                       {{"baseColorFactor", {linear[0], linear[1], linear[2], 1.0}},
                                        {"metallicFactor", 0.0},
                                        {"roughnessFactor", state ? 0.55 : 1.0}}}});
    return known->second;
  }

  const Geometry& geometry_of(std::size_t index) {
    std::optional<Geometry>& geometry = geometry_[index];
    if (geometry) return *geometry;
    geometry.emplace();
    const ShadedMesh mesh = shade(*scene_.meshes[index].solid);
    if (mesh.triangles.empty()) return *geometry;
    geometry->positions = add_vectors(mesh.positions, kMetresPerMillimetre, true);
    geometry->normals = add_vectors(mesh.normals, 1.0, false);
    geometry->triangles = add_indices(mesh.triangles, mesh.positions.size());
    if (!mesh.lines.empty()) geometry->lines = add_indices(mesh.lines, mesh.positions.size());
    return *geometry;
  }

  std::size_t add_view(std::size_t offset, int target) {
    const std::size_t view = add("bufferViews", {{"buffer", 0},
                                                 {"byteOffset", offset},
                                                 {"byteLength", buffer_.size() - offset},
                                                 {"target", target}});
    pad_to_four(buffer_, '\0');
    return view;
  }

  std::size_t add_vectors(const std::vector<Eigen::Vector3d>& vectors, double scale,
                          bool with_bounds) {
    const std::size_t offset = buffer_.size();
    Eigen::Vector3f low = Eigen::Vector3f::Constant(std::numeric_limits<float>::max());
    Eigen::Vector3f high = -low;
    for (const Eigen::Vector3d& v : vectors) {
      const Eigen::Vector3d scaled = scale * y_up(v);
      const Eigen::Vector3f rounded = scaled.cast<float>().array() + 0.0F;
      append_bytes(buffer_, rounded.data(), sizeof(float) * 3);
      low = low.cwiseMin(rounded);
      high = high.cwiseMax(rounded);
    }
    json accessor = {{"bufferView", add_view(offset, kArrayBuffer)},
                     {"componentType", kFloat},
                     {"count", vectors.size()},
                     {"type", "VEC3"}};
    if (with_bounds) {
      accessor["min"] = to_json(low.cast<double>());
      accessor["max"] = to_json(high.cast<double>());
    }
    return add("accessors", std::move(accessor));
  }

  template <std::size_t n>
  std::size_t add_indices(const std::vector<std::array<std::uint32_t, n>>& groups,
                          std::size_t vertex_count) {
    const std::size_t offset = buffer_.size();
    // 65535 itself may not be an index: it restarts a primitive.
    const bool is_short = vertex_count <= std::numeric_limits<std::uint16_t>::max();
    for (const auto& group : groups) {
      for (const std::uint32_t index : group) {
        if (is_short) {
          const auto narrow = static_cast<std::uint16_t>(index);
          append_bytes(buffer_, &narrow, sizeof narrow);
        } else {
          append_uint32(buffer_, index);
        }
      }
    }
    return add("accessors", {{"bufferView", add_view(offset, kElementArrayBuffer)},
                             {"componentType", is_short ? kUnsignedShort : kUnsignedInt},
                             {"count", n * groups.size()},
                             {"type", "SCALAR"}});
  }

  const DisplayScene& scene_;
  json document_;
  std::string buffer_;
  std::vector<std::optional<Geometry>> geometry_;  ///< one per DisplayMesh, built on first use
  std::map<std::pair<std::size_t, DisplayState>, std::size_t> meshes_;
  std::map<std::string, std::size_t> materials_;
};

}  // namespace

std::vector<std::byte> to_glb(const DisplayScene& scene) {
  DOWEL_EXPECTS(std::ranges::all_of(scene.instances, [&](const DisplayInstance& instance) {
    return instance.mesh < scene.meshes.size() && scene.meshes[instance.mesh].solid != nullptr;
  }));
  return GlbBuilder(scene).bytes();
}

void write_glb(const std::filesystem::path& file, const DisplayScene& scene) {
  write_file(file, to_glb(scene));
}

}  // namespace dowel
