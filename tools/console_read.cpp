#include "console_read.h"

#include <array>
#include <cmath>
#include <numbers>

namespace dowel::tools {
namespace {

constexpr double kRad_per_degree = std::numbers::pi / 180.0;
constexpr double kFullTurn_deg = 360.0;

}  // namespace

double read_angle(Arguments& arguments) {
  const double degrees = arguments.number("an angle in degrees");
  if (std::abs(degrees) > kFullTurn_deg) {
    arguments.fail_at_last("an angle is at most 360 degrees either way");
  }
  return degrees * kRad_per_degree;
}

std::string read_instance(Console& console, Arguments& arguments) {
  const std::string name = arguments.word("an instance");
  return arguments.located([&] { return console.session().instance(name).name; });
}

FeatureName read_feature(Console& console, Arguments& arguments, std::string_view what) {
  FeatureName name = arguments.feature(what);
  arguments.located([&] { console.session().feature(name); });
  return name;
}

std::optional<Eigen::Vector3d> take_coordinate_axis(Arguments& arguments) {
  constexpr std::array<const char*, 3> kNames{"x", "y", "z"};
  for (int i = 0; i < 3; ++i) {
    if (arguments.take(kNames[static_cast<std::size_t>(i)])) {
      return Eigen::Vector3d(Eigen::Vector3d::Unit(i));
    }
  }
  return std::nullopt;
}

Axis read_axis(Console& console, Arguments& arguments) {
  if (const auto direction = take_coordinate_axis(arguments)) return {std::nullopt, *direction};
  const FeatureName name = read_feature(console, arguments, "x, y, z or a feature");
  const PlacedFeature feature = console.session().feature(name);
  return {feature.origin_W(), feature.direction_W().normalized()};
}

InsertWords read_insert_words(Console& console, Arguments& arguments) {
  InsertWords words;
  bool has_offset = false;
  bool is_turned = false;
  while (!arguments.at_end()) {
    if (!words.seat && arguments.take("seat")) {
      FeatureName moving_face = read_feature(console, arguments, "a face");
      arguments.expect("on");
      FeatureName fixed_face = read_feature(console, arguments, "a face");
      words.seat = {std::move(moving_face), std::move(fixed_face)};
    } else if (!has_offset && arguments.take("offset")) {
      has_offset = true;
      words.options.offset_mm = arguments.number("an offset in mm");
    } else if (!is_turned && arguments.take("rot")) {
      is_turned = true;
      words.options.rotation_rad = read_angle(arguments);
    } else if (!words.options.flip && arguments.take("flip")) {
      words.options.flip = true;
    } else {
      arguments.fail("expected `seat`, `offset`, `rot` or `flip`, each once");
    }
  }
  return words;
}

}  // namespace dowel::tools
