#pragma once

#include <iosfwd>
#include <string>
#include <vector>

namespace dowel::bench {

/// A table of the report, as text: what is written in Markdown and in JSON.
struct Table {
  std::string title;
  std::string intro;  ///< what is shown, in which unit; may be several sentences
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

void write(std::ostream& out, const Table& table);

/// Two or three digits of a positive value; whole from 10 on, by powers of ten where it is tiny.
std::string text(double value);

/// "a / b", each as `text`.
std::string text(double a, double b);

}  // namespace dowel::bench
