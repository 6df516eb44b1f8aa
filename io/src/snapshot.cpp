#include "dowel/io/snapshot.h"

#include <algorithm>
#include <array>
#include <optional>

#include <Eigen/Geometry>

#include "canvas.h"
#include "display_colour.h"
#include "dowel/io/file.h"
#include "dowel/kernel/box.h"
#include "dowel/kernel/check.h"
#include "png_file.h"
#include "shaded_mesh.h"

namespace dowel {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Part of the picture's width and height that the scene fills.
constexpr double kFill = 0.92;

/// Pixel rows that are drawn at once: keeps the memory of a large picture small.
constexpr std::uint32_t kBandRows = 96;

/// Over the viewer's left shoulder.
const Vector3d& key_light() {
  static const Vector3d light = Vector3d(-0.45, 0.70, 0.65).normalized();
  return light;
}

/// Rotation from the world to the view: rows are right, up and towards the viewer.
Matrix3d view_rotation(View view) {
  Vector3d towards = Vector3d(1.0, -1.0, 1.0).normalized();
  Vector3d up = Vector3d::UnitZ();
  if (view == View::Top) {
    towards = Vector3d::UnitZ();
    up = Vector3d::UnitY();
  } else if (view == View::Front) {
    towards = -Vector3d::UnitY();
  } else if (view == View::Right) {
    towards = Vector3d::UnitX();
  }
  const Vector3d right = up.cross(towards).normalized();
  Matrix3d rotation;
  rotation << right.transpose(), towards.cross(right).transpose(), towards.transpose();
  return rotation;
}

/// Draws a scene band by band.
class Snapshot {
 public:
  Snapshot(const DisplayScene& scene, const SnapshotOptions& options)
      : scene_(scene), options_(options), rotation_(view_rotation(options.view)) {
    meshes_.resize(scene.meshes.size());
    for (const DisplayInstance& instance : scene.instances) {
      auto& mesh = meshes_[instance.mesh];
      if (!mesh) mesh = shade(*scene.meshes[instance.mesh].solid);
    }
    for (const DisplayState state :
         {DisplayState::Normal, DisplayState::Contact, DisplayState::Colliding}) {
      pens_.push_back(linear(line_colour(state)));
    }
    pen_of_owner_.push_back(0);
    for (const DisplayInstance& instance : scene.instances) {
      pen_of_owner_.push_back(static_cast<std::uint8_t>(instance.state));
    }
    fit();
  }

  /// sRGB bytes, three a pixel.
  std::vector<std::uint8_t> draw() const {
    std::vector<std::uint8_t> picture;
    picture.reserve(std::size_t{3} * options_.width_px * options_.height_px);
    for (std::uint32_t row = 0; row < options_.height_px; row += kBandRows) {
      const std::vector<std::uint8_t> band =
          draw_band(row, std::min(kBandRows, options_.height_px - row));
      picture.insert(picture.end(), band.begin(), band.end());
    }
    return picture;
  }

 private:
  static Linear linear(const Colour& srgb) {
    const Colour c = linear_from_srgb(srgb);
    return Eigen::Vector3d(c[0], c[1], c[2]).cast<float>();
  }

  const ShadedMesh& mesh_of(const DisplayInstance& instance) const {
    return *meshes_[instance.mesh];
  }

  /// Finds the scale (samples per mm) and the shift that bring the scene into the picture.
  void fit() {
    Aabb seen;
    for (const DisplayInstance& instance : scene_.instances) {
      Aabb of_instance;
      for (const Vector3d& position : mesh_of(instance).positions) {
        of_instance.extend(rotation_ * (instance.X_WI * position));
      }
      seen_of_instance_.push_back(of_instance);
      if (!of_instance.is_empty()) seen.extend(of_instance);
    }
    if (seen.is_empty()) return;
    const double width = kSamples * static_cast<double>(options_.width_px);
    const double height = kSamples * static_cast<double>(options_.height_px);
    const double share = std::max(seen.size().x() / width, seen.size().y() / height);
    if (share > 0.0) scale_ = kFill / share;
    const Vector3d center = seen.center();
    shift_ = Vector3d(0.5 * width - scale_ * center.x(), 0.5 * height + scale_ * center.y(),
                      scale_ * center.z());
  }

