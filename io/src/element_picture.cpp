#include "element_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include "canvas.h"
#include "display_colour.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/check.h"
#include "png_file.h"
#include "shaded_mesh.h"

namespace dowel {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector2d;
using Eigen::Vector3d;

constexpr Colour kPlain{0.80, 0.81, 0.83};
constexpr Colour kHole{0.16, 0.47, 0.76};
constexpr Colour kThread{0.87, 0.45, 0.09};
constexpr Colour kSlot{0.18, 0.58, 0.30};
constexpr Colour kShaft{0.55, 0.38, 0.72};
constexpr Colour kLine{0.20, 0.21, 0.24};

/// Part of the picture that the element fills; the rest is room for names.
constexpr double kFill = 0.84;

/// A mark may lie under the surface by what the facets there drop within a pixel.
constexpr double kHiddenBy_px = 1.5;

/// A mouth seen more from its edge than this shows nothing.
constexpr double kEdgeOn = 0.05;

const Vector3d& key_light() {
  static const Vector3d light = Vector3d(-0.45, 0.70, 0.65).normalized();
  return light;
}

/// Rows are right, up and towards the viewer.
Matrix3d view_rotation(SeenFrom from) {
  if (from == SeenFrom::Top) return Matrix3d::Identity();
  const double sign = from == SeenFrom::FrontRightTop ? 1.0 : -1.0;
  const Vector3d towards = sign * Vector3d(1.0, -1.0, 1.0).normalized();
  const Vector3d right = Vector3d::UnitZ().cross(towards).normalized();
  Matrix3d rotation;
  rotation << right.transpose(), towards.cross(right).transpose(), towards.transpose();
  return rotation;
}

Linear linear(const Colour& srgb) {
  const Colour c = linear_from_srgb(srgb);
  return Vector3d(c[0], c[1], c[2]).cast<float>();
}

Colour colour_of(const Feature& feature) {
  if (!feature.thread.empty()) return kThread;
  switch (feature.kind) {
    case FeatureKind::Hole:
      return kHole;
    case FeatureKind::Slot:
      return kSlot;
    case FeatureKind::Shaft:
      return kShaft;
    case FeatureKind::Face:
      break;
  }
  return kPlain;
}

bool faces(const Feature& feature, const Matrix3d& rotation) {
  const double towards_viewer = feature.direction.dot(rotation.row(2).transpose());
  switch (feature.kind) {
    case FeatureKind::Hole:
    case FeatureKind::Slot:
      return towards_viewer < -kEdgeOn;
    case FeatureKind::Face:
      return towards_viewer > kEdgeOn;
    case FeatureKind::Shaft:
      break;
  }
  return true;  // one side of it does
}

double widest_mm(const Feature& hole) {
  double widest_mm = hole.diameter_mm;
  if (!hole.segments.empty()) widest_mm = std::max(widest_mm, hole.segments.front().diameter_mm);
  return widest_mm;
}

class ElementDrawing {
 public:
  ElementDrawing(const Element& element, const FacetedSolid& solid, SeenFrom from,
                 std::uint32_t width_px, std::uint32_t height_px)
      : element_(element),
        solid_(solid),
        width_px_(width_px),
        height_px_(height_px),
        rotation_(view_rotation(from)),
        canvas_(width_px, 0, height_px, {key_light(), rotation_ * Vector3d::UnitZ()}) {
    fit();
  }

  ElementPicture run() && {
    draw_facets();
    ElementPicture picture;
    for (std::size_t i = 0; i < element_.features.size(); ++i) {
      if (auto mark = mark_of(element_.features[i])) {
        mark->feature = i;
        picture.marks.push_back(*mark);
      }
    }
    constexpr std::array<std::uint8_t, 2> kPenOfOwner{0, 0};
    canvas_.draw_outlines(kPenOfOwner);
    const std::array pens{linear(kLine)};
    picture.png = encode_png(canvas_.pixels(pens), width_px_, height_px_);
    return picture;
  }

 private:
  void fit() {
    Aabb seen;
    for (const Vector3d& vertex : solid_.vertices) seen.extend(rotation_ * vertex);
    if (seen.is_empty()) return;
    const double width = kSamples * static_cast<double>(width_px_);
    const double height = kSamples * static_cast<double>(height_px_);
    const double share = std::max(seen.size().x() / width, seen.size().y() / height);
    if (share > 0.0) scale_ = kFill / share;
    const Vector3d center = seen.center();
    shift_ = Vector3d(0.5 * width - scale_ * center.x(), 0.5 * height + scale_ * center.y(),
                      scale_ * center.z());
  }

