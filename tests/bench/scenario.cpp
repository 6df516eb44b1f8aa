#include "scenario.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "solids.h"

namespace dowel::bench {

namespace {

using testing::DrilledHole;
using testing::detail::Builder;

constexpr double kCell_mm = 80.0;  // risers and supports are this wide
constexpr double kHole_mm = 6.0;   // radius of a locating hole
constexpr double kClearanceHole_mm = 6.75;
constexpr double kShank_mm = kHole_mm - kFitClearance_mm;

Aabb box_of(double min_x, double min_y, double min_z, double max_x, double max_y, double max_z) {
  return {{min_x, min_y, min_z}, {max_x, max_y, max_z}};
}

std::vector<std::uint32_t> bores(const FacetedSolid& solid) {
  std::vector<std::uint32_t> result;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    const Face& face = solid.faces[f];
    if (face.reversed && std::holds_alternative<CylinderSurface>(face.surface)) result.push_back(f);
  }
  return result;
}

Element element(std::string name, FacetedSolid solid, const Aabb& box) {
  Element result;
  result.name = std::move(name);
  result.hole_faces = bores(solid);
  result.solid = std::make_shared<const FacetedSolid>(std::move(solid));
  result.box = box;
  result.hull = {box};
  return result;
}

/// Strips of a drilled plate between its holes, along both sides.
std::vector<Aabb> strips(const Aabb& plate, const std::vector<DrilledHole>& holes) {
  std::vector<Aabb> result;
  for (const int axis : {0, 1}) {
    std::vector<std::pair<double, double>> spans;
    for (const DrilledHole& hole : holes) {
      const double at = axis == 0 ? hole.x : hole.y;
      spans.emplace_back(at - hole.radius_mm, at + hole.radius_mm);
    }
    std::sort(spans.begin(), spans.end());
    spans.emplace_back(plate.max[axis], plate.max[axis]);
    double reach = plate.min[axis];
    for (const auto& [low, high] : spans) {
      if (low > reach) {
        Aabb strip = plate;
        strip.min[axis] = reach;
        strip.max[axis] = low;
        result.push_back(strip);
      }
      reach = std::max(reach, high);
    }
  }
  return result;
}

/// Stands on z = 0.
Element drilled_plate(std::string name, const Eigen::Vector3d& size,
                      const std::vector<DrilledHole>& holes, std::uint32_t segments) {
  const Aabb box =
      box_of(-0.5 * size.x(), -0.5 * size.y(), 0.0, 0.5 * size.x(), 0.5 * size.y(), size.z());
  Element result = element(std::move(name), testing::plate_with_holes(size, holes, segments), box);
  result.core = strips(box, holes);
  return result;
}

Element block(std::string name, const Eigen::Vector3d& size) {
  const Aabb box =
      box_of(-0.5 * size.x(), -0.5 * size.y(), 0.0, 0.5 * size.x(), 0.5 * size.y(), size.z());
  Element result = element(std::move(name), testing::box(size, {0.0, 0.0, 0.5 * size.z()}), box);
  result.core = {box};
  return result;
}

/// Locating hole in the middle, and clearance holes around it or none.
std::vector<DrilledHole> riser_holes(bool has_clearance_holes) {
  std::vector<DrilledHole> holes;
  if (has_clearance_holes) holes = testing::hole_grid(2, 2, 40.0, kClearanceHole_mm);
  DrilledHole middle;
  middle.radius_mm = kHole_mm;
  holes.push_back(middle);
  return holes;
}

/// Balls along the rim and the axis of a cylinder, tangent to both of its ends.
void add_cylinder_balls(std::vector<Ball>& balls, double radius_mm, double low_z, double high_z) {
  const double ball_mm = std::min(0.3 * radius_mm, 0.5 * (high_z - low_z));
  constexpr int kLevels = 5;
  constexpr int kAround = 8;
  for (int level = 0; level < kLevels; ++level) {
    const double z = low_z + ball_mm + (high_z - low_z - 2.0 * ball_mm) * level / (kLevels - 1);
    balls.push_back({{0.0, 0.0, z}, ball_mm});
    for (int i = 0; i < kAround; ++i) {
      const double angle = 2.0 * std::numbers::pi * i / kAround;
      const double r = radius_mm - ball_mm;
      balls.push_back({{r * std::cos(angle), r * std::sin(angle), z}, ball_mm});
    }
  }
}

/// A body of revolution that stands on z = 0 and has no bore; `profile` from axis to axis.
Element turned(std::string name, const std::vector<Eigen::Vector2d>& profile,
               std::uint32_t segments) {
  Aabb box;
  for (const Eigen::Vector2d& p : profile) {
    box.extend(Eigen::Vector3d(-p.x(), -p.x(), p.y()));
    box.extend(Eigen::Vector3d(p.x(), p.x(), p.y()));
  }
  Element result = element(std::move(name), testing::revolved(profile, segments), box);
  result.hull.clear();
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    const double low = std::min(profile[i].y(), profile[i + 1].y());
    const double high = std::max(profile[i].y(), profile[i + 1].y());
    const double wide = std::max(profile[i].x(), profile[i + 1].x());
    const double narrow = std::min(profile[i].x(), profile[i + 1].x());
    if (low == high) continue;
    result.hull.push_back(box_of(-wide, -wide, low, wide, wide, high));
    const double inner = narrow * std::numbers::sqrt2 / 2.0;
    if (narrow == 0.0) continue;
    result.core.push_back(box_of(-inner, -inner, low, inner, inner, high));
    add_cylinder_balls(result.core_balls, narrow, low, high);
  }
  return result;
}

