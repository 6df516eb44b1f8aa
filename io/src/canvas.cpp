#include "canvas.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace dowel {
namespace {

using Eigen::Vector3d;

/// Rows of samples above and below the band's own: lines there reach into it.
constexpr int kRim = 2 * kSamples;

/// Half the width of a line, in samples: a line is a little more than a pixel wide.
constexpr double kHalfLine = 0.55 * kSamples;

/// A line lies on the facets that it borders; the samples around it are off by what the facets drop
/// from one sample to the next.
constexpr double kLineSlack = 2.0;

/// An owner passes behind itself where its depth jumps by more samples than this, and by this many
/// times what it changed by just before: a slope, however steep, is no jump.
constexpr double kJump = 8.0;
constexpr double kJumpRatio = 4.0;

constexpr double kSky = 0.62;
constexpr double kGround = 0.30;
constexpr double kKey = 0.50;

constexpr double kNothing = std::numeric_limits<double>::infinity();

/// Twice the signed area of a, b and the point (x, y).
double turn(const Vector3d& a, const Vector3d& b, double x, double y) {
  return (b.x() - a.x()) * (y - a.y()) - (b.y() - a.y()) * (x - a.x());
}

/// First and last integer within [low, high] and [min, max); coordinates may be beyond any int.
struct Range {
  int first;
  int last;
};
Range clamped_range(double low, double high, int min, int max) {
  return {static_cast<int>(std::ceil(std::clamp<double>(low, min, max))),
          static_cast<int>(std::floor(std::clamp<double>(high, min - 1, max - 1)))};
}

std::uint8_t srgb_byte(float linear) {
  const float c = std::clamp(linear, 0.0F, 1.0F);
  const float s = c <= 0.0031308F ? 12.92F * c : 1.055F * std::pow(c, 1.0F / 2.4F) - 0.055F;
  return static_cast<std::uint8_t>(std::lround(255.0F * s));
}

}  // namespace

Canvas::Canvas(std::uint32_t width_px, std::uint32_t first_row, std::uint32_t row_count,
               const CanvasLight& light)
    : width_(static_cast<int>(width_px) * kSamples),
      top_(static_cast<int>(first_row) * kSamples - kRim),
      bottom_(static_cast<int>(first_row + row_count) * kSamples + kRim),
      light_(light),
      samples_(static_cast<std::size_t>(bottom_ - top_) * static_cast<std::size_t>(width_),
               {kNothing, kNothing, Linear::Ones(), 0, 0}) {}

bool Canvas::reaches(double min_y, double max_y) const {
  return max_y >= top_ - kHalfLine && min_y <= bottom_ + kHalfLine;
}

Linear Canvas::shade(const Linear& colour, Vector3d normal) const {
  // Both sides of an open facet are lit.
  if (normal.z() < 0.0) normal = -normal;
  const double sky_share = 0.5 + 0.5 * normal.dot(light_.up);
  const double light =
      kGround + (kSky - kGround) * sky_share + kKey * std::max(0.0, normal.dot(light_.key));
  return static_cast<float>(light) * colour;
}

void Canvas::draw_facet(const std::array<CanvasCorner, 3>& corners, const Linear& colour,
                        std::uint32_t owner) {
  const Vector3d& a = corners[0].position;
  const Vector3d& b = corners[1].position;
  const Vector3d& c = corners[2].position;
  const double area = turn(a, b, c.x(), c.y());
  if (!(std::abs(area) > 0.0)) return;  // seen from its edge
  const bool is_flat =
      corners[0].normal == corners[1].normal && corners[1].normal == corners[2].normal;
  const Linear flat_colour = shade(colour, corners[0].normal);
  // Sample (x, y) stands for the point (x + 0.5, y + 0.5).
  const auto rows = clamped_range(std::min({a.y(), b.y(), c.y()}) - 0.5,
                                  std::max({a.y(), b.y(), c.y()}) - 0.5, top_, bottom_);
  const auto columns = clamped_range(std::min({a.x(), b.x(), c.x()}) - 0.5,
                                     std::max({a.x(), b.x(), c.x()}) - 0.5, 0, width_);
  for (int y = rows.first; y <= rows.last; ++y) {
    for (int x = columns.first; x <= columns.last; ++x) {
      const double wa = turn(b, c, x + 0.5, y + 0.5) / area;
      const double wb = turn(c, a, x + 0.5, y + 0.5) / area;
      const double wc = turn(a, b, x + 0.5, y + 0.5) / area;
      if (wa < 0.0 || wb < 0.0 || wc < 0.0) continue;
      const double depth = wa * a.z() + wb * b.z() + wc * c.z();
      Sample& sample = at(x, y);
      if (!(depth < sample.depth)) continue;
      sample.depth = depth;
      sample.owner = owner;
      sample.colour = flat_colour;
      if (!is_flat) {
        const Vector3d normal =
            wa * corners[0].normal + wb * corners[1].normal + wc * corners[2].normal;
        sample.colour = shade(colour, normal.normalized());
      }
    }
  }
}

