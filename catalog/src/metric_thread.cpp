#include "dowel/catalog/metric_thread.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

constexpr std::array<MetricThread, 14> kMetricThreads{{{"M3", 3.0, 0.5, 2.5, true},
                                                       {"M4", 4.0, 0.7, 3.3, true},
                                                       {"M5", 5.0, 0.8, 4.2, true},
                                                       {"M6", 6.0, 1.0, 5.0, false},
                                                       {"M8", 8.0, 1.25, 6.8, true},
                                                       {"M10", 10.0, 1.5, 8.5, true},
                                                       {"M12", 12.0, 1.75, 10.2, true},
                                                       {"M12x1.5", 12.0, 1.5, 10.5, false},
                                                       {"M14", 14.0, 2.0, 12.0, false},
                                                       {"M16", 16.0, 2.0, 14.0, false},
                                                       {"M18", 18.0, 2.5, 15.5, false},
                                                       {"M20", 20.0, 2.5, 17.5, false},
                                                       {"M22", 22.0, 2.5, 19.5, true},
                                                       {"M24", 24.0, 3.0, 21.0, false}}};

template <class Condition>
const MetricThread* first_where(const Condition& condition) {
  const auto* const found = std::ranges::find_if(kMetricThreads, condition);
  return found == kMetricThreads.end() ? nullptr : found;
}

bool has_nominal(const MetricThread& thread, double shaft_diameter_mm) {
  return std::abs(thread.nominal_mm - shaft_diameter_mm) <= kThreadNominalSlack_mm;
}

bool is_core_hole(const MetricThread& thread, double hole_diameter_mm) {
  return hole_diameter_mm >= thread.minor_mm() - kTapDrillSlack_mm &&
         hole_diameter_mm <= thread.tap_drill_mm + kTapDrillSlack_mm;
}

}  // namespace

std::span<const MetricThread> metric_threads() {
  return kMetricThreads;
}

const MetricThread* find_metric_thread(std::string_view name) {
  return first_where([=](const MetricThread& thread) { return thread.name == name; });
}

const MetricThread* thread_of_shaft(double shaft_diameter_mm) {
  return first_where(
      [=](const MetricThread& thread) { return has_nominal(thread, shaft_diameter_mm); });
}

const MetricThread* thread_of_core_hole(double hole_diameter_mm) {
  return first_where(
      [=](const MetricThread& thread) { return is_core_hole(thread, hole_diameter_mm); });
}

const MetricThread* likely_thread_of_hole(double hole_diameter_mm) {
  const auto is = [=](double diameter_mm) {
    return std::abs(hole_diameter_mm - diameter_mm) <= kCoaxial_mm;
  };
  return first_where([&](const MetricThread& thread) {
    return is(thread.minor_mm()) || (thread.tap_drill_tells && is(thread.tap_drill_mm));
  });
}

const MetricThread* likely_thread_of_shaft(double shaft_diameter_mm, double end_diameter_mm) {
  // Turned to the pitch at least: an edge broken on a pin is shallower.
  return first_where([=](const MetricThread& thread) {
    return has_nominal(thread, shaft_diameter_mm) &&
           end_diameter_mm <= thread.nominal_mm - thread.pitch_mm + kCoaxial_mm;
  });
}

bool forms_thread(double shaft_diameter_mm, double hole_diameter_mm) {
  return first_where([=](const MetricThread& thread) {
           return has_nominal(thread, shaft_diameter_mm) && is_core_hole(thread, hole_diameter_mm);
         }) != nullptr;
}

}  // namespace dowel
