#pragma once

#include <chrono>
#include <cstddef>
#include <string>
#include <string_view>

namespace dowel::tools {

/// True where standard output is a terminal and the environment has no NO_COLOR.
bool wants_colour();

/// `text` in a terminal's colour, for example "31" (red); as it stands where `wants_colour` is
/// false.
std::string coloured(std::string_view text, const char* colour);

/// "0.4 s", "12 s", "3 min 20 s", "2 h 5 min".
std::string duration_text(double seconds);

/// A bar with count, rate and remaining time on standard error; nothing where that is no terminal.
class Progress {
 public:
  explicit Progress(std::string_view unit);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Redraws the bar: `done` of `total` are done, the last of them is called `label`. `skipped` of
  /// those done cost nothing: the rate leaves them out.
  void update(std::size_t done, std::size_t total, std::string_view label, std::size_t skipped = 0);

  /// Takes the bar away, so that other lines can be printed; the next update brings it back.
  void clear();

 private:
  std::string unit_;
  bool is_shown_ = false;  ///< standard error is a terminal
  bool is_drawn_ = false;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace dowel::tools
