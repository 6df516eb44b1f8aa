#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "chart.h"
#include "measure.h"
#include "table.h"

/// What a method pays for being right: run time against error, over the fineness of facets and over
/// tolerances, on pairs whose exact gap or depth is known (known_pair.h).
namespace dowel::bench {

/// One method at one setting, over all known pairs.
struct ErrorPoint {
  std::string method;
  double facet_error_mm = 0.0;
  double tolerance_mm = 0.0;  ///< dowel's; 0: the method has none
  double mean_us = 0.0;
  double slowest_us = 0.0;  ///< mean of the pair that took longest
  std::string slowest_on;
  std::size_t judged = 0;
  std::size_t wrong = 0;          ///< said interference at a gap, or none at a depth
  double gap_hit_mm = 0.0;        ///< largest gap that it called interference
  double depth_missed_mm = 0.0;   ///< largest depth that it did not
  double off_threshold_mm = 0.0;  ///< the same from the method's own threshold
  std::string off_on;             ///< pair on which that was
  double measured_off_mm = 0.0;   ///< largest error of a gap or depth that it measured; 0: does not

  double off_mm() const { return std::max(gap_hit_mm, depth_missed_mm); }
};

/// Over pairs whose gap is a formula.
std::vector<ErrorPoint> run_error_study(const Plan& plan);

/// Over exact solids that OpenCascade judges by Booleans and distances, for one tolerance.
std::vector<ErrorPoint> run_solid_study(const Plan& plan);

/// Whether dowel's exact mode told interference wrongly, by more than a tenth of its tolerance from
/// where it begins.
bool has_wrong_exact_verdict(const std::vector<ErrorPoint>& points);

Table error_table(const std::vector<ErrorPoint>& points);
Table solid_table(const std::vector<ErrorPoint>& points);
Chart error_chart(const std::vector<ErrorPoint>& points);

}  // namespace dowel::bench
