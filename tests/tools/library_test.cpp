#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
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

#include "designed_features.h"
#include "dowel/catalog/catalog.h"
#include "dowel/catalog/lint.h"
#include "dowel/catalog/recognition.h"
#include "dowel/io/catalog_build.h"
#include "dowel/io/file.h"
#include "dowel/kernel/error.h"
#include "library/builders.h"
#include "library/manifest.h"
#include "library/systems.h"
#include "library/write_library.h"
#include "odd_outlines.h"
#include "volumes.h"

namespace dowel::library {
namespace {

namespace fs = std::filesystem;

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

const System& h40() {
  return system_called("H40-12");
}

/// Made once: it takes its time.
const std::vector<Part>& parts_made() {
  static const std::vector<Part> parts = all_parts();
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

/// Whether a kind of screw of a hole system has a length that holds `grip_mm` on its plate: at
/// least one diameter in the thread below the node's bore, tip one pitch above the bottom at most;
/// a fit screw's shank reaches half a diameter into the node and ends above its thread.
bool has_screw(const System& system, const std::vector<Part>& screws, double grip_mm, bool fit) {
  const ThreadSize& thread = fastener_of(system).thread;
  const double bore_mm = system.node.value().bore_depth_mm;
  const std::string of_thread = "-" + std::string(thread.name) + "x";
  return std::any_of(screws.begin(), screws.end(), [&](const Part& screw) {
    if (screw.name.find(of_thread) == std::string::npos) return false;
    const double depth_mm = screw.dimensions.at(0).value_mm - grip_mm;
    if (depth_mm < bore_mm + thread.diameter_mm) return false;
    if (depth_mm > system.plate_height_mm - thread.pitch_mm) return false;
    const double shank_mm = screw.dimensions.at(1).value_mm - grip_mm;
    return !fit || (shank_mm >= thread.diameter_mm / 2.0 && shank_mm <= bore_mm);
  });
}

void expect_names_and_kinds() {
  std::set<std::string> names;
  std::map<std::string, std::size_t> counts;
  for (const Part& part : parts_made()) {
    ++counts[part.name.substr(0, part.name.find('/'))];
    CAPTURE(part.name);
    CHECK(names.insert(part.name).second);
    CHECK_FALSE(part.description.empty());
    CHECK_FALSE(part.source.empty());
    CHECK_FALSE(part.dimensions.empty());
    CHECK_FALSE(part.features.empty());
    CHECK(part.material.density_kg_per_m3 > 1000.0);
    CHECK(std::set<std::string>{"base plate", "riser", "support", "locator", "clamp", "fastener",
                                "workpiece"}
              .count(part.role) == 1);
    std::set<std::string> features;
    for (const Feature& feature : part.features) {
      CAPTURE(feature.name, feature.use);
      CHECK_FALSE(feature.use.empty());
      CHECK(features.insert(feature.name).second);
      CHECK(feature.direction.norm() == Approx(1.0).margin(1e-12));
    }
  }
  CHECK(counts["H40-12"] >= 120);
  CHECK(counts["H50-16"] >= 80);
  CHECK(counts["T14"] >= 40);
  CHECK(counts["U12"] >= 50);
  for (const System& system : systems()) CHECK(system.plates.size() >= 3);
  for (const char* name : {"H40-12/riser-80x80x40", "H40-12/rest-pad-20", "H40-12/pin-round-12",
                           "H40-12/screw-M12x55", "H40-12/spacer-100", "workpiece/bracket"}) {
    CHECK(names.count(name) == 1);
  }
}

void expect_sound_solids() {
  for (const Part& part : parts_made()) {
    CAPTURE(part.name);
    CHECK(part.solid.ShapeType() == TopAbs_SOLID);
    CHECK(BRepCheck_Analyzer(part.solid).IsValid());
    CHECK(volume_of(part.solid) > 0.0);
    const bool seated =
        std::any_of(part.features.begin(), part.features.end(), [](const Feature& feature) {
          return feature.kind == FeatureKind::Face && feature.origin.z() == 0.0 &&
                 feature.direction.z() == -1.0;
        });
    // A ball rests on a ring; a plug goes down from the top of a plate.
    const bool has_no_seat = part.name.find("/spherical-washer-") != std::string::npos ||
                             part.name.find("/plug-screw-") != std::string::npos;
    CHECK(seated != has_no_seat);
  }
}

void expect_volumes() {
  const std::vector<Part>& parts = parts_made();
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
                           cylinder(6.0, 8.0) + cone(6.0, 6.0 - 2.0 * std::tan(kPi / 12.0), 1.0)},
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
  const double h50_node = cylinder(16.0, 20.0) + cylinder(13.835, 30.0);
  const double u12_slots = 13.5 * (8.0 * 240.0 * 12.0 - 16.0 * 12.0 * 12.0) +
                           8.5 * (8.0 * 240.0 * 20.0 - 16.0 * 20.0 * 20.0);
  const std::map<std::string, double> others{
      {"H40-12/plate-6x6", 36.0 * (40.0 * 40.0 * 40.0 - node(40.0))},
      {"H50-16/plate-6x6", 36.0 * (50.0 * 50.0 * 50.0 - h50_node)},
      {"T14/plate-4x315", 315.0 * (252.0 * 55.0 - 4.0 * (16.0 * 14.0 + 10.0 * 24.0))},
      {"U12/plate-4x4", 240.0 * 240.0 * 60.0 - u12_slots},
      {"T14/tee-nut-M12", 22.0 * 22.0 * 8.0 + 22.0 * 13.7 * 8.0 - cylinder(10.106, 16.0)},
      {"U12/key-12x24", 24.0 * 6.0 * (12.0 + 18.0) - cylinder(6.6, 12.0)},
      {"H50-16/screw-M16x80", cylinder(16.0, 79.0) + cone(16.0, 14.0, 1.0) + cylinder(24.0, 14.56) +
                                  cone(24.0, 21.12, 1.44) - 8.0 * hexagon_area(14.0)}};
  for (const auto& [name, volume_mm3] : others) {
    CAPTURE(name);
    CHECK(volume_of(find(parts, name).solid) == Approx(volume_mm3).epsilon(1e-9));
  }
}

/// As wide and deep as the table says, by OpenCascade's classifier.
void expect_holes() {
  std::size_t holes = 0;
  for (const Part& part : parts_made()) {
    if (part.features.size() > 60) continue;  // large plates take their time
    BRepClass3d_SolidClassifier classifier(part.solid);
    for (const Feature& hole : part.features) {
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
  CHECK(holes > 200);
}

/// What recognition alone makes of threads: the coarse one of the size, and of what is none
/// nothing.
void expect_likely_threads(const Part& part, const FacetedSolid& solid) {
  const std::vector<Feature> found = recognise_features(solid);
  for (const Feature& designed : part.features) {
    if (designed.kind != FeatureKind::Hole && designed.kind != FeatureKind::Shaft) continue;
    const auto feature = std::ranges::find(found, designed.name, &Feature::name);
    REQUIRE(feature != found.end());
    CAPTURE(designed.name, designed.use);
    std::string expected = designed.thread;
    if (designed.kind == FeatureKind::Shaft && expected == "M12x1.5" && feature->thread == "M12") {
      continue;  // its chamfer is deep enough for the coarse one
    }
    CHECK(feature->thread == expected);
    CHECK(feature->thread_is_guess == !expected.empty());
  }
}

/// What the tables say is what a catalogue made of the files has: every hole, shaft and slot, with
/// its name, place, size, thread and fit; and what they say of the elements.
void expect_catalogue() {
  const Folder folder;
  write_library(folder.path() / "elements", parts_made());
  const std::vector<fs::path> paths{folder.path() / "elements"};
  const fs::path file = folder.path() / "c.db";
  BuildOptions options;
  options.jobs = 2;
  for (const BuiltFile& built : build_catalog(paths, file, options)) {
    CAPTURE(built.file, built.reason);
    CHECK(built.status == BuildStatus::Ok);
    CHECK(built.warnings.empty());
  }
  const Catalog catalog(file, Catalog::Access::ReadOnly);
  CHECK(catalog.names().size() == parts_made().size());
  std::map<FeatureKind, std::size_t> counts;
  for (const Part& part : parts_made()) {
    const std::optional<Element> element = catalog.find(part.name);
    REQUIRE(element);
    for (const std::string& line : testing::differences(part.features, *element)) FAIL_CHECK(line);
    for (const Feature& feature : part.features) ++counts[feature.kind];
    CAPTURE(part.name);
    if (part.features.size() < 20) {
      const auto solid = catalog.solid(part.name);
      expect_likely_threads(part, *solid);
      for (const std::string& line : testing::odd_outlines(*solid, *element)) FAIL_CHECK(line);
    }
    CHECK(element->family == part.name.substr(0, part.name.rfind('/')));
    CHECK(element->role == part.role);
    CHECK(element->description == part.description);
    CHECK(element->material == part.material.name);
    CHECK(element->dimensions_by == part.source);
    CHECK(element->licence == "Apache-2.0");
    CHECK(element->mass_kg().value() ==
          Approx(volume_of(part.solid) * 1e-9 * part.material.density_kg_per_m3).epsilon(1e-6));
  }
  CHECK(counts[FeatureKind::Hole] > 1000);
  CHECK(counts[FeatureKind::Shaft] > 500);
  CHECK(counts[FeatureKind::Slot] > 100);
  for (const LintFinding& finding : lint(catalog)) {
    FAIL_CHECK(finding.rule << " " << finding.element << ": " << finding.message);
  }
}

}  // namespace

TEST_CASE("all parts of all systems") {
  SECTION("each kind of element, under readable names of its own") {
    expect_names_and_kinds();
  }
  SECTION("each one valid solid that faces outwards and is seated at z = 0") {
    expect_sound_solids();
  }
  SECTION("volumes are those of the formulas") {
    expect_volumes();
  }
  SECTION("the holes of the table are in the solids") {
    expect_holes();
  }
  SECTION("a catalogue has what the tables say") {
    expect_catalogue();
  }
}

TEST_CASE("a plate's nodes lie on the pitch, rows by letter and columns by number") {
  System system = h40();
  system.plates = {{10, 8}};
  const Part plate = base_plates(system).at(0);
  std::map<std::string, Eigen::Vector3d> nodes;
  for (const Feature& feature : plate.features) {
    if (feature.kind == FeatureKind::Hole) {
      nodes[feature.name] = feature.origin;
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

TEST_CASE("every element that is screwed on a node has a screw of a standard length") {
  for (const System& system : systems()) {
    if (!system.node) continue;
    CAPTURE(system.name);
    const SocketHead& head = fastener_of(system).socket;
    const std::vector<Part> screws = socket_screws(system);
    const std::vector<Part> fits = fit_screws(system);
    std::size_t holes = 0;
    for (const auto& make :
         {risers, angle_plates, rest_buttons, edge_locators, vee_blocks, edge_clamps}) {
      for (const Part& part : make(system)) {
        for (const Feature& hole : part.features) {
          if (hole.kind != FeatureKind::Hole || !hole.thread.empty()) continue;
          ++holes;
          CAPTURE(part.name, hole.use);
          const double grip_mm = hole.depth_mm - hole.segments.front().to_mm;
          CHECK(hole.segments.front().diameter_mm >= head.head_diameter_mm + 0.5);
          CHECK(grip_mm >= 8.0);  // material under the head
          CHECK(hole.segments.front().to_mm >= head.head_height_mm);
          CHECK(has_screw(system, screws, grip_mm, false));
          if (hole.fit == "H7") CHECK(has_screw(system, fits, grip_mm, true));
        }
      }
    }
    CHECK(holes == 12 + 8 + 3 + 6 + 5 + 4);
  }
  // The stacks that the README lists.
  for (const double grip_mm : {67.0, 87.0, 47.0, 77.0}) {
    CHECK(has_screw(h40(), fit_screws(h40()), grip_mm, true));
  }
}

TEST_CASE("what goes into T-slots fits them") {
  std::size_t checked = 0;
  for (const System& system : systems()) {
    if (!system.slot) continue;
    const TeeSlotSize& slot = *system.slot;
    for (const TeeNutSize& nut : system.tee_nuts) {
      ++checked;
      CAPTURE(system.name, nut.thread);
      CHECK(nut.slot_mm == slot.throat_mm);
      CHECK(nut.width_mm < slot.undercut_mm);
      CHECK(nut.foot_height_mm < slot.undercut_height_mm);
      CHECK(nut.height_mm < slot.depth_mm);
      // Where the neck carries the thread there is wall left beside it.
      const double thread_mm = fastener_size(nut.thread).thread.diameter_mm;
      if (nut.height_mm > nut.foot_height_mm) {
        CHECK(thread_mm < nut.slot_mm - kTeeNutNeckPlay_mm);
        CHECK(nut.height_mm >= thread_mm);
      }
    }
    for (const KeySize& key : system.keys) {
      CHECK(key.width_mm == slot.throat_mm);
      CHECK(key.height_mm / 2.0 <= system.key_depth_mm);
    }
  }
  CHECK(checked == 3);
}

TEST_CASE("neighbouring holes and edges leave walls of two millimetres") {
  for (const System& system : systems()) {
    if (!system.node) continue;
    for (const Part& part : risers(system)) {
      for (const Feature& a : part.features) {
        if (a.kind != FeatureKind::Hole) continue;
        const double radius_mm = a.segments.front().diameter_mm / 2.0;
        CHECK(system.pitch_mm - a.origin.head<2>().cwiseAbs().maxCoeff() - radius_mm >= 2.0);
        for (const Feature& b : part.features) {
          if (b.kind != FeatureKind::Hole || &a == &b) continue;
          const double other_mm = b.segments.front().diameter_mm / 2.0;
          const double distance_mm = (a.origin - b.origin).head<2>().norm();
          CHECK(distance_mm - radius_mm - other_mm >= 2.0);
        }
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
                             straps, heel_screws, fit_screws, washers, dowel_pins,
                             spherical_washers, conical_seats, collar_nuts, plug_screws}) {
      some.push_back(make(h40()).back());
    }
    const System& u12 = system_called("U12");
    for (const auto& make : {risers, angle_plates, adjustable_supports, support_screws, edge_clamps,
                             swing_clamps, swing_arms, tee_nuts, tee_bolts, keys}) {
      some.push_back(make(u12).back());
    }
    some.push_back(workpieces().back());
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
  const std::vector<Part> parts = washers(h40());
  const nlohmann::json manifest = nlohmann::json::parse(manifest_json(parts));
  CHECK(manifest.at("format") == "dowel-library/1");
  REQUIRE(manifest.at("elements").size() == parts.size());
  const nlohmann::json& washer = manifest.at("elements").at(0);
  CHECK(washer.at("name") == "H40-12/washer-M6");
  CHECK(washer.at("file") == "H40-12/washer-M6.step");
  CHECK(washer.at("source") == "like ISO 7089");
  CHECK(washer.at("family") == "H40-12");
  CHECK(washer.at("role") == "fastener");
  CHECK(washer.at("material") == "steel C45");
  CHECK(washer.at("mass_kg").get<double>() ==
        Approx((cylinder(12.0, 1.6) - cylinder(6.4, 1.6)) * 7850.0e-9).epsilon(1e-9));
  CHECK(washer.at("dimensions").at("outer_diameter") == 12.0);
  const nlohmann::json& hole = washer.at("features").at(0);
  CHECK(hole.at("kind") == "hole");
  CHECK(hole.at("name") == "h1");
  CHECK(hole.at("use") == "hole");
  CHECK(hole.at("diameter") == 6.4);
  CHECK(hole.at("through") == true);
  CHECK(hole.at("axis").at("origin") == nlohmann::json({0.0, 0.0, 1.6}));
  CHECK(hole.at("segments").at(0).at("to") == 1.6);
}

TEST_CASE("a library that cannot be written is an error", "[fault]") {
  const Folder folder;
  write_file(folder.path() / "file", "x");
  try {
    write_library(folder.path() / "file", washers(h40()));
    FAIL("no error");
  } catch (const Error& error) {
    CHECK(error.code() == ErrorCode::FileUnwritable);
    CHECK_THAT(error.what(), Catch::Contains("file"));
  }
  CHECK(read_file(folder.path() / "file") == "x");
}

}  // namespace dowel::library
