// Features of real parts. The table was read off the files' own CYLINDRICAL_SURFACE entities: those
// whose circular edges go at least three quarters of the way round, inner ones of one axis as one
// hole by the narrowest, outer ones as shafts; threads, and set screw holes across a bore, whose
// edges are no circles, by the parts' names and the cylinders' number.

#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/catalog/recognition.h"
#include "dowel/io/import.h"

namespace {

using namespace dowel;

struct KnownPart {
  const char* file;
  std::vector<double> holes_mm;   ///< diameters, sorted
  std::vector<double> shafts_mm;  ///< likewise
  const char* thread = "";        ///< of the thinnest shaft
};

const std::vector<KnownPart>& known_parts() {
  static const std::vector<KnownPart> parts{
      {"fcl2015/608ZZ_Ball_Bearing.step", {8.0}, {22.0}},
      {"fcl2015/ANSI-ASME-B18.2.1_Hex_Head_Cap_Screw_1_4-20x1.stp", {}, {6.35}},
      {"fcl2015/ANSI-ASME-B18.2.2_Hex_Nut_1_4-20.stp", {6.35}, {}},
      {"fcl2015/DIN463_M20TabWasher.step", {21.0}, {}},
      {"fcl2015/DIN7349_M5FlatWasher.step", {5.3}, {15.0}},
      {"fcl2015/DIN913_Setscrew_M3x5.step", {}, {3.0}, "M3"},
      {"fcl2015/DowelPin_4mm_L4mm_setscrew_M3.step", {3.0, 4.0}, {6.0}},
      {"fcl2015/Hex-Standoff-M3-12mm-Male-Female.step", {3.0}, {3.0}, "M3"},
      {"fcl2015/ISO10642_Hex_Socket_Countersunk_Head_Screw_M6x12.step", {}, {6.0}, "M6"},
      {"fcl2015/ISO4017_Hex_Head_Cap_Screw_M6x25.step", {}, {6.0, 8.88}, "M6"},
      {"fcl2015/ISO4032_Hex_Nut_M10.step", {10.0}, {}},
      {"fcl2015/ISO4762_Hex_Socket_Head_Cap_Screw_M3x10.step", {}, {3.0, 5.5}, "M3"},
      {"fcl2015/ISO4762_Hex_Socket_Head_Cap_Screw_M4x20.step", {}, {4.0, 7.0}, "M4"},
      {"fcl2015/ISO4762_Hex_Socket_Head_Cap_Screw_M6x12.step", {}, {6.0, 10.0}, "M6"},
      {"fcl2015/ISO4762_Hex_Socket_Head_Cap_Screw_M6x40.step", {}, {6.0, 10.0}, "M6"},
      {"fcl2015/ISO7091DIN126_CLASS_C_M33FlatWasher.step", {36.0}, {60.0}},
      {"fcl2015/ISO7380_Hex_Socket_Button_Head_Screw_M6x12.step", {}, {6.0}, "M6"},
      {"fcl2015/NEMA-17_Stepper_Motor_47mm.step", {3.0, 3.0, 3.0, 3.0, 6.8}, {5.0, 22.0}},
      {"fcl2015/NEMA-23_Stepper_Motor.step", {5.1, 5.1, 5.1, 5.1}, {6.35, 38.1, 57.2}},
      {"fcl2015/ShaftCoupler_4mm_to_3mm_setscrew_M3.step", {3.0, 3.0, 3.0}, {6.0}},
      {"o2ac/01-BASE.step", {4.0, 4.0, 4.0, 4.0, 4.0, 4.0, 4.0}, {}},
      {"o2ac/02-PANEL.step", {3.4, 3.4, 3.4, 3.4, 3.4, 4.5, 4.5, 12.0}, {}},
      {"o2ac/03-PANEL2.step", {4.0, 4.0, 4.0, 4.0, 4.5, 4.5, 36.0}, {}},
      {"pythonocc_core/eight_cyl.stp", {}, {50.0, 50.0, 50.0, 50.0, 50.0, 50.0, 50.0, 50.0}}};
  return parts;
}

bool has_real_files() {
  if (std::filesystem::exists(std::filesystem::path(DOWEL_SHARED_STEP) / "MANIFEST.tsv")) {
    return true;
  }
  WARN("no folder of real STEP files here: " << DOWEL_SHARED_STEP);
  return false;
}

std::vector<Feature> features_of(const std::string& file) {
  const ImportResult result =
      import_file(std::filesystem::path(DOWEL_SHARED_STEP) / file, ImportOptions());
  REQUIRE(result.status == ImportResult::Status::Ok);
  std::vector<Feature> features;
  for (const ImportedPart& part : result.parts) {
    for (Feature& feature : recognise_features(part.solid)) features.push_back(std::move(feature));
  }
  return features;
}

std::vector<double> diameters_mm(const std::vector<Feature>& features, FeatureKind kind) {
  std::vector<double> result;
  for (const Feature& feature : features) {
    if (feature.kind == kind) result.push_back(feature.diameter_mm);
  }
  std::sort(result.begin(), result.end());
  return result;
}

void check_diameters(const std::vector<double>& found, const std::vector<double>& expected) {
  CHECK_THAT(found, Catch::Approx(expected).margin(2e-3));
}

}  // namespace

TEST_CASE("real parts have the holes, shafts and threads that their files describe") {
  if (!has_real_files()) return;
  for (const KnownPart& known : known_parts()) {
    CAPTURE(known.file);
    const std::vector<Feature> features = features_of(known.file);
    check_diameters(diameters_mm(features, FeatureKind::Hole), known.holes_mm);
    check_diameters(diameters_mm(features, FeatureKind::Shaft), known.shafts_mm);
    const auto thinnest = std::ranges::find(features, FeatureKind::Shaft, &Feature::kind);
    CHECK((thinnest == features.end() ? "" : thinnest->thread) == known.thread);
  }
}

TEST_CASE("real flanges have their bolt circles") {
  if (!has_real_files()) return;
  struct KnownCircle {
    const char* file;
    double diameter_mm;
    double hole_mm;
  };
  // Of four holes each; places as the files have them: 47.14 mm square, 31 mm square, 65 mm across.
  for (const KnownCircle& known :
       {KnownCircle{"fcl2015/NEMA-23_Stepper_Motor.step", 66.666, 5.1},
        KnownCircle{"fcl2015/NEMA-17_Stepper_Motor_47mm.step", 43.841, 3.0},
        KnownCircle{"fcl2015/DN15_Stamped_Flange.step", 65.0, 13.5}}) {
    CAPTURE(known.file);
    const std::vector<BoltCircle> circles = find_bolt_circles(features_of(known.file));
    REQUIRE(circles.size() == 1);
    CHECK(circles[0].holes.size() == 4);
    CHECK(circles[0].diameter_mm == Approx(known.diameter_mm).margin(2e-3));
    CHECK(circles[0].hole_diameter_mm == Approx(known.hole_mm).margin(2e-3));
  }
}
