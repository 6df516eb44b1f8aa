#include "contact_patch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>

#include "dowel/assembly/restraint.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

/// Planes that are tilted by less touch as planes: kCoaxial_rad, 0.01 mm over 100 mm.
constexpr double kFlat_rad = kCoaxial_rad;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A polygon in the plane, of at most a triangle cut by a triangle.
using Polygon = std::vector<Eigen::Vector2d>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// The part of `polygon` on the left of the line from `from` to `to` (Sutherland and Hodgman).
Polygon left_of(const Polygon& polygon, const Eigen::Vector2d& from, const Eigen::Vector2d& to) {
  Polygon result;
  const Eigen::Vector2d way = to - from;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Eigen::Vector2d& p = polygon[i];
    const Eigen::Vector2d& q = polygon[(i + 1) % polygon.size()];
    const double at_p = cross(way, p - from);
    const double at_q = cross(way, q - from);
    if (at_p >= 0.0) result.push_back(p);
    if ((at_p > 0.0 && at_q < 0.0) || (at_p < 0.0 && at_q > 0.0)) {
      result.push_back(p + at_p / (at_p - at_q) * (q - p));
    }
  }
  return result;
}

struct PlaneFrame {
  Eigen::Vector3d origin;
  Eigen::Vector3d x;
  Eigen::Vector3d y;
  Eigen::Vector3d normal;

  Eigen::Vector2d flat(const Eigen::Vector3d& p) const {
    return {x.dot(p - origin), y.dot(p - origin)};
  }
  Eigen::Vector3d in_space(const Eigen::Vector2d& p) const {
    return origin + p.x() * x + p.y() * y;
  }
};

PlaneFrame frame_of(const PlaneSurface& plane_W) {
  const Eigen::Vector3d x = plane_W.normal.unitOrthogonal();
  return {plane_W.origin, x, plane_W.normal.cross(x), plane_W.normal};
}

struct FlatTriangle {
  std::array<Eigen::Vector2d, 3> corners;  // counter-clockwise
  Eigen::AlignedBox2d box;
};

struct PlanarFace {
  std::uint32_t face = 0;
  PlaneSurface plane_W;
};

std::vector<PlanarFace> planar_faces(const FacetedSolid& solid, const Pose& X_WS) {
  std::vector<PlanarFace> faces;
  for (std::uint32_t i = 0; i < solid.faces.size(); ++i) {
    const auto* const plane = std::get_if<PlaneSurface>(&solid.faces[i].surface);
    if (plane == nullptr) continue;
    faces.push_back({i, {X_WS * plane->origin, X_WS.rotation() * plane->normal}});
  }
  return faces;
}

/// Facets of the faces, flat in `frame`: those that reach into `within`.
std::vector<FlatTriangle> flattened(const FacetedSolid& solid, const Pose& X_WS,
                                    const std::vector<std::uint32_t>& faces,
                                    const PlaneFrame& frame, const Eigen::AlignedBox2d& within) {
  std::vector<bool> is_wanted(solid.faces.size(), false);
  for (const std::uint32_t face : faces) is_wanted[face] = true;
  // A base plate has tens of thousands of facets: the plane's axes go to them, not they to it.
  const Eigen::Matrix3d R_SW = X_WS.rotation().toRotationMatrix().transpose();
  const Eigen::Vector3d x_S = R_SW * frame.x;
  const Eigen::Vector3d y_S = R_SW * frame.y;
  const Eigen::Vector2d origin = frame.flat(X_WS.translation());
  std::vector<FlatTriangle> result;
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    if (!is_wanted[solid.face_of[t]]) continue;
    FlatTriangle flat;
    const auto corners = solid.corners(t);
    for (std::size_t i = 0; i < 3; ++i) {
      flat.corners[i] = origin + Eigen::Vector2d(x_S.dot(corners[i]), y_S.dot(corners[i]));
      flat.box.extend(flat.corners[i]);
    }
    if (!flat.box.intersects(within)) continue;
    if (cross(flat.corners[1] - flat.corners[0], flat.corners[2] - flat.corners[0]) < 0.0) {
      std::swap(flat.corners[1], flat.corners[2]);
    }
    result.push_back(flat);
  }
  return result;
}

