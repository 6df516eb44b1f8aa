#include "shaded_mesh.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <utility>
#include <variant>

#include "dowel/kernel/check.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

using Eigen::Vector3d;

/// Corner of a facet: `3 * triangle + k`.
using Corner = std::uint32_t;

/// Twice the area times the unit normal; zero for a facet without area.
Vector3d area_vector(const std::array<Vector3d, 3>& corners) {
  return (corners[1] - corners[0]).cross(corners[2] - corners[0]);
}

Vector3d unit_or_zero(const Vector3d& v) {
  const double length = v.norm();
  return length > 0.0 ? Vector3d(v / length) : Vector3d::Zero();
}

bool is_drawable(const Triangle& t) {
  return t[0] != t[1] && t[1] != t[2] && t[2] != t[0];
}

/// Outward unit normal of a face with an exact surface, at one corner of a facet.
Vector3d exact_normal(const Face& face, const Vector3d& point, const Vector3d& facet_center) {
  const auto* cone = std::get_if<ConeSurface>(&face.surface);
  // All directions of the cone meet at its apex: there the facet's own middle stands for them.
  const bool at_apex = cone != nullptr && (point - cone->apex).norm() <= kCoincident_mm;
  const Vector3d gradient = distance_gradient(face.surface, at_apex ? facet_center : point);
  return face.reversed ? Vector3d(-gradient) : gradient;
}

void expect_sound_indices(const FacetedSolid& solid) {
  DOWEL_EXPECTS(solid.face_of.size() == solid.triangles.size());
  const auto vertex_count = solid.vertices.size();
  const auto face_count = solid.faces.size();
  DOWEL_EXPECTS(std::ranges::all_of(solid.face_of, [&](auto face) { return face < face_count; }));
  DOWEL_EXPECTS(std::ranges::all_of(solid.triangles, [&](const Triangle& t) {
    return std::ranges::all_of(t, [&](auto vertex) { return vertex < vertex_count; });
  }));
  DOWEL_EXPECTS(
      std::ranges::all_of(solid.vertices, [](const Vector3d& v) { return v.allFinite(); }));
}

/// Builds the corners of one solid: equal position, face and normal share an index.
class Shader {
 public:
  explicit Shader(const FacetedSolid& solid)
      : solid_(solid), normal_of_corner_(3 * solid.triangles.size(), Vector3d::Zero()) {}

  ShadedMesh run() {
    find_facet_normals();
    for_each_fan([this](std::span<const Corner> fan) { find_corner_normals(fan); });
    for_each_fan([this](std::span<const Corner> fan) { share_corners(fan); });
    for (std::size_t t = 0; t < solid_.triangles.size(); ++t) {
      if (is_drawable(solid_.triangles[t])) {
        mesh_.triangles.push_back({index_[3 * t], index_[3 * t + 1], index_[3 * t + 2]});
      }
    }
    note_tangent_faces();
    find_lines();
    return std::move(mesh_);
  }

 private:
  std::uint32_t vertex_of(Corner corner) const { return solid_.triangles[corner / 3][corner % 3]; }
  std::uint32_t face_of(Corner corner) const { return solid_.face_of[corner / 3]; }

  void find_facet_normals() {
    area_vectors_.reserve(solid_.triangles.size());
    for (std::uint32_t t = 0; t < solid_.triangles.size(); ++t) {
      area_vectors_.push_back(area_vector(solid_.corners(t)));
    }
    for (std::uint32_t t = 0; t < solid_.triangles.size(); ++t) {
      if (!is_drawable(solid_.triangles[t])) continue;
      for (std::uint32_t k = 0; k < 3; ++k) corners_.push_back(3 * t + k);
    }
    std::ranges::sort(corners_, {}, [this](Corner c) {
      return std::array{vertex_of(c), face_of(c), c};
    });
    index_.resize(3 * solid_.triangles.size());
  }

  /// Calls `visit` with the corners that one face has at one vertex.
  template <class Visit>
  void for_each_fan(const Visit& visit) const {
    for (std::size_t begin = 0; begin < corners_.size();) {
      std::size_t end = begin + 1;
      while (end < corners_.size() && vertex_of(corners_[end]) == vertex_of(corners_[begin]) &&
             face_of(corners_[end]) == face_of(corners_[begin])) {
        ++end;
      }
      visit(std::span(corners_).subspan(begin, end - begin));
      begin = end;
    }
  }

  void find_corner_normals(std::span<const Corner> fan) {
    const Face& face = solid_.faces[face_of(fan.front())];
    const Vector3d& point = solid_.vertices[vertex_of(fan.front())];
    if (std::holds_alternative<OtherSurface>(face.surface)) {
      for (const Corner corner : fan) normal_of_corner_[corner] = smooth_normal(fan, corner);
      return;
    }
    for (const Corner corner : fan) {
      const auto [a, b, c] = solid_.corners(corner / 3);
      normal_of_corner_[corner] = exact_normal(face, point, (a + b + c) / 3.0);
    }
  }