  Vector3d to_samples(const Vector3d& in_view) const {
    return shift_ + scale_ * Vector3d(in_view.x(), -in_view.y(), -in_view.z());
  }

  std::vector<CanvasCorner> place(const DisplayInstance& instance) const {
    const ShadedMesh& mesh = mesh_of(instance);
    const Matrix3d turned = rotation_ * instance.X_WI.rotation_matrix();
    std::vector<CanvasCorner> corners(mesh.positions.size());
    for (std::size_t i = 0; i < corners.size(); ++i) {
      corners[i].position = to_samples(rotation_ * (instance.X_WI * mesh.positions[i]));
      corners[i].normal = turned * mesh.normals[i];
    }
    return corners;
  }

  std::vector<std::uint8_t> draw_band(std::uint32_t first_row, std::uint32_t row_count) const {
    const Vector3d sky = rotation_ * Vector3d::UnitZ();
    Canvas canvas(options_.width_px, first_row, row_count, {key_light(), sky});
    std::vector<std::size_t> here;
    for (std::size_t i = 0; i < scene_.instances.size(); ++i) {
      const Aabb& seen = seen_of_instance_[i];
      if (seen.is_empty()) continue;
      if (canvas.reaches(to_samples(seen.max).y(), to_samples(seen.min).y())) here.push_back(i);
    }
    for (const std::size_t i : here) draw_facets(canvas, i);
    for (const std::size_t i : here) draw_lines(canvas, i);
    canvas.draw_outlines(pen_of_owner_);
    return canvas.pixels(pens_);
  }

  void draw_facets(Canvas& canvas, std::size_t index) const {
    const DisplayInstance& instance = scene_.instances[index];
    const Linear colour =
        linear(surface_colour(scene_.meshes[instance.mesh].colour, instance.state));
    const std::vector<CanvasCorner> corners = place(instance);
    for (const Triangle& t : mesh_of(instance).triangles) {
      canvas.draw_facet({corners[t[0]], corners[t[1]], corners[t[2]]}, colour,
                        static_cast<std::uint32_t>(index) + 1);
    }
  }

  void draw_lines(Canvas& canvas, std::size_t index) const {
    const DisplayInstance& instance = scene_.instances[index];
    const ShadedMesh& mesh = mesh_of(instance);
    const auto pen = static_cast<std::uint8_t>(instance.state);
    const auto at = [&](std::uint32_t position) {
      return to_samples(rotation_ * (instance.X_WI * mesh.positions[position]));
    };
    for (const auto& [a, b] : mesh.lines) canvas.draw_line(at(a), at(b), pen);
  }

  const DisplayScene& scene_;
  SnapshotOptions options_;
  Matrix3d rotation_;
  std::vector<std::optional<ShadedMesh>> meshes_;  ///< of those in use
  std::vector<Aabb> seen_of_instance_;             ///< in the view's frame, mm
  std::vector<Linear> pens_;                       ///< by state
  std::vector<std::uint8_t> pen_of_owner_;         ///< owner i + 1 is instance i
  double scale_ = 1.0;
  Vector3d shift_ = Vector3d::Zero();
};

}  // namespace

std::vector<std::byte> to_png(const DisplayScene& scene, const SnapshotOptions& options) {
  DOWEL_EXPECTS(options.width_px >= 1 && options.width_px <= kMaxSnapshot_px);
  DOWEL_EXPECTS(options.height_px >= 1 && options.height_px <= kMaxSnapshot_px);
  DOWEL_EXPECTS(std::ranges::all_of(scene.instances, [&](const DisplayInstance& instance) {
    return instance.mesh < scene.meshes.size() && scene.meshes[instance.mesh].solid != nullptr;
  }));
  return encode_png(Snapshot(scene, options).draw(), options.width_px, options.height_px);
}

void write_png(const std::filesystem::path& file, const DisplayScene& scene,
               const SnapshotOptions& options) {
  write_file(file, to_png(scene, options));
}

}  // namespace dowel
