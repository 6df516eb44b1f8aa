#include <algorithm>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/catalog/catalog.h"
#include "dowel/catalog/lint.h"
#include "program.h"
#include "solids.h"
#include "sound_record.h"

// Misprints of published tables, each planted in elements that are sound otherwise: the solid
// follows the table, so that only sense or the neighbouring sizes tell.

namespace {

using dowel::ElementRecord;
using dowel::Feature;
using dowel::FeatureKind;
using dowel::LintFinding;

/// `record` as a fastener whose shafts and holes are called `uses`, by rising diameter.
ElementRecord fastener(ElementRecord record, const std::vector<std::string>& uses) {
  record.element.role = "fastener";
  std::size_t next = 0;
  for (Feature& feature : record.element.features) {
    feature.thread.clear();
    feature.thread_is_guess = false;
    if (feature.kind == FeatureKind::Face) continue;
    REQUIRE(next < uses.size());
    feature.use = uses[next++];
  }
  REQUIRE(next == uses.size());
  return record;
}

/// A head over a shank of `diameter_mm`.
ElementRecord screw(const std::string& name, double diameter_mm, double head_mm, double length_mm) {
  const double head_height_mm = diameter_mm;
  return fastener(
      dowel::testing::sound_record(
          name, dowel::testing::stepped_pin(
                    {{head_mm / 2.0, head_height_mm}, {diameter_mm / 2.0, length_mm}}, 48)),
      diameter_mm < head_mm ? std::vector<std::string>{"thread", "head"}
                            : std::vector<std::string>{"head", "thread"});
}

ElementRecord washer(const std::string& name, double inner_mm, double outer_mm, double height_mm) {
  ElementRecord record = dowel::testing::sound_record(
      name, dowel::testing::tube(inner_mm / 2.0, outer_mm / 2.0, height_mm, 48));
  record.element.role = "fastener";
  for (Feature& feature : record.element.features) {
    feature.thread.clear();
    feature.thread_is_guess = false;
  }
  return record;
}

std::vector<LintFinding> findings_of(const std::vector<ElementRecord>& records) {
  const dowel::testing::TemporaryFolder folder;
  const auto file = folder / "c.db";
  dowel::Catalog catalog(file, dowel::Catalog::Access::ReadWrite);
  for (const ElementRecord& record : records) {
    catalog.put({record.element.source, record.element.sha256, "", "ok", "", {}},
                std::vector{record});
  }
  return lint(catalog);
}

/// The one finding of `records`, which is CAT-01 at `element`: its message.
std::string only_message(const std::vector<ElementRecord>& records, const std::string& element) {
  const std::vector<LintFinding> findings = findings_of(records);
  REQUIRE(findings.size() == 1);
  CHECK(findings[0].rule == "CAT-01");
  CHECK(findings[0].severity == LintFinding::Severity::Error);
  CHECK(findings[0].element == element);
  return findings[0].message;
}

/// ISO 7089.
std::vector<ElementRecord> washers() {
  return {washer("A/washer-M8", 8.4, 16.0, 1.6), washer("A/washer-M10", 10.5, 20.0, 2.0),
          washer("A/washer-M12", 13.0, 24.0, 2.5), washer("A/washer-M16", 17.0, 30.0, 3.0)};
}

}  // namespace

TEST_CASE("Sound fasteners have no findings", "[rule]") {
  CHECK(findings_of(washers()).empty());
  // Lengths and diameters vary; the shorter one of the next diameter is no smaller size.
  CHECK(
      findings_of({screw("A/screw-M8x20", 8.0, 13.0, 20.0), screw("A/screw-M8x50", 8.0, 13.0, 50.0),
                   screw("A/screw-M12x20", 12.0, 18.0, 20.0)})
          .empty());
  // A pitch is no size: the finer, the wider the core.
  CHECK(findings_of({washer("A/nut-M12x1.25", 12.1, 18.0, 10.8),
                     washer("A/nut-M12x1.5", 12.05, 18.0, 10.8)})
            .empty());
  // Other families and other kinds are other series.
  CHECK(
      findings_of({washer("A/washer-M12", 13.0, 24.0, 2.5), washer("B/washer-M16", 17.0, 20.0, 2.0),
                   washer("A/clamp-washer-M16", 17.0, 22.0, 2.0)})
          .empty());
}

TEST_CASE("CAT-01 finds a fastener that is smaller than the next smaller size", "[rule]") {
  std::vector<ElementRecord> records = washers();
  SECTION("a hole") {
    records[1] = washer("A/washer-M10", 10.5, 20.0, 2.0);
    records[3] = washer("A/washer-M16", 16.5, 30.0, 3.0);
    records[2] = washer("A/washer-M12", 16.6, 24.0, 2.5);
    CHECK_THAT(
        only_message(records, "A/washer-M16"),
        Catch::Contains("16.5 mm thick, that of A/washer-M12") && Catch::EndsWith("16.6 mm"));
  }
  SECTION("outside") {
    records[2] = washer("A/washer-M12", 13.0, 19.0, 2.5);
    CHECK_THAT(only_message(records, "A/washer-M12"),
               Catch::Contains("19 mm thick, that of A/washer-M10, the next smaller size, 20 mm"));
  }
  SECTION("height") {
    records[3] = washer("A/washer-M16", 17.0, 30.0, 2.0);
    CHECK_THAT(only_message(records, "A/washer-M16"),
               Catch::Contains("measures 2 x 30 x 30 mm, that of A/washer-M12, the next smaller "
                               "size, 2.5 x 24 x 24 mm"));
  }
  SECTION("length") {
    const std::vector<ElementRecord> screws{screw("A/screw-M8x20", 8.0, 13.0, 20.0),
                                            screw("A/screw-M8x25", 8.0, 13.0, 19.0),
                                            screw("A/screw-M8x100", 8.0, 13.0, 100.0)};
    CHECK_THAT(only_message(screws, "A/screw-M8x25"), Catch::Contains("A/screw-M8x20"));
  }
}

TEST_CASE("CAT-01 takes no other elements for sizes of a standard part", "[rule]") {
  std::vector<ElementRecord> records = washers();
  records[2] = washer("A/washer-M12", 13.0, 19.0, 2.5);
  for (ElementRecord& record : records) record.element.role = "support";
  CHECK(findings_of(records).empty());
}

TEST_CASE("CAT-01 finds fasteners that contradict themselves", "[rule]") {
  SECTION("a head thinner than its shank") {
    CHECK_THAT(only_message({screw("A/screw-M12x30", 12.0, 11.0, 30.0)}, "A/screw-M12x30"),
               Catch::Contains("head pin1 is 11 mm thick, its thread pin2 12 mm"));
  }
  SECTION("a washer that its screw does not pass") {
    CHECK_THAT(only_message({washer("A/washer-M12", 11.5, 24.0, 2.5)}, "A/washer-M12"),
               Catch::Contains("M12, but its widest through hole is 11.5 mm"));
  }
  SECTION("a thread of another size than the name") {
    ElementRecord nut = washer("A/nut-M12", 8.376, 18.0, 10.8);
    const auto hole = std::ranges::find(nut.element.features, FeatureKind::Hole, &Feature::kind);
    REQUIRE(hole != nut.element.features.end());
    hole->thread = "M10";
    CHECK_THAT(only_message({nut}, "A/nut-M12"), Catch::Contains("M12, but its thread is M10"));
  }
}
