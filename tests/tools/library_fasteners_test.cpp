#include <cmath>
#include <string>
#include <vector>

#include <BRepExtrema_DistShapeShape.hxx>
#include <TopLoc_Location.hxx>
#include <TopoDS_Shape.hxx>
#include <catch2/catch.hpp>
#include <gp_Trsf.hxx>
#include <gp_Vec.hxx>

#include "library/builders.h"
#include "library/solids.h"
#include "library/systems.h"
#include "volumes.h"

namespace dowel::library {
namespace {

const System& h40() {
  return system_called("H40-12");
}

double dimension(const Part& part, const std::string& name) {
  for (const Dimension& dimension : part.dimensions) {
    if (dimension.name == name) return dimension.value_mm;
  }
  FAIL("no dimension " << name << " in " << part.name);
  return 0.0;
}

TopoDS_Shape raised(const TopoDS_Shape& shape, double height_mm) {
  gp_Trsf shift;
  shift.SetTranslation(gp_Vec(0.0, 0.0, height_mm));
  return shape.Moved(TopLoc_Location(shift));
}

/// Of a ball between two planes, by the radii of the two circles.
double ball_zone(double radius_mm, double other_radius_mm, double height_mm) {
  return kPi * height_mm / 6.0 *
         (3.0 * radius_mm * radius_mm + 3.0 * other_radius_mm * other_radius_mm +
          height_mm * height_mm);
}

}  // namespace

TEST_CASE("volumes of spherical washers, seats and plugs are those of the formulas") {
  const double zone_mm = std::sqrt(17.0 * 17.0 - 6.5 * 6.5) - std::sqrt(17.0 * 17.0 - 12.0 * 12.0);
  const Part washer = spherical_washers(h40()).back();
  REQUIRE(washer.name == "H40-12/spherical-washer-M12");
  CHECK(volume_mm3(washer.solid) ==
        Approx(ball_zone(6.5, 12.0, zone_mm) + cylinder(24.0, 4.6 - zone_mm) - cylinder(13.0, 4.6))
            .epsilon(1e-9));
  const double cone_mm = 2.9 / std::sqrt(3.0);
  const double hole_mm3 = cone(20.0, 14.2, cone_mm) - cylinder(14.2, cone_mm);
  const std::vector<Part> seats = conical_seats(h40());
  REQUIRE(seats.at(3).name == "H40-12/conical-seat-M12");
  REQUIRE(seats.at(7).name == "H40-12/wide-conical-seat-M12");
  CHECK(volume_mm3(seats.at(3).solid) ==
        Approx(cylinder(24.0, 5.0) - cylinder(14.2, 5.0) - hole_mm3).epsilon(1e-9));
  CHECK(volume_mm3(seats.at(7).solid) ==
        Approx(cylinder(36.0, 6.0) - cylinder(14.2, 6.0) - hole_mm3).epsilon(1e-9));
  const Part plug = plug_screws(h40()).at(0);
  CHECK(volume_mm3(plug.solid) ==
        Approx(cylinder(11.9, 14.5) + cylinder(9.5, 2.0) + cylinder(12.0, 11.0) +
               cone(12.0, 10.0, 1.0) - 6.0 * hexagon_area(6.0))
            .epsilon(1e-9));
}

TEST_CASE("a spherical washer touches its seat at the height of the pair") {
  for (const char* const name : {"H40-12", "H50-16"}) {
    const System& system = system_called(name);
    const std::vector<Part> washers = spherical_washers(system);
    const std::vector<Part> seats = conical_seats(system);
    REQUIRE(seats.size() == 2 * washers.size());
    for (std::size_t i = 0; i < seats.size(); ++i) {
      const Part& washer = washers[i % washers.size()];
      const Part& seat = seats[i];
      CAPTURE(washer.name, seat.name);
      const double inner_mm = dimension(washer, "inner_diameter");
      const double radius_mm = dimension(washer, "ball_radius");
      const double mouth_mm = dimension(seat, "mouth_diameter");
      const double lift_mm = dimension(seat, "pair_height") - dimension(washer, "height");
      // The published overlap of a pair of DIN 6319 in closed form.
      const double overlap_mm = std::sqrt(3.0) / 6.0 * mouth_mm - 2.0 / std::sqrt(3.0) * radius_mm +
                                std::sqrt(4.0 * radius_mm * radius_mm - inner_mm * inner_mm) / 2.0;
      CHECK(lift_mm == Approx(dimension(seat, "height") - overlap_mm).margin(1e-9));
      // Raised by 0.1 mm, cone and ball are 0.1 cos(30 deg) apart.
      const BRepExtrema_DistShapeShape at(seat.solid, raised(washer.solid, lift_mm + 0.1));
      REQUIRE(at.IsDone());
      CHECK(at.Value() == Approx(0.1 * std::cos(kPi / 6.0)).margin(1e-6));
    }
  }
}

TEST_CASE("a collar nut is a high nut on a collar that covers its corners") {
  for (const System& system : systems()) {
    const std::vector<Part> parts = collar_nuts(system);
    CHECK(parts.size() == system.nut_threads.size());
    for (const Part& part : parts) {
      CAPTURE(part.name);
      const double width_mm = dimension(part, "width_across_flats");
      const double height_mm = dimension(part, "height");
      const double collar_mm3 =
          cylinder(dimension(part, "collar_diameter"), dimension(part, "collar_height"));
      const double above_mm = height_mm - dimension(part, "collar_height");
      const double bore_mm3 = cylinder(part.features.front().diameter_mm, height_mm);
      CHECK(dimension(part, "collar_diameter") > width_mm * 2.0 / std::sqrt(3.0));
      // The chamfer takes less than what stands out of the circle within the flats.
      CHECK(volume_mm3(part.solid) < collar_mm3 + hexagon_area(width_mm) * above_mm - bore_mm3);
      CHECK(volume_mm3(part.solid) >
            collar_mm3 + 0.97 * hexagon_area(width_mm) * above_mm - bore_mm3);
    }
  }
}

TEST_CASE("a plug screw ends at the end of the bore, below the plate's top, within the plate") {
  for (const System& system : systems()) {
    const std::vector<Part> parts = plug_screws(system);
    REQUIRE(parts.size() == (system.node ? 1U : 0U));
    if (!system.node) continue;
    const Part& plug = parts.front();
    CAPTURE(plug.name);
    CHECK(dimension(plug, "shank_diameter") < system.node->bore_mm);
    const double below_mm = system.node->bore_depth_mm - dimension(plug, "shank_length");
    CHECK(below_mm > 0.0);
    CHECK(below_mm < 1.0);
    // Screwed down to the bore's end it stays clear of a blind node's end.
    CHECK(dimension(plug, "length") + below_mm < system.node->thread_depth_mm);
  }
}

}  // namespace dowel::library
