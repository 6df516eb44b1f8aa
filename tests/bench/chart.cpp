#include "chart.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <string_view>

namespace dowel::bench {

namespace {

// All lengths of the picture are in its own units, one a pixel at full size.
constexpr double kWidth = 920.0;
constexpr double kHeight = 540.0;
constexpr double kLeft = 86.0;
constexpr double kRight = 690.0;
constexpr double kTop = 78.0;
constexpr double kBottom = 472.0;
constexpr double kLegend = 716.0;
constexpr double kMark = 4.5;

/// Colours that keep apart for the colour-blind too (after Okabe and Ito), for light and dark.
constexpr std::array<std::array<const char*, 2>, 9> kColours{{{"#c2410c", "#fb923c"},
                                                              {"#7c2d12", "#fdba74"},
                                                              {"#a16207", "#fde047"},
                                                              {"#0369a1", "#38bdf8"},
                                                              {"#15803d", "#4ade80"},
                                                              {"#7e22ce", "#c084fc"},
                                                              {"#be185d", "#f472b6"},
                                                              {"#0f766e", "#2dd4bf"},
                                                              {"#475569", "#cbd5e1"}}};

constexpr const char* kStyle =
    "text{font-family:system-ui,'DejaVu Sans',Helvetica,Arial,sans-serif;fill:#1f2937}"
    ".paper{fill:#ffffff}.title{font-size:19px;font-weight:600}"
    ".sub{font-size:13px;fill:#4b5563}.axis{font-size:14px}.tick{font-size:13px}"
    ".note{font-size:11px;fill:#4b5563}.grid{stroke:#e5e7eb;stroke-width:1}"
    ".minor{stroke:#9ca3af;stroke-width:1}"
    ".frame{stroke:#6b7280;stroke-width:1;fill:none}"
    ".line{fill:none;stroke-width:2;stroke-linejoin:round}.span{stroke-width:1.4}"
    ".front{fill:none;stroke:#9ca3af;stroke-width:7;stroke-linejoin:round;stroke-opacity:.45}";

constexpr const char* kDarkStyle =
    "text{fill:#e5e7eb}.paper{fill:#0d1117}.sub,.note{fill:#9ca3af}.grid{stroke:#2b3340}"
    ".minor{stroke:#6b7280}.frame{stroke:#8b949e}.front{stroke:#8b949e}";

std::string number(double value) {
  char buffer[32];
  (void)std::snprintf(buffer, sizeof buffer, "%.1f", value);
  return buffer;
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else {
      result += c;
    }
  }
  return result;
}

/// 0.001 to 1000 as they are, other powers of ten as such.
std::string power_of_ten(int exponent) {
  if (exponent >= 0 && exponent <= 3) return std::to_string(std::lround(std::pow(10.0, exponent)));
  if (exponent < 0 && exponent >= -3) {
    return "0." + std::string(static_cast<std::size_t>(-exponent - 1), '0') + "1";
  }
  constexpr std::array kDigits{"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string result = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) {
    result += kDigits.at(static_cast<std::size_t>(digit - '0'));
  }
  return result;
}

/// One axis of the picture: from values to places.
struct Scale {
  double low = 0.0;  // decades, or places
  double high = 1.0;
  double from = 0.0;
  double to = 1.0;
  bool is_log = true;

  double at(double value) const {
    const double v = is_log ? std::log10(value) : value;
    return from + (to - from) * (v - low) / (high - low);
  }
};

Scale decades(double min, double max, double from, double to) {
  const double low = std::floor(std::log10(min) + 1.0e-9);
  const double high = std::max(std::ceil(std::log10(max) - 1.0e-9), low + 1.0);
  return {low, high, from, to, true};
}

class Drawing {
 public:
  explicit Drawing(const Chart& chart) : chart_(chart) {
    Axis x = chart.x;
    Axis y = chart.y;
    for (const Series& series : chart.series) {
      for (const Mark& mark : series.marks) {
        if (!is_shown(mark)) continue;
        x.min = std::min(x.min, mark.x);
        x.max = std::max(x.max, mark.x);
        y.min = std::min(y.min, mark.y);
        y.max = std::max({y.max, mark.y, mark.y_high});
      }
    }
    if (!(y.min <= y.max)) y.min = y.max = x.min = x.max = 1.0;
    y_ = decades(y.min, y.max, kBottom, kTop);
    if (chart.categories.empty()) {
      x_ = decades(x.min, x.max, kLeft, kRight);
    } else {
      x_ = {0.5, 0.5 + static_cast<double>(chart.categories.size()), kLeft, kRight, false};
    }
  }

