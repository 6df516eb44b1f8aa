#pragma once

// A reader of GLB files for tests: strict, small, and nothing of the writer in it.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace dowel::testing {

struct GlbFile {
  nlohmann::json document;
  std::string buffer;
};

inline void require(bool condition, const char* what) {
  if (!condition) throw std::runtime_error(what);
}

inline std::uint32_t uint32_at(std::span<const std::byte> bytes, std::size_t offset) {
  require(offset + 4 <= bytes.size(), "the file ends early");
  std::uint32_t value = 0;
  for (std::size_t i = 4; i-- > 0;)
    value = value << 8U | std::to_integer<std::uint32_t>(bytes[offset + i]);
  return value;
}

/// Throws where the container is not as section 4 of the glTF 2.0 specification has it.
inline GlbFile parse_glb(std::span<const std::byte> bytes) {
  require(uint32_at(bytes, 0) == 0x46546C67, "no glTF magic");
  require(uint32_at(bytes, 4) == 2, "not version 2");
  require(uint32_at(bytes, 8) == bytes.size(), "length in the header is not the file's");
  std::vector<std::string> chunks;
  for (std::size_t offset = 12; offset < bytes.size();) {
    const std::uint32_t size = uint32_at(bytes, offset);
    const std::uint32_t type = uint32_at(bytes, offset + 4);
    require(size % 4 == 0, "a chunk is not padded to four bytes");
    require(offset + 8 + size <= bytes.size(), "a chunk is longer than the file");
    require(type == (chunks.empty() ? 0x4E4F534AU : 0x004E4942U), "unexpected type of chunk");
    const auto content = bytes.subspan(offset + 8, size);
    chunks.emplace_back(reinterpret_cast<const char*>(content.data()), content.size());
    offset += 8 + size;
  }
  require(chunks.size() == 1 || chunks.size() == 2, "expected one chunk or two");
  return {nlohmann::json::parse(chunks[0]), chunks.size() == 2 ? chunks[1] : std::string()};
}

/// Elements of an accessor as doubles, one after the other.
inline std::vector<double> read_accessor(const GlbFile& glb, std::size_t index) {
  const auto& accessor = glb.document.at("accessors").at(index);
  const auto& view =
      glb.document.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
  const int type = accessor.at("componentType").get<int>();
  const std::size_t size = type == 5123 ? 2 : 4;
  const std::size_t components = accessor.at("type") == "VEC3" ? 3 : 1;
  const std::size_t count = components * accessor.at("count").get<std::size_t>();
  const auto offset = view.at("byteOffset").get<std::size_t>();
  require(type == 5123 || type == 5125 || type == 5126, "unexpected component type");
  require(offset % 4 == 0, "a buffer view is not aligned");
  require(count > 0, "an accessor is empty");
  require(count * size == view.at("byteLength").get<std::size_t>(), "view and accessor disagree");
  require(offset + count * size <= glb.buffer.size(), "a view is beyond the buffer");
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) {
    const char* from = glb.buffer.data() + offset + i * size;
    std::uint16_t narrow = 0;
    std::uint32_t wide = 0;
    float real = 0.0F;
    if (type == 5123) std::memcpy(&narrow, from, size);
    if (type == 5125) std::memcpy(&wide, from, size);
    if (type == 5126) std::memcpy(&real, from, size);
    values.push_back(type == 5123 ? narrow : type == 5125 ? wide : static_cast<double>(real));
  }
  return values;
}

}  // namespace dowel::testing
