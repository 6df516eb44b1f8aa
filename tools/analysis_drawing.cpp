#include "analysis_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include <Eigen/Geometry>

#include "table.h"

namespace dowel::tools {
namespace {

constexpr double kMargin_mm = 30.0;
constexpr double kLegend_mm = 40.0;
constexpr double kArrow_mm = 28.0;

std::string number(double value) {
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "%.2f", value == 0.0 ? 0.0 : value);
  return text.data();
}

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : printable(text)) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else {
      result += c;
    }
  }
  return result;
}

/// y points up in the world and down on the page.
std::string at(const Eigen::Vector2d& p) {
  return number(p.x()) + "," + number(-p.y());
}

std::string polygon(const std::vector<Eigen::Vector2d>& corners, const std::string& style) {
  std::string points;
  for (const Eigen::Vector2d& corner : corners) points += (points.empty() ? "" : " ") + at(corner);
  return "<polygon points=\"" + points + "\" class=\"" + style + "\"/>\n";
}

/// A label with a white rim, so that it reads over lines.
std::string label(const Eigen::Vector2d& p, const std::string& text, const std::string& style) {
  return "<text x=\"" + number(p.x()) + "\" y=\"" + number(-p.y()) + "\" class=\"" + style + "\">" +
         escaped(text) + "</text>\n";
}

/// From `tail` to `tip`, with a head.
std::string arrow(const Eigen::Vector2d& tail, const Eigen::Vector2d& tip,
                  const std::string& style) {
  return "<line x1=\"" + number(tail.x()) + "\" y1=\"" + number(-tail.y()) + "\" x2=\"" +
         number(tip.x()) + "\" y2=\"" + number(-tip.y()) + "\" class=\"" + style +
         "\" marker-end=\"url(#head-" + style + ")\"/>\n";
}

/// A force seen along itself: a ring with a point (towards the eye) or a cross (away from it).
std::string straight(const Eigen::Vector2d& p, bool towards_eye, const std::string& style) {
  const std::string ring = "<circle cx=\"" + number(p.x()) + "\" cy=\"" + number(-p.y()) +
                           "\" r=\"6\" class=\"" + style + "\"/>\n";
  if (towards_eye) {
    return ring + "<circle cx=\"" + number(p.x()) + "\" cy=\"" + number(-p.y()) +
           "\" r=\"1.8\" class=\"" + style + " full\"/>\n";
  }
  const double d = 4.2;
  return ring + "<path d=\"M" + at(p + Eigen::Vector2d(-d, -d)) + " L" +
         at(p + Eigen::Vector2d(d, d)) + " M" + at(p + Eigen::Vector2d(-d, d)) + " L" +
         at(p + Eigen::Vector2d(d, -d)) + "\" class=\"" + style + "\"/>\n";
}

/// A force with direction `direction` that acts at `p`.
std::string force(const Eigen::Vector3d& p, const Eigen::Vector3d& direction,
                  const std::string& style) {
  const Eigen::Vector2d flat = direction.head<2>();
  constexpr double kUpright = 0.3;
  if (flat.norm() < kUpright * direction.norm()) {
    return straight(p.head<2>(), direction.z() > 0.0, style);
  }
  const Eigen::Vector2d tip = p.head<2>();
  return arrow(tip - kArrow_mm * flat.normalized(), tip, style);
}

/// Outline from above of the smallest box of a part.
std::vector<Eigen::Vector2d> outline(const Instance& instance, const Element& element) {
  std::vector<Eigen::Vector2d> corners;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d sign((i & 1) != 0 ? 1 : -1, (i & 2) != 0 ? 1 : -1, (i & 4) != 0 ? 1 : -1);
    const Eigen::Vector3d corner =
        element.obb.center + element.obb.axes * element.obb.half_extents_mm.cwiseProduct(sign);
    corners.emplace_back((instance.X_WI * corner).head<2>());
  }
  return convex_polygon(corners);
}

constexpr std::string_view kStyle =
    ".part{fill:none;stroke:#b8bec6;stroke-width:.6}"
    ".work{fill:#dfe8f2;fill-opacity:.55;stroke:#3b5b80;stroke-width:1}"
    ".support{fill:#7fb38a;fill-opacity:.25;stroke:#2c7a3f;stroke-width:.8;stroke-dasharray:4 3}"
    ".locator{fill:none;stroke:#14632a;stroke-width:1.4}.clamp{fill:none;stroke:#b3261e;stroke-"
    "width:1.4}"
    ".load{fill:none;stroke:#7a3fb0;stroke-width:1.4}.full.locator{fill:#14632a}.full.clamp{fill:#"
    "b3261e}"
    ".full.load{fill:#7a3fb0}.mass{fill:none;stroke:#111;stroke-width:1.2}"
    "text{font:7px system-ui,sans-serif;paint-order:stroke;stroke:#fff;stroke-width:2px}"
    ".t-locator{fill:#14632a}.t-clamp{fill:#b3261e}.t-load{fill:#7a3fb0}.t-plain{fill:#333}"
    ".big{font-size:9px}";

