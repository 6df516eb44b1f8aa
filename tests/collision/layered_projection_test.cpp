#include "dowel/collision/layered_projection.h"

#include <limits>

#include <catch2/catch.hpp>

#include "random_geometry.h"

using dowel::Aabb;
using dowel::LayeredProjection;

namespace {

Aabb box_at(const Eigen::Vector3d& corner, const Eigen::Vector3d& size) {
  return {corner, corner + size};
}

/// Rows of parts on a plate, in storeys: what the model is made for.
std::vector<Aabb> fixture(dowel::testing::RandomGeometry& random, int count) {
  std::vector<Aabb> boxes{box_at({-2000, -2000, -40}, {4000, 4000, 40})};
  while (static_cast<int>(boxes.size()) < count) {
    const double storey = 40.0 * random.index(4);
    const Eigen::Vector3d corner(40.0 * random.index(100) - 2000, 40.0 * random.index(100) - 2000,
                                 storey);
    boxes.push_back(box_at(corner, {random.uniform(5, 80), random.uniform(5, 80), 40.0}));
  }
  return boxes;
}

}  // namespace

TEST_CASE("an empty model finds nothing") {
  LayeredProjection model;
  std::vector<std::uint32_t> found{1, 2};
  model.query(box_at({0, 0, 0}, {1, 1, 1}), found);
  CHECK(found.empty());
}

TEST_CASE("boxes that only touch on a separation plane are found") {
  LayeredProjection model;
  for (std::uint32_t i = 0; i < 40; ++i) model.insert(i, box_at({0, 0, 10.0 * i}, {10, 10, 10}));
  CHECK(model.layer_count() > 1);
  std::vector<std::uint32_t> found;
  model.query(box_at({0, 0, 200}, {10, 10, 10}), found);
  CHECK(found == std::vector<std::uint32_t>{19, 20, 21});
}

TEST_CASE("the model finds exactly the boxes that brute force finds, as boxes come and go",
          "[property]") {
  const auto seed = static_cast<std::uint64_t>(GENERATE(range(0, 8)));
  CAPTURE(seed);
  dowel::testing::RandomGeometry random(seed);
  const std::vector<Aabb> boxes = fixture(random, 600);
  LayeredProjection model;
  std::vector<bool> present(boxes.size(), false);
  std::vector<std::uint32_t> fast;
  std::vector<std::uint32_t> slow;
  std::size_t hits = 0;
  int queries = 0;
  for (int step = 0; step < 13'000; ++step) {
    const std::uint32_t id = random.index(static_cast<std::uint32_t>(boxes.size()));
    const bool fill = step < 3'000;
    if (!present[id] && (fill || random.coin())) {
      model.insert(id, boxes[id]);
      present[id] = true;
    } else if (present[id] && !fill) {
      model.remove(id);
      present[id] = false;
    }
    // Every other one ends where boxes do, at cuts among other places.
    const bool is_flush = step % 2 == 0;
    const auto whole = [](const Eigen::Vector3d& p) {
      return Eigen::Vector3d(40.0 * (p / 40.0).array().round());
    };
    const Eigen::Vector3d corner = random.point(2100);
    const Eigen::Vector3d size(random.uniform(0, 900), random.uniform(0, 900), 30);
    Aabb query = is_flush ? box_at(whole(corner), whole(size)) : box_at(corner, size);
    // By layer, by column or by interval.
    for (int axis = 0; axis < 3; ++axis) {
      if (random.index(8) != 0) continue;
      query.min[axis] = -std::numeric_limits<double>::infinity();
      query.max[axis] = std::numeric_limits<double>::infinity();
    }
    model.query(query, fast);
    model.query_brute_force(query, slow);
    REQUIRE(fast == slow);
    hits += fast.size();
    ++queries;
  }
  CHECK(hits > static_cast<std::size_t>(queries / 20));  // the queries meet something
  CHECK(model.layer_count() > 1);
  CHECK(model.cell_count() > 10);
}

TEST_CASE("a thousand scattered boxes do not share one cell") {
  dowel::testing::RandomGeometry random(3);
  LayeredProjection model;
  const auto boxes = fixture(random, 1000);
  for (std::uint32_t i = 0; i < boxes.size(); ++i) model.insert(i, boxes[i]);
  CHECK(model.cell_count() > 100);
  CHECK(model.memory_bytes() < 256 * boxes.size());
}
