#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "measure.h"

namespace dowel::bench {

struct Results {
  std::vector<Scenario> scenarios;
  std::vector<std::string> methods;
  std::vector<Run> runs;
  std::vector<ScalePoint> scale;
};

/// Markdown tables.
void write_tables(std::ostream& out, const Results& results);

void write_json(std::ostream& out, const Results& results);

/// Poses at which dowel's verdict is not the truth, `limit` of each scenario and motion.
void write_wrong_verdicts(std::ostream& out, const Results& results, std::size_t limit);

}  // namespace dowel::bench
