#include "random_shape.h"

#include <array>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace dowel::testing {

namespace {

constexpr double kHalfTurn = std::numbers::pi;
constexpr double kQuarterTurn = 0.5 * std::numbers::pi;

struct NamedOutlines {
  std::string name;
  std::vector<Outline> outlines;
};

NamedOutlines named(std::string name, Outline outline) {
  return {std::move(name), {std::move(outline)}};
}

/// Pins and their kind: profiles without a bore, of sizes about 1.
NamedOutlines random_pin(RandomGeometry& random) {
  const double r = random.uniform(0.3, 1.0);
  const double h = random.uniform(0.3, 2.0);
  switch (random.index(9)) {
    case 0:
      return named("cylinder", {{0, 0}, {r, 0}, {r, h}, {0, h}});
    case 1:
      return named("cone", {{0, 0}, {r, 0}, {0, h}});
    case 2: {
      const double top = r * random.uniform(0.1, 0.9);
      return named("frustum", {{0, 0}, {r, 0}, {top, h}, {0, h}});
    }
    case 3:
      return named("ball", {{0, -r, kHalfTurn}, {0, r}});
    case 4:
      return named("pin with ball end", {{0, 0}, {r, 0}, {r, h, kQuarterTurn}, {0, h + r}});
    case 5: {
      const double f = r * random.uniform(0.1, 0.45);
      return named("rounded pin",
                   {{0, 0}, {r - f, 0, kQuarterTurn}, {r, f}, {r, f + h}, {0, f + h}});
    }
    case 6: {
      const double bead = r * random.uniform(0.1, 0.8);
      return named("pin with bead", {{0, 0},
                                     {r, 0},
                                     {r, h, kHalfTurn},
                                     {r, h + 2.0 * bead},
                                     {r, 2.0 * (h + bead)},
                                     {0, 2.0 * (h + bead)}});
    }
    case 7: {
      const double groove = r * random.uniform(0.1, 0.4);
      return named("pin with groove", {{0, 0},
                                       {r, 0},
                                       {r, h, -kHalfTurn},
                                       {r, h + 2.0 * groove},
                                       {r, 2.0 * (h + groove)},
                                       {0, 2.0 * (h + groove)}});
    }
    default: {
      const double rise = r * random.uniform(0.2, 0.8);
      const double sweep = 2.0 * std::atan2(rise, r);
      return named("lens", {{0, -rise, sweep}, {r, 0, sweep}, {0, rise}});
    }
  }
}

/// Steps, chamfers and cones on each other.
NamedOutlines random_stepped_body(RandomGeometry& random, double foot) {
  Outline profile{{0, 0}, {foot, 0}};
  double z = 0.0;
  for (std::uint32_t i = 1 + random.index(4); i > 0; --i) {
    const double next = random.uniform(0.2, 1.0);
    z += random.uniform(0.1, 0.6);
    if (random.coin()) profile.push_back({profile.back().x, z});
    if (!random.coin()) z += random.uniform(0.1, 0.6);
    profile.push_back({next, z});
  }
  z += random.uniform(0.1, 0.5);
  profile.push_back({profile.back().x, z});
  profile.push_back({0, z});
  return named("stepped body", profile);
}

/// Rings, sockets, collars, stepped bodies, of sizes about 1.
NamedOutlines random_ring(RandomGeometry& random) {
  const double r = random.uniform(0.3, 0.8);
  const double outer = r + random.uniform(0.2, 1.0);
  const double h = random.uniform(0.3, 1.5);
  switch (random.index(8)) {
    case 0:
      return named("tube", {{r, 0}, {outer, 0}, {outer, h}, {r, h}});
    case 1: {
      const double bar = r * random.uniform(0.2, 0.8);
      return named("torus", {{outer + bar, 0, kHalfTurn}, {outer - bar, 0, kHalfTurn}});
    }
    case 2: {
      const double f = (outer - r) * random.uniform(0.1, 0.9);
      return named("collar with fillet", {{0, 0},
                                          {outer, 0},
                                          {outer, h},
                                          {r + f, h, -kQuarterTurn},
                                          {r, h + f},
                                          {r, 2.0 * h + f},
                                          {0, 2.0 * h + f}});
    }
    case 3: {
      const double c = std::min(outer - r, h) * random.uniform(0.1, 0.4);
      return named("chamfered ring", {{r, c},
                                      {r + c, 0},
                                      {outer - c, 0},
                                      {outer, c},
                                      {outer, h - c},
                                      {outer - c, h},
                                      {r + c, h},
                                      {r, h - c}});
    }
    case 4: {
      const double deep = h * random.uniform(0.2, 0.9);
      return named("conical socket", {{0, 0}, {outer, 0}, {outer, h}, {r, h}, {0, h - deep}});
    }
    case 5:
      return named("ball socket",
                   {{0, 0}, {outer, 0}, {outer, r + h}, {r, r + h, -kQuarterTurn}, {0, h}});
    case 6: {
      const double deep = random.uniform(0.2, 1.0);
      const double tip = r * random.uniform(0.2, 0.9);
      return named(
          "blind bore",
          {{0, 0}, {outer, 0}, {outer, h + tip + deep}, {r, h + tip + deep}, {r, h + tip}, {0, h}});
    }
    default:
      return random_stepped_body(random, r);
  }
}

Outline rectangle(double half_x, double half_y) {
  return {{-half_x, -half_y}, {half_x, -half_y}, {half_x, half_y}, {-half_x, half_y}};
}

Outline obround(double half_length, double r) {
  return {{-half_length, -r},
          {half_length, -r, kHalfTurn},
          {half_length, r},
          {-half_length, r, kHalfTurn}};
}

NamedOutlines random_nut(RandomGeometry& random) {
  const std::uint32_t sides = 3 + random.index(5);
  const double r = random.uniform(0.5, 1.5);
  NamedOutlines nut{"nut", {{}}};
  for (std::uint32_t i = 0; i < sides; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / sides;
    nut.outlines[0].push_back({r * std::cos(angle), r * std::sin(angle)});
  }
  const double bore = r * std::cos(std::numbers::pi / sides) * random.uniform(0.2, 0.9);
  nut.outlines.push_back(reversed(circle({0, 0}, bore, random.uniform(0.0, 3.0))));
  return nut;
}

/// `w`: half the mouth, `s`: by how much it is wider within.
NamedOutlines slot_or_key(std::uint32_t kind, double w, double deep, double s) {
  if (kind == 3) {
    const double lip = 0.5 * deep;
    return named("T-slot", {{-1.2, -1},
                            {1.2, -1},
                            {1.2, 1},
                            {w, 1},
                            {w, 1 - lip},
                            {w + s, 1 - lip},
                            {w + s, 0.6 - lip},
                            {-w - s, 0.6 - lip},
                            {-w - s, 1 - lip},
                            {-w, 1 - lip},
                            {-w, 1},
                            {-1.2, 1}});
  }
  if (kind == 4) {
    return named("dovetail groove", {{-1.5, -0.8},
                                     {1.5, -0.8},
                                     {1.5, deep},
                                     {w, deep},
                                     {w + s, 0},
                                     {-w - s, 0},
                                     {-w, deep},
                                     {-1.5, deep}});
  }
  return named("dovetail", {{-w - s, 0}, {w + s, 0}, {w, deep}, {-w, deep}});
}

/// Sections of blocks, of sizes about 1.
NamedOutlines random_section(RandomGeometry& random) {
  const double a = random.uniform(0.5, 1.5);
  const double b = random.uniform(0.5, 1.5);
  const double w = random.uniform(0.1, 0.45);
  const double deep = random.uniform(0.2, 0.8);
  const double s = random.uniform(0.1, 0.5);
  const std::uint32_t kind = random.index(8);
  switch (kind) {
    case 0:
      return named("block", rectangle(a, b));
    case 1: {
      NamedOutlines plate{"plate with holes", {rectangle(a, b)}};
      const double r = w * std::min(a, b);
      const double phase = random.uniform(0.0, 3.0);
      plate.outlines.push_back(reversed(circle({-0.5 * a, 0}, r, phase)));
      plate.outlines.push_back(reversed(circle({0.5 * a, 0}, r, phase)));
      return plate;
    }
    case 2: {
      const double f = w * std::min(a, b);
      return named("rounded block", {{f - a, -b},
                                     {a - f, -b, kQuarterTurn},
                                     {a, f - b},
                                     {a, b - f, kQuarterTurn},
                                     {a - f, b},
                                     {f - a, b, kQuarterTurn},
                                     {-a, b - f},
                                     {-a, f - b, kQuarterTurn}});
    }
    case 3:
    case 4:
    case 5:
      return slot_or_key(kind, w, deep, s);
    case 6:
      return random_nut(random);
    default: {
      NamedOutlines link{"link", {obround(a, w)}};
      if (random.coin()) {
        link.outlines.push_back(reversed(obround(a * random.uniform(0.3, 1.0), 0.6 * w)));
      }
      return link;
    }
  }
}

ExactShape random_simple_shape(RandomGeometry& random, double size_mm) {
  constexpr std::array kPerTurn{8U, 9U, 12U, 16U, 17U, 24U, 33U, 48U, 72U};
  const Facets facets{kPerTurn[random.index(kPerTurn.size())], 2 + random.index(6),
                      random.uniform(0.0, 1.0)};
  const bool is_revolved = random.coin();
  NamedOutlines drawn = !is_revolved    ? random_section(random)
                        : random.coin() ? random_pin(random)
                                        : random_ring(random);
  for (Outline& outline : drawn.outlines) {
    for (Corner& corner : outline) {
      corner.x *= size_mm;
      corner.y *= size_mm;
    }
  }
  if (is_revolved) return revolved_shape(drawn.name, drawn.outlines[0], facets);
  return extruded_shape(drawn.name, drawn.outlines, size_mm * random.uniform(0.2, 2.0), facets);
}

Eigen::Vector3d random_point_in(RandomGeometry& random, const Aabb& box) {
  return box.center() + random.point(0.5).cwiseProduct(box.size());
}

/// With a cavity about the deepest of some random points; nothing where that is in the air.
std::optional<ExactShape> hollowed_at_random(RandomGeometry& random, const ExactShape& outer,
                                             const ExactShape& inner) {
  const Aabb box = outer.box;
  Eigen::Vector3d deepest = box.center();
  double depth_mm = 0.0;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d p = random_point_in(random, box);
    if (-outer.signed_distance_mm(p) <= depth_mm) continue;
    depth_mm = -outer.signed_distance_mm(p);
    deepest = p;
  }
  const Aabb inner_box = inner.box;
  if (depth_mm < 0.55 * inner_box.size().norm()) return std::nullopt;
  return hollowed(outer, transformed(Pose::from_translation(deepest) * random.pose(0.0) *
                                         Pose::from_translation(-inner_box.center()),
                                     inner));
}

}  // namespace

ExactShape random_shape(RandomGeometry& random, double size_mm) {
  ExactShape shape = random_simple_shape(random, size_mm);
  const std::uint32_t kind = random.index(14);
  if (kind == 0) {
    const ExactShape inner = random_simple_shape(random, 0.1 * size_mm);
    return hollowed_at_random(random, shape, inner).value_or(std::move(shape));
  }
  if (kind == 1) {
    const ExactShape other = random_simple_shape(random, size_mm);
    const double apart_mm = 0.6 * (shape.box.size().norm() + other.box.size().norm());
    return merged(shape,
                  transformed(Pose::from_translation(apart_mm * random.direction() +
                                                     shape.box.center() - other.box.center()),
                              other));
  }
  return shape;
}

}  // namespace dowel::testing