Element tube(std::string name, double inner_mm, double outer_mm, double height_mm,
             std::uint32_t segments) {
  return element(std::move(name), testing::tube(inner_mm, outer_mm, height_mm, segments),
                 box_of(-outer_mm, -outer_mm, 0.0, outer_mm, outer_mm, height_mm));
}

std::vector<Eigen::Vector2d> hexagon(double across_flats_mm) {
  std::vector<Eigen::Vector2d> result;
  for (int i = 0; i < 6; ++i) {
    const double angle = std::numbers::pi / 3.0 * i;
    result.emplace_back(across_flats_mm / std::sqrt(3.0) * std::cos(angle),
                        across_flats_mm / std::sqrt(3.0) * std::sin(angle));
  }
  return result;
}

double polygon_area(const std::vector<Eigen::Vector2d>& polygon) {
  double area = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& a = polygon[i];
    const Eigen::Vector2d& b = polygon[(i + 1) % polygon.size()];
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

double disc_area(double radius_mm) {
  return std::numbers::pi * radius_mm * radius_mm;
}

std::vector<std::uint32_t> loop_at(Builder& builder, const std::vector<Eigen::Vector2d>& polygon,
                                   double z) {
  std::vector<std::uint32_t> result;
  result.reserve(polygon.size());
  for (const Eigen::Vector2d& p : polygon) result.push_back(builder.vertex({p.x(), p.y(), z}));
  return result;
}

/// One plane for each side of a convex polygon between two loops, with the edges to the planes
/// below and above.
void add_sides(Builder& builder, const std::vector<std::uint32_t>& low,
               const std::vector<std::uint32_t>& high, std::uint32_t below, std::uint32_t above) {
  const std::size_t n = low.size();
  std::vector<std::uint32_t> sides;
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t j = (i + 1) % n;
    const Eigen::Vector3d along = builder.position(low[j]) - builder.position(low[i]);
    const Eigen::Vector3d normal = Eigen::Vector3d(along.y(), -along.x(), 0.0).normalized();
    const double height = builder.position(high[i]).z() - builder.position(low[i]).z();
    sides.push_back(
        builder.face(PlaneSurface{builder.position(low[i]), normal}, along.norm() * height));
    builder.quad(sides[i], low[i], low[j], high[j], high[i]);
    builder.line_edge(below, sides[i], Convexity::Convex, low[i], low[j]);
    builder.line_edge(above, sides[i], Convexity::Convex, high[i], high[j]);
  }
  for (std::size_t i = 0; i < n; ++i) {
    builder.line_edge(sides[(i + n - 1) % n], sides[i], Convexity::Convex, low[i], high[i]);
  }
}

