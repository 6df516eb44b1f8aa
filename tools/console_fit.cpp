#include "console_fit.h"

#include <cmath>
#include <optional>
#include <utility>

#include "console_text.h"
#include "dowel/assembly/thread.h"
#include "dowel/kernel/tolerance.h"
#include "table.h"

namespace dowel::tools {
namespace {

/// Diameters of one nominal size differ by no more than this: fits to 80 mm deviate by less.
constexpr double kOneSize_mm = 0.15;

/// The cylinder of the bore that the shaft goes with: one that it is drawn to fit, else the
/// narrowest that it goes into, else the narrowest of all.
double bore_of(const Feature& shaft, const Feature& hole) {
  double bore_mm = 0.0;
  for (const HoleSegment& segment : hole.segments) {
    if (segment.type != HoleSegment::Type::Cylinder) continue;
    if (fit_as_drawn(segment.diameter_mm, shaft.diameter_mm)) return segment.diameter_mm;
    const bool goes_in = segment.diameter_mm >= shaft.diameter_mm;
    if (goes_in && (bore_mm == 0.0 || segment.diameter_mm < bore_mm)) {
      bore_mm = segment.diameter_mm;
    }
  }
  return bore_mm > 0.0 ? bore_mm : hole.diameter_mm;
}

struct ToldFit {
  Fit fit;
  bool is_stated = false;  ///< both classes, by the catalogue
};

/// By the classes that the catalogue states of shaft and hole; what it does not state, as drawn.
std::optional<ToldFit> told_fit(const Feature& shaft, const Feature& hole, double bore_mm) {
  const double nominal_mm = 0.5 * std::round(2.0 * bore_mm);
  const auto hole_class = tolerance_class_from(hole.fit);
  const auto shaft_class = tolerance_class_from(shaft.fit);
  // A class of a diameter holds for what is drawn with about that diameter.
  const bool is_sized = is_nominal_size(nominal_mm) &&
                        std::abs(bore_mm - nominal_mm) <= kCoincident_mm &&
                        std::abs(shaft.diameter_mm - nominal_mm) <= kOneSize_mm;
  if (is_sized && hole_class && shaft_class) {
    return ToldFit{{nominal_mm, *hole_class, *shaft_class}, true};
  }
  auto drawn = fit_as_drawn(bore_mm, shaft.diameter_mm);
  if (!drawn) return std::nullopt;
  if (hole_class) drawn->hole = *hole_class;
  return ToldFit{*drawn, false};
}

/// As stated; else by the diameter, which does not tell the pitch.
std::string thread_text(const Feature& feature, double nominal_mm) {
  return feature.thread.empty() ? "M" + short_number(nominal_mm) : feature.thread;
}

}  // namespace

std::string fit_text(const Fit& fit) {
  return fit.text() + ": " + std::string(fit.kind()) + " fit, clearance " +
         short_number(fit.least_clearance_um()) + " to " + short_number(fit.most_clearance_um()) +
         " um";
}

Json to_json(const Fit& fit) {
  return {{"fit", fit.text()},
          {"kind", fit.kind()},
          {"least_clearance_um", fit.least_clearance_um()},
          {"most_clearance_um", fit.most_clearance_um()}};
}

std::string drawn_fit_text(const Feature& shaft, const Feature& hole) {
  if (core_hole(hole, shaft.diameter_mm)) {
    return "thread " + thread_text(shaft, shaft.diameter_mm) + " in thread " +
           thread_text(hole, shaft.diameter_mm);
  }
  const double bore_mm = bore_of(shaft, hole);
  if (const auto told = told_fit(shaft, hole, bore_mm)) {
    return fit_text(told->fit) + (told->is_stated ? " (as stated)" : " (as drawn)");
  }
  std::string text =
      "shaft " + length_text(shaft.diameter_mm) + " mm in hole " + length_text(bore_mm) + " mm: ";
  const double play_mm = bore_mm - shaft.diameter_mm;
  text += play_mm < 0.0 ? "too thick by " + length_text(-play_mm) + " mm"
                        : "play " + length_text(play_mm) + " mm as drawn";
  const MetricThread* core = thread_of_core_hole(bore_mm);
  if (core != nullptr && play_mm >= 0.0 && likely_thread_of_hole(bore_mm) != nullptr) {
    text += "; the hole is the core of a thread " + std::string(core->name);
  }
  return text;
}

Json drawn_fit_json(const Feature& shaft, const Feature& hole) {
  const double bore_mm = bore_of(shaft, hole);
  Json json{{"shaft_mm", shaft.diameter_mm}, {"hole_mm", bore_mm}};
  if (core_hole(hole, shaft.diameter_mm)) {
    json["thread_mm"] = shaft.diameter_mm;
  } else if (const auto told = told_fit(shaft, hole, bore_mm)) {
    json.update(to_json(told->fit));
    json["stated"] = told->is_stated;
  }
  return json;
}

std::string mate_fit_text(Session& session, const Mate& mate) {
  if (mate.kind == MateKind::Fix) return {};
  PlacedFeature shaft = session.feature(mate.moving);
  PlacedFeature hole = session.feature(mate.fixed);
  if (shaft.feature->kind == FeatureKind::Hole) std::swap(shaft, hole);
  if (shaft.feature->kind != FeatureKind::Shaft || hole.feature->kind != FeatureKind::Hole ||
      mate.kind == MateKind::Angle) {
    return {};
  }
  std::string text = drawn_fit_text(*shaft.feature, *hole.feature);
  if (mate.thread) {
    text += ", engaged over " +
            length_text(engagement_mm(*shaft.feature, shaft.X_WI, *hole.feature, hole.X_WI)) +
            " mm";
  }
  return text;
}

}  // namespace dowel::tools
