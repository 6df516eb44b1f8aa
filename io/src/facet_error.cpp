#include "facet_error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <variant>

#include <BRepAdaptor_Surface.hxx>
#include <gp_Pnt2d.hxx>

#include "occt.h"

namespace dowel {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// Barycentric samples: corners, edge midpoints, centroid, and the middles of the lines from the
/// centroid's side to each corner, because the worst point of a facet is rarely the centroid.
constexpr std::array<std::array<double, 3>, 10> kProbes{{{1, 0, 0},
                                                         {0, 1, 0},
                                                         {0, 0, 1},
                                                         {0.5, 0.5, 0},
                                                         {0, 0.5, 0.5},
                                                         {0.5, 0, 0.5},
                                                         {1.0 / 3, 1.0 / 3, 1.0 / 3},
                                                         {0.5, 0.25, 0.25},
                                                         {0.25, 0.5, 0.25},
                                                         {0.25, 0.25, 0.5}}};

template <class Vector>
Vector combine(const std::array<Vector, 3>& corners, const std::array<double, 3>& weights) {
  return weights[0] * corners[0] + weights[1] * corners[1] + weights[2] * corners[2];
}

std::array<int, 3> nodes_of(const Poly_Triangulation& facets, int triangle) {
  std::array<int, 3> nodes{};
  facets.Triangle(triangle).Get(nodes[0], nodes[1], nodes[2]);
  return nodes;
}

/// Distance from `point` to the surface, from (u, v) by a few Gauss-Newton steps. Every foot point
/// is on the surface, so that the least distance seen bounds the true one from above, and the
/// search may stop as soon as it is below `enough`.
double distance_near(const BRepAdaptor_Surface& surface, const Vector3d& point, Vector2d uv,
                     double enough) {
  constexpr int kSteps = 4;
  double best = std::numeric_limits<double>::infinity();
  for (int step = 0; step <= kSteps && !(best <= enough); ++step) {
    gp_Pnt foot;
    gp_Vec du;
    gp_Vec dv;
    surface.D1(uv.x(), uv.y(), foot, du, dv);
    const Vector3d off = point - to_eigen(foot);
    if (!off.allFinite()) break;
    best = std::min(best, off.norm());
    Eigen::Matrix<double, 3, 2> jacobian;
    jacobian << to_eigen(du), to_eigen(dv);
    const Eigen::Matrix2d normal = jacobian.transpose() * jacobian;
    const double determinant = normal.determinant();
    if (!(determinant > 0.0)) break;
    uv += normal.inverse() * (jacobian.transpose() * off);
    uv.x() = std::clamp(uv.x(), surface.FirstUParameter(), surface.LastUParameter());
    uv.y() = std::clamp(uv.y(), surface.FirstVParameter(), surface.LastVParameter());
  }
  return best;
}

double error_of_other(const TopoDS_Face& face, const Poly_Triangulation& facets,
                      const gp_Trsf& placement) {
  if (!facets.HasUVNodes()) return 0.0;
  const BRepAdaptor_Surface surface(face);
  double worst = 0.0;
  for (int t = 1; t <= facets.NbTriangles(); ++t) {
    const std::array<int, 3> nodes = nodes_of(facets, t);
    std::array<Vector3d, 3> corners;
    std::array<Vector2d, 3> uv;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = to_eigen(facets.Node(nodes[k]).Transformed(placement));
      const gp_Pnt2d at = facets.UVNode(nodes[k]);
      uv[k] = {at.X(), at.Y()};
    }
    for (const auto& weights : kProbes) {
      const double distance =
          distance_near(surface, combine(corners, weights), combine(uv, weights), worst);
      if (std::isfinite(distance)) worst = std::max(worst, distance);
    }
  }
  return worst;
}

}  // namespace

double facet_error_mm(const TopoDS_Face& face, const Poly_Triangulation& facets,
                      const gp_Trsf& placement, const Surface& surface) {
  if (std::holds_alternative<OtherSurface>(surface)) {
    return error_of_other(face, facets, placement);
  }
  double worst = 0.0;
  for (int t = 1; t <= facets.NbTriangles(); ++t) {
    const std::array<int, 3> nodes = nodes_of(facets, t);
    std::array<Vector3d, 3> corners;
    for (std::size_t k = 0; k < 3; ++k) {
      corners[k] = to_eigen(facets.Node(nodes[k]).Transformed(placement));
    }
    for (const auto& weights : kProbes) {
      worst = std::max(worst, std::abs(signed_distance_mm(surface, combine(corners, weights))));
    }
  }
  return worst;
}

double corner_error_mm(const Poly_Triangulation& facets, const gp_Trsf& placement,
                       const Surface& surface) {
  double worst = 0.0;
  for (int n = 1; n <= facets.NbNodes(); ++n) {
    const Vector3d node = to_eigen(facets.Node(n).Transformed(placement));
    worst = std::max(worst, std::abs(signed_distance_mm(surface, node)));
  }
  return worst;
}

}  // namespace dowel