Element hexagon_nut(double bore_mm, double across_flats_mm, double height_mm,
                    std::uint32_t segments) {
  Builder builder;
  const std::vector<Eigen::Vector2d> outline = hexagon(across_flats_mm);
  const auto low = loop_at(builder, outline, 0.0);
  const auto high = loop_at(builder, outline, height_mm);
  const Eigen::Vector2d axis = Eigen::Vector2d::Zero();
  const auto low_bore = builder.ring(axis, 0.0, bore_mm, segments, 0.0);
  const auto high_bore = builder.ring(axis, height_mm, bore_mm, segments, 0.0);
  const double area = polygon_area(outline) - disc_area(bore_mm);
  const auto bottom =
      builder.face(PlaneSurface{Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitZ()}, area);
  const auto top =
      builder.face(PlaneSurface{{0.0, 0.0, height_mm}, Eigen::Vector3d::UnitZ()}, area);
  testing::detail::fill_between(builder, bottom, false, low_bore, low);
  testing::detail::fill_between(builder, top, true, high_bore, high);
  add_sides(builder, low, high, bottom, top);
  const auto wall =
      builder.face(CylinderSurface{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), bore_mm},
                   2.0 * std::numbers::pi * bore_mm * height_mm, true);
  builder.band(wall, high_bore, low_bore);
  builder.circle_edge(bottom, wall, Convexity::Convex, {0.0, 0.0, 0.0}, bore_mm, low_bore[0]);
  builder.circle_edge(top, wall, Convexity::Convex, {0.0, 0.0, height_mm}, bore_mm, high_bore[0]);

  const double corner = across_flats_mm / std::sqrt(3.0);
  Element result = element(
      "nut", builder.finish(),
      box_of(-corner, -0.5 * across_flats_mm, 0.0, corner, 0.5 * across_flats_mm, height_mm));
  const double ball_mm = 0.5 * (0.5 * across_flats_mm - bore_mm);
  constexpr int kAround = 24;
  constexpr int kLevels = 4;
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2.0 * std::numbers::pi * i / kAround;
    for (int level = 0; level < kLevels; ++level) {
      const double z = ball_mm + (height_mm - 2.0 * ball_mm) * level / (kLevels - 1);
      const double r = bore_mm + ball_mm;
      result.core_balls.push_back({{r * std::cos(angle), r * std::sin(angle), z}, ball_mm});
    }
  }
  return result;
}

/// Shank below, with a chamfered end at z = 0, head above.
Element hexagon_bolt(double shank_mm, double shank_length_mm, double across_flats_mm,
                     double head_height_mm, std::uint32_t segments) {
  constexpr double kChamfer_mm = 1.0;
  Builder builder;
  const Eigen::Vector2d axis = Eigen::Vector2d::Zero();
  const double top_z = shank_length_mm + head_height_mm;
  const std::vector<Eigen::Vector2d> outline = hexagon(across_flats_mm);
  const auto tip = builder.vertex(Eigen::Vector3d::Zero());
  const auto end = builder.ring(axis, 0.0, shank_mm - kChamfer_mm, segments, 0.0);
  const auto chamfer_end = builder.ring(axis, kChamfer_mm, shank_mm, segments, 0.0);
  const auto neck = builder.ring(axis, shank_length_mm, shank_mm, segments, 0.0);
  const auto low = loop_at(builder, outline, shank_length_mm);
  const auto high = loop_at(builder, outline, top_z);

  const auto end_face =
      builder.face(PlaneSurface{Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitZ()},
                   disc_area(shank_mm - kChamfer_mm));
  builder.band(end_face, {tip}, end);
  const auto chamfer = builder.face(
      ConeSurface{
          {0.0, 0.0, kChamfer_mm - shank_mm}, Eigen::Vector3d::UnitZ(), std::numbers::pi / 4.0},
      std::numbers::pi * (2.0 * shank_mm - kChamfer_mm) * kChamfer_mm * std::numbers::sqrt2);
  builder.band(chamfer, end, chamfer_end);
  const auto shank =
      builder.face(CylinderSurface{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), shank_mm},
                   2.0 * std::numbers::pi * shank_mm * (shank_length_mm - kChamfer_mm));
  builder.band(shank, chamfer_end, neck);
  const auto seat =
      builder.face(PlaneSurface{{0.0, 0.0, shank_length_mm}, -Eigen::Vector3d::UnitZ()},
                   polygon_area(outline) - disc_area(shank_mm));
  testing::detail::fill_between(builder, seat, false, neck, low);
  const auto top = builder.face(PlaneSurface{{0.0, 0.0, top_z}, Eigen::Vector3d::UnitZ()},
                                polygon_area(outline));
  add_sides(builder, low, high, seat, top);
  for (std::uint32_t i = 1; i + 1 < high.size(); ++i) {
    builder.triangle(top, high[0], high[i], high[i + 1]);
  }
  builder.circle_edge(end_face, chamfer, Convexity::Convex, {0.0, 0.0, 0.0}, shank_mm - kChamfer_mm,
                      end[0]);
  builder.circle_edge(chamfer, shank, Convexity::Convex, {0.0, 0.0, kChamfer_mm}, shank_mm,
                      chamfer_end[0]);
  builder.circle_edge(shank, seat, Convexity::Concave, {0.0, 0.0, shank_length_mm}, shank_mm,
                      neck[0]);

  const double corner = across_flats_mm / std::sqrt(3.0);
  const Aabb head = box_of(-corner, -0.5 * across_flats_mm, shank_length_mm, corner,
                           0.5 * across_flats_mm, top_z);
  Element result = element("bolt", builder.finish(), head);
  result.box.min.z() = 0.0;
  result.hull = {box_of(-shank_mm, -shank_mm, 0.0, shank_mm, shank_mm, shank_length_mm), head};
  add_cylinder_balls(result.core_balls, shank_mm - kChamfer_mm, 0.0, shank_length_mm);
  add_cylinder_balls(result.core_balls, 0.5 * across_flats_mm, shank_length_mm, top_z);
  return result;
}

