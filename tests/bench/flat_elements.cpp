#include <array>
#include <cmath>
#include <numbers>

#include "element.h"
#include "solids.h"

namespace dowel::bench {

namespace {

using testing::detail::Builder;

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

}  // namespace

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

}  // namespace dowel::bench
