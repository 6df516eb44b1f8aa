#include "table.h"

#include <cstdio>
#include <ostream>

namespace dowel::bench {

namespace {

void write_row(std::ostream& out, const std::vector<std::string>& cells) {
  for (const std::string& cell : cells) out << "| " << cell << ' ';
  out << "|\n";
}

}  // namespace

void write(std::ostream& out, const Table& table) {
  out << "\n### " << table.title << "\n\n" << table.intro << "\n\n";
  write_row(out, table.columns);
  for (std::size_t i = 0; i < table.columns.size(); ++i) out << (i == 0 ? "|---" : "|---:");
  out << "|\n";
  for (const auto& row : table.rows) write_row(out, row);
}

std::string text(double value) {
  if (value == 0.0) return "0";
  char buffer[32];
  const char* format = "%.0f";
  if (value < 0.01) {
    format = "%.1e";
  } else if (value < 1.0) {
    format = "%.2f";
  } else if (value < 10.0) {
    format = "%.1f";
  }
  (void)std::snprintf(buffer, sizeof buffer, format, value);
  return buffer;
}

std::string text(double a, double b) {
  return text(a) + " / " + text(b);
}

}  // namespace dowel::bench