/// Two lands of a cylinder, `land_rad` wide to either side of the x axis, and two flats.
Element rhombus_pin(double radius_mm, double land_rad, double height_mm,
                    std::uint32_t points_per_land) {
  Builder builder;
  std::vector<Eigen::Vector2d> outline;
  for (const double middle : {0.0, std::numbers::pi}) {
    for (std::uint32_t i = 0; i < points_per_land; ++i) {
      const double angle = middle - land_rad + 2.0 * land_rad * i / (points_per_land - 1);
      outline.emplace_back(radius_mm * std::cos(angle), radius_mm * std::sin(angle));
    }
  }
  const auto low = loop_at(builder, outline, 0.0);
  const auto high = loop_at(builder, outline, height_mm);
  const double half_width = radius_mm * std::sin(land_rad);
  const double area = radius_mm * radius_mm * (2.0 * land_rad + std::sin(2.0 * land_rad));
  const auto bottom =
      builder.face(PlaneSurface{Eigen::Vector3d::Zero(), -Eigen::Vector3d::UnitZ()}, area);
  const auto top =
      builder.face(PlaneSurface{{0.0, 0.0, height_mm}, Eigen::Vector3d::UnitZ()}, area);
  const auto n = static_cast<std::uint32_t>(outline.size());
  for (std::uint32_t i = 1; i + 1 < n; ++i) {
    builder.triangle(bottom, low[0], low[i + 1], low[i]);
    builder.triangle(top, high[0], high[i], high[i + 1]);
  }
  std::array<std::uint32_t, 2> lands{};
  std::array<std::uint32_t, 2> flats{};
  for (std::uint32_t side = 0; side < 2; ++side) {
    lands[side] =
        builder.face(CylinderSurface{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ(), radius_mm},
                     2.0 * land_rad * radius_mm * height_mm);
    const std::uint32_t first = side * points_per_land;
    for (std::uint32_t i = first; i + 1 < first + points_per_land; ++i) {
      builder.quad(lands[side], low[i], low[i + 1], high[i + 1], high[i]);
    }
    const std::uint32_t last = first + points_per_land - 1;
    const std::uint32_t next = (last + 1) % n;
    flats[side] = builder.face(PlaneSurface{{0.0, side == 0 ? half_width : -half_width, 0.0},
                                            {0.0, side == 0 ? 1.0 : -1.0, 0.0}},
                               2.0 * radius_mm * std::cos(land_rad) * height_mm);
    builder.quad(flats[side], low[last], low[next], high[next], high[last]);
  }
  for (std::uint32_t side = 0; side < 2; ++side) {
    const std::uint32_t last = (side + 1) * points_per_land - 1;
    const std::uint32_t next = (last + 1) % n;
    builder.line_edge(lands[side], flats[side], Convexity::Convex, low[last], high[last]);
    builder.line_edge(flats[side], lands[1 - side], Convexity::Convex, low[next], high[next]);
    builder.line_edge(bottom, flats[side], Convexity::Convex, low[last], low[next]);
    builder.line_edge(top, flats[side], Convexity::Convex, high[last], high[next]);
  }
  Element result = element("rhombus pin", builder.finish(),
                           box_of(-radius_mm, -half_width, 0.0, radius_mm, half_width, height_mm));
  add_cylinder_balls(result.core_balls, half_width, 0.0, height_mm);
  const std::size_t count = result.core_balls.size();
  const double shift = radius_mm * std::cos(land_rad) - half_width;
  for (std::size_t i = 0; i < count && shift > 0.0; ++i) {
    Ball ball = result.core_balls[i];
    ball.center.x() += ball.center.x() < 0.0 ? -shift : shift;
    result.core_balls.push_back(ball);
  }
  return result;
}