  /// Mean over the facets of `fan` that turn less than a crease from the facet of `corner`, by
  /// area.
  Vector3d smooth_normal(std::span<const Corner> fan, Corner corner) const {
    const Vector3d own = unit_or_zero(area_vectors_[corner / 3]);
    Vector3d sum = Vector3d::Zero();
    for (const Corner other : fan) {
      const Vector3d& candidate = area_vectors_[other / 3];
      // A facet without area has no normal of its own and takes what its neighbours have.
      if (own.isZero(0.0) || own.dot(candidate) >= std::cos(kCrease_rad) * candidate.norm()) {
        sum += candidate;
      }
    }
    Vector3d mean = unit_or_zero(sum);
    if (!mean.isZero(0.0)) return mean;
    return own.isZero(0.0) ? Vector3d(Vector3d::UnitZ()) : own;
  }

  void share_corners(std::span<const Corner> fan) {
    const std::size_t first = mesh_.positions.size();
    for (const Corner corner : fan) {
      const Vector3d& normal = normal_of_corner_[corner];
      const auto known = std::find(mesh_.normals.begin() + static_cast<std::ptrdiff_t>(first),
                                   mesh_.normals.end(), normal);
      index_[corner] = static_cast<std::uint32_t>(known - mesh_.normals.begin());
      if (known == mesh_.normals.end()) {
        mesh_.positions.push_back(solid_.vertices[vertex_of(corner)]);
        mesh_.normals.push_back(normal);
      }
    }
  }

  /// One side of a facet: its vertices, lower index first, and the corner that it starts from.
  struct Side {
    std::array<std::uint32_t, 2> vertices;
    Corner corner;
  };

  static Corner next(Corner corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

  Corner corner_at(const Side& side, std::uint32_t vertex) const {
    return vertex_of(side.corner) == vertex ? side.corner : next(side.corner);
  }

  void find_lines() {
    std::vector<Side> sides;
    sides.reserve(corners_.size());
    for (const Corner corner : corners_) {
      const auto [low, high] = std::minmax({vertex_of(corner), vertex_of(next(corner))});
      sides.push_back({{low, high}, corner});
    }
    std::ranges::sort(sides, {}, [](const Side& side) {
      return std::array{side.vertices[0], side.vertices[1], side.corner};
    });
    for (std::size_t begin = 0; begin < sides.size();) {
      std::size_t end = begin + 1;
      while (end < sides.size() && sides[end].vertices == sides[begin].vertices) ++end;
      if (is_line(std::span(sides).subspan(begin, end - begin))) {
        const Side& side = sides[begin];
        mesh_.lines.push_back(
            {index_[corner_at(side, side.vertices[0])], index_[corner_at(side, side.vertices[1])]});
      }
      begin = end;
    }
    std::ranges::sort(mesh_.lines);
  }

  bool is_line(std::span<const Side> sides) const {
    if (sides.size() != 2) return true;
    const auto face_a = face_of(sides[0].corner);
    const auto face_b = face_of(sides[1].corner);
    if (face_a == face_b && has_exact_surface(face_a)) return false;
    if (!is_tangent(sides[0], sides[1])) return true;
    // A tangent border is worth a line where a plane runs into a fillet, not where an exporter has
    // cut one cylinder into halves.
    return solid_.faces[face_a].surface.index() != solid_.faces[face_b].surface.index();
  }

  bool has_exact_surface(std::uint32_t face) const {
    return !std::holds_alternative<OtherSurface>(solid_.faces[face].surface);
  }

  bool is_tangent(const Side& a, const Side& b) const {
    const auto face_a = face_of(a.corner);
    const auto face_b = face_of(b.corner);
    const auto [low, high] = std::minmax({face_a, face_b});
    const auto known = is_tangent_.find({low, high});
    if (known != is_tangent_.end()) return known->second;
    // Normals that come from facets are off by as much as neighbouring facets turn.
    const bool exact = has_exact_surface(face_a) && has_exact_surface(face_b);
    const double limit = std::cos(exact ? kTangent_rad : kCrease_rad);
    return std::ranges::all_of(a.vertices, [&](auto vertex) {
      return normal_of_corner_[corner_at(a, vertex)].dot(normal_of_corner_[corner_at(b, vertex)]) >=
             limit;
    });
  }

  /// Collects what the solid itself says of its edges; two faces that meet at several edges, some
  /// tangent and some not, are left to their normals.
  void note_tangent_faces() {
    std::set<std::array<std::uint32_t, 2>> undecided;
    for (const Edge& edge : solid_.edges) {
      const bool smooth = edge.convexity == Convexity::Smooth;
      const auto [known, is_new] = is_tangent_.emplace(edge.faces, smooth);
      if (edge.convexity == Convexity::Unknown || (!is_new && known->second != smooth)) {
        undecided.insert(edge.faces);
      }
    }
    for (const auto& faces : undecided) is_tangent_.erase(faces);
  }

  const FacetedSolid& solid_;
  std::vector<Corner> corners_;  ///< of drawable facets, by vertex, then face
  std::vector<Vector3d> area_vectors_;
  std::vector<Vector3d> normal_of_corner_;
  std::vector<std::uint32_t> index_;                         ///< of each corner among the positions
  std::map<std::array<std::uint32_t, 2>, bool> is_tangent_;  ///< by face pair, where it is known
  ShadedMesh mesh_;
};

}  // namespace

ShadedMesh shade(const FacetedSolid& solid) {
  expect_sound_indices(solid);
  return Shader(solid).run();
}

}  // namespace dowel
