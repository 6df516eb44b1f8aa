// Dragging parts of loops, against closed forms.

#include <array>
#include <cmath>
#include <numbers>

#include <catch2/catch.hpp>

#include "dowel/assembly/session.h"
#include "dowel/kernel/error.h"
#include "fixture_elements.h"
#include "program.h"
#include "random_geometry.h"

using dowel::Catalog;
using dowel::DragMode;
using dowel::DragReport;
using dowel::DragRequest;
using dowel::MateKind;
using dowel::Pose;
using dowel::ProjectElement;
using dowel::Session;
using Eigen::Vector2d;
using Eigen::Vector3d;
namespace testing = dowel::testing;

namespace {

constexpr double kThick_mm = 10.0;
constexpr double kBore_mm = 8.0;

/// A bar with a through hole at each end: h1 at its origin, h2 `length_mm` along x.
ProjectElement bar(const std::string& name, double length_mm) {
  const double half_mm = 0.5 * length_mm;
  const std::vector<testing::DrilledHole> holes{
      {.x = -half_mm, .y = 0.0, .radius_mm = 0.5 * kBore_mm},
      {.x = half_mm, .y = 0.0, .radius_mm = 0.5 * kBore_mm}};
  dowel::FacetedSolid solid =
      testing::plate_with_holes({length_mm + 16.0, 16.0, kThick_mm}, holes, 24);
  const auto hole = [&](const char* hole_name, double x_mm) {
    return testing::hole_feature(hole_name, {x_mm, 0, kThick_mm}, -Vector3d::UnitZ(),
                                 {{kBore_mm, kThick_mm}}, true);
  };
  return testing::element_of(
      name, std::move(solid),
      {hole("h1", -half_mm), hole("h2", half_mm),
       testing::face_feature("top", {0, 0, kThick_mm}, Vector3d::UnitZ(), 1000.0),
       testing::face_feature("bottom", {0, 0, 0}, -Vector3d::UnitZ(), 1000.0)});
}

/// Lengths of a four-bar linkage: frame between the fixed pivots, crank, coupler, rocker.
struct FourBar {
  double frame_mm = 0.0;
  double crank_mm = 0.0;
  double coupler_mm = 0.0;
  double rocker_mm = 0.0;

  /// The joint of coupler and rocker for a crank at `angle_rad`, by the intersection of two
  /// circles; on the left of the way from the crank's end to the rocker's pivot where `left`.
  std::optional<Vector2d> joint(double angle_rad, bool left) const {
    const Vector2d a(crank_mm * std::cos(angle_rad), crank_mm * std::sin(angle_rad));
    const Vector2d d = Vector2d(frame_mm, 0.0) - a;
    const double distance = d.norm();
    const double along =
        (distance * distance + coupler_mm * coupler_mm - rocker_mm * rocker_mm) / (2.0 * distance);
    const double square = coupler_mm * coupler_mm - along * along;
    if (square < 0.0) return std::nullopt;
    const Vector2d u = d / distance;
    const double side = (left ? 1.0 : -1.0) * std::sqrt(square);
    return a + along * u + side * Vector2d(-u.y(), u.x());
  }
};

/// The linkage as parts: FRAME is grounded, its pivots at (0, 0) and (frame, 0).
struct LinkageShop {
  testing::TemporaryFolder folder;
  Session session{dowel::Project()};
  FourBar bars;

  LinkageShop(const FourBar& lengths, double crank_rad, bool left) : bars(lengths) {
    const auto file = folder / "bars.db";
    {
      Catalog catalog(file, Catalog::Access::ReadWrite);
      for (const ProjectElement& element :
           {bar("L/frame", bars.frame_mm), bar("L/crank", bars.crank_mm),
            bar("L/coupler", bars.coupler_mm), bar("L/rocker", bars.rocker_mm),
            testing::block_element(), testing::pin_element()}) {
        dowel::SourceRecord source;
        source.path = element.element.source;
        source.status = "ok";
        const std::vector<dowel::ElementRecord> records{{element.element, *element.solid, {}}};
        catalog.put(source, records);
      }
    }
    session.use_catalog(std::make_shared<const Catalog>(file, Catalog::Access::ReadOnly));
    const Vector2d a = bars.crank_mm * Vector2d(std::cos(crank_rad), std::sin(crank_rad));
    const Vector2d b = bars.joint(crank_rad, left).value();
    const Vector2d pivot(bars.frame_mm, 0.0);
    place("frame", "FRAME", {0, 0}, pivot, 0.0);
    place("crank", "CRANK", {0, 0}, a, kThick_mm);
    place("rocker", "ROCKER", pivot, b, kThick_mm);
    place("coupler", "COUPLER", a, b, 2.0 * kThick_mm);
    session.set_grounded("FRAME", true, "ground");
    insert({"CRANK", "h1"}, {"FRAME", "h1"});
    insert({"ROCKER", "h1"}, {"FRAME", "h2"});
    insert({"COUPLER", "h1"}, {"CRANK", "h2"});
    insert({"COUPLER", "h2"}, {"ROCKER", "h2"});
  }

