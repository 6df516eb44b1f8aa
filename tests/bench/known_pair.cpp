#include "known_pair.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "collision_element.h"
#include "solids.h"

namespace dowel::bench {

namespace {

constexpr double kPi = std::numbers::pi;

/// Corners of a regular polygon in a circle that it misses by no more than `error_mm`.
std::uint32_t segments(double radius_mm, double error_mm) {
  const double cosine = std::max(1.0 - error_mm / radius_mm, 0.0);
  return std::max(5U, static_cast<std::uint32_t>(std::ceil(kPi / std::acos(cosine))));
}

ElementPtr made(std::string name, FacetedSolid solid) {
  const Obb box = testing::box_of(solid);
  return share(element(std::move(name), std::move(solid),
                       {box.center - box.half_extents_mm, box.center + box.half_extents_mm}));
}

Pose about(const Eigen::Vector3d& axis, double angle_rad, const Eigen::Vector3d& to) {
  return Pose(Eigen::Quaterniond(Eigen::AngleAxisd(angle_rad, axis)), to);
}

Pose about_z(double angle_rad, const Eigen::Vector3d& to) {
  return about(Eigen::Vector3d::UnitZ(), angle_rad, to);
}

/// Axis along x, turned about it by `roll_rad`.
Pose lying(double roll_rad, const Eigen::Vector3d& to) {
  return about_z(0.0, to) * about(Eigen::Vector3d::UnitX(), roll_rad, Eigen::Vector3d::Zero()) *
         about(Eigen::Vector3d::UnitY(), 0.5 * kPi, Eigen::Vector3d::Zero());
}

class PairMaker {
 public:
  explicit PairMaker(const PairMesh& mesh) : k_(mesh.scale), error_mm_(mesh.facet_error_mm) {}

  KnownPair pin_in_hole() const {
    // Far enough below the hole's radius for all gaps asked about, at any scale.
    const double clearance = 1.2;
    const double hole = 6.0 * k_ + clearance;
    FacetedSolid plate = testing::plate_with_holes({60.0 * k_ + 4.0, 60.0 * k_ + 4.0, 20.0 * k_},
                                                   {{0.0, 0.0, hole}}, segments(6.0, error_mm_));
    return {"pin in hole", round(6.0, 30.0), made("plate", std::move(plate)),
            [clearance, k = k_](double gap, double turn) {
              const double off = clearance - gap;
              return about_z(3.0 * turn, {off * std::cos(turn), off * std::sin(turn), -5.0 * k});
            }};
  }

  KnownPair lying_cylinder() const {
    return {"cylinder on plane", round(8.0, 40.0), table(), [k = k_](double gap, double turn) {
              return lying(turn, {-20.0 * k, 3.0 * k * std::sin(turn), 8.0 * k + gap});
            }};
  }

  KnownPair beside_post() const {
    return {"cylinder beside post", round(8.0, 40.0), round(18.0, 60.0),
            [k = k_](double gap, double turn) {
              const double off = 26.0 * k + gap;
              return about_z(2.5 * turn, {off * std::cos(turn), off * std::sin(turn), 7.0 * k});
            }};
  }

  KnownPair across_post() const {
    return {"cylinder across post", round(8.0, 40.0), round(18.0, 60.0),
            [k = k_](double gap, double turn) {
              return about_z(turn, Eigen::Vector3d::Zero()) *
                     lying(3.0 * turn, {-20.0 * k, 26.0 * k + gap, 30.0 * k});
            }};
  }

  KnownPair ball() const {
    // Facets of a ball stand off by about the sum of what its meridians and parallels miss.
    FacetedSolid solid = testing::sphere(10.0 * k_, segments(10.0, 0.5 * error_mm_));
    return {"ball on plane", made("ball", std::move(solid)), table(),
            [k = k_](double gap, double turn) {
              const Eigen::Vector3d axis(std::cos(turn), std::sin(turn), 0.7);
              return about(axis.normalized(), 2.0 * turn, {0.0, 0.0, 10.0 * k + gap});
            }};
  }

  KnownPair countersink() const {
    const std::uint32_t n = segments(12.0, error_mm_);
    FacetedSolid seat = testing::revolved(
        {{4.0 * k_, 0.0}, {20.0 * k_, 0.0}, {20.0 * k_, 8.0 * k_}, {12.0 * k_, 8.0 * k_}}, n);
    FacetedSolid head =
        testing::revolved({{0.0, 0.0}, {4.0 * k_, 0.0}, {12.0 * k_, 8.0 * k_}, {0.0, 8.0 * k_}}, n);
    return {"cone in countersink", made("head", std::move(head)), made("seat", std::move(seat)),
            [](double gap, double turn) {
              return about_z(turn, {0.0, 0.0, gap * std::numbers::sqrt2});
            }};
  }