  std::string draw() {
    begin();
    draw_axes();
    for (const Series& series : chart_.series) {
      if (series.style == SeriesStyle::Front) draw_front(series);
    }
    double legend_y = kTop + 10.0;
    std::size_t index = 0;
    for (const Series& series : chart_.series) {
      if (series.style == SeriesStyle::Front) {
        out_ += "<path class=\"front\" d=\"M" + number(kLegend - 12.0) + ' ' + number(legend_y) +
                "h24\"/>";
      } else {
        draw_series(series, index);
        mark_at(kLegend, legend_y, index++);
      }
      text("axis", kLegend + 18.0, legend_y + 5.0, "start", series.name);
      legend_y += 25.0;
    }
    return out_ + "</svg>\n";
  }

 private:
  bool is_shown(const Mark& mark) const {
    return mark.y > 0.0 && (mark.x > 0.0 || !chart_.categories.empty());
  }

  void begin() {
    const std::string size = number(kWidth) + ' ' + number(kHeight);
    out_ = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 " + size + "\" width=\"" +
           number(kWidth) + "\" height=\"" + number(kHeight) + "\" role=\"img\">\n<title>" +
           escaped(chart_.title) + "</title>\n<style>" + kStyle;
    std::string dark = kDarkStyle;
    for (std::size_t i = 0; i < kColours.size(); ++i) {
      for (const std::size_t scheme : {0U, 1U}) {
        const std::string rule = ".s" + std::to_string(i) + "{stroke:" + kColours.at(i)[scheme] +
                                 "}.f" + std::to_string(i) + "{fill:" + kColours.at(i)[scheme] +
                                 "}";
        (scheme == 0 ? out_ : dark) += rule;
      }
    }
    out_ += "@media (prefers-color-scheme:dark){" + dark +
            "}</style>\n<rect class=\"paper\" width=\"" + number(kWidth) + "\" height=\"" +
            number(kHeight) + "\"/>\n";
    text("title", kLeft - 62.0, 30.0, "start", chart_.title);
    text("sub", kLeft - 62.0, 52.0, "start", chart_.subtitle);
  }

  void text(const char* style, double x, double y, const char* anchor, std::string_view words,
            const char* more = "") {
    out_ += std::string("<text class=\"") + style + "\" x=\"" + number(x) + "\" y=\"" + number(y) +
            "\" text-anchor=\"" + anchor + "\"" + more + ">" + escaped(words) + "</text>\n";
  }

  void line(const char* style, double x1, double y1, double x2, double y2) {
    out_ += std::string("<path class=\"") + style + "\" d=\"M" + number(x1) + ' ' + number(y1) +
            'L' + number(x2) + ' ' + number(y2) + "\"/>\n";
  }

  void draw_axes() {
    for (int decade = static_cast<int>(y_.low); decade <= static_cast<int>(y_.high); ++decade) {
      const double y = y_.at(std::pow(10.0, decade));
      line("grid", kLeft, y, kRight, y);
      text("tick", kLeft - 10.0, y + 4.5, "end", power_of_ten(decade));
    }
    if (chart_.categories.empty()) {
      const bool is_crowded = x_.high - x_.low > 9.0;
      const int first = static_cast<int>(x_.low);
      for (int decade = first; decade <= static_cast<int>(x_.high); ++decade) {
        const double x = x_.at(std::pow(10.0, decade));
        line("grid", x, kTop, x, kBottom);
        if (is_crowded && (decade - first) % 2 != 0) continue;
        text("tick", x, kBottom + 20.0, "middle", power_of_ten(decade));
      }
      draw_minor_ticks();
    } else {
      for (std::size_t i = 0; i < chart_.categories.size(); ++i) {
        const double place = static_cast<double>(i) + 1.0;
        text("tick", x_.at(place), kBottom + 20.0, "middle", chart_.categories[i]);
        if (i > 0) line("grid", x_.at(place - 0.5), kTop, x_.at(place - 0.5), kBottom);
      }
    }
    out_ += "<path class=\"frame\" d=\"M" + number(kLeft) + ' ' + number(kTop) + 'V' +
            number(kBottom) + 'H' + number(kRight) + "\"/>\n";
    text("axis", 0.5 * (kLeft + kRight), kBottom + 46.0, "middle", chart_.x.label);
    const std::string turn = " transform=\"rotate(-90 22 " + number(0.5 * (kTop + kBottom)) + ")\"";
    text("axis", 22.0, 0.5 * (kTop + kBottom), "middle", chart_.y.label, turn.c_str());
  }