/// The sample or one beside it is not nearer than `depth`.
bool Canvas::is_visible(int x, int y, double depth) const {
  for (int j = std::max(y - 1, top_); j <= std::min(y + 1, bottom_ - 1); ++j) {
    for (int i = std::max(x - 1, 0); i <= std::min(x + 1, width_ - 1); ++i) {
      if (depth <= at(i, j).depth + kLineSlack) return true;
    }
  }
  return false;
}

void Canvas::stamp(double x, double y, double depth, std::uint8_t pen) {
  const auto rows = clamped_range(y - kHalfLine - 0.5, y + kHalfLine - 0.5, top_, bottom_);
  const auto columns = clamped_range(x - kHalfLine - 0.5, x + kHalfLine - 0.5, 0, width_);
  for (int j = rows.first; j <= rows.last; ++j) {
    for (int i = columns.first; i <= columns.last; ++i) {
      const double dx = i + 0.5 - x;
      const double dy = j + 0.5 - y;
      Sample& sample = at(i, j);
      if (dx * dx + dy * dy > kHalfLine * kHalfLine || depth >= sample.line_depth) continue;
      sample.line_depth = depth;
      sample.pen = pen;
    }
  }
}

void Canvas::draw_line(const Vector3d& a, const Vector3d& b, std::uint8_t pen) {
  const Vector3d along = b - a;
  const double length = std::max(std::abs(along.x()), std::abs(along.y()));
  // Only what can be seen in the band, so that a line far beyond it costs nothing.
  double from = 0.0;
  double to = 1.0;
  if (!(along.y() == 0.0)) {
    const double enter = (top_ - a.y()) / along.y();
    const double leave = (bottom_ - a.y()) / along.y();
    from = std::max(from, std::min(enter, leave));
    to = std::min(to, std::max(enter, leave));
  } else if (a.y() < top_ || a.y() >= bottom_) {
    return;
  }
  constexpr double kLongest = 0x1p53;  // beyond, a step is no whole number
  if (!(from <= to) || !(length < kLongest)) return;
  // Whole steps from the start of the line, so that bands meet without a seam.
  const double steps = std::max(1.0, std::ceil(length));
  const auto first = static_cast<std::int64_t>(std::ceil(from * steps));
  const auto last = static_cast<std::int64_t>(std::floor(to * steps));
  for (std::int64_t i = first; i <= last; ++i) {
    const Vector3d p = a + static_cast<double>(i) / steps * along;
    if (!(p.x() >= 0.0 && p.x() < width_ && p.y() >= top_ && p.y() < bottom_)) continue;
    const int x = static_cast<int>(std::floor(p.x()));
    const int y = static_cast<int>(std::floor(p.y()));
    if (is_visible(x, y, p.z())) stamp(p.x(), p.y(), p.z(), pen);
  }
}

void Canvas::draw_outlines(std::span<const std::uint8_t> pen_of_owner) {
  struct Step {
    int x;
    int y;
  };
  for (int y = top_ + 1; y + 1 < bottom_; ++y) {
    for (int x = 1; x + 1 < width_; ++x) {
      const Sample& here = at(x, y);
      if (here.owner == 0) continue;
      for (const auto& [dx, dy] : {Step{1, 0}, Step{-1, 0}, Step{0, 1}, Step{0, -1}}) {
        const Sample& next = at(x + dx, y + dy);
        const double jump = next.depth - here.depth;
        if (!(jump > 0.0)) continue;  // the nearer side has the line
        const double before = std::abs(here.depth - at(x - dx, y - dy).depth);
        const bool is_border =
            next.owner != here.owner ? true : jump > kJump && jump > kJumpRatio * before;
        if (!is_border) continue;
        stamp(x + 0.5, y + 0.5, here.depth, pen_of_owner[here.owner]);
        break;
      }
    }
  }
}

double Canvas::depth_at(double x, double y) const {
  if (!(x >= 0.0 && x < width_ && y >= top_ && y < bottom_)) return kNothing;
  return at(static_cast<int>(std::floor(x)), static_cast<int>(std::floor(y))).depth;
}

std::vector<std::uint8_t> Canvas::pixels(std::span<const Linear> pens) const {
  std::vector<std::uint8_t> bytes;
  bytes.reserve(samples_.size() / kSamples / kSamples * 3);
  for (int row = top_ + kRim; row < bottom_ - kRim; row += kSamples) {
    for (int column = 0; column < width_; column += kSamples) {
      Linear sum = Linear::Zero();
      for (int y = row; y < row + kSamples; ++y) {
        for (int x = column; x < column + kSamples; ++x) {
          const Sample& sample = at(x, y);
          sum += sample.line_depth < kNothing ? pens[sample.pen] : sample.colour;
        }
      }
      const Linear mean = sum / static_cast<float>(kSamples * kSamples);
      for (const float component : {mean.x(), mean.y(), mean.z()}) {
        bytes.push_back(srgb_byte(component));
      }
    }
  }
  return bytes;
}

}  // namespace dowel