  /// From the element's frame to samples of the picture.
  Vector3d to_samples(const Vector3d& point) const {
    const Vector3d in_view = rotation_ * point;
    return shift_ + scale_ * Vector3d(in_view.x(), -in_view.y(), -in_view.z());
  }

  /// Colours by face. Where features share one, as a slot and the planes of its walls do, the first
  /// that is no plane counts.
  std::vector<Linear> face_colours() const {
    std::vector<Linear> colours(solid_.faces.size(), linear(kPlain));
    for (auto feature = element_.features.rbegin(); feature != element_.features.rend();
         ++feature) {
      if (feature->kind == FeatureKind::Face) continue;
      for (const std::uint32_t face : feature->faces) {
        if (face < colours.size()) colours[face] = linear(colour_of(*feature));
      }
    }
    return colours;
  }

  void draw_facets() {
    const ShadedMesh mesh = shade(solid_);
    const std::vector<Linear> colours = face_colours();
    std::vector<CanvasCorner> corners(mesh.positions.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      corners[i] = {to_samples(mesh.positions[i]), rotation_ * mesh.normals[i]};
    }
    std::size_t shaded = 0;  // the shaded mesh leaves out facets with two equal corners
    for (std::size_t i = 0; i < solid_.triangles.size(); ++i) {
      const Triangle& t = solid_.triangles[i];
      if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) continue;
      const Triangle& s = mesh.triangles[shaded++];
      canvas_.draw_facet({corners[s[0]], corners[s[1]], corners[s[2]]}, colours[solid_.face_of[i]],
                         1);
    }
    for (const auto& [a, b] : mesh.lines) {
      canvas_.draw_line(corners[a].position, corners[b].position, 0);
    }
  }

  bool is_hidden(const Vector3d& in_samples) const {
    return canvas_.depth_at(in_samples.x(), in_samples.y()) <
           in_samples.z() - kHiddenBy_px * kSamples;
  }

  std::optional<FeatureMark> mark_at(const Vector3d& point, double radius_mm = 0.0) const {
    const Vector3d in_samples = to_samples(point);
    if (is_hidden(in_samples)) return std::nullopt;
    FeatureMark mark;
    mark.at = in_samples.head<2>() / kSamples;
    mark.radius_px = radius_mm * scale_ / kSamples;
    return mark;
  }

  /// Where the feature shows; nothing where it does not.
  std::optional<FeatureMark> mark_of(const Feature& feature) const {
    if (!faces(feature, rotation_)) return std::nullopt;
    if (feature.kind == FeatureKind::Shaft) return mark_of_shaft(feature);
    const bool is_hole = feature.kind == FeatureKind::Hole;
    return mark_at(feature.origin, is_hole ? 0.5 * widest_mm(feature) : 0.0);
  }

  /// The middle of what can be seen of a shaft: half-way along its near side, or its end.
  std::optional<FeatureMark> mark_of_shaft(const Feature& shaft) const {
    const Vector3d towards = rotation_.row(2).transpose();
    const Vector3d across = towards - towards.dot(shaft.direction) * shaft.direction;
    const Vector3d near_side = 0.5 * shaft.diameter_mm * across.normalized();
    for (const double share : {0.5, 0.75, 0.25}) {
      const Vector3d middle = shaft.origin + share * shaft.depth_mm * shaft.direction;
      if (const auto mark = mark_at(middle + near_side)) return mark;
    }
    return mark_at(shaft.origin + shaft.depth_mm * shaft.direction);
  }

  const Element& element_;
  const FacetedSolid& solid_;
  std::uint32_t width_px_;
  std::uint32_t height_px_;
  Matrix3d rotation_;
  Canvas canvas_;
  double scale_ = 1.0;  ///< samples per mm
  Vector3d shift_ = Vector3d::Zero();
};

}  // namespace

bool faces_viewer(const Feature& feature, SeenFrom from) {
  return faces(feature, view_rotation(from));
}

std::string feature_colour(const Feature& feature) {
  return feature.kind == FeatureKind::Face ? "#5b6069" : to_hex(colour_of(feature));
}

ElementPicture draw_element(const Element& element, const FacetedSolid& solid, SeenFrom from,
                            std::uint32_t width_px, std::uint32_t height_px) {
  DOWEL_EXPECTS(width_px > 0 && height_px > 0);
  return ElementDrawing(element, solid, from, width_px, height_px).run();
}

}  // namespace dowel