/// Locating pin with a flange: shank down to z = 0, locating diameter up.
Element locator(std::uint32_t segments) {
  return turned("locator",
                {{0.0, 0.0},
                 {kShank_mm - 1.0, 0.0},
                 {kShank_mm, 1.0},
                 {kShank_mm, 20.0},
                 {11.0, 20.0},
                 {12.0, 21.0},
                 {12.0, 26.0},
                 {7.0, 26.0},
                 {8.0, 28.0},
                 {8.0, 38.0},
                 {6.0, 41.0},
                 {0.0, 41.0}},
                segments);
}

/// Turns a prism that stands on z = 0 so that z becomes -y and y becomes z, without rounding.
FacetedSolid lying(FacetedSolid prism) {
  const auto turn = [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), -p.z(), p.y()); };
  for (Eigen::Vector3d& p : prism.vertices) p = turn(p);
  for (Face& face : prism.faces) {
    auto& plane = std::get<PlaneSurface>(face.surface);
    plane = {turn(plane.origin), turn(plane.normal)};
  }
  for (Edge& edge : prism.edges) {
    edge.start = turn(edge.start);
    edge.end = turn(edge.end);
  }
  return prism;
}

/// T-slots along y in its top, z = 0.
Element slotted_plate(double length_mm, double width_mm, double height_mm, std::uint32_t slots,
                      double pitch_mm) {
  constexpr double kNeck_mm = 7.0;  // half widths and depths of the slot
  constexpr double kFoot_mm = 11.5;
  constexpr double kNeckDepth_mm = 12.0;
  constexpr double kDepth_mm = 21.0;
  const double half = 0.5 * length_mm;
  const Aabb box = box_of(-half, -0.5 * width_mm, -height_mm, half, 0.5 * width_mm, 0.0);
  std::vector<Eigen::Vector2d> outline{{-half, -height_mm}, {half, -height_mm}, {half, 0.0}};
  std::vector<Aabb> core{box};
  core.front().max.z() = -kDepth_mm;
  double reach = -half;
  for (std::uint32_t i = 0; i < slots; ++i) {
    const double x = pitch_mm * (i - 0.5 * (slots - 1.0));
    Aabb land = box;
    land.min.x() = reach;
    land.max.x() = x - kNeck_mm;
    land.min.z() = -kNeckDepth_mm;
    core.push_back(land);
    reach = x + kNeck_mm;
  }
  core.push_back(box);
  core.back().min.x() = reach;
  core.back().min.z() = -kNeckDepth_mm;
  for (std::uint32_t i = slots; i-- > 0;) {
    const double x = pitch_mm * (i - 0.5 * (slots - 1.0));
    for (const auto& [dx, z] : {std::pair{kNeck_mm, 0.0},
                                {kNeck_mm, -kNeckDepth_mm},
                                {kFoot_mm, -kNeckDepth_mm},
                                {kFoot_mm, -kDepth_mm},
                                {-kFoot_mm, -kDepth_mm},
                                {-kFoot_mm, -kNeckDepth_mm},
                                {-kNeck_mm, -kNeckDepth_mm},
                                {-kNeck_mm, 0.0}}) {
      outline.emplace_back(x + dx, z);
    }
  }
  outline.emplace_back(-half, 0.0);
  FacetedSolid solid = lying(testing::prism(outline, width_mm));
  for (Eigen::Vector3d& p : solid.vertices) p.y() += 0.5 * width_mm;
  for (Face& face : solid.faces) std::get<PlaneSurface>(face.surface).origin.y() += 0.5 * width_mm;
  for (Edge& edge : solid.edges) {
    edge.start.y() += 0.5 * width_mm;
    edge.end.y() += 0.5 * width_mm;
  }
  Element result = element("slotted plate", std::move(solid), box);
  result.core = std::move(core);
  return result;
}