Eigen::AlignedBox2d extent_of(const std::vector<FlatTriangle>& triangles) {
  Eigen::AlignedBox2d extent;
  for (const FlatTriangle& triangle : triangles) extent.extend(triangle.box);
  return extent;
}

ContactPatch overlap(const std::vector<FlatTriangle>& a, const std::vector<FlatTriangle>& b,
                     const PlaneFrame& frame) {
  ContactPatch patch;
  patch.normal_W = frame.normal;
  const Eigen::AlignedBox2d reach = extent_of(b);
  Eigen::Vector2d moment = Eigen::Vector2d::Zero();
  Polygon all;
  for (const FlatTriangle& first : a) {
    if (!first.box.intersects(reach)) continue;
    for (const FlatTriangle& second : b) {
      if (!first.box.intersects(second.box)) continue;
      Polygon piece(first.corners.begin(), first.corners.end());
      for (std::size_t i = 0; i < 3 && !piece.empty(); ++i) {
        piece = left_of(piece, second.corners[i], second.corners[(i + 1) % 3]);
      }
      for (std::size_t i = 2; i < piece.size(); ++i) {
        const double area_mm2 = 0.5 * cross(piece[i - 1] - piece[0], piece[i] - piece[0]);
        patch.area_mm2 += area_mm2;
        moment += area_mm2 / 3.0 * (piece[0] + piece[i - 1] + piece[i]);
      }
      all.insert(all.end(), piece.begin(), piece.end());
    }
  }
  // Faces that meet in an edge alone share rounding.
  if (patch.area_mm2 <= kCoincident_mm * kCoincident_mm) return {};
  patch.at_W = frame.in_space(moment / patch.area_mm2);
  for (const Eigen::Vector2d& corner : convex_polygon(all)) {
    patch.corners_W.push_back(frame.in_space(corner));
  }
  return patch;
}

double distance2_to_triangle(const Eigen::Vector3d& p, const std::array<Eigen::Vector3d, 3>& t) {
  const Eigen::Vector3d n = (t[1] - t[0]).cross(t[2] - t[0]);
  const double n2 = n.squaredNorm();
  bool inside = n2 > 0.0;
  double best = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < 3; ++i) {
    const Eigen::Vector3d way = t[(i + 1) % 3] - t[i];
    if (inside && n.cross(way).dot(p - t[i]) < 0.0) inside = false;
    const double length2 = way.squaredNorm();
    const double share = length2 > 0.0 ? std::clamp(way.dot(p - t[i]) / length2, 0.0, 1.0) : 0.0;
    best = std::min(best, (t[i] + share * way - p).squaredNorm());
  }
  if (inside) {
    const double off = n.dot(p - t[0]);
    best = std::min(best, off * off / n2);
  }
  return best;
}

/// Outward normals, in the world, of the faces that have a facet next to `p_W`: no farther than the
/// nearest one by what facets are off.
std::vector<Eigen::Vector3d> normals_near(const FacetedSolid& solid, const Pose& X_WS,
                                          const Eigen::Vector3d& p_W) {
  const Eigen::Vector3d p = X_WS.inverse() * p_W;
  std::vector<double> nearest(solid.faces.size(), std::numeric_limits<double>::infinity());
  std::vector<std::uint32_t> facet(solid.faces.size(), 0);
  for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
    const double distance2 = distance2_to_triangle(p, solid.corners(t));
    if (distance2 >= nearest[solid.face_of[t]]) continue;
    nearest[solid.face_of[t]] = distance2;
    facet[solid.face_of[t]] = t;
  }
  const double least = std::sqrt(*std::ranges::min_element(nearest));
  std::vector<Eigen::Vector3d> normals;
  for (std::uint32_t f = 0; f < solid.faces.size(); ++f) {
    const Face& face = solid.faces[f];
    if (std::sqrt(nearest[f]) > least + face.facet_error_mm + kDefaultTolerance_mm) continue;
    Eigen::Vector3d normal;
    if (std::holds_alternative<OtherSurface>(face.surface)) {
      const auto corners = solid.corners(facet[f]);
      normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalized();
    } else {
      normal = distance_gradient(face.surface, p);
      if (face.reversed) normal = -normal;
    }
    normals.emplace_back(X_WS.rotation() * normal);
  }
  return normals;
}

