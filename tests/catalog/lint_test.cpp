#include "dowel/catalog/lint.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <SQLiteCpp/SQLiteCpp.h>
#include <catch2/catch.hpp>

#include "dowel/catalog/recognition.h"
#include "dowel/kernel/mass_properties.h"
#include "program.h"
#include "slotted_solids.h"
#include "solids.h"
#include "sound_record.h"

namespace {

using dowel::ElementRecord;
using dowel::LintFinding;
using dowel::testing::sound_record;

ElementRecord plate_record() {
  return sound_record("plate", dowel::testing::plate_with_holes(
                                   {100.0, 80.0, 20.0}, {{-30.0, 0.0, 6.0}, {30.0, 0.0, 6.0}}, 48));
}

/// The rules that find something wrong, each once.
std::vector<std::string> rules_of(const ElementRecord& record) {
  std::vector<std::string> rules;
  for (const LintFinding& finding : lint(record.element, record.solid)) {
    CHECK(finding.element == record.element.name);
    CHECK_FALSE(finding.message.empty());
    if (rules.empty() || rules.back() != finding.rule) rules.push_back(finding.rule);
  }
  return rules;
}

using Rules = std::vector<std::string>;

dowel::Feature& first_hole(ElementRecord& record) {
  const auto hole =
      std::ranges::find(record.element.features, dowel::FeatureKind::Hole, &dowel::Feature::kind);
  REQUIRE(hole != record.element.features.end());
  return *hole;
}

}  // namespace

TEST_CASE("Sound elements have no findings", "[rule]") {
  CHECK(rules_of(plate_record()).empty());
  CHECK(rules_of(sound_record("block", dowel::testing::box({80.0, 40.0, 20.0}))).empty());
  CHECK(rules_of(sound_record("pin", dowel::testing::cylinder(6.0, 40.0, 32))).empty());
  CHECK(rules_of(sound_record("ball", dowel::testing::sphere(20.0, 48))).empty());
  CHECK(rules_of(sound_record("tube", dowel::testing::tube(5.0, 9.0, 30.0, 40))).empty());
}

TEST_CASE("CAT-01 finds numbers that do not agree with each other", "[rule]") {
  ElementRecord record = plate_record();
  dowel::Element& element = record.element;
  SECTION("triangles") {
    ++element.triangles.total;
  }
  SECTION("triangles of a class") {
    ++element.triangles.plane;
  }
  SECTION("solids") {
    element.solids = 2;
  }
  SECTION("volume") {
    element.volume_mm3 *= 25.4 * 25.4 * 25.4;
  }
  SECTION("facet error") {
    element.facet_error_mm = 0.0;
  }
  SECTION("a face that is not there") {
    element.features.back().faces = {4000};
  }
  SECTION("an entry that is no face") {
    first_hole(record).entry = first_hole(record).name;
  }
  SECTION("a diameter that no segment has") {
    first_hole(record).diameter_mm = 8.0;
  }
  SECTION("segments deeper than the hole") {
    first_hole(record).depth_mm = 5.0;
  }
  SECTION("a thread that is wider than its bore") {
    first_hole(record).thread = "M16";
  }
  SECTION("a shaft's fit on a hole") {
    first_hole(record).fit = "g6";
  }
  SECTION("segments that overlap") {
    first_hole(record).segments.push_back(first_hole(record).segments.back());
  }
  const Rules rules = rules_of(record);
  REQUIRE_FALSE(rules.empty());
  CHECK(rules.front() == "CAT-01");
}

TEST_CASE("CAT-01 finds T-slots that are none", "[rule]") {
  ElementRecord record =
      sound_record("bar", dowel::testing::tee_bar(60.0, 50.0, 100.0, {}, {30.0}));
  REQUIRE(rules_of(record).empty());
  const auto slot =
      std::ranges::find(record.element.features, dowel::FeatureKind::Slot, &dowel::Feature::kind);
  REQUIRE(slot != record.element.features.end());
  SECTION("for nothing is wider below the throat") {
    slot->slot->undercut_width_mm = slot->diameter_mm;
  }
  SECTION("for throat and undercut are deeper than the slot") {
    slot->slot->undercut_height_mm += 0.5;
  }
  CHECK(rules_of(record) == Rules{"CAT-01"});
}

