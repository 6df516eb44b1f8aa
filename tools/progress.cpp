#include "progress.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include <sys/ioctl.h>
#include <unistd.h>

namespace dowel::tools {
namespace {

std::size_t terminal_width() {
  winsize size{};
  const bool is_known = ::ioctl(STDERR_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0;
  return is_known ? size.ws_col : 80;
}

}  // namespace

bool wants_colour() {
  const char* const no_colour = std::getenv("NO_COLOR");
  return ::isatty(STDOUT_FILENO) == 1 && (no_colour == nullptr || *no_colour == '\0');
}

std::string coloured(std::string_view text, const char* colour) {
  if (!wants_colour()) return std::string(text);
  return std::string("\x1b[") + colour + "m" + std::string(text) + "\x1b[0m";
}

std::string duration_text(double seconds) {
  char text[64];
  const long whole = std::lround(seconds);
  if (seconds < 10.0) {
    std::snprintf(text, sizeof text, "%.1f s", seconds);
  } else if (whole < 60) {
    std::snprintf(text, sizeof text, "%ld s", whole);
  } else if (whole < 3600) {
    std::snprintf(text, sizeof text, "%ld min %ld s", whole / 60, whole % 60);
  } else {
    std::snprintf(text, sizeof text, "%ld h %ld min", whole / 3600, whole / 60 % 60);
  }
  return text;
}

Progress::Progress(std::string_view unit) : unit_(unit), is_shown_(::isatty(STDERR_FILENO) == 1) {}

Progress::~Progress() {
  clear();
}

void Progress::update(std::size_t done, std::size_t total, std::string_view label,
                      std::size_t skipped) {
  if (!is_shown_ || total == 0) return;
  constexpr std::size_t kCells = 24;
  const std::size_t filled = kCells * done / total;
  const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - start_;
  const std::size_t counted = done - std::min(skipped, done);
  const double rate = static_cast<double>(counted) / std::max(taken.count(), 1e-3);

  std::string line = "[" + std::string(filled, '#') + std::string(kCells - filled, '.') + "] " +
                     std::to_string(done) + "/" + std::to_string(total) + " " + unit_;
  if (counted > 0) {
    char text[32];
    std::snprintf(text, sizeof text, ", %.1f/s, ", rate);
    line += text + duration_text(static_cast<double>(total - done) / rate) + " left";
  }
  line += "  ";
  // A line that wraps could not be taken back. Bytes that move the cursor are left out.
  const std::size_t width = terminal_width() - 1;
  for (const char c : label) {
    if (line.size() < width && c >= ' ' && c != '\x7f') line += c;
  }
  line.resize(std::min(line.size(), width));
  std::fprintf(stderr, "\r\x1b[K%s", line.c_str());
  std::fflush(stderr);
  is_drawn_ = true;
}

void Progress::clear() {
  if (is_drawn_) std::fputs("\r\x1b[K", stderr);
  is_drawn_ = false;
}

}  // namespace dowel::tools
