#include "mate_condition.h"

#include <algorithm>
#include <array>
#include <set>
#include <string>

#include "near_singular.h"

namespace dowel::bench {

namespace {

using testing::HolesOutcome;

/// `count` outcomes from random places, as a row. `lever`: by how much of `arm` the last mate tells
/// the turn; 0: by nothing.
std::vector<std::string> row(const std::string& what, const std::vector<Pose>& holes, double lever,
                             double arm, std::size_t count) {
  testing::RandomGeometry random(94);
  std::set<std::string> verdicts;
  double off_mm = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    const HolesOutcome outcome = outcome_of(testing::HolesOnHoles(holes, random));
    verdicts.emplace(testing::name_of(outcome.last));
    const double turn_mm = outcome.is_held ? kMateArm_mm * outcome.turn_off_rad : 0.0;
    off_mm = std::max(off_mm, outcome.slide_off_mm + turn_mm);
  }
  std::string said;
  for (const std::string& verdict : verdicts) said += (said.empty() ? "" : ", ") + verdict;
  return {what, lever > 0.0 ? text(lever) : "", lever > 0.0 ? text(std::max(1.0, arm / lever)) : "",
          said, text(off_mm)};
}

}  // namespace

Table mate_conditions(const Plan& plan) {
  Table table{
      "Nearly singular mates",
      "A part is put with its holes on those of another one, from random places, 0.2 mm and 0.01 "
      "rad off. Condition: 100 mm over the lever by which the last hole tells the turn, or 1 over "
      "the angle between two axes through one point. The solver's verdict on the last hole, and "
      "how far points 100 mm away are from where they belong; where the verdict is that the turn "
      "is not told (redundant beside one hole, nearly redundant), the first hole.",
      {"holes", "lever, mm or rad", "condition", "last mate", "largest error, mm"},
      {}};
  const std::size_t count = std::max<std::size_t>(plan.poses / 20, 10);
  constexpr std::array kLevers{100.0, 1.0, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-9, 1e-12};
  for (const double apart_mm : kLevers) {
    table.rows.push_back(
        row("two, apart", testing::holes_apart(apart_mm), apart_mm, kMateArm_mm, count));
  }
  for (const double tilt_rad : kLevers) {
    if (tilt_rad > 0.5) continue;
    table.rows.push_back(
        row("two, axes askew", testing::axes_askew(tilt_rad), tilt_rad, 1.0, count));
  }
  table.rows.push_back(row("three in line", testing::holes_in_line(), 0.0, 1.0, count));
  table.rows.push_back(row("two, each mated twice", testing::holes_again(), 0.0, 1.0, count));
  return table;
}

}  // namespace dowel::bench
