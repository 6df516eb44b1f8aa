#include "dowel/assembly/fit.h"

#include <array>
#include <string>

#include <catch2/catch.hpp>

using dowel::deviations;
using dowel::fit_as_drawn;
using dowel::fit_from;
using dowel::tolerance_class_from;

namespace {

struct FitRow {
  double nominal_mm;
  const char* text;
  double least_um;
  double most_um;
  const char* kind;
};

/// From published tables.
constexpr FitRow kFits[] = {
    {6, "H7/g6", 4, 24, "clearance"},       {6, "H7/h6", 0, 20, "clearance"},
    {6, "F7/h6", 10, 30, "clearance"},      {6, "F7/g6", 14, 34, "clearance"},
    {6, "H7/m6", -12, 8, "transition"},     {6, "H7/n6", -16, 4, "transition"},
    {6, "H7/p6", -20, 0, "interference"},   {6, "H6/h6", 0, 16, "clearance"},
    {8, "H7/g6", 5, 29, "clearance"},       {8, "H7/h6", 0, 24, "clearance"},
    {8, "F7/h6", 13, 37, "clearance"},      {8, "F7/g6", 18, 42, "clearance"},
    {8, "H7/m6", -15, 9, "transition"},     {8, "H7/n6", -19, 5, "transition"},
    {8, "H7/p6", -24, 0, "interference"},   {8, "H6/h6", 0, 18, "clearance"},
    {10, "H7/g6", 5, 29, "clearance"},      {10, "H7/h6", 0, 24, "clearance"},
    {10, "F7/h6", 13, 37, "clearance"},     {10, "F7/g6", 18, 42, "clearance"},
    {10, "H7/m6", -15, 9, "transition"},    {10, "H7/n6", -19, 5, "transition"},
    {10, "H7/p6", -24, 0, "interference"},  {10, "H6/h6", 0, 18, "clearance"},
    {12, "H7/g6", 6, 35, "clearance"},      {12, "H7/h6", 0, 29, "clearance"},
    {12, "F7/h6", 16, 45, "clearance"},     {12, "F7/g6", 22, 51, "clearance"},
    {12, "H7/m6", -18, 11, "transition"},   {12, "H7/n6", -23, 6, "transition"},
    {12, "H7/p6", -29, 0, "interference"},  {12, "H6/h6", 0, 22, "clearance"},
    {16, "H7/g6", 6, 35, "clearance"},      {16, "H7/h6", 0, 29, "clearance"},
    {16, "F7/h6", 16, 45, "clearance"},     {16, "F7/g6", 22, 51, "clearance"},
    {16, "H7/m6", -18, 11, "transition"},   {16, "H7/n6", -23, 6, "transition"},
    {16, "H7/p6", -29, 0, "interference"},  {16, "H6/h6", 0, 22, "clearance"},
    {20, "H7/g6", 7, 41, "clearance"},      {20, "H7/h6", 0, 34, "clearance"},
    {20, "F7/h6", 20, 54, "clearance"},     {20, "F7/g6", 27, 61, "clearance"},
    {20, "H7/m6", -21, 13, "transition"},   {20, "H7/n6", -28, 6, "transition"},
    {20, "H7/p6", -35, -1, "interference"}, {20, "H6/h6", 0, 26, "clearance"},
    {25, "H7/g6", 7, 41, "clearance"},      {25, "H7/h6", 0, 34, "clearance"},
    {25, "F7/h6", 20, 54, "clearance"},     {25, "F7/g6", 27, 61, "clearance"},
    {25, "H7/m6", -21, 13, "transition"},   {25, "H7/n6", -28, 6, "transition"},
    {25, "H7/p6", -35, -1, "interference"}, {25, "H6/h6", 0, 26, "clearance"},
};

struct LimitsRow {
  double nominal_mm;
  const char* text;
  double lower_um;
  double upper_um;
};

/// Limits by range of sizes, each at both ends of its range.
constexpr LimitsRow kLimits[] = {
    {3.1, "H6", 0, 8},    {6, "H8", 0, 18},     {6, "F7", 10, 22},   {6, "g6", -12, -4},
    {6, "m6", 4, 12},     {6, "n6", 8, 16},     {6, "p6", 12, 20},   {6.1, "g6", -14, -5},
    {10, "g6", -14, -5},  {10, "F7", 13, 28},   {10, "h6", -9, 0},   {10, "p6", 15, 24},
    {10.1, "H7", 0, 18},  {18, "g6", -17, -6},  {18, "F7", 16, 34},  {18, "n6", 12, 23},
    {18.1, "p6", 22, 35}, {30, "H8", 0, 33},    {30, "F7", 20, 41},  {30, "m6", 8, 21},
    {30.1, "H7", 0, 25},  {50, "F7", 25, 50},   {50, "g6", -25, -9}, {50, "h6", -16, 0},
    {50, "m6", 9, 25},    {50, "n6", 17, 33},   {50, "p6", 26, 42},  {12, "k6", 1, 12},
    {80, "H7", 0, 30},    {80, "g6", -29, -10}, {80, "p6", 32, 51},  {12, "h11", -110, 0}};

}  // namespace

TEST_CASE("limits of tolerance classes are those of published tables") {
  for (const LimitsRow& row : kLimits) {
    CAPTURE(row.nominal_mm, row.text);
    const auto tolerance = tolerance_class_from(row.text);
    REQUIRE(tolerance);
    CHECK(tolerance->text() == row.text);
    CHECK(deviations(row.nominal_mm, *tolerance).lower_um == row.lower_um);
    CHECK(deviations(row.nominal_mm, *tolerance).upper_um == row.upper_um);
  }
}

TEST_CASE("clearances of fits are those of published tables") {
  for (const FitRow& row : kFits) {
    CAPTURE(row.nominal_mm, row.text);
    const auto fit = fit_from(row.nominal_mm, row.text);
    REQUIRE(fit);
    CHECK(fit->least_clearance_um() == row.least_um);
    CHECK(fit->most_clearance_um() == row.most_um);
    CHECK(fit->kind() == row.kind);
  }
}

TEST_CASE("what is no class, no fit or no size is told apart") {
  for (const char* text : {"", "H", "7", "H4", "H12", "H7x", "Q7", "h-6", "p"}) {
    CAPTURE(text);
    CHECK_FALSE(tolerance_class_from(text));
  }
  for (const char* text : {"H7", "H7/", "/g6", "g6/H7", "H7/H7", "H7/g6/x"}) {
    CAPTURE(text);
    CHECK_FALSE(fit_from(12, text));
  }
  CHECK_FALSE(fit_from(3, "H7/g6"));
  CHECK_FALSE(fit_from(80.1, "H7/g6"));
}

TEST_CASE(
    "drawn diameters tell their fit: the hole nominal, the shaft in the middle of its class") {
  CHECK(fit_as_drawn(12, 11.9885).value().text() == "12 H7/g6");
  CHECK(fit_as_drawn(12, 11.9945).value().text() == "12 H7/h6");
  CHECK(fit_as_drawn(12, 12.0235).value().text() == "12 H7/p6");
  CHECK(fit_as_drawn(6, 5.992).value().text() == "6 H7/g6");
  CHECK_FALSE(fit_as_drawn(12, 12));      // size on size
  CHECK_FALSE(fit_as_drawn(13.5, 12));    // a clearance hole
  CHECK_FALSE(fit_as_drawn(10.106, 12));  // a core hole
}
