#include "dowel/io/catalog_sheet.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include <catch2/catch.hpp>
#include <png.h>

#include "dowel/catalog/recognition.h"
#include "dowel/kernel/mass_properties.h"
#include "element_picture.h"
#include "label_layout.h"
#include "program.h"
#include "solids.h"

using namespace dowel;

namespace {

constexpr std::uint32_t kWidth = 400;
constexpr std::uint32_t kHeight = 300;

ElementRecord record_of(const std::string& name, FacetedSolid solid) {
  ElementRecord record;
  record.element.name = name;
  record.element.family = name.substr(0, std::min(name.find('/'), name.size()));
  record.element.source = name + ".step";
  record.element.solids = solid.solid_count;
  record.element.volume_mm3 = mass_properties(solid).volume_mm3;
  record.element.features = recognise_features(solid);
  record.element.triangles = count_triangles(solid, classify_faces(solid, record.element.features));
  record.element.obb = enclosing_box(solid);
  record.solid = std::move(solid);
  return record;
}

/// Two through bores that open on top, and a blind one of another size.
ElementRecord plate() {
  return record_of(
      "H40/plate",
      testing::plate_with_holes({120, 80, 20}, {{-40, -20, 6}, {40, -20, 6}, {0, 20, 9, 12}}, 32));
}

struct Pixels {
  std::vector<std::uint8_t> bytes;
  std::array<int, 3> at(const Eigen::Vector2d& point) const {
    const auto x = static_cast<std::size_t>(point.x());
    const auto y = static_cast<std::size_t>(point.y());
    const std::size_t first = 3 * (y * kWidth + x);
    return {bytes[first], bytes[first + 1], bytes[first + 2]};
  }
};

Pixels read(const std::vector<std::byte>& png) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&image, png.data(), png.size()) == 0) {
    throw std::runtime_error(std::begin(image.message));
  }
  image.format = PNG_FORMAT_RGB;
  REQUIRE(image.width == kWidth);
  REQUIRE(image.height == kHeight);
  Pixels pixels;
  pixels.bytes.resize(PNG_IMAGE_SIZE(image));
  png_image_finish_read(&image, nullptr, pixels.bytes.data(), 0, nullptr);
  return pixels;
}

std::map<std::string, Eigen::Vector2d> marks_of(const ElementRecord& record,
                                                const ElementPicture& picture) {
  std::map<std::string, Eigen::Vector2d> marks;
  for (const FeatureMark& mark : picture.marks) {
    marks[record.element.features[mark.feature].name] = mark.at;
  }
  return marks;
}

ElementPicture draw(const ElementRecord& record, SeenFrom from) {
  return draw_element(record.element, record.solid, from, kWidth, kHeight);
}

std::size_t count(const std::string& text, const std::string& part) {
  std::size_t result = 0;
  for (auto at = text.find(part); at != text.npos; at = text.find(part, at + 1)) ++result;
  return result;
}

class Stored {
 public:
  explicit Stored(const std::vector<ElementRecord>& records)
      : catalog_(folder_ / "parts & pins.db", Catalog::Access::ReadWrite) {
    for (const ElementRecord& record : records) {
      catalog_.put({record.element.source, "", "", "ok", "", {}}, std::vector{record});
      elements_.push_back(catalog_.find(record.element.name).value());
    }
  }
  std::string sheet() const { return to_sheet(catalog_, elements_); }
  const Catalog& catalog() const { return catalog_; }
  const std::vector<Element>& elements() const { return elements_; }
  std::filesystem::path operator/(const char* name) const { return folder_ / name; }

 private:
  testing::TemporaryFolder folder_;
  Catalog catalog_;
  std::vector<Element> elements_;
};

}  // namespace

