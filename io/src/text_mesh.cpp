#include "text_mesh.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <system_error>
#include <vector>

#include "dowel/kernel/error.h"
#include "polygon.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// Hands out the lines of a text, split into words, without comments and empty lines.
class Lines {
 public:
  explicit Lines(std::string_view text) : rest_(text) {}

  /// Moves to the next line that has a word; false at the end.
  bool next() {
    while (!rest_.empty()) {
      take_line();
      if (!words_.empty()) return true;
    }
    words_.clear();
    return false;
  }
  const std::vector<std::string_view>& words() const noexcept { return words_; }

  [[noreturn]] void fail(const std::string& expected) const {
    throw Error(ErrorCode::FileMalformed, "line " + std::to_string(number_) + ": " + expected);
  }

  double number(std::size_t word) const {
    if (word >= words_.size()) fail("a number is missing");
    std::string_view text = words_[word];
    if (text.starts_with('+')) text.remove_prefix(1);
    double value = 0.0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    const bool is_whole = error == std::errc() && end == text.data() + text.size();
    if (!is_whole || !std::isfinite(value)) {
      fail("expected a finite number, found \"" + std::string(words_[word].substr(0, 40)) + "\"");
    }
    return value;
  }

  std::int64_t integer(std::string_view text) const {
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (error != std::errc() || end != text.data() + text.size()) {
      fail("expected a whole number, found \"" + std::string(text.substr(0, 40)) + "\"");
    }
    return value;
  }
  std::int64_t integer(std::size_t word) const {
    if (word >= words_.size()) fail("a number is missing");
    return integer(words_[word]);
  }

  Vector3d point(std::size_t first_word) const {
    return {number(first_word), number(first_word + 1), number(first_word + 2)};
  }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  /// Takes a line, joined with the next where it ends in a backslash.
  void take_line() {
    words_.clear();
    bool goes_on = true;
    while (goes_on && !rest_.empty()) {
      ++number_;
      const std::size_t end = std::min(rest_.find('\n'), rest_.size());
      std::string_view line = rest_.substr(0, end);
      rest_.remove_prefix(std::min(end + 1, rest_.size()));
      line = line.substr(0, line.find('#'));
      while (!line.empty() && is_space(line.back())) line.remove_suffix(1);
      goes_on = line.ends_with('\\');
      if (goes_on) line.remove_suffix(1);
      split(line);
    }
  }

  void split(std::string_view line) {
    while (!line.empty()) {
      if (is_space(line.front())) {
        line.remove_prefix(1);
        continue;
      }
      std::size_t length = 0;
      while (length < line.size() && !is_space(line[length])) ++length;
      words_.push_back(line.substr(0, length));
      line.remove_prefix(length);
    }
  }

  std::string_view rest_;
  std::vector<std::string_view> words_;
  std::size_t number_ = 0;
};

std::uint32_t checked_index(const Lines& lines, std::int64_t index, std::size_t vertex_count) {
  if (index < 0 || static_cast<std::uint64_t>(index) >= vertex_count) {
    lines.fail("vertex index " + std::to_string(index) + " is out of range, the file has " +
               std::to_string(vertex_count) + " vertices so far");
  }
  return static_cast<std::uint32_t>(index);
}

}  // namespace

FacetedSolid parse_obj(std::string_view text) {
  FacetedSolid mesh;
  Lines lines(text);
  while (lines.next()) {
    const auto& words = lines.words();
    if (words[0] == "v") {
      mesh.vertices.push_back(lines.point(1));
    } else if (words[0] == "f") {
      if (words.size() < 4) lines.fail("a face needs three vertices or more");
      std::vector<std::uint32_t> polygon;
      for (std::size_t w = 1; w < words.size(); ++w) {
        const std::int64_t index = lines.integer(words[w].substr(0, words[w].find('/')));
        if (index == 0) lines.fail("vertex index 0, expected 1 or more, or a negative one");
        // Negative indices count back from the last vertex so far.
        const auto count = static_cast<std::int64_t>(mesh.vertices.size());
        polygon.push_back(
            checked_index(lines, index > 0 ? index - 1 : count + index, mesh.vertices.size()));
      }
      append_polygon(polygon, mesh);
    }
  }
  return mesh;
}

FacetedSolid parse_off(std::string_view text) {
  FacetedSolid mesh;
  Lines lines(text);
  if (!lines.next()) lines.fail("expected \"OFF\"");
  std::size_t first = 0;
  if (lines.words()[0].ends_with("OFF")) {
    const std::string_view prefix = lines.words()[0].substr(0, lines.words()[0].size() - 3);
    // Texture coordinates, colours and normals follow the position; more dimensions do not.
    if (prefix.find_first_not_of("STCN") != std::string_view::npos) {
      lines.fail("\"" + std::string(lines.words()[0].substr(0, 40)) + "\" is not supported");
    }
    first = 1;
    if (lines.words().size() == 1) {
      first = 0;
      if (!lines.next()) lines.fail("expected the numbers of vertices and faces");
    }
  } else if (lines.words().size() < 2) {
    lines.fail("expected \"OFF\"");
  }
  if (lines.words()[first] == "BINARY") lines.fail("binary OFF is not supported");
  const std::int64_t vertex_count = lines.integer(first);
  const std::int64_t face_count = lines.integer(first + 1);
  if (vertex_count < 0 || face_count < 0) lines.fail("negative number of vertices or faces");
  for (std::int64_t v = 0; v < vertex_count; ++v) {
    if (!lines.next()) lines.fail("the file ends before its last vertex");
    mesh.vertices.push_back(lines.point(0));
  }
  for (std::int64_t f = 0; f < face_count; ++f) {
    if (!lines.next()) lines.fail("the file ends before its last face");
    const std::int64_t corners = lines.integer(0);
    if (corners < 3 || static_cast<std::uint64_t>(corners) >= lines.words().size()) {
      lines.fail("expected a number of corners, 3 or more, and as many indices");
    }
    std::vector<std::uint32_t> polygon;
    for (std::size_t w = 1; w <= static_cast<std::size_t>(corners); ++w) {
      polygon.push_back(checked_index(lines, lines.integer(w), mesh.vertices.size()));
    }
    append_polygon(polygon, mesh);
  }
  return mesh;
}

FacetedSolid parse_ascii_stl(std::string_view text) {
  FacetedSolid mesh;
  Lines lines(text);
  std::size_t loop_start = 0;
  bool in_loop = false;
  while (lines.next()) {
    const std::string_view word = lines.words()[0];
    if (word == "outer") {
      if (in_loop) lines.fail("\"outer loop\" inside a loop");
      loop_start = mesh.vertices.size();
      in_loop = true;
    } else if (word == "vertex") {
      if (!in_loop) lines.fail("\"vertex\" outside a loop");
      mesh.vertices.push_back(lines.point(1));
    } else if (word == "endloop") {
      if (!in_loop || mesh.vertices.size() != loop_start + 3) {
        lines.fail("expected three vertices in a loop");
      }
      const auto first_vertex = static_cast<std::uint32_t>(loop_start);
      mesh.triangles.push_back({first_vertex, first_vertex + 1, first_vertex + 2});
      in_loop = false;
    } else if (word != "solid" && word != "facet" && word != "endfacet" && word != "endsolid") {
      lines.fail("expected an STL keyword, found \"" + std::string(word.substr(0, 40)) + "\"");
    }
  }
  if (in_loop) lines.fail("the file ends inside a loop");
  return mesh;
}

}  // namespace dowel
