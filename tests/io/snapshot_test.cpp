#include "dowel/io/snapshot.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <png.h>

#include "display_scenes.h"
#include "dowel/kernel/error.h"
#include "program.h"

using namespace dowel;
using namespace dowel::testing;

namespace {

struct Picture {
  std::uint32_t width = 0;
  std::uint32_t height = 0;
  std::vector<std::uint8_t> bytes;

  std::array<int, 3> at(std::uint32_t x, std::uint32_t y) const {
    const std::size_t first = 3 * (std::size_t{y} * width + x);
    return {bytes[first], bytes[first + 1], bytes[first + 2]};
  }
  bool is_white(std::uint32_t x, std::uint32_t y) const {
    return at(x, y) == std::array{255, 255, 255};
  }
  /// On white parts: darker than any face, as a line is whose pixels share it.
  bool is_line(std::uint32_t x, std::uint32_t y) const { return at(x, y)[0] < 200; }
};

Picture read_png(const std::vector<std::byte>& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, png.data(), png.size()) == 0) {
    throw std::runtime_error(std::begin(image.message));
  }
  image.format = PNG_FORMAT_RGB;
  Picture picture{image.width, image.height, {}};
  picture.bytes.resize(PNG_IMAGE_SIZE(image));
  if (png_image_finish_read(&image, nullptr, picture.bytes.data(), 0, nullptr) == 0) {
    throw std::runtime_error(std::begin(image.message));
  }
  return picture;
}

Picture draw(const DisplayScene& scene, const SnapshotOptions& options) {
  return read_png(to_png(scene, options));
}

/// First and last column and row that are not white.
struct Extent {
  std::uint32_t left;
  std::uint32_t right;
  std::uint32_t top;
  std::uint32_t bottom;
};

Extent extent(const Picture& picture) {
  Extent e{picture.width, 0, picture.height, 0};
  for (std::uint32_t y = 0; y < picture.height; ++y) {
    for (std::uint32_t x = 0; x < picture.width; ++x) {
      if (picture.is_white(x, y)) continue;
      e = {std::min(e.left, x), std::max(e.right, x), std::min(e.top, y), std::max(e.bottom, y)};
    }
  }
  return e;
}

DisplayScene in_white(DisplayScene scene) {
  for (DisplayMesh& mesh : scene.meshes) mesh.colour = {1, 1, 1};
  return scene;
}

/// How many lines cross row `y`, on white parts.
int lines_in_row(const Picture& picture, std::uint32_t y) {
  int lines = 0;
  for (std::uint32_t x = 1; x < picture.width; ++x) {
    if (picture.is_line(x, y) && !picture.is_line(x - 1, y)) ++lines;
  }
  return lines;
}

}  // namespace

TEST_CASE("a box fills the picture in its own proportions and lies in its middle") {
  const DisplayScene scene = in_white(scene_of(box({200, 100, 50}, {1000, -500, 80})));
  struct Case {
    View view;
    double ratio;
  };
  for (const auto& [view, ratio] :
       {Case{View::Top, 2.0}, Case{View::Front, 4.0}, Case{View::Right, 2.0}}) {
    CAPTURE(ratio);
    const Picture picture = draw(scene, {400, 300, view});
    REQUIRE(picture.width == 400);
    REQUIRE(picture.height == 300);
    const Extent e = extent(picture);
    const double width = e.right - e.left + 1.0;
    const double height = e.bottom - e.top + 1.0;
    CHECK(width == Approx(0.92 * 400).margin(3));
    CHECK(height == Approx(width / ratio).margin(3));
    CHECK(e.left + e.right == Approx(399).margin(2));
    CHECK(e.top + e.bottom == Approx(299).margin(2));
    CHECK(lines_in_row(picture, 150) == 2);
  }
}

TEST_CASE("the views are those of a drawing: x to the right, y or z upwards") {
  // A long bar along x with a red block at its +x end, green at +y, on top at +z.
  DisplayScene scene;
  scene.meshes.push_back({"bar", shared(box({100, 10, 10})), {0.2, 0.2, 0.8}});
  scene.meshes.push_back({"x", shared(box({10, 10, 10}, {45, 0, 10})), {0.9, 0.1, 0.1}});
  scene.meshes.push_back({"y", shared(box({10, 40, 10}, {-20, 25, 0})), {0.1, 0.8, 0.1}});
  for (std::size_t i = 0; i < 3; ++i)
    scene.instances.push_back({"", i, Pose(), DisplayState::Normal, ""});
  struct Mean {
    double x = 0.0;
    double y = 0.0;
    int count = 0;
  };
  const auto mean_of = [&](View view, std::size_t channel) {
    const Picture picture = draw(scene, {200, 200, view});
    Mean mean;
    for (std::uint32_t y = 0; y < 200; ++y) {
      for (std::uint32_t x = 0; x < 200; ++x) {
        const auto colour = picture.at(x, y);
        const int others = colour[0] + colour[1] + colour[2] - colour[channel];
        if (colour[channel] < others) continue;
        mean.x += x;
        mean.y += y;
        ++mean.count;
      }
    }
    REQUIRE(mean.count > 100);
    return Mean{mean.x / mean.count, mean.y / mean.count, mean.count};
  };
  CHECK(mean_of(View::Top, 0).x > 150);
  CHECK(mean_of(View::Top, 1).y < 100);
  CHECK(mean_of(View::Front, 0).x > 150);
  CHECK(mean_of(View::Front, 0).y < mean_of(View::Front, 2).y - 5);
  CHECK(mean_of(View::Right, 1).x > mean_of(View::Right, 0).x + 20);  // y to the right
  CHECK(mean_of(View::Isometric, 0).x > mean_of(View::Isometric, 1).x + 50);
}

