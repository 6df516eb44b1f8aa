// Fastening over the T-slots of the library's systems, with its own screws, T-bolts, nuts and
// washers.

#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/assembly/automation.h"
#include "dowel/assembly/sequence.h"
#include "dowel/catalog/catalog.h"
#include "dowel/io/catalog_build.h"
#include "library/builders.h"
#include "library/systems.h"
#include "library/write_library.h"
#include "program.h"

namespace {

using namespace dowel;

/// Those of `make(system)` whose names end in one of `endings`.
template <class Make>
void add_parts(std::vector<library::Part>& parts, const char* system, const Make& make,
               const std::vector<std::string>& endings) {
  for (library::Part& part : make(library::system_called(system))) {
    if (std::ranges::any_of(endings,
                            [&](const std::string& end) { return part.name.ends_with(end); })) {
      parts.push_back(std::move(part));
    }
  }
}

/// A session with a grounded plate of a slot system, and a riser on it whose key slot is over a
/// slot of the plate.
struct Bench {
  testing::TemporaryFolder folder;
  Session session{Project()};

  Bench(const char* system, const std::string& plate, const std::string& riser, double y_mm) {
    using namespace library;
    std::vector<Part> parts;
    add_parts(parts, system, base_plates, {plate});
    add_parts(parts, system, risers, {riser});
    for (const auto& make : {tee_nuts, tee_bolts, nuts, collar_nuts, socket_screws}) {
      add_parts(parts, system, make, {""});
    }
    // What a slot system has not itself comes from others.
    add_parts(parts, "H40-12", washers, {"/washer-M12"});
    add_parts(parts, "H40-12", spherical_washers, {"M12"});
    add_parts(parts, "H40-12", conical_seats, {"M12"});
    if (parts_of_kind_missing(system)) {
      add_parts(parts, "H40-12", socket_screws, {"M12x60", "M12x70", "M12x80"});
      add_parts(parts, "H40-12", nuts, {"/nut-M12"});
      add_parts(parts, "H40-12", collar_nuts, {"M12"});
      add_parts(parts, "U12", nuts, {"/nut-M12x1.5"});
      add_parts(parts, "U12", socket_screws, {"M12x1.5x70"});
    }
    write_library(folder / "out", parts);
    const std::vector<std::filesystem::path> paths{folder / "out"};
    build_catalog(paths, folder / "c.db", {});
    session.use_catalog(
        std::make_shared<const Catalog>(folder / "c.db", Catalog::Access::ReadOnly));
    const std::string family = system_called(system).name.data();
    session.place(family + "/" + plate, "PLATE", Pose(), "place");
    session.set_grounded("PLATE", true, "ground");
    const double top_mm = session.feature({"PLATE", face_up("PLATE")}).origin_W().z();
    session.place(family + "/" + riser, "RISER", Pose::from_translation({0, y_mm, top_mm}),
                  "place");
  }

  static bool parts_of_kind_missing(const char* system) {
    return library::system_called(system).screws.empty();
  }

  /// The highest face of an instance that looks up.
  std::string face_up(const std::string& instance) {
    std::string highest;
    double z_mm = -1e9;
    for (const Feature& face : session.element(session.instance(instance).element).features) {
      if (face.kind != FeatureKind::Face || face.direction.z() < 1.0 - 1e-9) continue;
      if (face.origin.z() > z_mm) {
        highest = face.name;
        z_mm = face.origin.z();
      }
    }
    return highest;
  }

  /// The hole of the riser for its screw on the side of +x.
  std::string screw_hole() {
    for (const Feature& hole : session.element(session.instance("RISER").element).features) {
      if (hole.kind == FeatureKind::Hole && hole.origin.x() > 0.0) return hole.name;
    }
    throw std::runtime_error("the riser has no hole on the right");
  }
};

std::vector<std::string> elements_of(const Fastening& way) {
  std::vector<std::string> names{way.screw.element};
  for (const auto* part : {&way.conical_seat, &way.washer, &way.nut, &way.tee_nut}) {
    if (*part) names.push_back((*part)->element);
  }
  return names;
}

/// Places a way, looks that nothing is entered and that all mates hold, and takes it back.
void check_placed(Session& session, const FasteningPlan& plan, std::size_t way) {
  CAPTURE(way);
  const auto reports = fasten(session, plan, way, "fasten");
  for (const MoveReport& report : reports) {
    CAPTURE(report.instance);
    for (const Touch& touch : report.touches) {
      UNSCOPED_INFO(touch.with << " " << to_string(touch.pair.verdict));
    }
    CHECK_FALSE(report.refused);
  }
  CHECK(worst(session.check_all()) == Verdict::Contact);
  const bool is_bolt = plan.ways[way].screw.kind == Fastener::Kind::TeeBolt;
  CHECK(session.state().mates.size() == reports.size() + (is_bolt ? 1 : 0));
  for (const auto& [number, mate] : session.state().mates) {
    CAPTURE(number);
    const MateResidual off = session.residual(mate);
    CHECK(off.axis_mm < 1e-9);
    CHECK(off.angle_rad < 1e-9);
    CHECK(std::abs(off.along_mm) < 1e-9);
  }
  // A T-bolt comes along its slot before the riser stands on it.
  CHECK(plan_sequence(session).blocked.empty());
  if (!reports.front().refused) session.undo(1);
}

}  // namespace

