#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace dowel {

/// Samples along one side of a pixel.
inline constexpr int kSamples = 3;

using Linear = Eigen::Vector3f;  ///< colour in linear light, 0..1

struct CanvasLight {
  Eigen::Vector3d key;  ///< unit, towards the lamp
  Eigen::Vector3d up;   ///< unit, towards the sky
};

/// A corner of a facet. `position`: x to the right and y down in samples of the picture, z away
/// from the viewer in the same unit. `normal`: x to the right, y up, z towards the viewer; unit.
struct CanvasCorner {
  Eigen::Vector3d position;
  Eigen::Vector3d normal;
};

/// A band of a picture, kSamples x kSamples samples a pixel, drawn with a depth buffer. Facets
/// first, then lines and outlines, then the pixels are read.
class Canvas {
 public:
  /// Pixel rows [first_row, first_row + row_count) of a picture that is `width_px` wide.
  Canvas(std::uint32_t width_px, std::uint32_t first_row, std::uint32_t row_count,
         const CanvasLight& light);

  /// True where something between these y (in samples) could be seen here.
  bool reaches(double min_y, double max_y) const;

  /// `owner`: what the facet belongs to, not 0; outlines run between owners.
  void draw_facet(const std::array<CanvasCorner, 3>& corners, const Linear& colour,
                  std::uint32_t owner);

  /// The part of the segment that no facet hides.
  void draw_line(const Eigen::Vector3d& a, const Eigen::Vector3d& b, std::uint8_t pen);

  /// Lines along the borders of what one owner shows, and where it passes behind itself.
  /// `pen_of_owner[owner]`.
  void draw_outlines(std::span<const std::uint8_t> pen_of_owner);

  /// Depth of the nearest facet there; infinite where there is none or beyond the band. In samples.
  double depth_at(double x, double y) const;

  /// sRGB bytes of the band's pixels, three a pixel, row by row. `pens`: colours of the lines.
  std::vector<std::uint8_t> pixels(std::span<const Linear> pens) const;

 private:
  struct Sample {
    double depth;
    double line_depth;  ///< of the nearest line over the sample
    Linear colour;
    std::uint32_t owner;
    std::uint8_t pen;
  };

  Sample& at(int x, int y) { return samples_[index(x, y)]; }
  const Sample& at(int x, int y) const { return samples_[index(x, y)]; }
  std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(y - top_) * static_cast<std::size_t>(width_) +
           static_cast<std::size_t>(x);
  }
  Linear shade(const Linear& colour, Eigen::Vector3d normal) const;
  bool is_visible(int x, int y, double depth) const;
  void stamp(double x, double y, double depth, std::uint8_t pen);

  int width_;   ///< samples in a row
  int top_;     ///< first row of samples, the rim included
  int bottom_;  ///< beyond the last row of samples, the rim included
  CanvasLight light_;
  std::vector<Sample> samples_;
};

}  // namespace dowel