TEST_CASE("what is behind is hidden, its lines too") {
  DisplayScene scene;
  scene.meshes.push_back({"front", shared(box({100, 10, 100}, {0, -50, 0}))});
  scene.meshes.push_back({"behind", shared(box({60, 10, 30}, {0, 0, 0}))});
  for (std::size_t i = 0; i < 2; ++i)
    scene.instances.push_back({"", i, Pose(), DisplayState::Normal, ""});
  scene = in_white(scene);
  const Picture both = draw(scene, {300, 300, View::Front});
  CHECK(lines_in_row(both, 150) == 2);
  std::swap(scene.meshes[0], scene.meshes[1]);
  CHECK((draw(scene, {300, 300, View::Front}).bytes == both.bytes));
  scene.instances.erase(scene.instances.begin() + 1);  // the one in front
  CHECK((draw(scene, {300, 300, View::Front}).bytes != both.bytes));
}

TEST_CASE("a cylinder seen from the side has an outline though no edge is there") {
  const Picture picture = draw(in_white(scene_of(cylinder(20, 60, 64))), {300, 300, View::Front});
  CHECK(lines_in_row(picture, 150) == 2);
}

TEST_CASE("colliding parts are red") {
  DisplayScene scene = scene_of(box({10, 10, 10}));
  const auto normal = draw(scene, {100, 100, View::Front}).at(50, 50);
  scene.instances[0].state = DisplayState::Colliding;
  const auto red = draw(scene, {100, 100, View::Front}).at(50, 50);
  CHECK(std::abs(normal[0] - normal[1]) < 20);
  CHECK(red[0] > 2 * red[1]);
  CHECK(red[0] > 2 * red[2]);
}

TEST_CASE("bands meet without a seam") {
  // The picture is symmetric about its middle row, where the bands are not.
  const DisplayScene scene = scene_of(box({50, 50, 50}));
  const Picture picture = draw(scene, {250, 250, View::Top});
  for (std::uint32_t y = 0; y < 125; ++y) {
    for (std::uint32_t x = 0; x < 250; ++x) {
      REQUIRE(picture.is_white(x, y) == picture.is_white(x, 249 - y));
    }
  }
}

TEST_CASE("pictures of nothing, of a speck and of one pixel are drawn") {
  const auto is_blank = [](const Picture& picture) {
    return std::ranges::all_of(picture.bytes, [](auto byte) { return byte == 255; });
  };
  CHECK(is_blank(draw({}, {40, 30, View::Isometric})));
  CHECK(is_blank(draw(scene_of({}), {40, 30, View::Isometric})));
  CHECK_FALSE(is_blank(draw(scene_of(box({1e-6, 1e-6, 1e-6})), {40, 30, View::Isometric})));
  CHECK(draw(small_fixture(), {1, 1, View::Isometric}).bytes.size() == 3);
  CHECK_THROWS_AS(to_png({}, {0, 30, View::Top}), std::logic_error);
  CHECK_THROWS_AS(to_png({}, {40, kMaxSnapshot_px + 1, View::Top}), std::logic_error);
  DisplayScene scene = scene_of(box({1, 1, 1}));
  scene.instances[0].mesh = 1;
  CHECK_THROWS_AS(to_png(scene), std::logic_error);
}

TEST_CASE("the same scene gives the same picture, also as a file") {
  const SnapshotOptions options{320, 240, View::Isometric};
  const std::vector<std::byte> png = to_png(small_fixture(), options);
  CHECK((png == to_png(small_fixture(), options)));
  const TemporaryFolder folder;
  write_png(folder / "scene.png", small_fixture(), options);
  const std::string file = read_text(folder / "scene.png");
  REQUIRE(file.size() == png.size());
  CHECK(std::memcmp(file.data(), png.data(), png.size()) == 0);
  CHECK_THROWS_AS(write_png(folder / "none" / "scene.png", small_fixture(), options), Error);
}
