#pragma once

#include <span>
#include <string_view>

namespace dowel {

/// ISO metric thread. An external thread is modelled as a cylinder of nominal diameter, an internal
/// one as a cylinder between its minor diameter and its tap drill.
struct MetricThread {
  std::string_view name;  ///< "M12", with the pitch where it is a fine one: "M12x1.5"
  double nominal_mm = 0.0;
  double pitch_mm = 0.0;
  double tap_drill_mm = 0.0;
  /// A bore of the tap drill's diameter hardly is anything else: it is neither a whole number of mm
  /// nor a clearance hole of ISO 273.
  bool tap_drill_tells = false;

  /// D1 of the internal thread.
  double minor_mm() const { return nominal_mm - 1.0825 * pitch_mm; }
};

/// M3 to M24 by diameter, coarse before fine. Source: ISO 261 (pitches), ISO 2306 (tap drills).
std::span<const MetricThread> metric_threads();

/// The thread called `name`; nothing where it is none of the table.
const MetricThread* find_metric_thread(std::string_view name);

/// The coarse thread that a cylinder of `shaft_diameter_mm` can stand for; nothing where it is of
/// no nominal diameter.
const MetricThread* thread_of_shaft(double shaft_diameter_mm);

/// The first thread that a bore of `hole_diameter_mm` can be the core hole of, plain as it may be;
/// nothing where it is none.
const MetricThread* thread_of_core_hole(double hole_diameter_mm);

/// The thread that a bore of `hole_diameter_mm` likely is for: it has the minor diameter (within
/// 0.02 mm), or that of a tap drill that tells. Nothing where it may as well be a plain bore.
const MetricThread* likely_thread_of_hole(double hole_diameter_mm);

/// The thread that an outside cylinder likely is, whose free end a chamfer narrows to
/// `end_diameter_mm`: it has a nominal diameter, and the chamfer reaches about the thread's depth.
/// The coarse one, where the chamfer is deep enough for both.
const MetricThread* likely_thread_of_shaft(double shaft_diameter_mm, double end_diameter_mm);

/// True where a bore of `hole_diameter_mm` is a core hole for a thread, coarse or fine, of the
/// shaft's diameter.
bool forms_thread(double shaft_diameter_mm, double hole_diameter_mm);

}  // namespace dowel
