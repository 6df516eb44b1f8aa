#pragma once

#include <cstddef>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace dowel::tools {

/// Text in aligned columns for people: two blanks between columns, those that hold numbers to the
/// right.
class Table {
 public:
  enum class Align { Left, Right };
  struct Column {
    std::string title;
    Align align = Align::Left;
  };

  explicit Table(std::vector<Column> columns);

  /// Expects: one cell a column. What would move the cursor is replaced by '?'.
  void add(std::vector<std::string> cells);

  /// The titles and the rows, each ended by a line end but for the last.
  std::string text() const;

 private:
  std::vector<Column> columns_;
  std::vector<std::vector<std::string>> rows_;
};

/// `text` without what would move a terminal's cursor.
std::string printable(std::string_view text);

/// "1 element", "2 elements"
std::string counted(std::size_t count, const std::string& noun);

/// With six digits: "12", "0.0833333", "1e+06".
std::string short_number(double value);

}  // namespace dowel::tools
