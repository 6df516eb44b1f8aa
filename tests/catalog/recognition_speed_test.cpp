// How long recognition takes; hidden, for it is a measurement and no test. Run by tag:
// dowel_catalog_tests "[benchmark]"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/catalog/recognition.h"
#include "solids.h"

using namespace dowel;

namespace {

/// Processor time of the fastest of `rounds`, in ms.
template <class Body>
double fastest_ms(int rounds, const Body& body) {
  double fastest = 1.0e9;
  for (int i = 0; i < rounds; ++i) {
    const std::clock_t start = std::clock();
    body();
    fastest =
        std::min(fastest, 1000.0 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return fastest;
}

}  // namespace

TEST_CASE("time to recognise plates of holes", "[.benchmark]") {
  struct Case {
    std::uint32_t columns, rows;
    int rounds;
  };
  for (const Case& c : {Case{15, 10, 20}, Case{50, 50, 3}, Case{100, 100, 1}}) {
    const FacetedSolid plate =
        testing::plate_with_holes({40.0 * c.columns + 40.0, 40.0 * c.rows + 40.0, 40.0},
                                  testing::hole_grid(c.columns, c.rows, 40.0, 6.0), 16);
    std::vector<Feature> features;
    const double features_ms = fastest_ms(c.rounds, [&] { features = recognise_features(plate); });
    const double circles_ms = fastest_ms(c.rounds, [&] { find_bolt_circles(features); });
    const double shape_ms = fastest_ms(c.rounds, [&] { classify_shape(plate, features); });
    const double box_ms = fastest_ms(c.rounds, [&] { enclosing_box(plate); });
    std::printf(
        "%6u holes, %7zu faces, %8zu facets: features %.2f ms, circles %.2f ms, shape %.2f ms, "
        "box %.2f ms\n",
        c.columns * c.rows, plate.faces.size(), plate.triangles.size(), features_ms, circles_ms,
        shape_ms, box_ms);
    CHECK(features.size() == static_cast<std::size_t>(c.columns * c.rows) + 6);
  }
}