  /// At 2 to 9 of each decade: they show that the axis is logarithmic.
  void draw_minor_ticks() {
    for (int decade = static_cast<int>(x_.low); decade < static_cast<int>(x_.high); ++decade) {
      for (int digit = 2; digit <= 9; ++digit) {
        const double x = x_.at(digit * std::pow(10.0, decade));
        line("minor", x, kBottom, x, kBottom - 4.0);
      }
    }
    for (int decade = static_cast<int>(y_.low); decade < static_cast<int>(y_.high); ++decade) {
      for (int digit = 2; digit <= 9; ++digit) {
        const double y = y_.at(digit * std::pow(10.0, decade));
        line("minor", kLeft, y, kLeft + 4.0, y);
      }
    }
  }

  /// A shape and a colour of its own for each series.
  void mark_at(double x, double y, std::size_t index) {
    const std::string fill = "f" + std::to_string(index % kColours.size());
    const auto shape = [&](const std::string& path) {
      out_ += "<path class=\"" + fill + "\" d=\"" + path + "\"/>\n";
    };
    const auto at = [&](double dx, double dy) { return number(x + dx) + ' ' + number(y + dy); };
    switch (index % 5) {
      case 0:
        out_ += "<circle class=\"" + fill + "\" cx=\"" + number(x) + "\" cy=\"" + number(y) +
                "\" r=\"" + number(kMark) + "\"/>\n";
        break;
      case 1:
        shape("M" + at(-kMark, -kMark) + "L" + at(kMark, -kMark) + "L" + at(kMark, kMark) + "L" +
              at(-kMark, kMark) + "Z");
        break;
      case 2:
        shape("M" + at(0, -1.3 * kMark) + "L" + at(1.2 * kMark, kMark) + "L" +
              at(-1.2 * kMark, kMark) + "Z");
        break;
      case 3:
        shape("M" + at(0, -1.4 * kMark) + "L" + at(1.4 * kMark, 0) + "L" + at(0, 1.4 * kMark) +
              "L" + at(-1.4 * kMark, 0) + "Z");
        break;
      default:
        shape("M" + at(0, 1.3 * kMark) + "L" + at(1.2 * kMark, -kMark) + "L" +
              at(-1.2 * kMark, -kMark) + "Z");
    }
  }

  void draw_series(const Series& series, std::size_t index) {
    const std::string stroke = "s" + std::to_string(index % kColours.size());
    std::string path;
    for (const Mark& mark : series.marks) {
      if (!is_shown(mark)) continue;
      path += path.empty() ? 'M' : 'L';
      path += number(x_.at(mark.x)) + ' ' + number(y_.at(mark.y));
    }
    if (series.style == SeriesStyle::Line && !path.empty()) {
      out_ += "<path class=\"line " + stroke + "\" d=\"" + path + "\"/>\n";
    }
    for (const Mark& mark : series.marks) {
      if (!is_shown(mark)) continue;
      const double x = x_.at(mark.x);
      if (mark.y_high > mark.y) {
        line(("span " + stroke).c_str(), x, y_.at(mark.y), x, y_.at(mark.y_high));
      }
      mark_at(x, y_.at(mark.y), index);
      if (!mark.label.empty()) {
        text("note", x + 8.0, y_.at(mark.y) - 7.0, "start", mark.label);
      }
    }
  }

  void draw_front(const Series& series) {
    std::string path;
    double last_y = 0.0;
    for (const Mark& mark : series.marks) {
      if (!is_shown(mark)) continue;
      const std::string x = number(x_.at(mark.x));
      if (path.empty()) {
        path = "M" + x + ' ' + number(y_.at(mark.y));
      } else {
        path += "L" + x + ' ' + number(last_y) + "L" + x + ' ' + number(y_.at(mark.y));
      }
      last_y = y_.at(mark.y);
    }
    if (!path.empty()) out_ += "<path class=\"front\" d=\"" + path + "\"/>\n";
  }

  const Chart& chart_;
  Scale x_;
  Scale y_;
  std::string out_;
};

}  // namespace

std::string svg(const Chart& chart) {
  return Drawing(chart).draw();
}

}  // namespace dowel::bench
