#include "calipers.h"

#include "dowel/kernel/check.h"

namespace dowel {
namespace {

/// A caliper: a corner that is extreme in a direction which only ever turns counter-clockwise.
class Caliper {
 public:
  explicit Caliper(std::span<const Eigen::Vector2d> polygon) : polygon_(polygon) {}

  /// Largest extent along `direction`. Goes on over ties, so that rounding cannot stop it, and
  /// around once at most.
  double reach(const Eigen::Vector2d& direction) {
    double best = direction.dot(polygon_[at_]);
    for (std::size_t steps = 0; steps < polygon_.size(); ++steps) {
      const std::size_t next = at_ + 1 == polygon_.size() ? 0 : at_ + 1;
      const double value = direction.dot(polygon_[next]);
      if (value < best) break;
      best = value;
      at_ = next;
    }
    return best;
  }

 private:
  std::span<const Eigen::Vector2d> polygon_;
  std::size_t at_ = 0;
};

}  // namespace

std::vector<FlushRectangle> flush_rectangles(std::span<const Eigen::Vector2d> polygon) {
  DOWEL_EXPECTS(polygon.size() >= 2);
  const std::size_t n = polygon.size();
  std::vector<FlushRectangle> result;
  result.reserve(n);
  Caliper front(polygon);
  Caliper top(polygon);
  Caliper back(polygon);
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d& start = polygon[i];
    const Eigen::Vector2d along = (polygon[(i + 1) % n] - start).normalized();
    const Eigen::Vector2d up(-along.y(), along.x());
    if (i == 0) {
      // The first corner of the first edge is no extreme in its own directions: each caliper
      // starts from the one before it.
      front.reach(along);
      top = front;
      top.reach(up);
      back = top;
    }
    const double length = front.reach(along) + back.reach(-along);
    const double height = top.reach(up) - up.dot(start);
    result.push_back({along, length * height});
  }
  return result;
}

}  // namespace dowel
