#include "fact_function.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "dowel/assembly/fit.h"
#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"
#include "fact_source.h"
#include "fixture_result.h"

namespace dowel {
namespace {

using Arguments = std::span<const FactValue>;

const std::string& text(const FactValue& value, const char* expected) {
  const auto* const found = std::get_if<std::string>(&value);
  if (found == nullptr) {
    throw Error(ErrorCode::InvalidInput, std::string("a function expected ") + expected);
  }
  return *found;
}

const Instance& instance(FactSource& source, const FactValue& value) {
  const std::string& name = text(value, "the name of an instance");
  const Instance* const found = source.state().find(name);
  if (found == nullptr) {
    throw Error(ErrorCode::InvalidInput, "there is no instance \"" + name + "\"");
  }
  return *found;
}

bool is_null(Arguments arguments) {
  return std::ranges::any_of(arguments, [](const FactValue& value) {
    return std::holds_alternative<std::monostate>(value);
  });
}

FactValue gap(FactSource& source, Arguments arguments) {
  if (is_null(arguments)) return {};
  const std::string& a = instance(source, arguments[0]).name;
  const std::string& b = instance(source, arguments[1]).name;
  if (a == b) return 0.0;
  const PairVerdict pair = source.pair(a, b, kMaxTolerance_mm);
  return pair.verdict == Verdict::Clear ? FactValue() : FactValue(pair.gap_mm);
}

FactValue depth(FactSource& source, Arguments arguments) {
  if (is_null(arguments)) return {};
  const std::string& a = instance(source, arguments[0]).name;
  const std::string& b = instance(source, arguments[1]).name;
  if (a == b) return {};
  return source.pair(a, b, source.state().tolerance_mm).depth_mm;
}

std::optional<Fit> fit_of(Arguments arguments) {
  double nominal_mm = 0.0;
  if (const auto* const real = std::get_if<double>(arguments.data())) nominal_mm = *real;
  if (const auto* const whole = std::get_if<std::int64_t>(arguments.data())) {
    nominal_mm = static_cast<double>(*whole);
  }
  if (is_null(arguments) || !is_nominal_size(nominal_mm)) return std::nullopt;
  const auto hole = tolerance_class_from(text(arguments[1], "the class of a hole, as 'H7'"));
  const auto shaft = tolerance_class_from(text(arguments[2], "the class of a shaft, as 'g6'"));
  if (!hole || !shaft || !hole->is_hole() || shaft->is_hole()) return std::nullopt;
  return Fit{nominal_mm, *hole, *shaft};
}

FactValue fit_min(FactSource&, Arguments arguments) {
  const auto fit = fit_of(arguments);
  return fit ? FactValue(fit->least_clearance_um()) : FactValue();
}

FactValue fit_max(FactSource&, Arguments arguments) {
  const auto fit = fit_of(arguments);
  return fit ? FactValue(fit->most_clearance_um()) : FactValue();
}

FactValue engagement(FactSource& source, Arguments arguments) {
  if (is_null(arguments)) return {};
  const std::string& screw = instance(source, arguments[0]).name;
  const std::string& part = instance(source, arguments[1]).name;
  double most_mm = 0.0;
  for (const AxisPair& pair : source.axes()) {
    if (pair.shaft_instance == screw && pair.hole_instance == part && pair.is_thread) {
      most_mm = std::max(most_mm, pair.engagement_mm);
    }
  }
  return most_mm;
}

const FixtureModel* fixture_of(FactSource& source, const FactValue& value) {
  const std::string& name = instance(source, value).name;
  const auto& fixtures = source.fixtures();
  const auto found = std::ranges::find(fixtures, name, &FixtureModel::workpiece);
  return found == fixtures.end() ? nullptr : &*found;
}

FactValue rank(FactSource& source, Arguments arguments) {
  if (is_null(arguments)) return {};
  const FixtureModel* const model = fixture_of(source, arguments[0]);
  if (model == nullptr) return {};
  return std::int64_t{analyse_locating(model->locators, model->frame).rank};
}

FactValue condition(FactSource& source, Arguments arguments) {
  if (is_null(arguments)) return {};
  const FixtureModel* const model = fixture_of(source, arguments[0]);
  if (model == nullptr) return {};
  const double value = analyse_locating(model->locators, model->frame).condition;
  return std::isfinite(value) ? FactValue(value) : FactValue();
}

FactValue seating(FactSource& source, Arguments arguments) {
  if (is_null(arguments)) return {};
  const FixtureModel* const model = fixture_of(source, arguments[0]);
  const std::string& locator = instance(source, arguments[1]).name;
  if (model == nullptr) return {};
  const auto found = seating_of(*model, source.state().design);
  std::optional<double> least_N;
  for (std::size_t i = 0; found && i < model->locators.size(); ++i) {
    if (model->locators[i].name != locator) continue;
    least_N = std::min(least_N.value_or(found->forces_N[i]), found->forces_N[i]);
  }
  return least_N ? FactValue(*least_N) : FactValue();
}

FactValue access(FactSource& source, Arguments arguments) {
  if (is_null(arguments)) return {};
  const std::string& name = instance(source, arguments[0]).name;
  const auto& wrenches = source.wrenches();
  const auto found = std::ranges::find(wrenches, name, &WrenchAccess::fastener);
  if (found == wrenches.end()) return {};
  return found->swing_rad * 180.0 / std::numbers::pi;
}

constexpr unsigned kFromFixture = FromParts | FromDesign | FromTolerance;

}  // namespace

const std::vector<FactFunction>& fact_functions() {
  static const std::vector<FactFunction> kFunctions{
      {"access", "fastener", 1,
       "angle in degrees through which a wrench turns the screw or nut freely; 0 where none gets "
       "onto it, NULL where it has no hexagon",
       kFromFixture | FromMates, access},
      {"condition", "workpiece", 1,
       "condition number of its locators; NULL below rank 6 and for what is no workpiece",
       kFromFixture, condition},
      {"depth", "a, b", 2, "by how many mm two instances are in each other at least; 0: not",
       FromParts | FromTolerance, depth},
      {"engagement", "screw, part", 2, "mm of the screw's thread in the part's; 0: none", FromParts,
       engagement},
      {"fit_max", "nominal_mm, hole, shaft", 3,
       "most clearance in um of two ISO 286 classes, as fit_max(12, 'H7', 'g6'); NULL for what is "
       "no fit",
       0U, fit_max},
      {"fit_min", "nominal_mm, hole, shaft", 3, "least clearance in um; below 0: interference", 0U,
       fit_min},
      {"gap", "a, b", 2, "mm between two instances, to a micrometre; NULL beyond 10", FromParts,
       gap},
      {"rank", "workpiece", 1, "of its locator matrix: 6 settles it; NULL for what is no workpiece",
       kFromFixture, rank},
      {"seating", "workpiece, locator", 2,
       "least force in N on the locator under clamps and weight, without friction; NULL without "
       "clamp forces",
       kFromFixture, seating},
  };
  return kFunctions;
}

}  // namespace dowel
