// Keys and the slots they go into, as a catalogue has them.

#include <cmath>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "dowel/assembly/fit.h"
#include "dowel/catalog/catalog.h"
#include "dowel/io/catalog_build.h"
#include "library/builders.h"
#include "library/systems.h"
#include "library/write_library.h"
#include "program.h"

namespace {

using namespace dowel;

/// Width across the two opposite faces of a fit that are called `use` and stand `back` and `front`;
/// nothing where they are missing or not opposite.
std::optional<double> width_mm(const Element& element, const std::string& use) {
  const Feature* back = nullptr;
  const Feature* front = nullptr;
  for (const Feature& feature : element.features) {
    if (feature.kind != FeatureKind::Face || feature.fit != "h6") continue;
    if (feature.use == use + "-back") back = &feature;
    if (feature.use == use + "-front") front = &feature;
  }
  if (back == nullptr || front == nullptr) return std::nullopt;
  if ((back->direction + front->direction).norm() > 1e-9) return std::nullopt;
  return back->direction.dot(back->origin - front->origin);
}

const Feature& slot_for(const Element& element, const std::string& use) {
  for (const Feature& feature : element.features) {
    if (feature.kind == FeatureKind::Slot && feature.use == use) return feature;
  }
  throw std::runtime_error(element.name + " has no slot called " + use);
}

/// The clearance of a key in a slot is what ISO 286 gives for the classes of both.
void check_fit(double key_mm, const Feature& slot, double least_um, double most_um) {
  CHECK(key_mm == Approx(slot.diameter_mm).margin(1e-9));
  const auto fit = fit_from(slot.diameter_mm, slot.fit + "/h6");
  REQUIRE(fit);
  CHECK(fit->least_clearance_um() == Approx(least_um).margin(0.5));
  CHECK(fit->most_clearance_um() == Approx(most_um));
}

}  // namespace

TEST_CASE("keys are h6 across their flanks, as wide as the slots that they fit") {
  const testing::TemporaryFolder folder;
  std::vector<library::Part> parts;
  for (const char* name : {"T14", "U12"}) {
    const library::System& system = library::system_called(name);
    for (const auto& make : {library::keys, library::base_plates, library::edge_locators}) {
      parts.push_back(make(system).front());
    }
  }
  library::write_library(folder / "out", parts);
  const std::vector<std::filesystem::path> paths{folder / "out"};
  build_catalog(paths, folder / "c.db", {});
  const Catalog catalog(folder / "c.db", Catalog::Access::ReadOnly);
  const auto element = [&](std::size_t i) { return catalog.find(parts[i].name).value(); };

  const std::optional<double> t14_mm = width_mm(element(0), "slot");
  REQUIRE(t14_mm);
  CHECK(*t14_mm == Approx(14.0).margin(1e-9));
  check_fit(*t14_mm, slot_for(element(1), "slot"), 0.0, 38.0);  // H8/h6: +27 and +11
  check_fit(*t14_mm, slot_for(element(2), "key"), 0.0, 29.0);   // H7/h6: +18 and +11

  const std::optional<double> lower_mm = width_mm(element(3), "slot");
  const std::optional<double> upper_mm = width_mm(element(3), "key-slot");
  REQUIRE(lower_mm);
  REQUIRE(upper_mm);
  CHECK(*lower_mm == Approx(12.0).margin(1e-9));
  CHECK(*upper_mm == Approx(18.0).margin(1e-9));
  CHECK(slot_for(element(4), "slot").diameter_mm == Approx(*lower_mm).margin(1e-9));
  check_fit(*upper_mm, slot_for(element(5), "key"), 0.0, 29.0);
}