TEST_CASE("U12: a T-bolt comes up from the slot and takes washer and nut on the face") {
  Bench bench("U12", "plate-4x4", "riser-120x60x60", 30.0);
  const FeatureName hole{"RISER", bench.screw_hole()};
  const FasteningPlan plan = plan_fastening(bench.session, hole);
  // 60 mm of riser and 13.5 of throat; washer 2.5, nut 10.8 and a pitch of 1.5: 88.3.
  REQUIRE(plan.ways.size() == 3);
  CHECK(elements_of(plan.ways[0]) == std::vector<std::string>{"U12/tee-bolt-M12x1.5x90",
                                                              "H40-12/washer-M12",
                                                              "U12/nut-M12x1.5"});
  CHECK(plan.ways[0].grip_mm == Approx(76.0));
  CHECK(plan.ways[0].spare_mm == Approx(3.2));
  CHECK(plan.holes.at(plan.ways[0].thread).instance == "PLATE");
  // A collar nut is 18 high: 93. The ball touches its cone 3.148 mm above the face, so that washer
  // and seat are 7.748 high together.
  CHECK(elements_of(plan.ways[1]) ==
        std::vector<std::string>{"U12/tee-bolt-M12x1.5x120", "U12/collar-nut-M12x1.5"});
  CHECK(elements_of(plan.ways[2]) ==
        std::vector<std::string>{"U12/tee-bolt-M12x1.5x120", "H40-12/conical-seat-M12",
                                 "H40-12/spherical-washer-M12", "U12/nut-M12x1.5"});
  CHECK(plan.ways[2].grip_mm == Approx(73.5 + 7.748).margin(0.001));
  for (std::size_t way = 0; way < plan.ways.size(); ++way) check_placed(bench.session, plan, way);
}

TEST_CASE("a riser is dragged along its slot with what fastens it, and does not turn") {
  Bench bench("U12", "plate-4x4", "riser-120x60x60", 30.0);
  Session& session = bench.session;
  session.mate({.kind = MateKind::FaceOnFace,
                .moving = {"RISER", "bottom"},
                .fixed = {"PLATE", bench.face_up("PLATE")},
                .seat = {},
                .options = {}},
               "mate");
  const auto placed =
      fasten(session, plan_fastening(session, {"RISER", bench.screw_hole()}), 0, "f");
  std::vector<Pose> before;
  for (const MoveReport& report : placed) before.push_back(report.X_WI);
  DragRequest request;
  request.instance = "RISER";
  request.by_mm_W = {10.0, 0.0, 0.0};
  const DragReport report = session.drag(request, "drag");
  CHECK_FALSE(report.move.refused);
  CHECK(report.move.verdict == Verdict::Contact);
  CHECK(report.move.moved_along.size() == placed.size());
  const Pose& X_WR = session.instance("RISER").X_WI;
  CHECK((X_WR.translation() - Eigen::Vector3d(10.0, 30.0, 60.0)).norm() < 1e-9);
  CHECK(X_WR.rotation().angularDistance(Eigen::Quaterniond::Identity()) < 1e-12);
  for (std::size_t i = 0; i < placed.size(); ++i) {
    CAPTURE(placed[i].instance);
    const Pose& X_WI = session.instance(placed[i].instance).X_WI;
    CHECK((X_WI.translation() - before[i].translation() - Eigen::Vector3d(10.0, 0.0, 0.0)).norm() <
          1e-9);
  }
}

TEST_CASE("T14: screw and T-nut first, T-bolts as alternatives, no nut of another pitch") {
  Bench bench("T14", "plate-4x315", "riser-126x63x63", 31.5);
  const FasteningPlan plan = plan_fastening(bench.session, {"RISER", bench.screw_hole()});
  REQUIRE(plan.ways.size() >= 4);
  // From the counterbore, 13 deep: 58 mm to the T-nut, 10.8 in it, and its slot's floor at 76.
  CHECK(elements_of(plan.ways[0]) ==
        std::vector<std::string>{"H40-12/screw-M12x70", "T14/tee-nut-M12"});
  CHECK(plan.ways[0].seat_mm == Approx(13.0));
  const auto bolt = std::ranges::find_if(
      plan.ways, [](const Fastening& way) { return way.screw.kind == Fastener::Kind::TeeBolt; });
  REQUIRE(bolt != plan.ways.end());
  // 79 mm to the shoulder, washer, nut and a pitch of 1.75: 94.05.
  CHECK(elements_of(*bolt) ==
        std::vector<std::string>{"T14/tee-bolt-M12x100", "H40-12/washer-M12", "H40-12/nut-M12"});
  for (std::size_t way = 0; way < plan.ways.size(); ++way) {
    for (const std::string& element : elements_of(plan.ways[way])) {
      CHECK(element.find("x1.5") == std::string::npos);
    }
    check_placed(bench.session, plan, way);
  }
}