ElementPtr share(Element element) {
  return std::make_shared<const Element>(std::move(element));
}

Pose at(double x, double y, double z) {
  return Pose::from_translation({x, y, z});
}

/// The elements of one scenario.
struct Kit {
  ElementPtr base;  ///< top at z = 0
  ElementPtr riser, support, wall, foot, adaptor, strap, post, stud, nut, washer, screw, pin,
      weight;
};

struct Density {
  std::uint32_t holes = 24;   ///< segments of a hole
  std::uint32_t rounds = 24;  ///< segments of pins, screws, nuts
};

/// `columns` x `columns` holes in a support: how densely the scenario's elements are drilled.
Kit kit_of(bool has_slots, bool has_full_risers, std::uint32_t columns, const Density& density) {
  const std::uint32_t h = density.holes;
  const std::uint32_t n = density.rounds;
  Kit kit;
  if (has_slots) {
    kit.base = share(slotted_plate(400.0, 320.0, 40.0, 10, 40.0));
  } else {
    Element plate = drilled_plate("base plate", {400.0, 320.0, 40.0},
                                  testing::hole_grid(10, 8, 40.0, kHole_mm), h);
    kit.base = share(std::move(plate));
  }
  const double pitch_mm = 60.0 / columns;
  kit.riser =
      share(drilled_plate("riser", {kCell_mm, kCell_mm, 40.0}, riser_holes(has_full_risers), h));
  kit.support =
      share(drilled_plate("support", {kCell_mm, kCell_mm, 20.0},
                          testing::hole_grid(columns, columns, pitch_mm, 0.3 * pitch_mm), h));
  kit.wall =
      share(drilled_plate("wall", {kCell_mm, 100.0, 16.0},
                          testing::hole_grid(columns, columns, pitch_mm, 0.3 * pitch_mm), h));
  kit.foot = share(drilled_plate("foot", {kCell_mm, 40.0, 20.0},
                                 testing::hole_grid(2, 1, 40.0, kClearanceHole_mm), h));
  kit.adaptor = share(drilled_plate("adaptor", {60.0, 60.0, 15.0},
                                    testing::hole_grid(2, 2, 30.0, kClearanceHole_mm), h));
  kit.strap = share(drilled_plate("strap", {30.0, 80.0, 16.0},
                                  testing::hole_grid(1, 3, 25.0, kClearanceHole_mm), h));
  kit.post = share(turned("post",
                          {{0.0, 0.0},
                           {30.0, 0.0},
                           {30.0, 10.0},
                           {18.0, 10.0},
                           {18.0, 60.0},
                           {15.0, 63.0},
                           {0.0, 63.0}},
                          n));
  kit.stud =
      share(turned("stud", {{0.0, 0.0}, {6.0, 0.0}, {6.0, 60.0}, {5.0, 61.0}, {0.0, 61.0}}, n));
  kit.nut = share(hexagon_nut(6.0, 19.0, 10.0, n));
  kit.washer = share(tube("washer", 6.5, 12.0, 2.5, n));
  kit.screw = share(turned("screw",
                           {{0.0, 0.0},
                            {5.0, 0.0},
                            {6.0, 1.0},
                            {6.0, 20.0},
                            {9.0, 20.0},
                            {9.0, 31.0},
                            {8.0, 32.0},
                            {0.0, 32.0}},
                           n));
  kit.pin = share(turned(
      "pin", {{0.0, 0.0}, {5.5, 0.0}, {6.0, 0.5}, {6.0, 29.5}, {5.5, 30.0}, {0.0, 30.0}}, n));
  kit.weight = share(block("weight", {76.0, 76.0, 80.0}));
  return kit;
}

Eigen::Vector2d cell(int column, int row) {
  return {kCell_mm * (column - 2), kCell_mm * (row - 1.5)};
}