  /// A bar from `from` to `to` at a height.
  void place(const std::string& element, const std::string& name, const Vector2d& from,
             const Vector2d& to, double z_mm) {
    const Vector2d run = to - from;
    const Vector2d middle = 0.5 * (from + to);
    session.place(
        "L/" + element, name,
        Pose(Eigen::Quaterniond(Eigen::AngleAxisd(std::atan2(run.y(), run.x()), Vector3d::UnitZ())),
             {middle.x(), middle.y(), z_mm}),
        "place");
  }

  void insert(const dowel::FeatureName& moving, const dowel::FeatureName& fixed) {
    const auto report = session.mate(
        {.kind = {}, .moving = moving, .fixed = fixed, .seat = {}, .options = {}}, "mate");
    REQUIRE_FALSE(report.refused);
  }

  Vector3d at(const std::string& name, const std::string& hole) {
    return session.feature({name, hole}).origin_W();
  }

  double crank_rad() {
    const Vector3d run = at("CRANK", "h2") - at("CRANK", "h1");
    return std::atan2(run.y(), run.x());
  }

  DragReport turn(const std::string& name, double angle_rad, DragMode mode = DragMode::Off) {
    DragRequest request;
    request.instance = name;
    request.turn_rad = angle_rad;
    request.mode = mode;
    return session.drag(request, "drag");
  }

  /// How far the linkage is from its closed form for the crank as it stands.
  double off_mm(bool left) {
    const double angle_rad = crank_rad();
    const Vector2d a = bars.crank_mm * Vector2d(std::cos(angle_rad), std::sin(angle_rad));
    const Vector2d b = bars.joint(angle_rad, left).value();
    const auto flat = [](const Vector3d& p) { return Vector2d(p.x(), p.y()); };
    return std::max({(flat(at("CRANK", "h1"))).norm(), (flat(at("COUPLER", "h1")) - a).norm(),
                     (flat(at("COUPLER", "h2")) - b).norm(), (flat(at("ROCKER", "h2")) - b).norm(),
                     std::abs(at("COUPLER", "h1").z() - 3.0 * kThick_mm),
                     std::abs(at("ROCKER", "h2").z() - 2.0 * kThick_mm)});
  }
};

}  // namespace

TEST_CASE("a crank drags its linkage along the closed form, all around", "[property]") {
  const unsigned seed = GENERATE(range(0U, 12U));
  testing::RandomGeometry random(seed);
  // Grashof: the crank is the shortest, and shortest and longest are less than the others.
  FourBar bars;
  bars.crank_mm = random.uniform(30, 50);
  bars.frame_mm = random.uniform(110, 140);
  bars.coupler_mm = random.uniform(100, 130);
  bars.rocker_mm = bars.frame_mm + bars.crank_mm - bars.coupler_mm + random.uniform(30, 50);
  const bool left = seed % 2 == 0;
  CAPTURE(seed, bars.frame_mm, bars.crank_mm, bars.coupler_mm, bars.rocker_mm, left);
  LinkageShop shop(bars, random.uniform(-3, 3), left);
  for (int i = 0; i < 8; ++i) {
    const double before_rad = shop.crank_rad();
    const double turn_rad = random.uniform(-2.0, 2.0) + (i == 7 ? 4.0 : 0.0);
    const DragReport report = shop.turn("CRANK", turn_rad);
    CHECK_FALSE(report.move.refused);
    CHECK(report.is_linkage);
    CHECK(report.allowed_rad == turn_rad);
    CHECK(report.move.moved_along.size() == 2);
    CHECK(std::abs(std::remainder(shop.crank_rad() - before_rad - turn_rad,
                                  2.0 * std::numbers::pi)) < 1e-11);
    CHECK(shop.off_mm(left) < testing::kExact_mm);
    CHECK(shop.session.state().mates.size() == 4);
  }
  shop.session.undo(1);
  CHECK(shop.off_mm(left) < testing::kExact_mm);
}