std::string heads() {
  std::string defs = "<defs>";
  for (const auto& [style, colour] :
       {std::pair("locator", "#14632a"), std::pair("clamp", "#b3261e"),
        std::pair("load", "#7a3fb0")}) {
    defs += "<marker id=\"head-" + std::string(style) +
            "\" viewBox=\"0 0 8 8\" refX=\"7\" refY=\"4\" markerWidth=\"5\" markerHeight=\"5\" "
            "orient=\"auto\"><path d=\"M0,0 L8,4 L0,8 z\" fill=\"" +
            std::string(colour) + "\"/></marker>";
  }
  return defs + "</defs>\n";
}

std::string newtons(double force_N) {
  return short_number(std::round(force_N)) + " N";
}

std::string contacts(const FixtureAnalysis& analysis, const FixtureDesign& design) {
  std::string svg;
  const Eigen::Vector2d aside(8.0, 3.0);
  for (std::size_t i = 0; i < analysis.model.locators.size(); ++i) {
    const LocatingPoint& point = analysis.model.locators[i];
    svg += force(point.at, point.normal, "locator");
    std::string text = point.name;
    if (analysis.seating) text += " " + newtons(analysis.seating->forces_N[i]);
    svg += label(point.at.head<2>() + aside, text, "t-locator");
  }
  for (const WorkpieceContact& contact : analysis.model.contacts) {
    if (contact.role != Role::Clamp) continue;
    svg += force(contact.at, contact.normal, "clamp");
    const auto given = design.clamp_forces_N.find(contact.instance);
    svg += label(contact.at.head<2>() + aside - Eigen::Vector2d(0.0, 9.0),
                 contact.instance +
                     (given != design.clamp_forces_N.end() ? " " + newtons(given->second) : ""),
                 "t-clamp");
  }
  for (const LoadAnalysis& load : analysis.loads) {
    svg += force(load.load.at, load.load.force_N, "load");
    svg += label(load.load.at.head<2>() + aside,
                 load.name + " " + newtons(load.load.force_N.norm()) + ", holds " +
                     short_number(std::round(10.0 * load.factor) / 10.0) + " times",
                 "t-load");
  }
  return svg;
}

}  // namespace

std::string analysis_drawing(Session& session, const FixtureAnalysis& analysis) {
  const FixtureModel& model = analysis.model;
  Eigen::AlignedBox2d page;
  std::string parts;
  std::string work;
  for (const Instance* instance : session.state().in_order()) {
    const auto corners = outline(*instance, session.element(instance->element));
    for (const Eigen::Vector2d& corner : corners) page.extend(corner);
    const bool is_work = instance->name == model.workpiece;
    (is_work ? work : parts) += polygon(corners, is_work ? "work" : "part");
  }
  page.extend(page.min() - Eigen::Vector2d::Constant(kMargin_mm));
  page.extend(page.max() + Eigen::Vector2d::Constant(kMargin_mm));
  const Eigen::Vector2d size = page.sizes();
  std::string svg = "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"" +
                    number(page.min().x()) + " " + number(-page.max().y()) + " " +
                    number(size.x()) + " " + number(size.y() + kLegend_mm) + "\" width=\"" +
                    number(2.0 * size.x()) + "\" height=\"" +
                    number(2.0 * (size.y() + kLegend_mm)) + "\">\n<style>" + std::string(kStyle) +
                    "</style>\n" + heads() + "<rect x=\"" + number(page.min().x()) + "\" y=\"" +
                    number(-page.max().y()) + "\" width=\"100%\" height=\"100%\" fill=\"#fff\"/>\n";
  svg += parts + work;
  const auto supports = convex_polygon(support_points(model));
  if (supports.size() >= 3) svg += polygon(supports, "support");
  svg += contacts(analysis, session.state().design);
  const Eigen::Vector2d mass = model.center_of_mass.head<2>();
  svg += "<g class=\"mass\"><circle cx=\"" + number(mass.x()) + "\" cy=\"" + number(-mass.y()) +
         "\" r=\"5\"/><path d=\"M" + at(mass - Eigen::Vector2d(7, 0)) + " L" +
         at(mass + Eigen::Vector2d(7, 0)) + " M" + at(mass - Eigen::Vector2d(0, 7)) + " L" +
         at(mass + Eigen::Vector2d(0, 7)) + "\"/></g>\n";
  svg += label(mass + Eigen::Vector2d(8.0, -9.0), "centre of mass", "t-plain");
  const double hundredths = 100.0;
  const std::vector<std::string> legend{
      model.workpiece + " from above, mm; rank " + std::to_string(analysis.locating.rank) +
          ", condition " +
          short_number(std::round(hundredths * analysis.locating.condition) / hundredths),
      "green: locators (dashed: polygon of the supports), red: clamps, violet: loads",
      "a ring with a point: force towards the eye; with a cross: away from it"};
  Eigen::Vector2d line(page.min().x() + 8.0, page.min().y() + 2.0);
  for (const std::string& text : legend) {
    line.y() -= 12.0;
    svg += label(line, text, "t-plain big");
  }
  return svg + "</svg>\n";
}

}  // namespace dowel::tools
