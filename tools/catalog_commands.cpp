// dowel catalog list, show, search, lint.

#include "catalog_commands.h"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "commands.h"
#include "dowel/catalog/catalog.h"
#include "dowel/catalog/lint.h"
#include "dowel/catalog/search.h"
#include "dowel/kernel/error.h"
#include "element_json.h"
#include "json.h"
#include "progress.h"
#include "table.h"

namespace dowel::tools {
namespace {

using Align = Table::Align;

constexpr const char* kRed = "31";
constexpr const char* kYellow = "33";

Catalog open(const std::string& file) {
  return Catalog(file, Catalog::Access::ReadOnly);
}

std::string size_text(const Element& element) {
  const Eigen::Vector3d size = box_size_mm(element);
  return short_number(size.x()) + " x " + short_number(size.y()) + " x " + short_number(size.z());
}

/// Coordinates to a tenth of a micrometre, so that rounding does not show.
std::string point_text(const Eigen::Vector3d& point) {
  constexpr double kSteps_per_mm = 1.0e4;
  std::string text;
  for (const double coordinate : point) {
    // Adding zero turns a negative zero into zero.
    const double rounded = std::round(coordinate * kSteps_per_mm) / kSteps_per_mm + 0.0;
    text += (text.empty() ? "" : ", ") + short_number(rounded);
  }
  return text;
}

// ---- list and search ---------------------------------------------------------------------------

void print_elements(const std::vector<Element>& elements, bool json) {
  if (json) {
    for (const Element& element : elements) print_line(to_line(to_summary_json(element)));
    return;
  }
  Table table({{"name"},
               {"family"},
               {"shape"},
               {"size in mm", Align::Right},
               {"holes", Align::Right},
               {"shafts", Align::Right}});
  for (const Element& element : elements) {
    table.add({element.name, element.family, std::string(to_string(element.shape)),
               size_text(element), std::to_string(count_features(element, FeatureKind::Hole)),
               std::to_string(count_features(element, FeatureKind::Shaft))});
  }
  if (!elements.empty()) print_line(table.text());
  print_line(counted(elements.size(), "element"));
}

void add_list(CLI::App& catalog) {
  struct Arguments {
    std::string file;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = catalog.add_subcommand("list", "Lists all elements.");
  command->add_option("CATALOG.db", arguments->file)->required();
  command->add_flag("--json", arguments->json, "one line of JSON an element");
  command->callback([arguments] {
    // The search for nothing finds everything, by name.
    print_elements(search(open(arguments->file), {}), arguments->json);
  });
}

void add_search(CLI::App& catalog) {
  struct Arguments {
    std::string file;
    std::vector<std::string> terms;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = catalog.add_subcommand(
      "search",
      "Lists the elements that match all terms: words in the name, family, role, description, "
      "shape, "
      "material or features; comparisons of length, width, height, hole, shaft, slot, diameter, "
      "depth, circle (mm), holes, volume (mm3) or mass (kg) with numbers; thread=M12, hole=M12 (or "
      "hole M12), shaft=M12, fit=H7, role=clamp, material=steel.");
  command->footer("Example: dowel catalog search elements.db \"riser height>=80 hole M12\"");
  command->add_option("CATALOG.db", arguments->file)->required();
  command
      ->add_option("TERM", arguments->terms, "riser, 'height>=80', hole=12, d=10..16, \"hole M12\"")
      ->required();
  command->add_flag("--json", arguments->json, "one line of JSON an element");
  command->callback([arguments] {
    const SearchQuery query = parse_query(arguments->terms);
    const Catalog elements = open(arguments->file);
    const std::vector<Element> found = search(elements, query);
    print_elements(found, arguments->json);
    if (!found.empty()) return;
    for (const std::string& reason : explain_no_match(elements, query)) {
      std::cerr << printable(reason) << '\n';
    }
  });
}

// ---- show --------------------------------------------------------------------------------------

[[noreturn]] void fail_to_find(const Catalog& catalog, const std::string& name) {
  std::string message = catalog.file().string() + ": has no element \"" + printable(name) + "\"";
  std::string guesses;
  for (const std::string& guess : catalog.similar_names(name)) {
    guesses += (guesses.empty() ? "\"" : "\" or \"") + printable(guess);
  }
  if (!guesses.empty()) message += "; did you mean " + guesses + "\"?";
  throw Error(ErrorCode::NotFound, message);
}

std::string describe(const SlotShape& slot) {
  std::string text(to_string(slot.type));
  if (slot.nominal_mm != 0) text += " " + std::to_string(slot.nominal_mm) + " (ISO 299)";
  text += ", " + short_number(slot.length_mm) + " along " + point_text(slot.run) + ", ends " +
          std::string(to_string(slot.ends[0])) + " and " + std::string(to_string(slot.ends[1]));
  if (slot.type == SlotShape::Type::Tee) {
    text += "; throat " + short_number(slot.throat_depth_mm) + " deep, undercut " +
            short_number(slot.undercut_width_mm) + " x " + short_number(slot.undercut_height_mm);
  }
  return text;
}

std::string describe(const OutlineLoop& loop) {
  const auto count = [&loop](OutlineEdge::Type type) {
    return static_cast<std::size_t>(std::ranges::count(loop, type, &OutlineEdge::type));
  };
  const std::size_t arcs = count(OutlineEdge::Type::Arc);
  if (loop.size() == 1 && arcs == 1) return "a circle of " + short_number(2.0 * loop[0].radius_mm);
  std::string text;
  const auto add = [&text](std::size_t number, const char* what) {
    if (number > 0) text += (text.empty() ? "" : ", ") + counted(number, what);
  };
  add(count(OutlineEdge::Type::Line), "line");
  add(arcs, "arc");
  add(count(OutlineEdge::Type::Chord), "chord");
  return text;
}

std::string describe(const FaceOutline& outline) {
  std::string text = outline.on_hull ? "on the hull" : "";
  if (outline.outer.empty()) return text;
  text += std::string(text.empty() ? "" : "; ") + "bounded by " + describe(outline.outer);
  if (!outline.inner.empty()) text += ", " + counted(outline.inner.size(), "cutout");
  return text;
}

std::string describe(const Feature& feature) {
  std::string text;
  switch (feature.kind) {
    case FeatureKind::Hole:
      text = feature.through ? "through" : "blind";
      if (!feature.blind_end.empty()) text += " (" + feature.blind_end + ")";
      if (!feature.entry.empty()) text += " from " + feature.entry;
      for (const HoleSegment& segment : feature.segments) {
        text +=
            "; " + std::string(to_string(segment.type)) + " " + short_number(segment.diameter_mm);
        if (segment.type == HoleSegment::Type::Cone) {
          text += " to " + short_number(segment.diameter_end_mm);
        }
        text += " at " + short_number(segment.from_mm) + ".." + short_number(segment.to_mm);
      }
      break;
    case FeatureKind::Face:
      text = short_number(feature.area_mm2) + " mm2";
      break;
    case FeatureKind::Slot:
      if (feature.slot) text = describe(*feature.slot);
      if (!feature.entry.empty()) text += " from " + feature.entry;
      break;
    case FeatureKind::Shaft:
      break;
  }
  const auto add = [&text](const std::string& word) {
    if (!word.empty()) text += (text.empty() ? "" : "; ") + printable(word);
  };
  add(feature.thread_is_guess ? "likely " + feature.thread : feature.thread);
  add(feature.fit);
  add(feature.use);
  return text;
}

std::string circles_text(const Element& element) {
  std::string text;
  for (const BoltCircle& circle : element.bolt_circles) {
    text += "bolt circle of " + short_number(circle.diameter_mm) + " about " +
            point_text(circle.center) + ": " + counted(circle.holes.size(), "hole") + " of " +
            short_number(circle.hole_diameter_mm) + ",";
    for (const std::string& hole : circle.holes) text += " " + printable(hole);
    text += "\n";
  }
  return text.empty() ? text : "\n" + text;
}

std::string material_text(const Element& element) {
  if (element.material.empty()) return "not stated";
  const std::optional<double> mass_kg = element.mass_kg();
  return element.material + (mass_kg ? ", " + short_number(*mass_kg) + " kg" : "");
}

std::string stated(const std::string& text) {
  return text.empty() ? "not stated" : text;
}

std::string features_text(const Element& element, const std::vector<FaceOutline>& outlines) {
  Table table({{"feature"},
               {"kind"},
               {"diameter", Align::Right},
               {"depth", Align::Right},
               {"at"},
               {"direction"},
               {""}});
  auto outline = outlines.begin();
  for (const Feature& feature : element.features) {
    const bool has_diameter = feature.kind != FeatureKind::Face;
    std::string text = describe(feature);
    if (!has_diameter) text += "; " + describe(*outline++);
    table.add({feature.name, std::string(to_string(feature.kind)),
               has_diameter ? short_number(feature.diameter_mm) : "",
               has_diameter ? short_number(feature.depth_mm) : "", point_text(feature.origin),
               point_text(feature.direction), std::move(text)});
  }
  return table.text();
}

std::string to_text(const Element& element, const std::vector<FaceOutline>& outlines) {
  const TriangleCounts& triangles = element.triangles;
  const std::vector<std::pair<const char*, std::string>> lines{
      {"name", element.name},
      {"family", element.family},
      {"role", stated(element.role)},
      {"description", stated(element.description)},
      {"dimensions by", stated(element.dimensions_by)},
      {"material", material_text(element)},
      {"shape", std::string(to_string(element.shape))},
      {"size", size_text(element) + " mm"},
      {"volume", short_number(element.volume_mm3) + " mm3"},
      {"surface", short_number(element.surface_mm2) + " mm2"},
      {"centre of mass", point_text(element.center_of_mass)},
      {"solids", std::to_string(element.solids)},
      {"triangles", std::to_string(triangles.total) + " (" + std::to_string(triangles.plane) +
                        " plane, " + std::to_string(triangles.hole) + " hole, " +
                        std::to_string(triangles.other) + " other), within " +
                        short_number(element.facet_error_mm) + " mm"},
      {"source", element.source + " (" + element.unit_in_file + ")"},
      {"sha256", element.sha256},
      {"licence", element.licence.empty() ? "not recorded" : element.licence}};
  std::string text;
  for (const auto& [title, value] : lines) {
    std::string padded(title);
    padded.resize(16, ' ');
    text += (value.empty() ? title : padded + printable(value)) + "\n";
  }
  return text + "\n" + features_text(element, outlines) + circles_text(element);
}

void add_show(CLI::App& catalog) {
  struct Arguments {
    std::string file;
    std::string name;
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command =
      catalog.add_subcommand("show", "Shows one element with its sizes and features.");
  command->add_option("CATALOG.db", arguments->file)->required();
  command->add_option("NAME", arguments->name, "of the element")->required();
  command->add_flag("--json", arguments->json, "one line of JSON");
  command->callback([arguments] {
    const Catalog elements = open(arguments->file);
    const std::optional<Element> element = elements.find(arguments->name);
    if (!element) fail_to_find(elements, arguments->name);
    const std::vector<FaceOutline> outlines =
        face_outlines(*elements.solid(arguments->name), element->features);
    print_line(arguments->json ? to_line(tools::to_json(*element, outlines))
                               : to_text(*element, outlines));
  });
}

// ---- lint --------------------------------------------------------------------------------------

Json to_json(const LintFinding& finding) {
  Json json;
  json["rule"] = finding.rule;
  json["severity"] = to_string(finding.severity);
  json["element"] = finding.element;
  json["message"] = finding.message;
  return json;
}

std::string to_text(const LintFinding& finding) {
  const bool is_error = finding.severity == LintFinding::Severity::Error;
  return coloured(to_string(finding.severity), is_error ? kRed : kYellow) + " " + finding.rule +
         "  " + printable(finding.element) + ": " + printable(finding.message);
}

int run_lint(const std::string& file, bool json, LintFinding::Severity gate) {
  const Catalog elements = open(file);
  const std::vector<LintFinding> findings = lint(elements);
  for (const LintFinding& finding : findings) {
    print_line(json ? to_line(to_json(finding)) : to_text(finding));
  }
  const std::size_t checked = elements.names().size();
  const auto errors = static_cast<std::size_t>(
      std::ranges::count(findings, LintFinding::Severity::Error, &LintFinding::severity));
  const std::size_t warnings = findings.size() - errors;
  if (json) {
    Json summary;
    summary["elements"] = checked;
    summary["errors"] = errors;
    summary["warnings"] = warnings;
    Json line;
    line["summary"] = std::move(summary);
    print_line(to_line(line));
  } else {
    print_line(counted(checked, "element") + ": " + counted(errors, "error") + ", " +
               counted(warnings, "warning"));
  }
  const bool has_findings = gate == LintFinding::Severity::Error ? errors > 0 : !findings.empty();
  return has_findings ? kFindings : kDone;
}

void add_lint(CLI::App& catalog, int& exit_code) {
  struct Arguments {
    std::string file;
    std::string gate = "error";
    bool json = false;
  };
  const auto arguments = std::make_shared<Arguments>();
  CLI::App* const command = catalog.add_subcommand(
      "lint", "Checks that the elements' data are sound and agree with each other.");
  command->add_option("CATALOG.db", arguments->file)->required();
  command->add_option("--gate", arguments->gate, "lowest severity that makes the exit code 1")
      ->check(CLI::IsMember({"error", "warning"}))
      ->capture_default_str();
  command->add_flag("--json", arguments->json, "one line of JSON a finding, then a summary");
  command->callback([arguments, &exit_code] {
    const auto gate =
        arguments->gate == "error" ? LintFinding::Severity::Error : LintFinding::Severity::Warning;
    exit_code = run_lint(arguments->file, arguments->json, gate);
  });
}

}  // namespace

void add_catalog_commands(CLI::App& app, int& exit_code) {
  CLI::App* const catalog =
      app.add_subcommand("catalog", "Makes and reads catalogues of elements.");
  catalog->require_subcommand(1);
  add_build_command(*catalog, exit_code);
  add_list(*catalog);
  add_show(*catalog);
  add_search(*catalog);
  add_lint(*catalog, exit_code);
  add_sheet_command(*catalog);
}

}  // namespace dowel::tools
