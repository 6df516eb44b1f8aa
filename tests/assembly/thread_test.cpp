#include "dowel/assembly/thread.h"

#include <catch2/catch.hpp>

#include "fixture_elements.h"

using dowel::AxisFit;
using dowel::Feature;
using dowel::Pose;
namespace testing = dowel::testing;

namespace {

Feature hole(const std::vector<std::pair<double, double>>& steps) {
  return testing::hole_feature("h1", {0, 0, 0}, -Eigen::Vector3d::UnitZ(), steps, true);
}

Feature shaft(double diameter_mm, double length_mm) {
  return testing::shaft_feature("pin1", {0, 0, 0}, -Eigen::Vector3d::UnitZ(), diameter_mm,
                                length_mm);
}

}  // namespace

TEST_CASE("minor diameters are those of ISO 965-1, to a micrometre") {
  // D1 = d - 1.0825 P by the standard's table.
  const std::vector<std::pair<double, double>> table{
      {3, 2.459},  {4, 3.242},   {5, 4.134},   {6, 4.917},   {8, 6.647},
      {10, 8.376}, {12, 10.106}, {16, 13.835}, {20, 17.294}, {24, 20.752}};
  for (const auto& [nominal_mm, minor_mm] : table) {
    CAPTURE(nominal_mm);
    const dowel::MetricThread* thread = dowel::thread_of_shaft(nominal_mm);
    REQUIRE(thread != nullptr);
    CHECK(thread->minor_mm() == Approx(minor_mm).margin(1e-3));
    CHECK(thread->tap_drill_mm > thread->minor_mm() - 0.02);
  }
}

TEST_CASE("a thread needs a core hole between the minor diameter and the tap drill") {
  CHECK(dowel::forms_thread(12.0, 10.106));
  CHECK(dowel::forms_thread(12.0, 10.2));
  CHECK_FALSE(dowel::forms_thread(12.0, 12.0));
  CHECK_FALSE(dowel::forms_thread(12.0, 10.3));
  CHECK_FALSE(dowel::forms_thread(12.0, 10.0));
  CHECK_FALSE(dowel::forms_thread(12.0, 8.376));
  CHECK_FALSE(dowel::forms_thread(11.9885, 10.106));  // a ground pin, 12 g6
  CHECK_FALSE(dowel::forms_thread(7.0, 6.0));
}

TEST_CASE("no core hole serves two threads") {
  for (const dowel::MetricThread& thread : dowel::metric_threads()) {
    for (const dowel::MetricThread& other : dowel::metric_threads()) {
      CAPTURE(thread.nominal_mm, other.nominal_mm);
      const bool same = thread.nominal_mm == other.nominal_mm;
      CHECK(dowel::forms_thread(thread.nominal_mm, other.minor_mm()) == same);
      CHECK(dowel::forms_thread(thread.nominal_mm, other.tap_drill_mm) == same);
    }
  }
}

TEST_CASE("a shaft is measured against the stretches of the bore that it is in") {
  const Feature bore = hole({{12.0, 15.0}, {10.106, 25.0}});
  const Pose here;
  // A shank that ends on the step is not in the thread below.
  CHECK(dowel::fit_on_axis(shaft(12.0, 15.0), here, bore, here).obstacle == nullptr);
  CHECK_FALSE(dowel::fit_on_axis(shaft(12.0, 15.0), here, bore, here).thread);
  // A screw reaches the thread.
  CHECK(dowel::fit_on_axis(shaft(12.0, 30.0), here, bore, here).thread);
  // A pin that is no screw does not fit below the step.
  const AxisFit pin = dowel::fit_on_axis(shaft(11.98, 16.0), here, bore, here);
  REQUIRE(pin.obstacle != nullptr);
  CHECK(pin.obstacle->diameter_mm == 10.106);
  CHECK(pin.obstacle->from_mm == 15.0);
  // A micrometre more than the bore is nominal, two are not.
  CHECK(dowel::fit_on_axis(shaft(12.0009, 10.0), here, bore, here).obstacle == nullptr);
  CHECK(dowel::fit_on_axis(shaft(12.002, 10.0), here, bore, here).obstacle != nullptr);
  // Lifted off, it is still too thick for the opening.
  const Pose above = Pose::from_translation({0, 0, 100});
  CHECK(dowel::fit_on_axis(shaft(20.0, 50.0), above, bore, here).obstacle == &bore.segments[0]);
  CHECK(dowel::fit_on_axis(shaft(11.0, 50.0), above, bore, here).obstacle == nullptr);
}

TEST_CASE("a screw on the axis of a tapped hole is relieved over the whole thread") {
  const dowel::Element plate = testing::plate_element().element;
  const dowel::Element screw = testing::screw_element().element;
  CHECK(dowel::may_form_thread(plate, screw));
  CHECK_FALSE(dowel::may_form_thread(screw, plate));
  CHECK_FALSE(dowel::may_form_thread(plate, testing::pin_element().element));

  const Pose X_WP(Eigen::Quaterniond(Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized())),
                  {500, -200, 90});
  // Shoulder of the screw 20 mm over hole B4 (x = 40, y = 0).
  const Pose X_PS = Pose::from_translation({40, 0, 60 - 65});
  const auto reliefs = dowel::thread_reliefs(plate, X_WP, screw, X_WP * X_PS);
  REQUIRE(reliefs.size() == 1);
  CHECK(reliefs[0].start.isApprox(Eigen::Vector3d(40, 0, 25)));
  CHECK(reliefs[0].direction.isApprox(Eigen::Vector3d(0, 0, -1)));
  CHECK(reliefs[0].length_mm == 25.0);
  CHECK(reliefs[0].radius_mm == 6.0);

  const Pose beside = Pose::from_translation({40.03, 0, -5});
  CHECK(dowel::thread_reliefs(plate, X_WP, screw, X_WP * beside).empty());
  const Pose tilted = Pose::about_axis({40, 0, 12.5}, Eigen::Vector3d::UnitX(), 0.001) * X_PS;
  CHECK(dowel::thread_reliefs(plate, X_WP, screw, X_WP * tilted).empty());
  const Pose nearly = Pose::from_translation({40.01, 0.01, -5});
  CHECK(dowel::thread_reliefs(plate, X_WP, screw, X_WP * nearly).size() == 1);
}

TEST_CASE("chamfers at the mouths of a core hole belong to the thread") {
  dowel::Element plate;
  Feature bore = hole({{10.2, 20.0}});
  bore.segments = {{dowel::HoleSegment::Type::Cone, 12.4, 10.2, 0.0, 1.1},
                   {dowel::HoleSegment::Type::Cylinder, 10.2, 10.2, 1.1, 18.9},
                   {dowel::HoleSegment::Type::Cone, 10.2, 12.4, 18.9, 20.0}};
  plate.features = {bore};
  const auto reliefs =
      dowel::thread_reliefs(plate, Pose(), testing::screw_element().element, Pose());
  REQUIRE(reliefs.size() == 1);
  CHECK(reliefs[0].start.z() == 0.0);
  CHECK(reliefs[0].length_mm == 20.0);
  // A drill point narrows with depth: no screw goes there.
  plate.features[0].segments[2] = {dowel::HoleSegment::Type::Cone, 10.2, 0.0, 18.9, 22.0};
  const auto blind = dowel::thread_reliefs(plate, Pose(), testing::screw_element().element, Pose());
  REQUIRE(blind.size() == 1);
  CHECK(blind[0].length_mm == 18.9);
}
