#include "dowel/assembly/stack.h"

#include <algorithm>
#include <array>
#include <set>

#include <catch2/catch.hpp>

#include "fixture_elements.h"
#include "random_geometry.h"

using dowel::Spacer;
using dowel::stack_choices;
namespace testing = dowel::testing;

namespace {

std::vector<Spacer> spacers_of(const std::vector<int>& heights_mm) {
  std::vector<Spacer> spacers;
  for (const int height_mm : heights_mm) {
    spacers.push_back(
        {"spacer-" + std::to_string(height_mm), static_cast<double>(height_mm), "h1"});
  }
  return spacers;
}

double height_of(const std::vector<Spacer>& pile) {
  double height_mm = 0.0;
  for (const Spacer& spacer : pile) height_mm += spacer.height_mm;
  return height_mm;
}

/// Fewest pieces for each height up to `most`, by building up from below; 0 where there is no way.
std::vector<std::size_t> fewest_pieces(const std::vector<int>& heights_mm, std::size_t most) {
  std::vector<std::size_t> fewest(most + 1, 0);
  for (std::size_t height = 1; height <= most; ++height) {
    for (const int piece_mm : heights_mm) {
      const auto piece = static_cast<std::size_t>(piece_mm);
      if (piece > height) continue;
      const std::size_t rest = height - piece;
      if (rest != 0 && fewest[rest] == 0) continue;
      const std::size_t pieces = 1 + (rest == 0 ? 0 : fewest[rest]);
      if (fewest[height] == 0 || pieces < fewest[height]) fewest[height] = pieces;
    }
  }
  return fewest;
}

}  // namespace

TEST_CASE("a stack takes the fewest pieces, as building up from below finds them", "[property]") {
  const unsigned seed = GENERATE(range(0U, 20U));
  CAPTURE(seed);
  testing::RandomGeometry random(seed);
  std::vector<int> heights_mm{5, 10, 15, 20, 25, 30, 40, 50, 60, 80, 100};
  if (seed > 0) {
    heights_mm.clear();
    for (int i = 0; i < 6; ++i) heights_mm.push_back(static_cast<int>(3 + random.index(60)));
    std::ranges::sort(heights_mm);
    heights_mm.erase(std::unique(heights_mm.begin(), heights_mm.end()), heights_mm.end());
  }
  const auto spacers = spacers_of(heights_mm);
  const auto fewest = fewest_pieces(heights_mm, 240);
  int reached = 0;
  for (std::size_t height = 1; height <= 240; ++height) {
    CAPTURE(height);
    const auto choices = stack_choices(spacers, static_cast<double>(height), 3);
    const bool can = fewest[height] != 0 && fewest[height] <= dowel::kMostStacked;
    REQUIRE(choices.empty() == !can);
    if (!can) continue;
    ++reached;
    CHECK(choices[0].size() == fewest[height]);
    for (std::size_t i = 0; i < choices.size(); ++i) {
      CHECK(height_of(choices[i]) == Approx(static_cast<double>(height)).margin(1e-9));
      if (i > 0) CHECK(choices[i].size() >= choices[i - 1].size());
      CHECK(std::ranges::is_sorted(choices[i], std::ranges::greater{}, &Spacer::height_mm));
    }
  }
  CHECK(reached > 40);
}

TEST_CASE("all ways of stacking are different, in a fixed order") {
  const auto choices = stack_choices(spacers_of({10, 20, 30, 40}), 60, 100);
  std::set<std::vector<double>> known;
  for (const auto& pile : choices) {
    std::vector<double> heights_mm;
    for (const Spacer& spacer : pile) heights_mm.push_back(spacer.height_mm);
    CHECK(known.insert(heights_mm).second);
  }
  // 40+20, 30+30; 40+10+10, 30+20+10, 20+20+20; 30+10*3, 20+20+10+10; 20+10*4; 10*6.
  CHECK(choices.size() == 9);
  CHECK(choices[0][0].height_mm == 40);
  CHECK(choices[1][0].height_mm == 30);
  CHECK(stack_choices({}, 60, 3).empty());
  CHECK(stack_choices(spacers_of({7}), 60, 3).empty());
  CHECK(stack_choices(spacers_of({7}), -7, 3).empty());
}

TEST_CASE("a spacer is told by its faces and its one hole") {
  const auto riser = spacer_of(testing::riser_element().element);
  REQUIRE(riser);
  CHECK(riser->height_mm == 40.0);
  CHECK(riser->hole == "h1");
  CHECK_FALSE(spacer_of(testing::plate_element().element));
  CHECK_FALSE(spacer_of(testing::pin_element().element));
  CHECK_FALSE(spacer_of(testing::block_element().element));
}