TEST_CASE("CAT-02 finds a box that the element stands out of", "[rule]") {
  SECTION("its facets") {
    ElementRecord record = plate_record();
    record.element.obb.half_extents_mm.x() -= 0.01;
    CHECK(rules_of(record) == Rules{"CAT-02"});
  }
  SECTION("its exact face, though the facets are inside") {
    ElementRecord record = sound_record("pin", dowel::testing::cylinder(6.0, 40.0, 12));
    // Of a prism of 12 sides the facets reach 6 cos(15 deg) along a side's normal.
    const double reach_mm = 6.0 * std::cos(std::numbers::pi / 12.0);
    record.element.obb.center = {0.0, 0.0, 20.0};
    record.element.obb.axes =
        Eigen::AngleAxisd(std::numbers::pi / 12.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    record.element.obb.half_extents_mm = {reach_mm, reach_mm, 20.0};
    CHECK(rules_of(record) == Rules{"CAT-02"});
  }
}

TEST_CASE("CAT-03 finds a mesh that is open or inside out", "[rule]") {
  ElementRecord record = sound_record("block", dowel::testing::box({80.0, 40.0, 20.0}));
  SECTION("open") {
    record.solid.triangles.pop_back();
    record.solid.face_of.pop_back();
    record.element.triangles = {11, 11, 0, 0};
  }
  SECTION("inside out") {
    record.solid = dowel::testing::inverted(record.solid);
  }
  const Rules rules = rules_of(record);
  CHECK(std::ranges::count(rules, "CAT-03") == 1);
}

TEST_CASE("CAT-04 finds hole triangles without a hole and holes without their walls", "[rule]") {
  ElementRecord record = plate_record();
  SECTION("triangles tagged as hole, but the hole is not declared") {
    const auto is_hole = [](const dowel::Feature& feature) {
      return feature.kind == dowel::FeatureKind::Hole;
    };
    std::erase_if(record.element.features, is_hole);
  }
  SECTION("planes that are tagged as something else") {
    record.element.triangles.plane -= 2;
    record.element.triangles.other += 2;
  }
  SECTION("a hole that is not where its wall is") {
    first_hole(record).origin.x() += 0.5;
  }
  SECTION("a hole of another diameter than its wall") {
    for (dowel::HoleSegment& segment : first_hole(record).segments) {
      segment.diameter_mm = segment.diameter_end_mm = 11.0;
    }
    first_hole(record).diameter_mm = 11.0;
  }
  SECTION("a hole of too few facets") {
    record = sound_record("coarse", dowel::testing::tube(5.0, 20.0, 30.0, 6));
    REQUIRE(first_hole(record).diameter_mm == Approx(10.0));
  }
  const Rules rules = rules_of(record);
  CHECK(std::ranges::count(rules, "CAT-04") == 1);
}

TEST_CASE("CAT-05 finds units that cannot be right", "[rule]") {
  CHECK(rules_of(sound_record("km", dowel::testing::box({80e3, 40e3, 20e3}))) == Rules{"CAT-05"});
  CHECK(rules_of(sound_record("m", dowel::testing::box({0.08, 0.04, 0.02}))) == Rules{"CAT-05"});
  ElementRecord record = plate_record();
  record.element.unit_in_file.clear();
  CHECK(rules_of(record) == Rules{"CAT-05"});
  record = plate_record();
  record.element.density_kg_per_m3 = 7850.0;
  CHECK(rules_of(record).empty());
  record.element.density_kg_per_m3 = GENERATE(7.85, 7.85e-9, 7.85e6);
  CHECK(rules_of(record) == Rules{"CAT-05"});
}

TEST_CASE("CAT-01 takes threads and fits that their features can have", "[rule]") {
  ElementRecord record = plate_record();  // bores of 12 mm
  first_hole(record).thread = GENERATE("M12", "M14", "M13");
  first_hole(record).fit = GENERATE("H7", "F7", "");
  CHECK(rules_of(record).empty());
}

TEST_CASE("CAT-09 warns of a box that is larger than it need be", "[rule]") {
  ElementRecord record = plate_record();
  SECTION("by little") {
    record.element.obb.half_extents_mm *= 1.0003;
    CHECK(rules_of(record).empty());
  }
  SECTION("by a tenth of a millimetre") {
    record.element.obb.half_extents_mm.z() += 0.1;
    CHECK(rules_of(record) == Rules{"CAT-09"});
  }
  SECTION("for it stands askew") {
    record.element.obb.axes = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    record.element.obb.half_extents_mm += Eigen::Vector3d(5.0, 6.0, 0.0);
    CHECK(rules_of(record) == Rules{"CAT-09"});
  }
}

TEST_CASE("CAT-10 finds features that their faces are not of", "[rule]") {
  ElementRecord plate = plate_record();
  ElementRecord pin = sound_record("pin", dowel::testing::stepped_pin({{10, 8}, {6, 20}}, 32));
  const auto feature_of = [](ElementRecord& record, dowel::FeatureKind kind) -> dowel::Feature& {
    return *std::ranges::find(record.element.features, kind, &dowel::Feature::kind);
  };
  dowel::Feature& face = feature_of(plate, dowel::FeatureKind::Face);
  dowel::Feature& shaft = feature_of(pin, dowel::FeatureKind::Shaft);
  REQUIRE(rules_of(plate).empty());
  REQUIRE(rules_of(pin).empty());
  SECTION("a planar face at another height") {
    face.origin += 0.5 * face.direction;
    CHECK(rules_of(plate) == Rules{"CAT-10"});
  }
  SECTION("a planar face that looks the other way") {
    face.direction = -face.direction;
    CHECK(rules_of(plate) == Rules{"CAT-10"});
  }
  SECTION("a shaft beside its wall") {
    shaft.origin.x() += 0.1;
    CHECK(rules_of(pin) == Rules{"CAT-10"});
  }
  SECTION("a shaft of another diameter") {
    shaft.diameter_mm += 0.01;
    CHECK(rules_of(pin) == Rules{"CAT-10"});
  }
  SECTION("a shaft without faces") {
    shaft.faces.clear();
    CHECK(rules_of(pin) == Rules{"CAT-10"});
  }
}

TEST_CASE("CAT-06 warns where licence, source or revision are missing", "[rule]") {
  ElementRecord record = plate_record();
  record.element.licence.clear();
  record.element.source.clear();
  record.element.sha256.clear();
  const auto findings = lint(record.element, record.solid);
  REQUIRE(findings.size() == 3);
  for (const LintFinding& finding : findings) {
    CHECK(finding.rule == "CAT-06");
    CHECK(finding.severity == LintFinding::Severity::Warning);
  }
}

namespace {

/// The findings of a catalogue with these records, after `sql` was run on its file.
std::vector<LintFinding> findings_of(const std::vector<ElementRecord>& records,
                                     const std::string& sql = "") {
  const dowel::testing::TemporaryFolder folder;
  const auto file = folder / "c.db";
  {
    dowel::Catalog catalog(file, dowel::Catalog::Access::ReadWrite);
    for (const ElementRecord& record : records) {
      catalog.put({record.element.source, record.element.sha256, "", "ok", "", {}},
                  std::vector{record});
    }
  }
  SQLite::Database(file.string(), SQLite::OPEN_READWRITE).exec(sql);
  return lint(dowel::Catalog(file, dowel::Catalog::Access::ReadOnly));
}

}  // namespace

TEST_CASE("CAT-07 warns of elements with the same facets", "[rule]") {
  const auto a = sound_record("a", dowel::testing::box({80.0, 40.0, 20.0}));
  const auto b = sound_record("b", dowel::testing::box({80.0, 40.0, 20.0}));
  const auto c = sound_record("c", dowel::testing::box({80.0, 40.0, 21.0}));
  const auto findings = findings_of({c, b, a});
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].rule == "CAT-07");
  CHECK(findings[0].element == "b");
  CHECK(findings[0].severity == LintFinding::Severity::Warning);
  CHECK_THAT(findings[0].message, Catch::EndsWith("as a"));
}

TEST_CASE("CAT-08 finds what cannot be read and goes on", "[rule][fault]") {
  const auto a = sound_record("a", dowel::testing::box({80.0, 40.0, 20.0}));
  auto b = sound_record("b", dowel::testing::box({60.0, 40.0, 20.0}));
  b.element.unit_in_file.clear();
  const std::string of_a = "element_id = (SELECT id FROM element WHERE name = 'a')";
  const std::string facets_of_a =
      "id = (SELECT blob_id FROM element_blob WHERE kind = 'facets' AND " + of_a + ")";
  const std::string damage = GENERATE_COPY("UPDATE blob SET bytes = x'00' WHERE " + facets_of_a,
                                           "UPDATE blob SET checksum = 1 WHERE " + facets_of_a,
                                           "DELETE FROM element_blob WHERE " + of_a,
                                           "UPDATE feature SET direction_x = 7.0 WHERE " + of_a);
  const auto findings = findings_of({a, b}, damage);
  REQUIRE(findings.size() == 2);
  CHECK(findings[0].element == "a");
  CHECK(findings[0].rule == "CAT-08");
  CHECK(findings[1].element == "b");
  CHECK(findings[1].rule == "CAT-05");
}