TEST_CASE("marks stand where the isometric projection puts the mouths of holes") {
  const ElementRecord record = plate();
  const auto marks = marks_of(record, draw(record, SeenFrom::FrontRightTop));
  REQUIRE(marks.contains("h1"));
  REQUIRE(marks.contains("h2"));
  REQUIRE(marks.contains("b1"));
  // Seen along (-1, 1, -1): x goes right and down, y right and up, by cos 30 and sin 30 degrees.
  const auto expected = [](double x_mm, double y_mm) {
    return Eigen::Vector2d(std::sqrt(0.5) * (x_mm + y_mm), std::sqrt(1.0 / 6.0) * (x_mm - y_mm));
  };
  const Eigen::Vector2d along_x = marks.at("h2") - marks.at("h1");
  const double scale = along_x.norm() / expected(80.0, 0.0).norm();
  CHECK(scale > 1.0);
  CHECK((along_x - scale * expected(80.0, 0.0)).norm() < 1e-6);
  CHECK((marks.at("b1") - marks.at("h1") - scale * expected(40.0, 40.0)).norm() < 1e-6);
}

TEST_CASE("a picture names what can be seen and nothing else") {
  const ElementRecord record = plate();
  const auto front = marks_of(record, draw(record, SeenFrom::FrontRightTop));
  const auto back = marks_of(record, draw(record, SeenFrom::BackLeftBottom));
  const auto top = marks_of(record, draw(record, SeenFrom::Top));
  for (const char* name : {"top", "front", "right"}) {
    CHECK(front.contains(name));
    CHECK_FALSE(back.contains(name));
  }
  for (const char* name : {"bottom", "back", "left"}) {
    CHECK(back.contains(name));
    CHECK_FALSE(front.contains(name));
  }
  CHECK_FALSE(back.contains("h1"));
  CHECK(top.size() == 4);
}

TEST_CASE("a pin that stands before a hole hides it") {
  ElementRecord record = plate();
  record.solid = testing::merged(record.solid,
                                 testing::transformed(Pose::from_translation({55.0, -35.0, 30.0}),
                                                      testing::cylinder(8.0, 60.0, 24)));
  const auto with = marks_of(record, draw(record, SeenFrom::FrontRightTop));
  CHECK_FALSE(with.contains("h2"));
  CHECK(with.contains("h1"));
}

TEST_CASE("walls of holes, threads and shafts are drawn in their colours") {
  ElementRecord record = plate();
  for (Feature& feature : record.element.features) {
    if (feature.name == "h2") feature.thread = "M12";
  }
  const ElementPicture picture = draw(record, SeenFrom::FrontRightTop);
  const Pixels pixels = read(picture.png);
  const auto marks = marks_of(record, picture);
  // Beyond the middle of a mouth, a little up, the far wall of the bore shows.
  const auto [hole_red, hole_green, hole_blue] = pixels.at(marks.at("h1") - Eigen::Vector2d(0, 4));
  CHECK(hole_blue > hole_red + 40);
  const auto [red, green, blue] = pixels.at(marks.at("h2") - Eigen::Vector2d(0, 4));
  CHECK(red > blue + 40);
  const auto [r, g, b] = pixels.at(marks.at("front"));
  CHECK(std::abs(r - b) < 20);
  CHECK(pixels.at({2, 2}) == std::array{255, 255, 255});
}

