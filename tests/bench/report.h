#pragma once

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "chart.h"
#include "measure.h"
#include "table.h"

namespace dowel::bench {

struct Results {
  std::vector<Scenario> scenarios;
  std::vector<std::string> methods;
  std::vector<Run> runs;
  double clock_us = 0.0;  ///< of one reading, which is part of each time of a single check
  std::vector<ScalePoint> scale;
  std::vector<SizePoint> sizes;
  std::vector<Table> tables;            ///< of the other studies
  std::map<std::string, Chart> charts;  ///< by the name of their file
  bool has_wrong_verdict = false;       ///< dowel was wrong in one of the other studies
};

/// Markdown tables.
void write_tables(std::ostream& out, const Results& results);

/// All figures.
std::string json_text(const Results& results);

/// Median and 99th percentile of each method on each motion.
Chart time_chart(const Results& results);

/// Median of a move by the number of elements.
Chart growth_chart(const Results& results);

/// Mean of a move by the size of the moving block.
Chart size_chart(const Results& results);

/// Whether dowel, asked for exact verdicts, was wrong at a pose whose truth is known.
bool has_wrong_verdict_of_dowel(const Results& results);

/// Poses at which dowel's verdict is not the truth, `limit` of each scenario and motion.
void write_wrong_verdicts(std::ostream& out, const Results& results, std::size_t limit);

}  // namespace dowel::bench