struct Layout {
  std::string name;
  std::string title;
  std::size_t static_triangles = 0;
  std::size_t moving_triangles = 0;
  bool has_slots = false;
  bool has_full_risers = true;  ///< risers with five holes, not one
  std::uint32_t columns = 3;    ///< of holes in supports and walls
  std::uint64_t seed = 0;
  std::function<Element()> moving;
};

Scenario assemble(const Layout& layout, const Density& density) {
  const Kit kit = kit_of(layout.has_slots, layout.has_full_risers, layout.columns, density);
  Scenario scene;
  scene.name = layout.name;
  scene.title = layout.title;
  scene.paper_static_triangles = layout.static_triangles;
  scene.paper_moving_triangles = layout.moving_triangles;
  scene.moving = share(layout.moving());
  const auto put = [&](const ElementPtr& element, const Pose& X_WE) {
    scene.elements.push_back(placed(element, X_WE));
  };
  put(kit.base, layout.has_slots ? Pose() : at(0.0, 0.0, -40.0));

  // The stage: four risers side by side at the right.
  for (const int column : {3, 4}) {
    for (const int row : {1, 2}) {
      const Eigen::Vector2d c = cell(column, row);
      put(kit.riser, at(c.x(), c.y(), 0.0));
    }
  }
  scene.stage = box_of(kCell_mm * 0.5, -kCell_mm, 0.0, kCell_mm * 2.5, kCell_mm, 40.0);
  // The aisle: the middle column but for its far end, where a stud stands.
  scene.aisle = box_of(-0.5 * kCell_mm, -2.0 * kCell_mm, -40.0, 0.5 * kCell_mm, kCell_mm, 0.0);
  const Eigen::Vector2d stud = cell(2, 3);
  put(kit.stud, at(stud.x(), stud.y(), 0.0));

  // Stacks in all other cells; what stands where is drawn by lot.
  testing::RandomGeometry random(layout.seed);
  std::vector<Eigen::Vector2d> cells;
  for (const int column : {0, 1, 3, 4}) {
    for (const int row : {0, 1, 2, 3}) {
      if (column < 2 || row == 0 || row == 3) cells.push_back(cell(column, row));
    }
  }
  for (std::size_t i = cells.size(); i > 1; --i) {
    std::swap(cells[i - 1], cells[random.index(static_cast<std::uint32_t>(i))]);
  }
  for (std::size_t i = 0; i < cells.size(); ++i) {
    const double x = cells[i].x();
    const double y = cells[i].y();
    if (i == 0) {
      put(kit.weight, at(x, y, 0.0));
      scene.solid_W = scene.elements.back().box_W;
      continue;
    }
    switch (i % 4) {
      case 0:
        put(kit.riser, at(x, y, 0.0));
        put(kit.support, at(x, y, 40.0));
        put(kit.pin, at(x, y, 60.0));
        put(kit.screw, at(x - 20.0, y - 20.0, 40.0));
        put(kit.screw, at(x + 20.0, y + 20.0, 40.0));
        break;
      case 1:
        put(kit.riser, at(x, y, 0.0));
        put(kit.riser, at(x, y, 40.0));
        put(kit.strap, at(x, y, 80.0));
        put(kit.stud, at(x, y, 60.0));
        put(kit.washer, at(x, y, 96.0));
        put(kit.nut, at(x, y, 98.5));
        break;
      case 2: {
        put(kit.foot, at(x, y, 0.0));
        const double quarter = std::numbers::pi / 2.0;
        const Pose upright(Eigen::Quaterniond(Eigen::AngleAxisd(quarter, Eigen::Vector3d::UnitX())),
                           {x, y + 8.0, 70.0});
        put(kit.wall, upright);
        put(kit.screw, at(x - 20.0, y, 0.0));
        put(kit.screw, at(x + 20.0, y, 0.0));
        break;
      }
      default:
        put(kit.post, at(x, y, 0.0));
        put(kit.adaptor, at(x, y, 63.0));
        put(kit.support, at(x, y, 78.0));
        put(kit.pin, at(x + 15.0, y + 15.0, 70.0));
        break;
    }
  }

  const bool is_nut = scene.moving->name == "nut";
  scene.fit.partner = is_nut ? 5 : 1;
  if (is_nut) {
    scene.fit.top = {stud.x(), stud.y(), 61.0};
    scene.fit.travel_mm = 50.0;
  } else {
    const Eigen::Vector2d c = cell(3, 1);
    scene.fit.top = {c.x(), c.y(), 40.0};
    scene.fit.travel_mm = 18.0;
  }
  return scene;
}