TEST_CASE("any part drives the linkage, as far as its mates let it") {
  const FourBar bars{120, 40, 110, 80};
  LinkageShop shop(bars, 1.0, true);
  CHECK(shop.session.freedoms("COUPLER").freedoms.size() == 1);
  CHECK_FALSE(shop.turn("COUPLER", 0.1).move.refused);
  CHECK(shop.off_mm(true) < testing::kExact_mm);
  // The rocker's joint is farthest from the crank's pivot where crank and coupler are in line.
  const DragReport report = shop.turn("ROCKER", -2.0);
  CHECK_FALSE(report.move.refused);
  CHECK(std::abs(report.allowed_rad) < 2.0);
  const Vector3d joint = shop.at("ROCKER", "h2");
  CHECK(Vector2d(joint.x(), joint.y()).norm() ==
        Approx(bars.crank_mm + bars.coupler_mm).margin(1e-4));
  // There is no further way, and back there is.
  CHECK_THROWS_WITH(shop.turn("ROCKER", -0.5), Catch::Contains("ROCKER"));
  CHECK_FALSE(shop.turn("ROCKER", 0.2).move.refused);
}

TEST_CASE("a parallelogram's coupler slides on a circle to the place nearest to the goal") {
  const FourBar bars{100, 60, 100, 60};
  LinkageShop shop(bars, 1.0, true);
  DragRequest request;
  request.instance = "COUPLER";
  request.by_mm_W = {70, -5, 4};
  request.mode = DragMode::Off;
  const Vector3d start = shop.at("COUPLER", "h1");
  const Vector3d goal = start + request.by_mm_W;
  const DragReport report = shop.session.drag(request, "drag");
  CHECK_FALSE(report.move.refused);
  // The end of the crank is on its circle, in line with the goal.
  const double angle_rad = std::atan2(goal.y(), goal.x());
  const Vector3d end = shop.at("COUPLER", "h1");
  CHECK((end - Vector3d(60 * std::cos(angle_rad), 60 * std::sin(angle_rad), start.z())).norm() <
        1e-5);
  CHECK(std::hypot(end.x(), end.y()) == Approx(60.0).margin(testing::kExact_mm));
  CHECK((shop.at("COUPLER", "h2") - end - Vector3d(100, 0, 0)).norm() < testing::kExact_mm);
  CHECK((report.allowed_mm_W - (end - start)).norm() < 1e-9);
}

TEST_CASE("a linkage stops where any of its parts touches something") {
  const FourBar bars{120, 40, 110, 80};
  const bool warns = GENERATE(false, true);
  LinkageShop shop(bars, 1.0, true);
  // The rocker's end goes to the left, where the block is beside it and below the coupler.
  shop.session.place("T/block-40", "BLOCK", Pose::from_translation({80, 80, -5}), "place");
  REQUIRE(shop.at("ROCKER", "h2").x() > 110.0);
  const DragReport report = shop.turn("CRANK", -2.0, warns ? DragMode::Warn : DragMode::Block);
  for (const dowel::Touch& touch : report.move.touches) {
    UNSCOPED_INFO(touch.instance << " " << touch.with << " " << to_string(touch.pair.verdict));
  }
  CHECK_FALSE(report.move.refused);
  REQUIRE(report.move.stopped_by.size() == 1);
  CHECK(report.move.stopped_by[0].with == "BLOCK");
  CHECK(report.move.free_share > 0.0);
  CHECK(report.move.free_share < 1.0);
  CHECK(shop.off_mm(true) < testing::kExact_mm);
  if (warns) return;
  CHECK(report.move.verdict == dowel::Verdict::Contact);
  // Something of the rocker is at the block.
  const auto touch = report.move.touches;
  CHECK(std::ranges::any_of(touch, [](const dowel::Touch& t) { return t.with == "BLOCK"; }));
  CHECK(shop.turn("CRANK", -0.5, DragMode::Block).move.refused);
  CHECK_FALSE(shop.turn("CRANK", 0.3, DragMode::Block).move.refused);
}
