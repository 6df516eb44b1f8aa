#include "ply.h"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "dowel/kernel/error.h"
#include "polygon.h"

namespace dowel {
namespace {

static_assert(std::endian::native == std::endian::little);

[[noreturn]] void fail(const std::string& what) {
  throw Error(ErrorCode::FileMalformed, what);
}

enum class Encoding { Ascii, LittleEndian, BigEndian };

struct Property {
  std::string_view name;
  std::string_view type;
  std::string_view count_type;  ///< empty: not a list
};

struct PlyElement {
  std::string_view name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  std::optional<Encoding> encoding;
  std::vector<PlyElement> elements;
  std::string_view data;
};

bool is_space(char c) {
  return c == ' ' || (c >= '\t' && c <= '\r');
}

std::string_view next_word(std::string_view& text) {
  while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
  std::size_t length = 0;
  while (length < text.size() && !is_space(text[length])) ++length;
  const std::string_view word = text.substr(0, length);
  text.remove_prefix(length);
  return word;
}

std::string quoted(std::string_view word) {
  return "\"" + std::string(word.substr(0, 40)) + "\"";
}

void read_header_line(std::string_view line, Header& header) {
  const std::string_view keyword = next_word(line);
  if (keyword == "format") {
    const std::string_view name = next_word(line);
    if (name == "ascii") header.encoding = Encoding::Ascii;
    if (name == "binary_little_endian") header.encoding = Encoding::LittleEndian;
    if (name == "binary_big_endian") header.encoding = Encoding::BigEndian;
    if (!header.encoding) fail("PLY format " + quoted(name) + " is not supported");
  } else if (keyword == "element") {
    PlyElement element;
    element.name = next_word(line);
    const std::string_view count = next_word(line);
    const auto [end, error] =
        std::from_chars(count.data(), count.data() + count.size(), element.count);
    if (error != std::errc() || end != count.data() + count.size()) {
      fail("PLY header: " + quoted(count) + " is not a number of elements");
    }
    header.elements.push_back(element);
  } else if (keyword == "property") {
    if (header.elements.empty()) fail("PLY header: a property before the first element");
    Property property;
    property.type = next_word(line);
    if (property.type == "list") {
      property.count_type = next_word(line);
      property.type = next_word(line);
    }
    property.name = next_word(line);
    header.elements.back().properties.push_back(property);
  } else if (keyword != "comment" && keyword != "obj_info" && keyword != "ply" &&
             !keyword.empty()) {
    fail("PLY header: unknown keyword " + quoted(keyword));
  }
}

Header read_header(std::string_view content) {
  if (!content.starts_with("ply")) fail("not a PLY file: expected \"ply\" at its beginning");
  Header header;
  header.data = content;
  for (;;) {
    const std::size_t end = header.data.find('\n');
    if (end == std::string_view::npos) fail("PLY header: \"end_header\" is missing");
    std::string_view line = header.data.substr(0, end);
    header.data.remove_prefix(end + 1);
    if (std::string_view rest = line; next_word(rest) == "end_header") break;
    read_header_line(line, header);
  }
  if (!header.encoding) fail("PLY header: the format is missing");
  return header;
}

/// Hands out the numbers behind the header one by one.
class Numbers {
 public:
  Numbers(std::string_view data, Encoding encoding) : data_(data), encoding_(encoding) {}

  double next(std::string_view type) {
    if (encoding_ == Encoding::Ascii) return next_word_as_number();
    if (type == "char" || type == "int8") return raw<std::int8_t>();
    if (type == "uchar" || type == "uint8") return raw<std::uint8_t>();
    if (type == "short" || type == "int16") return raw<std::int16_t>();
    if (type == "ushort" || type == "uint16") return raw<std::uint16_t>();
    if (type == "int" || type == "int32") return raw<std::int32_t>();
    if (type == "uint" || type == "uint32") return raw<std::uint32_t>();
    if (type == "float" || type == "float32") return static_cast<double>(raw<float>());
    if (type == "double" || type == "float64") return raw<double>();
    fail("PLY header: unknown type " + quoted(type));
  }

 private:
  double next_word_as_number() {
    const std::string_view word = next_word(data_);
    if (word.empty()) fail("the file ends before its last number");
    double value = 0.0;
    const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
    if (error != std::errc() || end != word.data() + word.size()) {
      fail("expected a number, found " + quoted(word));
    }
    return value;
  }