/// The normal at a point: of the faces of A and B there, the two that look at each other best.
Eigen::Vector3d normal_at(const FacetedSolid& a, const Pose& X_WA, const FacetedSolid& b,
                          const Pose& X_WB, const Eigen::Vector3d& p_W) {
  const auto out_of_a = normals_near(a, X_WA, p_W);
  const auto out_of_b = normals_near(b, X_WB, p_W);
  Eigen::Vector3d best = Eigen::Vector3d::UnitZ();
  double best_dot = std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& n_A : out_of_a) {
    for (const Eigen::Vector3d& n_B : out_of_b) {
      if (n_A.dot(n_B) >= best_dot) continue;
      best_dot = n_A.dot(n_B);
      best = (n_A - n_B).normalized();
    }
  }
  return best;
}

}  // namespace

std::vector<ContactPatch> plane_patches(const FacetedSolid& a, const Pose& X_WA,
                                        const FacetedSolid& b, const Pose& X_WB,
                                        double tolerance_mm) {
  const std::vector<PlanarFace> faces_A = planar_faces(a, X_WA);
  const std::vector<PlanarFace> faces_B = planar_faces(b, X_WB);
  struct SharedPlane {
    PlaneSurface plane_W;
    std::vector<std::uint32_t> of_a;
    std::vector<std::uint32_t> of_b;
  };
  std::vector<SharedPlane> planes;
  const auto lies_on = [&](const PlaneSurface& plane, const PlaneSurface& other, double sense) {
    return sense * plane.normal.dot(other.normal) > 0.0 &&
           plane.normal.cross(other.normal).norm() <= kFlat_rad &&
           std::abs(plane.normal.dot(other.origin - plane.origin)) <=
               tolerance_mm + kFlat_rad * (other.origin - plane.origin).norm();
  };
  for (const PlanarFace& first : faces_A) {
    for (const PlanarFace& second : faces_B) {
      if (!lies_on(first.plane_W, second.plane_W, -1.0)) continue;
      auto known = std::ranges::find_if(planes, [&](const SharedPlane& plane) {
        return lies_on(plane.plane_W, first.plane_W, 1.0);
      });
      if (known == planes.end()) known = planes.insert(planes.end(), {first.plane_W, {}, {}});
      const auto add = [](std::vector<std::uint32_t>& faces, std::uint32_t face) {
        if (std::ranges::find(faces, face) == faces.end()) faces.push_back(face);
      };
      add(known->of_a, first.face);
      add(known->of_b, second.face);
    }
  }
  const Eigen::AlignedBox2d everywhere(Eigen::Vector2d::Constant(-kInfinity),
                                       Eigen::Vector2d::Constant(kInfinity));
  std::vector<ContactPatch> patches;
  for (const SharedPlane& plane : planes) {
    const PlaneFrame frame = frame_of(plane.plane_W);
    // The smaller of the two tells which facets of the larger matter.
    std::vector<FlatTriangle> flat_a;
    std::vector<FlatTriangle> flat_b;
    if (a.triangles.size() <= b.triangles.size()) {
      flat_a = flattened(a, X_WA, plane.of_a, frame, everywhere);
      flat_b = flattened(b, X_WB, plane.of_b, frame, extent_of(flat_a));
    } else {
      flat_b = flattened(b, X_WB, plane.of_b, frame, everywhere);
      flat_a = flattened(a, X_WA, plane.of_a, frame, extent_of(flat_b));
    }
    ContactPatch patch = overlap(flat_a, flat_b, frame);
    if (patch.area_mm2 > 0.0) patches.push_back(std::move(patch));
  }
  std::ranges::stable_sort(patches, std::ranges::greater{}, &ContactPatch::area_mm2);
  return patches;
}

std::vector<ContactPatch> contact_patches(const FacetedSolid& a, const Pose& X_WA,
                                          const FacetedSolid& b, const Pose& X_WB,
                                          double tolerance_mm, const Eigen::Vector3d& witness_W) {
  std::vector<ContactPatch> patches = plane_patches(a, X_WA, b, X_WB, tolerance_mm);
  if (patches.empty()) {
    patches.push_back({witness_W, normal_at(a, X_WA, b, X_WB, witness_W), 0.0, {}});
  }
  return patches;
}

}  // namespace dowel
