#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <BRepCheck_Analyzer.hxx>
#include <BRepClass3d_SolidClassifier.hxx>
#include <BRepGProp.hxx>
#include <Eigen/Geometry>
#include <GProp_GProps.hxx>
#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>
#include <STEPControl_Reader.hxx>
#include <TopAbs_ShapeEnum.hxx>
#include <catch2/catch.hpp>
#include <gp_Pnt.hxx>
#include <nlohmann/json.hpp>

#include "dowel/io/file.h"
#include "dowel/kernel/error.h"
#include "library/builders.h"
#include "library/dimensions.h"
#include "library/manifest.h"
#include "library/write_library.h"

namespace dowel::library {
namespace {

namespace fs = std::filesystem;
constexpr double kPi = std::numbers::pi;

/// A folder that goes with the test.
class Folder {
 public:
  Folder() {
    std::string pattern = (fs::temp_directory_path() / "dowel-library-XXXXXX").string();
    path_ = ::mkdtemp(pattern.data());
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;
  ~Folder() { fs::remove_all(path_); }
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

double volume_of(const TopoDS_Shape& shape) {
  GProp_GProps properties;
  BRepGProp::VolumeProperties(shape, properties);
  return properties.Mass();
}

double cylinder(double diameter_mm, double length_mm) {
  return kPi / 4.0 * diameter_mm * diameter_mm * length_mm;
}

double cone(double from_mm, double to_mm, double length_mm) {
  return kPi / 12.0 * (from_mm * from_mm + from_mm * to_mm + to_mm * to_mm) * length_mm;
}

double hexagon_area(double across_flats_mm) {
  return std::sqrt(3.0) / 2.0 * across_flats_mm * across_flats_mm;
}

/// Material that two wrench flats take off a round bar.
double flats(double diameter_mm, double across_mm, double length_mm) {
  const double r = diameter_mm / 2.0;
  const double h = across_mm / 2.0;
  return 2.0 * (r * r * std::acos(h / r) - h * std::sqrt(r * r - h * h)) * length_mm;
}

double spigot() {
  return cylinder(11.9885, 13.0) + cylinder(9.5, 2.0) + cylinder(12.0, 18.0) +
         cone(12.0, 10.0, 1.0);
}

double node(double depth_mm) {
  return cylinder(12.0, 15.0) + cylinder(10.106, depth_mm - 15.0);
}

/// Every part but the large plates, whose holes take their time.
std::vector<Part> make_small_parts() {
  std::vector<Part> parts;
  for (const auto& make : {risers, spacers, columns, rest_pads, rest_buttons, edge_locators,
                           locating_pins, pin_holders, vee_blocks, straps, heel_screws, studs,
                           socket_screws, fit_screws, nuts, washers, dowel_pins, workpieces}) {
    for (Part& part : make()) parts.push_back(std::move(part));
  }
  return parts;
}

const std::vector<Part>& small_parts() {
  static const std::vector<Part> parts = make_small_parts();
  return parts;
}

const std::vector<Part>& plates() {
  static const std::vector<Part> parts = base_plates();
  return parts;
}

const Part& find(const std::vector<Part>& parts, const std::string& name) {
  const auto found =
      std::find_if(parts.begin(), parts.end(), [&](const Part& part) { return part.name == name; });
  REQUIRE(found != parts.end());
  return *found;
}

gp_Pnt at(const Feature& hole, double depth_mm, double radius_mm) {
  const Eigen::Vector3d side = hole.direction.unitOrthogonal();
  const Eigen::Vector3d p = hole.origin + depth_mm * hole.direction + radius_mm * side;
  return {p.x(), p.y(), p.z()};
}

/// Lengths of a kind of screw M12 that hold `grip_mm` on a plate of 40 mm: at least 12 mm in the
/// thread that starts 15 mm deep, tip one pitch above the bottom at most; a fit screw's shank
/// reaches at least 6 mm into the node and ends above its thread.
bool has_screw(const std::vector<Part>& screws, double grip_mm, bool fit) {
  return std::any_of(screws.begin(), screws.end(), [&](const Part& screw) {
    if (screw.name.find("M12x") == std::string::npos) return false;
    const double depth_mm = screw.dimensions.at(0).value_mm - grip_mm;
    if (depth_mm < 27.0 || depth_mm > 38.25) return false;
    const double shank_mm = screw.dimensions.at(1).value_mm - grip_mm;
    return !fit || (shank_mm >= 6.0 && shank_mm <= 15.0);
  });
}

}  // namespace

TEST_CASE("the library has each kind of element, under readable names of its own") {
  std::set<std::string> names;
  std::size_t count = 4;  // plates
  for (const Part& part : small_parts()) {
    ++count;
    CAPTURE(part.name);
    CHECK(names.insert(part.name).second);
    CHECK_FALSE(part.description.empty());
    CHECK_FALSE(part.source.empty());
    CHECK_FALSE(part.dimensions.empty());
    CHECK_FALSE(part.features.empty());
    CHECK(std::set<std::string>{"riser", "support", "locator", "clamp", "fastener", "workpiece"}
              .count(part.role) == 1);
    std::set<std::string> features;
    for (const DesignedFeature& feature : part.features) {
      CHECK(features.insert(feature.geometry.name).second);
      CHECK(feature.geometry.direction.norm() == Approx(1.0).margin(1e-12));
    }
  }
  CHECK(count >= 70);
  for (const char* name : {"H40-12/riser-80x80x40", "H40-12/rest-pad-20", "H40-12/pin-round-12",
                           "H40-12/screw-M12x55", "H40-12/spacer-100", "workpiece/bracket"}) {
    CHECK(names.count(name) == 1);
  }
}

TEST_CASE("every part is one valid solid that faces outwards and is seated at z = 0") {
  for (const Part& part : small_parts()) {
    CAPTURE(part.name);
    CHECK(part.solid.ShapeType() == TopAbs_SOLID);
    CHECK(BRepCheck_Analyzer(part.solid).IsValid());
    CHECK(volume_of(part.solid) > 0.0);
    const bool seated =
        std::any_of(part.features.begin(), part.features.end(), [](const DesignedFeature& feature) {
          return feature.geometry.kind == FeatureKind::Face && feature.geometry.origin.z() == 0.0 &&
                 feature.geometry.direction.z() == -1.0;
        });
    CHECK(seated);
  }
}

TEST_CASE("volumes are those of the formulas") {
  const std::vector<Part>& parts = small_parts();
  const double screw_hole_60 = cylinder(20.0, 13.0) + cylinder(13.5, 35.0) + cylinder(12.0, 12.0);
  const std::map<std::string, double> expected{
      {"spacer-20", 39.5 * 39.5 * 20.0 - cylinder(12.0, 20.0)},
      {"riser-80x80x40", 80.0 * 80.0 * 40.0 - 4.0 * (cylinder(20.0, 13.0)) -
                             2.0 * (cylinder(13.5, 15.0) + cylinder(12.0, 12.0)) -
                             2.0 * cylinder(13.5, 27.0) - node(40.0)},
      {"column-36x60", spigot() + cylinder(36.0, 58.0) + 2.0 * cone(36.0, 34.0, 1.0) - node(36.0) -
                           cone(10.106, 0.0, 5.053 / std::tan(59.0 / 180.0 * kPi)) -
                           flats(36.0, 30.0, 10.0)},
      {"rest-pad-20",
       spigot() + cylinder(18.0, 19.0) + cone(18.0, 16.0, 1.0) - flats(18.0, 15.0, 8.0)},
      {"rest-button-30", cylinder(36.0, 29.0) + cone(36.0, 34.0, 1.0) - cylinder(20.0, 13.0) -
                             cylinder(13.5, 5.0) - cylinder(12.0, 12.0)},
      {"edge-locator-60", 80.0 * 39.5 * 60.0 - 1.0 * 39.5 * 35.0 - 2.0 * screw_hole_60},
      {"pin-round-12", cylinder(11.9885, 12.0) +
                           cone(11.9885, 11.9885 - 12.0 * std::tan(kPi / 12.0), 6.0) +
                           cylinder(6.0, 8.5) + cone(6.0, 5.0, 0.5)},
      {"strap-14x100",
       40.0 * (100.0 * 20.0 - 58.0 * 2.0 - 20.0 * 10.0 / 2.0) - 18.0 * (26.0 * 14.0 + kPi * 49.0)},
      {"stud-M12x160", cylinder(12.0, 158.0) + 2.0 * cone(12.0, 10.0, 1.0)},
      {"screw-M12x55", cylinder(12.0, 54.125) + cone(12.0, 10.25, 0.875) + cylinder(18.0, 10.92) +
                           cone(18.0, 15.84, 1.08) - 6.0 * hexagon_area(10.0)},
      {"fit-screw-M12x80", cylinder(11.9885, 55.0) + cylinder(9.5, 2.0) + cylinder(12.0, 22.0) +
                               cone(12.0, 10.0, 1.0) + cylinder(18.0, 10.92) +
                               cone(18.0, 15.84, 1.08) - 6.0 * hexagon_area(10.0)},
      {"washer-M12", cylinder(24.0, 2.5) - cylinder(13.0, 2.5)},
      {"clamp-washer-M12", cylinder(35.0, 5.0) - cylinder(13.0, 5.0)},
      {"dowel-pin-12x30",
       cylinder(12.0, 26.4) + 2.0 * cone(12.0, 12.0 - 3.6 * std::tan(kPi / 12.0), 1.8)}};
  for (const auto& [name, volume_mm3] : expected) {
    CAPTURE(name);
    CHECK(volume_of(find(parts, "H40-12/" + name).solid) == Approx(volume_mm3).epsilon(1e-9));
  }
  for (const auto& [name, nodes_x, nodes_y] :
       {std::tuple("plate-6x6", 6, 6), std::tuple("plate-10x8", 10, 8)}) {
    const double volume_mm3 = nodes_x * nodes_y * (40.0 * 40.0 * 40.0 - node(40.0));
    CHECK(volume_of(find(plates(), std::string("H40-12/") + name).solid) ==
          Approx(volume_mm3).epsilon(1e-9));
  }
}

TEST_CASE("the holes of the table are in the solids, as wide as they say") {
  std::size_t holes = 0;
  for (const Part& part : small_parts()) {
    BRepClass3d_SolidClassifier classifier(part.solid);
    for (const DesignedFeature& feature : part.features) {
      const Feature& hole = feature.geometry;
      if (hole.kind != FeatureKind::Hole) continue;
      ++holes;
      CAPTURE(part.name, hole.name);
      CHECK(hole.segments.front().from_mm == 0.0);
      CHECK(hole.segments.back().to_mm == hole.depth_mm);
      for (const HoleSegment& segment : hole.segments) {
        if (segment.type != HoleSegment::Type::Cylinder) continue;
        const double radius_mm = segment.diameter_mm / 2.0;
        // Near its lower end a counterbore in a V has material all around.
        const double depth_mm = segment.to_mm - 0.05 * (segment.to_mm - segment.from_mm);
        classifier.Perform(at(hole, depth_mm, radius_mm - 0.01), 1e-7);
        CHECK(classifier.State() == TopAbs_OUT);
        classifier.Perform(at(hole, depth_mm, radius_mm + 0.01), 1e-7);
        CHECK(classifier.State() == TopAbs_IN);
      }
      classifier.Perform(at(hole, hole.depth_mm + 0.01, 0.0), 1e-7);
      CHECK(classifier.State() == (hole.through ? TopAbs_OUT : TopAbs_IN));
    }
  }
  CHECK(holes > 60);
}

TEST_CASE("a plate's nodes lie on the pitch, rows by letter and columns by number") {
  const Part& plate = find(plates(), "H40-12/plate-10x8");
  std::map<std::string, Eigen::Vector3d> nodes;
  for (const DesignedFeature& feature : plate.features) {
    if (feature.geometry.kind == FeatureKind::Hole) {
      nodes[feature.geometry.name] = feature.geometry.origin;
      CHECK(feature.thread == "M12");
      CHECK(feature.fit == "H7");
    }
  }
  CHECK(nodes.size() == 80);
  CHECK(nodes.at("A1") == Eigen::Vector3d(-180.0, -140.0, 40.0));
  CHECK(nodes.at("A10") == Eigen::Vector3d(180.0, -140.0, 40.0));
  CHECK(nodes.at("H1") == Eigen::Vector3d(-180.0, 140.0, 40.0));
  CHECK(nodes.at("C4") == Eigen::Vector3d(-60.0, -60.0, 40.0));
}

TEST_CASE("every element that is screwed on has a screw of a standard length") {
  const std::vector<Part> screws = socket_screws();
  const std::vector<Part> fits = fit_screws();
  std::vector<Part> held = risers();
  for (const auto& make : {rest_buttons, edge_locators, vee_blocks}) {
    for (Part& part : make()) held.push_back(std::move(part));
  }
  std::size_t holes = 0;
  for (const Part& part : held) {
    for (const DesignedFeature& feature : part.features) {
      const Feature& hole = feature.geometry;
      if (hole.kind != FeatureKind::Hole || feature.thread == "M12") continue;
      ++holes;
      CAPTURE(part.name, hole.name);
      const double grip_mm = hole.depth_mm - hole.segments.front().to_mm;
      CHECK(hole.segments.front().diameter_mm >= 18.0 + 0.5);  // the head, like DIN 974-1
      CHECK(hole.segments.front().to_mm >= 12.0);              // and its height
      CHECK(grip_mm >= 8.0);                                   // material under the head
      CHECK(has_screw(screws, grip_mm, false));
      if (feature.fit == "H7") CHECK(has_screw(fits, grip_mm, true));
    }
  }
  CHECK(holes == 12 + 3 + 6 + 5);
  // The stacks that the README lists.
  for (const double grip_mm : {67.0, 87.0, 47.0, 77.0}) CHECK(has_screw(fits, grip_mm, true));
}

TEST_CASE("neighbouring holes and edges leave walls of two millimetres") {
  for (const Part& part : risers()) {
    for (const DesignedFeature& a : part.features) {
      if (a.geometry.kind != FeatureKind::Hole) continue;
      const double radius_mm = a.geometry.segments.front().diameter_mm / 2.0;
      CHECK(40.0 - a.geometry.origin.head<2>().cwiseAbs().maxCoeff() - radius_mm >= 2.0);
      for (const DesignedFeature& b : part.features) {
        if (b.geometry.kind != FeatureKind::Hole || &a == &b) continue;
        const double other_mm = b.geometry.segments.front().diameter_mm / 2.0;
        const double distance_mm = (a.geometry.origin - b.geometry.origin).head<2>().norm();
        CHECK(distance_mm - radius_mm - other_mm >= 2.0);
      }
    }
  }
}

TEST_CASE("the same parts give the same files, in any order, and they read back", "[determinism]") {
  Message::DefaultMessenger()->RemovePrinters(STANDARD_TYPE(Message_PrinterOStream));
  // One of each way of making, made anew the second time.
  const auto samples = [] {
    std::vector<Part> some;
    for (const auto& make : {risers, columns, rest_pads, edge_locators, locating_pins, vee_blocks,
                             straps, heel_screws, fit_screws, washers, dowel_pins, workpieces}) {
      some.push_back(make().back());
    }
    return some;
  };
  const std::vector<Part> parts = samples();
  std::vector<Part> again = samples();
  std::reverse(again.begin(), again.end());
  const Folder first;
  const Folder second;
  write_library(first.path(), parts);
  write_library(second.path(), again);
  for (const Part& part : parts) {
    CAPTURE(part.name);
    const fs::path file = first.path() / file_name(part);
    CHECK(read_file(file) == read_file(second.path() / file_name(part)));
    STEPControl_Reader reader;
    REQUIRE(reader.ReadFile(file.c_str()) == IFSelect_RetDone);
    REQUIRE(reader.TransferRoots() == 1);
    const TopoDS_Shape shape = reader.OneShape();
    CHECK(shape.ShapeType() == TopAbs_SOLID);
    // Where a cone meets a plane of a nut the edge is a B-spline: the volumes' own error.
    CHECK(volume_of(shape) == Approx(volume_of(part.solid)).epsilon(1e-7));
  }
}

TEST_CASE("the manifest describes every part") {
  const std::vector<Part> parts = washers();
  const nlohmann::json manifest = nlohmann::json::parse(manifest_json(parts));
  CHECK(manifest.at("format") == "dowel-library/1");
  REQUIRE(manifest.at("elements").size() == parts.size());
  const nlohmann::json& washer = manifest.at("elements").at(0);
  CHECK(washer.at("name") == "H40-12/washer-M6");
  CHECK(washer.at("file") == "H40-12/washer-M6.step");
  CHECK(washer.at("source") == "like ISO 7089");
  CHECK(washer.at("dimensions").at("outer_diameter") == 12.0);
  const nlohmann::json& hole = washer.at("features").at(0);
  CHECK(hole.at("kind") == "hole");
  CHECK(hole.at("diameter") == 6.4);
  CHECK(hole.at("through") == true);
  CHECK(hole.at("axis").at("origin") == nlohmann::json({0.0, 0.0, 1.6}));
  CHECK(hole.at("segments").at(0).at("to") == 1.6);
}

TEST_CASE("a library that cannot be written is an error", "[fault]") {
  const Folder folder;
  write_file(folder.path() / "file", "x");
  try {
    write_library(folder.path() / "file", washers());
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::FileUnwritable);
    CHECK_THAT(error.what(), Catch::Contains("file"));
  }
  CHECK(read_file(folder.path() / "file") == "x");
}

}  // namespace dowel::library
