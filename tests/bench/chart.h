#pragma once

#include <limits>
#include <string>
#include <vector>

namespace dowel::bench {

struct Axis {
  std::string label;  ///< with its unit
  /// Decades that are shown whatever the data; the data may widen them.
  double min = std::numeric_limits<double>::infinity();
  double max = -std::numeric_limits<double>::infinity();
};

struct Mark {
  double x = 0.0;
  double y = 0.0;
  std::string label;    ///< beside the mark; may be empty
  double y_high = 0.0;  ///< a thin line goes up to here; 0: none
};

enum class SeriesStyle { Line, Marks, Front };  ///< Front: steps without marks, in grey

struct Series {
  std::string name;
  std::vector<Mark> marks;
  SeriesStyle style = SeriesStyle::Line;
};

/// A diagram with logarithmic axes: every time and error here spans decades.
struct Chart {
  std::string title;
  std::string subtitle;
  Axis x;
  Axis y;
  /// Names of the places 1, 2, ... on the x axis, which is then not logarithmic.
  std::vector<std::string> categories;
  std::vector<Series> series;
};

/// The chart as an SVG file that follows the reader's light or dark scheme. The same bytes for the
/// same chart. Marks at 0 or below are left out: they have no logarithm.
std::string svg(const Chart& chart);

}  // namespace dowel::bench