  KnownPair block_on_plane() const {
    return {"block on plane", box("block", {40.0, 30.0, 20.0}, 10.0), table(), lift(), true};
  }

  KnownPair riser_on_plate() const {
    const std::uint32_t n = segments(6.0, error_mm_);
    FacetedSolid riser = testing::plate_with_holes(
        {78.0 * k_, 78.0 * k_, 20.0 * k_}, testing::hole_grid(2, 2, 40.0 * k_, 6.75 * k_), n);
    FacetedSolid plate = testing::transformed(
        Pose::from_translation({0.0, 0.0, -20.0 * k_}),
        testing::plate_with_holes({160.0 * k_, 160.0 * k_, 20.0 * k_},
                                  testing::hole_grid(4, 4, 40.0 * k_, 6.0 * k_), n));
    return {"riser on plate", made("riser", std::move(riser)), made("plate", std::move(plate)),
            lift(), true};
  }

 private:
  static std::function<Pose(double, double)> lift() {
    return [](double gap, double turn) { return about_z(turn, {0.0, 0.0, gap}); };
  }

  ElementPtr round(double radius, double height) const {
    return made("cylinder",
                testing::cylinder(radius * k_, height * k_, segments(radius, error_mm_)));
  }

  ElementPtr box(std::string name, const Eigen::Vector3d& size, double middle) const {
    return made(std::move(name), testing::box(k_ * size, {0.0, 0.0, k_ * middle}));
  }

  ElementPtr table() const { return box("table", {100.0, 100.0, 20.0}, -10.0); }

  double k_;
  double error_mm_;
};

}  // namespace

std::vector<KnownPair> known_pairs(const PairMesh& mesh) {
  const PairMaker maker(mesh);
  return {maker.pin_in_hole(),    maker.lying_cylinder(), maker.beside_post(),
          maker.across_post(),    maker.ball(),           maker.countersink(),
          maker.block_on_plane(), maker.riser_on_plate()};
}

KnownPair sliver_pair(double sliver_mm) {
  // A vertex close to each corner, a tenth of that off the side: the side ends in a sliver, and so
  // do top and bottom.
  const std::vector<Eigen::Vector2d> corners{
      {-20.0, -15.0}, {20.0, -15.0}, {20.0, 15.0}, {-20.0, 15.0}};
  std::vector<Eigen::Vector2d> outline;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector2d along = (corners[(i + 1) % 4] - corners[i]).normalized();
    const Eigen::Vector2d outward(along.y(), -along.x());
    outline.push_back(corners[i]);
    outline.emplace_back(corners[i] + sliver_mm * along + 0.1 * sliver_mm * outward);
  }
  return {"block of slivers", made("block", testing::prism(outline, 20.0)),
          made("table", testing::box({100.0, 100.0, 20.0}, {0.0, 0.0, -10.0})),
          [](double gap, double turn) {
            return about_z(turn, {0.0, 0.0, gap});
          },
          true};
}

KnownPair crossed_edges(double angle_rad) {
  // A square bar along x, its lowest edge on the x axis.
  const auto bar = [] {
    const std::vector<Eigen::Vector2d> square{{0.0, 0.0}, {14.0, 14.0}, {0.0, 28.0}, {-14.0, 14.0}};
    return testing::transformed(about(Eigen::Vector3d::UnitX(), 0.5 * kPi, {0.0, 0.0, 0.0}) *
                                    about(Eigen::Vector3d::UnitY(), 0.5 * kPi, {0.0, 0.0, 0.0}) *
                                    Pose::from_translation({0.0, 0.0, -30.0}),
                                testing::prism(square, 60.0));
  };
  FacetedSolid below =
      testing::transformed(about(Eigen::Vector3d::UnitX(), kPi, Eigen::Vector3d::Zero()), bar());
  return {"crossed edges", made("bar", bar()), made("bar below", std::move(below)),
          [angle_rad](double gap, double turn) {
            // The largest ball between two square edges touches all four flanks.
            const double height = gap < 0.0 ? gap * std::numbers::sqrt2 : gap;
            return about_z(angle_rad, {1.5 * std::sin(turn) * std::cos(0.5 * angle_rad),
                                       1.5 * std::sin(turn) * std::sin(0.5 * angle_rad), height});
          },
          true};
}

double swept_gap_mm(double s, double least_mm, double reach_mm) {
  const double wave = std::sin(2.0 * kPi * 3.0 * s);
  const double magnitude = least_mm * std::pow(reach_mm / least_mm, std::abs(wave));
  return wave < 0.0 ? -magnitude : magnitude;
}

}  // namespace dowel::bench