  template <class T>
  T raw() {
    if (data_.size() < sizeof(T)) fail("the file ends before its last number");
    std::array<char, sizeof(T)> bytes{};
    std::copy_n(data_.begin(), sizeof(T), bytes.begin());
    if (encoding_ == Encoding::BigEndian) std::reverse(bytes.begin(), bytes.end());
    data_.remove_prefix(sizeof(T));
    return std::bit_cast<T>(bytes);
  }

  std::string_view data_;
  Encoding encoding_;
};

/// Reads a list into `items`; what is no whole number in range becomes the largest index, which
/// no vertex has.
void read_list(const Property& property, Numbers& numbers, std::vector<std::uint32_t>& items) {
  items.clear();
  const double count = numbers.next(property.count_type);
  if (!(count >= 0.0) || count != std::floor(count)) fail("a list of a negative or broken length");
  // No file is that long; reading on past its end fails.
  constexpr double kLongest = 0x1p53;
  const auto length = static_cast<std::uint64_t>(std::min(count, kLongest));
  for (std::uint64_t i = 0; i < length; ++i) {
    const double item = numbers.next(property.type);
    constexpr std::uint32_t kNoVertex = std::numeric_limits<std::uint32_t>::max();
    const bool is_index = item >= 0.0 && item < kNoVertex && item == std::floor(item);
    items.push_back(is_index ? static_cast<std::uint32_t>(item) : kNoVertex);
  }
}

void append_face(const std::vector<std::uint32_t>& corners, std::uint64_t number,
                 FacetedSolid& mesh) {
  const std::string face = "face " + std::to_string(number);
  if (corners.size() < 3) fail(face + " needs three vertices or more");
  for (const std::uint32_t corner : corners) {
    if (corner >= mesh.vertices.size()) {
      fail(face + ": a vertex index is out of range, the file has " +
           std::to_string(mesh.vertices.size()) + " vertices");
    }
  }
  append_polygon(corners, mesh);
}

void read_element(const PlyElement& element, Numbers& numbers, FacetedSolid& mesh) {
  if (element.properties.empty() && element.count > 0) {
    fail("PLY header: element " + quoted(element.name) + " has no properties");
  }
  std::vector<std::uint32_t> list;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    Eigen::Vector3d position = Eigen::Vector3d::Constant(std::nan(""));
    for (const Property& property : element.properties) {
      if (!property.count_type.empty()) {
        read_list(property, numbers, list);
        const bool is_corners =
            property.name == "vertex_indices" || property.name == "vertex_index";
        if (element.name == "face" && is_corners) append_face(list, i, mesh);
        continue;
      }
      const double value = numbers.next(property.type);
      if (property.name == "x") position.x() = value;
      if (property.name == "y") position.y() = value;
      if (property.name == "z") position.z() = value;
    }
    if (element.name != "vertex") continue;
    if (!position.allFinite()) {
      fail("vertex " + std::to_string(i) + ": expected finite x, y and z");
    }
    mesh.vertices.push_back(position);
  }
}

constexpr std::size_t kStlHeader = 84;
constexpr std::size_t kStlRecord = 50;

}  // namespace

FacetedSolid parse_ply(std::string_view content) {
  const Header header = read_header(content);
  Numbers numbers(header.data, *header.encoding);
  FacetedSolid mesh;
  for (const PlyElement& element : header.elements) read_element(element, numbers, mesh);
  return mesh;
}

bool is_binary_stl(std::string_view content) {
  if (content.size() < kStlHeader) return false;
  std::uint32_t count = 0;
  std::memcpy(&count, content.data() + kStlHeader - sizeof count, sizeof count);
  return content.size() == kStlHeader + std::size_t{count} * kStlRecord;
}

FacetedSolid parse_binary_stl(std::string_view content) {
  constexpr std::size_t kNormal = 12;
  FacetedSolid mesh;
  for (std::size_t at = kStlHeader; at < content.size(); at += kStlRecord) {
    std::array<float, 9> numbers{};
    std::memcpy(numbers.data(), content.data() + at + kNormal, sizeof numbers);
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::size_t k = 0; k < numbers.size(); k += 3) {
      mesh.vertices.emplace_back(static_cast<double>(numbers[k]),
                                 static_cast<double>(numbers[k + 1]),
                                 static_cast<double>(numbers[k + 2]));
    }
    mesh.triangles.push_back({first, first + 1, first + 2});
  }
  return mesh;
}

}  // namespace dowel
