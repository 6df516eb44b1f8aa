#include "solid_pair.h"

#include <array>
#include <cmath>
#include <optional>
#include <string>

#include <BRepBndLib.hxx>
#include <Bnd_Box.hxx>

#include "boolean_oracle.h"
#include "facet.h"
#include "oracle_shapes.h"
#include "random_geometry.h"

namespace dowel::bench {

namespace {

using testing::Nearest;

/// Of the moving solid along the shortest way, negative: into the other one.
constexpr std::array kOffsets_mm{1.0,    0.3,   0.1,   0.03, 0.01,  0.003, 0.0,
                                 -0.003, -0.01, -0.03, -0.1, -0.25, -0.5,  -1.0};

/// OpenCascade's own distances were found off by less than this.
constexpr double kOracleSlack_mm = 1.0e-4;

/// Large enough for the search of a ball to go on to its end.
constexpr double kAnyBall_mm = 1.0e3;

struct Judged {
  Pose X_SM;
  double gap_mm = 0.0;
};

/// The gap, or the diameter of a ball in both with a minus; nothing where neither is certain.
std::optional<double> judged_gap_mm(const TopoDS_Shape& still, const TopoDS_Shape& moving) {
  constexpr double kOpen_mm = 2.0 * SolidPairs::kTolerance_mm;
  testing::Overlap overlap(still, moving);
  if (!overlap.is_known()) return std::nullopt;
  if (overlap.volume_mm3() > 0.0) {
    const double ball_mm = overlap.ball_mm(kAnyBall_mm);
    if (ball_mm < kOpen_mm) return std::nullopt;
    return -ball_mm;
  }
  // A Boolean may lose slivers, a distance above its own error does not come from an overlap.
  const std::optional<Nearest> way = testing::nearest(still, moving);
  if (!way || way->distance_mm <= kOracleSlack_mm) return std::nullopt;
  return way->distance_mm;
}

Aabb exact_bounds(const TopoDS_Shape& shape) {
  Bnd_Box box;
  BRepBndLib::AddOptimal(shape, box, Standard_False, Standard_False);
  return {to_eigen(box.CornerMin()), to_eigen(box.CornerMax())};
}

/// Its name without its sizes.
std::string kind_of(const testing::NamedShape& shape) {
  return shape.name.substr(0, shape.name.find_first_of("0123456789") - 1);
}

double radius_mm(const TopoDS_Shape& shape) {
  return 0.5 * exact_bounds(shape).size().norm();
}

}  // namespace

struct SolidPairs::Impl {
  struct Pair {
    testing::NamedShape still;
    testing::NamedShape moving;
    std::vector<Judged> poses;
  };
  std::vector<Pair> pairs;
};

SolidPairs::SolidPairs(std::size_t count) : impl_(std::make_unique<Impl>()) {
  testing::RandomGeometry random(83);
  while (impl_->pairs.size() < count) {
    const std::vector<testing::NamedShape> shapes = testing::random_shapes(random);
    const auto any = [&] {
      return shapes[random.index(static_cast<std::uint32_t>(shapes.size()))];
    };
    Impl::Pair pair{any(), any(), {}};
    const double reach_mm = radius_mm(pair.still.shape) + radius_mm(pair.moving.shape);
    const Eigen::Vector3d center = exact_bounds(pair.still.shape).center();
    const Pose apart(random.rotation(), center + 2.0 * reach_mm * random.direction());
    const auto way = testing::nearest(pair.still.shape, testing::placed(pair.moving.shape, apart));
    if (!way || way->distance_mm <= 0.0) continue;
    const Eigen::Vector3d together = way->a - way->b;
    for (const double offset_mm : kOffsets_mm) {
      const Pose X_SM(apart.rotation(),
                      apart.translation() + together - offset_mm * together.normalized());
      const auto gap_mm = judged_gap_mm(pair.still.shape, testing::placed(pair.moving.shape, X_SM));
      if (gap_mm) pair.poses.push_back({X_SM, *gap_mm});
    }
    if (!pair.poses.empty()) impl_->pairs.push_back(std::move(pair));
  }
}

SolidPairs::~SolidPairs() = default;

std::vector<PlacedPair> SolidPairs::faceted(double facet_error_mm) const {
  // Facets are to be as coarse as their error allows, whatever their angle.
  const FacetOptions options{.deflection_mm = facet_error_mm, .angular_deflection_rad = 1.2};
  const auto made = [&](const testing::NamedShape& source) {
    return share(
        element(source.name, facet(source.shape, options).solid, exact_bounds(source.shape)));
  };
  std::vector<PlacedPair> result;
  for (const Impl::Pair& pair : impl_->pairs) {
    PlacedPair placed{kind_of(pair.moving) + " at " + kind_of(pair.still),
                      made(pair.moving),
                      made(pair.still),
                      {},
                      {}};
    for (const Judged& judged : pair.poses) {
      placed.X_SM.push_back(judged.X_SM);
      placed.gaps_mm.push_back(judged.gap_mm);
    }
    result.push_back(std::move(placed));
  }
  return result;
}

}  // namespace dowel::bench
