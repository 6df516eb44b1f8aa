#include "dowel/io/catalog_sheet.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <optional>
#include <set>
#include <string_view>
#include <utility>
#include <vector>

#include "dowel/io/file.h"
#include "element_picture.h"
#include "html_text.h"
#include "label_layout.h"
#include "sheet_text.h"

namespace dowel {
namespace {

constexpr std::uint32_t kPictureWidth_px = 460;
constexpr std::uint32_t kPictureHeight_px = 345;

constexpr std::string_view kStyle = R"(
:root{color-scheme:light}
*{box-sizing:border-box}
body{margin:0 auto;max-width:1560px;padding:20px 24px 60px;color:#1d2026;background:#fff;
 font:14px/1.45 system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif}
h1{font-size:24px;margin:0 0 4px}
h2{font-size:18px;margin:32px 0 10px;padding-bottom:4px;border-bottom:2px solid #1d2026}
.about{color:#5b6069;margin:0 0 10px}
nav a{display:inline-block;margin:0 14px 4px 0;color:#1a5fa8;text-decoration:none}
.legend span{margin-right:16px;white-space:nowrap}
i.dot{display:inline-block;width:10px;height:10px;border-radius:50%;margin-right:5px}
.grid{display:grid;grid-template-columns:repeat(auto-fill,minmax(min(420px,100%),1fr));gap:16px}
article{border:1px solid #d5d8dd;border-radius:6px;overflow:hidden;break-inside:avoid;
 content-visibility:auto;contain-intrinsic-size:480px 640px}
.pictures{display:flex;justify-content:center;background:#fff;border-bottom:1px solid #e6e8eb}
.pictures svg{flex:1 1 50%;min-width:0;max-width:460px;height:auto}
.text{padding:8px 14px 12px}
h3{font-size:15px;margin:0}
h3 small{font-weight:400;color:#5b6069;margin-left:6px}
dl{display:grid;grid-template-columns:max-content 1fr;gap:0 12px;margin:6px 0}
dt{color:#5b6069}
dd{margin:0;overflow-wrap:anywhere}
ul{list-style:none;margin:6px 0 0;padding:6px 0 0;border-top:1px solid #e6e8eb}
li{padding-left:15px;text-indent:-15px}
li b{font-weight:600}
li.faces{color:#5b6069}
text{font-family:system-ui,"Segoe UI",Roboto,"DejaVu Sans",sans-serif;font-weight:600;
 text-anchor:middle;dominant-baseline:central;paint-order:stroke;stroke:#fff;stroke-width:2.2px;
 stroke-linejoin:round}
@media print{body{padding:0}nav{display:none}.grid{gap:8px}}
)";

std::string in_picture(double px) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f", px);
  return text;
}

/// Names of holes, shafts and slots must be there; those of faces where there is room.
std::vector<Label> labels_of(const Element& element, const std::vector<FeatureMark>& marks) {
  std::vector<Label> labels;
  for (const bool faces : {false, true}) {
    for (const FeatureMark& mark : marks) {
      const Feature& feature = element.features[mark.feature];
      if ((feature.kind == FeatureKind::Face) != faces) continue;
      labels.push_back({feature.name, mark.at, mark.radius_px, !faces});
    }
  }
  return labels;
}

class Sheet {
 public:
  Sheet(const Catalog& catalog, std::span<const Element> elements)
      : catalog_(catalog), elements_(elements) {}

  /// Nothing where the callback stops it.
  std::optional<std::string> run(const SheetCallback& on_element) && {
    std::vector<std::pair<std::string, std::vector<const Element*>>> families;
    for (const Element& element : elements_) {
      auto family = std::ranges::find(families, element.family,
                                      &std::pair<std::string, std::vector<const Element*>>::first);
      if (family == families.end()) {
        family = families.insert(family, {element.family, {}});
      }
      family->second.push_back(&element);
    }
    add_head();
    if (families.size() > 1) {
      html_ += "<nav>";
      for (std::size_t i = 0; i < families.size(); ++i) {
        html_ += "<a href=\"#family-" + std::to_string(i) + "\">" + title_of(families[i].first) +
                 " (" + std::to_string(families[i].second.size()) + ")</a>";
      }
      html_ += "</nav>\n";
    }
    std::size_t done = 0;
    for (std::size_t i = 0; i < families.size(); ++i) {
      html_ += "<h2 id=\"family-" + std::to_string(i) + "\">" + title_of(families[i].first) +
               "</h2>\n<div class=\"grid\">\n";
      for (const Element* const element : families[i].second) {
        add_element(*element);
        if (on_element && !on_element(++done, elements_.size())) return std::nullopt;
      }
      html_ += "</div>\n";
    }
    html_ += "</body></html>\n";
    return std::move(html_);
  }

 private:
  static std::string title_of(const std::string& family) {
    return family.empty() ? "Without a family" : escaped_html(family);
  }

  void add_head() {
    const std::string title = escaped_html(catalog_.file().filename().string());
    html_ += "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">\n<title>" + title +
             "</title>\n<meta name=\"viewport\" content=\"width=device-width\">\n<style>";
    html_ += kStyle;
    html_ += "</style></head><body>\n<h1>" + title + "</h1>\n<p class=\"about\">" +
             std::to_string(elements_.size()) + (elements_.size() == 1 ? " element" : " elements") +
             "; lengths in mm.</p>\n<p class=\"legend\">";
    Feature thread;
    thread.thread = "M12";
    add_key(thread, "thread, stated or likely");
    Feature other;
    for (const auto& [kind, text] :
         {std::pair(FeatureKind::Hole, "hole"), std::pair(FeatureKind::Shaft, "shaft"),
          std::pair(FeatureKind::Slot, "slot"), std::pair(FeatureKind::Face, "planar face")}) {
      other.kind = kind;
      add_key(other, text);
    }
    html_ += "</p>\n";
  }

  void add_key(const Feature& feature, const char* text) {
    html_ += "<span>" + dot(feature) + text + "</span>";
  }

  static std::string dot(const Feature& feature) {
    return "<i class=\"dot\" style=\"background:" + feature_colour(feature) + "\"></i>";
  }

  void add_element(const Element& element) {
    const auto solid = catalog_.solid(element.name);
    const auto draw = [&](SeenFrom corner) {
      return draw_element(element, *solid, corner, kPictureWidth_px, kPictureHeight_px);
    };
    ElementPicture front = draw(SeenFrom::FrontRightTop);
    std::set<std::size_t> shown;
    for (const FeatureMark& mark : front.marks) shown.insert(mark.feature);
    html_ += "<article><div class=\"pictures\">";
    if (is_crowded(element, front)) {
      const ElementPicture plan = draw(SeenFrom::Top);
      std::set<std::size_t> in_plan;
      for (const FeatureMark& mark : plan.marks) in_plan.insert(mark.feature);
      std::erase_if(front.marks, [&](const auto& mark) {
        return in_plan.contains(mark.feature) && is_hole(element, mark);
      });
      shown.insert(in_plan.begin(), in_plan.end());
      add_picture(element, plan, "from above");
    }
    add_picture(element, front, "from the front, right and above");
    if (may_show_more(element, SeenFrom::BackLeftBottom, shown)) {
      const ElementPicture back = draw(SeenFrom::BackLeftBottom);
      const bool shows_more = std::ranges::any_of(back.marks, [&](const FeatureMark& mark) {
        return !is_face(element, mark) && !shown.contains(mark.feature);
      });
      if (shows_more) add_picture(element, back, "from the back, left and below");
    }
    html_ += "</div>\n<div class=\"text\">";
    add_text(element);
    html_ += "</div></article>\n";
  }

  static bool is_hole(const Element& element, const FeatureMark& mark) {
    return element.features[mark.feature].kind == FeatureKind::Hole;
  }

  static bool is_face(const Element& element, const FeatureMark& mark) {
    return element.features[mark.feature].kind == FeatureKind::Face;
  }

  /// Whether the picture shows so many holes that open upwards that a plan reads better.
  static bool is_crowded(const Element& element, const ElementPicture& picture) {
    constexpr std::ptrdiff_t kMostNames = 20;
    return std::ranges::count_if(picture.marks, [&](const FeatureMark& mark) {
             return is_hole(element, mark) &&
                    faces_viewer(element.features[mark.feature], SeenFrom::Top);
           }) > kMostNames;
  }

  /// Whether something but a planar face that was not shown turns towards there.
  static bool may_show_more(const Element& element, SeenFrom from,
                            const std::set<std::size_t>& shown) {
    for (std::size_t i = 0; i < element.features.size(); ++i) {
      const Feature& feature = element.features[i];
      if (feature.kind == FeatureKind::Face || shown.contains(i)) continue;
      if (faces_viewer(feature, from)) return true;
    }
    return false;
  }

  void add_picture(const Element& element, const ElementPicture& picture, const char* from) {
    const std::string width = std::to_string(kPictureWidth_px);
    const std::string height = std::to_string(kPictureHeight_px);
    html_ += "<svg viewBox=\"0 0 " + width + " " + height + "\" role=\"img\" aria-label=\"" +
             escaped_html(element.name) + " " + from + "\"><image width=\"" + width +
             "\" height=\"" + height + "\" decoding=\"async\" href=\"data:image/png;base64," +
             base64(picture.png) + "\"/>";
    const std::vector<Label> labels = labels_of(element, picture.marks);
    const std::vector<PlacedLabel> placed =
        place_labels(labels, kPictureWidth_px, kPictureHeight_px);
    for (const PlacedLabel& place : placed) {
      if (!place.has_leader) continue;
      const Eigen::Vector2d& at = labels[place.label].at;
      html_ += "<line x1=\"" + in_picture(at.x()) + "\" y1=\"" + in_picture(at.y()) + "\" x2=\"" +
               in_picture(place.center.x()) + "\" y2=\"" + in_picture(place.center.y()) +
               "\" stroke=\"#33363d\" stroke-width=\".7\"/>";
    }
    for (const PlacedLabel& place : placed) {
      const Label& label = labels[place.label];
      const Feature* const feature = element.find_feature(label.text);
      html_ += "<text x=\"" + in_picture(place.center.x()) + "\" y=\"" +
               in_picture(place.center.y()) + "\" font-size=\"" + in_picture(place.font_px) +
               "\" fill=\"" + feature_colour(*feature) + "\">" + escaped_html(label.text) +
               "</text>";
    }
    html_ += "</svg>";
  }

  void add_text(const Element& element) {
    const std::size_t slash = element.name.rfind('/');
    html_ += "<h3>" + escaped_html(element.name.substr(slash == element.name.npos ? 0 : slash + 1));
    if (!element.description.empty()) {
      html_ += "<small>" + escaped_html(element.description) + "</small>";
    }
    html_ += "</h3>\n<dl>";
    for (const auto& [title, value] : element_facts(element)) {
      html_ += "<dt>" + title + "</dt><dd>" + escaped_html(value) + "</dd>";
    }
    html_ += "</dl>\n<ul>";
    for (const FeatureGroup& group : feature_groups(element)) {
      const std::size_t count = group.members.size();
      html_ += "<li>" + dot(element.features[group.members.front()]) +
               (count > 1 ? std::to_string(count) + " × " : "") + escaped_html(group.description) +
               ": <b>" + escaped_html(member_names(element, group)) + "</b></li>";
    }
    for (const BoltCircle& circle : element.bolt_circles) {
      html_ += "<li>bolt circle ⌀" + sheet_number(circle.diameter_mm) + ": <b>";
      for (const std::string& hole : circle.holes) html_ += escaped_html(hole) + " ";
      html_ += "</b></li>";
    }
    add_faces(element);
    html_ += "</ul>";
  }

  void add_faces(const Element& element) {
    std::string names;
    for (const Feature& feature : element.features) {
      if (feature.kind == FeatureKind::Face) names += " " + escaped_html(feature.name);
    }
    if (!names.empty()) html_ += "<li class=\"faces\">planar faces:" + names + "</li>";
  }

  const Catalog& catalog_;
  std::span<const Element> elements_;
  std::string html_;
};

}  // namespace

std::string to_sheet(const Catalog& catalog, std::span<const Element> elements,
                     const SheetCallback& on_element) {
  return Sheet(catalog, elements).run(on_element).value_or("");
}

void write_sheet(const std::filesystem::path& file, const Catalog& catalog,
                 std::span<const Element> elements, const SheetCallback& on_element) {
  if (const auto html = Sheet(catalog, elements).run(on_element)) write_file(file, *html);
}

}  // namespace dowel
