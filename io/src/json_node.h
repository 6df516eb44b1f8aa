#pragma once

// Reading of JSON files that somebody else wrote: every complaint names its place.

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <initializer_list>
#include <string>
#include <string_view>

#include <nlohmann/json.hpp>

#include "dowel/kernel/error.h"

namespace dowel {

/// A value of a file and how to name it in a message.
struct JsonNode {
  const nlohmann::json& value;
  std::string file;  ///< "scene.json: "
  std::string top;   ///< what the whole file is: "scene"
  std::string path;  ///< "elements[2].pose"; empty for the whole file

  std::string place() const { return file + (path.empty() ? top : path); }

  [[noreturn]] void fail(const std::string& problem) const {
    throw Error(ErrorCode::FileMalformed, place() + ": " + problem);
  }
  bool has(const std::string& key) const { return value.contains(key); }
  JsonNode at(const std::string& key) const {
    return {value.at(key), file, top, path.empty() ? key : path + "." + key};
  }
  JsonNode at(std::size_t index) const {
    return {value.at(index), file, top, path + "[" + std::to_string(index) + "]"};
  }
  JsonNode require(const std::string& key) const {
    if (!has(key)) fail("the key \"" + key + "\" is missing");
    return at(key);
  }
  void expect_object() const {
    if (!value.is_object()) fail(std::string("expected an object, found ") + value.type_name());
  }
  void expect_object(std::initializer_list<std::string_view> known_keys) const {
    expect_object();
    for (const auto& [key, ignored] : value.items()) {
      if (std::ranges::find(known_keys, key) != known_keys.end()) continue;
      std::string known;
      for (const std::string_view name : known_keys) {
        if (!known.empty()) known += ", ";
        known += name;
      }
      std::string problem = "unknown key \"";
      problem.append(key).append("\", expected one of: ").append(known);
      fail(problem);
    }
  }
  void expect_list() const {
    if (!value.is_array()) fail(std::string("expected a list, found ") + value.type_name());
  }
  std::string text() const {
    if (!value.is_string()) fail(std::string("expected a text, found ") + value.type_name());
    std::string result = value.get<std::string>();
    if (result.empty()) fail("expected a text, found an empty one");
    return result;
  }
  double number() const {
    if (!value.is_number()) fail(std::string("expected a number, found ") + value.type_name());
    const auto result = value.get<double>();
    if (!std::isfinite(result)) fail("expected a finite number");
    return result;
  }
  template <std::size_t N>
  std::array<double, N> numbers() const {
    if (!value.is_array() || value.size() != N) {
      fail("expected a list of " + std::to_string(N) + " numbers");
    }
    std::array<double, N> result{};
    for (std::size_t i = 0; i < N; ++i) result[i] = at(i).number();
    return result;
  }
};

/// Throws Error{FileUnreadable}, or Error{FileMalformed} with line and column.
nlohmann::json parse_json_file(const std::filesystem::path& file);

}  // namespace dowel