double relative_error(std::size_t found, std::size_t wanted) {
  return std::abs(static_cast<double>(found) / static_cast<double>(wanted) - 1.0);
}

/// The segment counts of holes and round parts are chosen such that the triangles add up.
Scenario tuned(const Layout& layout) {
  Density best;
  double best_error = 1.0e9;
  for (std::uint32_t holes = 20; holes <= 32; ++holes) {
    for (std::uint32_t rounds = 18; rounds <= 32; rounds += 2) {
      // Counting is linear in both, but assembling is quick enough.
      const Scenario scene = assemble(layout, {holes, rounds});
      const double error = relative_error(static_triangles(scene), layout.static_triangles);
      if (error < best_error) {
        best_error = error;
        best = {holes, rounds};
      }
    }
  }
  Scenario scene = assemble(layout, best);
  if (best_error > 0.02 ||
      relative_error(scene.moving->solid->triangles.size(), layout.moving_triangles) > 0.02) {
    throw std::logic_error("scenario " + layout.name + " misses the paper's triangle counts: " +
                           std::to_string(static_triangles(scene)) + ", " +
                           std::to_string(scene.moving->solid->triangles.size()));
  }
  return scene;
}

}  // namespace

Placed placed(ElementPtr element, const Pose& X_WE) {
  const auto in_world = [&](const Aabb& box) {
    const Obb obb{box.center(), Eigen::Matrix3d::Identity(), 0.5 * box.size()};
    return bounds(transformed(X_WE, obb));
  };
  Placed result{std::move(element), X_WE, {}, {}};
  result.box_W = in_world(result.element->box);
  for (const Aabb& box : result.element->core) result.core_W.push_back(in_world(box));
  return result;
}

std::size_t static_triangles(const Scenario& scenario) {
  std::size_t count = 0;
  for (const Placed& p : scenario.elements) count += p.element->solid->triangles.size();
  return count;
}

std::vector<Scenario> paper_scenarios() {
  const std::vector<Layout> layouts{
      {"a", "slots, nut", 11316, 215, true, false, 2, 1,
       [] { return hexagon_nut(6.0 + kFitClearance_mm, 19.0, 10.0, 48); }},
      {"b", "holes, locator", 31296, 948, false, true, 3, 2, [] { return locator(48); }},
      {"c", "slots, bolt", 18004, 220, true, true, 2, 3,
       [] { return hexagon_bolt(kShank_mm, 30.0, 19.0, 8.0, 33); }},
      {"d", "slots, rhombus pin", 29452, 236, true, true, 4, 4,
       [] { return rhombus_pin(kShank_mm, std::numbers::pi / 6.0, 30.0, 30); }}};
  std::vector<Scenario> result;
  result.reserve(layouts.size());
  for (const Layout& layout : layouts) result.push_back(tuned(layout));
  return result;
}

Scenario field_of_elements(std::size_t count) {
  const Kit kit = kit_of(false, true, 2, {24, 24});
  Scenario scene;
  scene.name = "field";
  scene.title = std::to_string(count) + " elements";
  scene.moving = share(locator(48));
  const auto side =
      static_cast<std::size_t>(std::ceil(std::sqrt(0.5 * static_cast<double>(count))));
  constexpr double kPitch_mm = 120.0;  // aisles of 40 mm between the risers
  const double start = -0.5 * kPitch_mm * static_cast<double>(side - 1);
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = i / 2;
    const std::size_t row = place / side;
    const double x = start + kPitch_mm * static_cast<double>(place % side);
    const double y = start + kPitch_mm * static_cast<double>(row);
    const bool is_pin = i % 2 == 1;
    scene.elements.push_back(placed(is_pin ? kit.pin : kit.riser, at(x, y, is_pin ? 25.0 : 0.0)));
  }
  const double reach = start + kPitch_mm * static_cast<double>(side - 1);
  scene.stage = box_of(start - 40.0, start - 40.0, 0.0, reach + 40.0, reach + 40.0, 40.0);
  return scene;
}

}  // namespace dowel::bench