TEST_CASE("a sheet shows every element once, needs nothing else, and is the same each time") {
  const Stored stored({plate(), record_of("H40/pin", testing::stepped_pin({{10, 8}, {6, 20}}, 24)),
                       record_of("T14/block", testing::box({80, 40, 20}))});
  const std::string sheet = stored.sheet();
  CHECK(sheet == stored.sheet());
  CHECK(count(sheet, "<article") == 3);
  CHECK(count(sheet, "<h2 ") == 2);
  CHECK(count(sheet, "<title>parts &amp; pins.db</title>") == 1);
  CHECK(count(sheet, "http") == 0);
  CHECK(count(sheet, "src=") == 0);
  CHECK(count(sheet, "href=\"data:image/png") == count(sheet, "<image"));
  CHECK(count(sheet, ">h1</text>") == 1);
  CHECK(count(sheet, ">pin1</text>") >= 1);
  CHECK(count(sheet, "2 × hole ⌀12, through 20: <b>h1 h2</b>") == 1);
  CHECK(count(sheet, "80 × 40 × 20 mm") == 1);
  // About 15 kB an element; a sheet of hundreds must stay small enough to open.
  CHECK(sheet.size() < 200'000);
}

TEST_CASE("texts from files are shown, not obeyed") {
  ElementRecord record = plate();
  record.element.name = "<script>alert(1)</script>";
  record.element.description = "a \"plate\" & more \xff";
  record.element.features.front().name = "<b>";
  const Stored stored({record});
  const std::string sheet = stored.sheet();
  CHECK(count(sheet, "<script") == 0);
  CHECK(count(sheet, "&lt;script&gt;alert(1)&lt;/script&gt;") >= 1);
  CHECK(count(sheet, "a &quot;plate&quot; &amp; more \xEF\xBF\xBD") == 1);
  CHECK(count(sheet, "<b><b>") == 0);
}

TEST_CASE("a plate of many holes is shown in plan, each hole named once") {
  const Stored stored({record_of(
      "plate", testing::plate_with_holes({400, 320, 30}, testing::hole_grid(8, 6, 40, 6), 16))});
  const std::string sheet = stored.sheet();
  CHECK(count(sheet, "<image") == 2);
  for (const char* name : {"A1", "C4", "F8"}) {
    CHECK(count(sheet, ">" + std::string(name) + "</text>") == 1);
  }
}

TEST_CASE("a sheet that is stopped leaves no file, one that is written replaces it") {
  const Stored stored({plate()});
  write_sheet(stored / "out.html", stored.catalog(), stored.elements(),
              [](std::size_t, std::size_t) { return false; });
  CHECK_FALSE(std::filesystem::exists(stored / "out.html"));
  write_sheet(stored / "out.html", stored.catalog(), stored.elements());
  CHECK(testing::read_text(stored / "out.html") == stored.sheet());
}

TEST_CASE("names stay inside the picture and apart from each other where there is room",
          "[property]") {
  const auto seed = GENERATE(range(0U, 20U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  std::vector<Label> labels;
  for (int i = 0; i < 12; ++i) {
    // Places on a coarse grid, so that no two are closer than 60 px.
    const Eigen::Vector2d at(60.0 + 90.0 * (i % 4), 60.0 + 90.0 * (i / 4));
    const Eigen::Vector2d off(random.uniform(-15.0, 15.0), random.uniform(-15.0, 15.0));
    labels.push_back({"cb" + std::to_string(i + 1), at + off, random.uniform(0.0, 12.0), true});
  }
  const std::vector<PlacedLabel> placed = place_labels(labels, kWidth, kHeight);
  REQUIRE(placed.size() == labels.size());
  for (std::size_t i = 0; i < placed.size(); ++i) {
    const Label& label = labels[placed[i].label];
    const Eigen::Vector2d half(0.3 * placed[i].font_px * static_cast<double>(label.text.size()),
                               0.5 * placed[i].font_px);
    CHECK(((placed[i].center - half).array() >= 0.0).all());
    CHECK(placed[i].center.x() + half.x() <= kWidth);
    CHECK(placed[i].center.y() + half.y() <= kHeight);
    CHECK_FALSE(placed[i].has_leader);
    for (std::size_t j = i + 1; j < placed.size(); ++j) {
      const Eigen::Vector2d apart = (placed[i].center - placed[j].center).cwiseAbs();
      CHECK((apart.x() > half.x() || apart.y() >= placed[i].font_px));
    }
  }
}

TEST_CASE("where there is no room, holes are named all the same and faces are not") {
  std::vector<Label> labels;
  for (int i = 0; i < 400; ++i) {
    labels.push_back({"h" + std::to_string(i), {200.0, 150.0}, 3.0, i < 300});
  }
  const std::vector<PlacedLabel> placed = place_labels(labels, kWidth, kHeight);
  CHECK(placed.size() >= 300);
  CHECK(placed.size() < 400);
}
