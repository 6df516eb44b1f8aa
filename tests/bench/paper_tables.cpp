#include "paper_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "dowel/kernel/surface.h"
#include "plate_with_holes.h"

namespace dowel::bench {

namespace {

/// Three elements of the paper's kinds: a base plate, a block full of holes, and one that is round
/// outside. The first two have as many triangles in their holes as the paper's.
Table triangles_by_class() {
  Table table{"Triangles by class (the paper's Table 1)",
              "Most triangles belong to holes or lie beside them. The paper shows pictures of its "
              "elements, no names.",
              {"element", "triangles", "of planes", "of holes", "others"},
              {{"paper, first", "14604", "7692", "6912", "0"},
               {"paper, second", "1116", "558", "558", "0"},
               {"paper, third", "700", "257", "391", "52"}}};
  const std::array elements{
      drilled_plate("base plate, 144 holes", {480.0, 480.0, 40.0},
                    testing::hole_grid(12, 12, 40.0, 6.0), 24),
      drilled_plate("block, 9 holes", {80.0, 80.0, 40.0}, testing::hole_grid(3, 3, 25.0, 6.0), 31),
      tube("round washer", 6.5, 12.0, 2.5, 26)};
  for (const Element& element : elements) {
    std::size_t planes = 0;
    std::size_t holes = 0;
    const FacetedSolid& solid = *element.solid;
    for (const std::uint32_t face : solid.face_of) {
      if (std::ranges::count(element.hole_faces, face) > 0) {
        ++holes;
      } else if (is_plane(solid.faces[face].surface)) {
        ++planes;
      }
    }
    const std::size_t all = solid.triangles.size();
    table.rows.push_back({element.name, std::to_string(all), std::to_string(planes),
                          std::to_string(holes), std::to_string(all - planes - holes)});
  }
  return table;
}

/// What the paper's Table 2 says of one scenario.
struct Published {
  const char* scene;
  const char* collisions;
  const char* solid_tests[2];
  const char* rapid_tests[2];
  const char* own_tests[2];
};

constexpr std::array<Published, 4> kPublished{
    {{"a", "324", {"5273", "1271"}, {"4327", "1914"}, {"1282", "896"}},
     {"b", "89", {"115273", "40271"}, {"64327", "18314"}, {"1182", "1096"}},
     {"c", "845", {"107412", "33715"}, {"45513", "14348"}, {"1013", "6543"}},
     {"d", "not printed", {"67412", "13715"}, {"25513", "3348"}, {"113", "1543"}}}};

std::string per_thousand(std::uint64_t count, std::size_t poses) {
  return std::to_string(
      std::llround(1000.0 * static_cast<double>(count) / static_cast<double>(poses)));
}

std::vector<std::string> row_of(const Run& run) {
  std::size_t hits = 0;
  for (const Answer& answer : run.answers) hits += answer.hit ? 1U : 0U;
  const std::size_t poses = run.answers.size();
  return {"(" + run.scenario + ") " + run.method, per_thousand(hits, poses),
          run.counters ? per_thousand(run.counters->box_tests, poses) : "–",
          run.counters ? per_thousand(run.counters->triangle_tests, poses) : "–",
          text(run.batch_mean_us)};
}

Table colliding_moves(const Results& results) {
  Table table{"Colliding moves (the paper's Table 2)",
              "Per 1,000 moves of the motion \"insert\", and what the paper prints for its own, "
              "unpublished motions: collisions, N_b (box tests), N_p (triangle pairs) and mean "
              "microseconds. RAPID's method is FCL OBB here, SOLID's \"AABB tree\", written for "
              "this comparison, and ODE, which tells no counts. The paper defines N_p as \"number "
              "of actual colliding triangle pairs\" and discusses it as tests; ours are tests.",
              {"scene, method", "collisions", "N_b", "N_p", "time"},
              {}};
  for (const Published& paper : kPublished) {
    bool has_scene = false;
    for (const Run& run : results.runs) {
      if (run.scenario != paper.scene || run.kind != MotionKind::Insert) continue;
      if (!has_scene) {
        const std::string scene = std::string("(") + paper.scene + ") ";
        for (const auto& [name, tests] :
             {std::pair{"paper: SOLID", paper.solid_tests},
              std::pair{"paper: RAPID", paper.rapid_tests}, std::pair{"paper", paper.own_tests}}) {
          table.rows.push_back({scene + name, paper.collisions, tests[0], tests[1], "chart only"});
        }
      }
      has_scene = true;
      table.rows.push_back(row_of(run));
    }
  }
  return table;
}

}  // namespace

std::vector<Table> paper_tables(const Results& results) {
  if (results.runs.empty()) return {};
  std::vector<Table> tables{triangles_by_class()};
  Table moves = colliding_moves(results);
  if (!moves.rows.empty()) tables.push_back(std::move(moves));
  return tables;
}

}  // namespace dowel::bench
