#include "script_words.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>

namespace dowel::tools {
namespace {

bool is_blank(char c) {
  return c == ' ' || c == '\t' || c == '\r' || c == '\v' || c == '\f';
}

std::optional<double> number_of(std::string_view text) {
  if (text.starts_with('+')) text.remove_prefix(1);
  double value = 0.0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || stop != text.data() + text.size() || !std::isfinite(value)) {
    return std::nullopt;
  }
  return value;
}

/// Takes a quoted stretch off `line` at `at` (its opening quote) and appends what it holds.
std::size_t read_quoted(std::string_view line, std::size_t at, std::string& text) {
  const char quote = line[at];
  for (std::size_t i = at + 1; i < line.size(); ++i) {
    if (line[i] == quote) return i + 1;
    if (quote == '"' && line[i] == '\\' && i + 1 < line.size()) ++i;
    text += line[i];
  }
  throw CommandError(ErrorCode::InvalidInput,
                     std::string("quote is not closed, expected a second ") + quote, at + 1);
}

bool needs_quotes(const Word& word) {
  return word.quoted || word.text.empty() || word.text.front() == '#' ||
         std::ranges::any_of(
             word.text, [](char c) { return is_blank(c) || c == '"' || c == '\'' || c == '\n'; });
}

}  // namespace

std::vector<Word> split_words(std::string_view line) {
  std::vector<Word> words;
  std::size_t i = 0;
  while (true) {
    while (i < line.size() && is_blank(line[i])) ++i;
    if (i == line.size() || line[i] == '#') return words;
    Word word;
    word.column = i + 1;
    while (i < line.size() && !is_blank(line[i])) {
      if (line[i] == '"' || line[i] == '\'') {
        word.quoted = true;
        i = read_quoted(line, i, word.text);
      } else {
        word.text += line[i++];
      }
    }
    words.push_back(std::move(word));
  }
}

std::string join_words(const std::vector<Word>& words) {
  std::string line;
  for (const Word& word : words) {
    if (!line.empty()) line += ' ';
    if (!needs_quotes(word)) {
      line += word.text;
      continue;
    }
    line += '"';
    for (const char c : word.text) {
      if (c == '"' || c == '\\') line += '\\';
      line += c;
    }
    line += '"';
  }
  return line;
}

bool Arguments::take(std::string_view keyword) {
  if (at_end() || words_[next_].quoted || words_[next_].text != keyword) return false;
  ++next_;
  return true;
}

void Arguments::expect(std::string_view keyword) {
  if (!take(keyword)) fail("expected `" + std::string(keyword) + "`");
}

bool Arguments::is_number() const {
  return !at_end() && !words_[next_].quoted && number_of(words_[next_].text).has_value();
}

std::string Arguments::word(std::string_view what) {
  if (at_end()) fail("expected " + std::string(what));
  return words_[next_++].text;
}

double Arguments::number(std::string_view what) {
  if (!is_number()) fail("expected " + std::string(what));
  return *number_of(words_[next_++].text);
}

std::size_t Arguments::count(std::string_view what) {
  constexpr double kMost = 1.0e9;
  const double value = is_number() ? *number_of(words_[next_].text) : 0.0;
  if (value < 1.0 || value > kMost || value != std::floor(value)) {
    fail("expected " + std::string(what));
  }
  ++next_;
  return static_cast<std::size_t>(value);
}

Eigen::Vector3d Arguments::point(std::string_view what) {
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (double& coordinate : result) coordinate = number(what);
  return result;
}

FeatureName Arguments::feature(std::string_view what) {
  const std::string expectation = std::string(what) + ", written INSTANCE.FEATURE";
  if (at_end()) fail("expected " + expectation);
  const std::string& text = words_[next_].text;
  const std::size_t dot = text.find('.');
  if (dot == std::string::npos || dot == 0 || dot + 1 == text.size()) {
    fail("expected " + expectation);
  }
  ++next_;
  return {text.substr(0, dot), text.substr(dot + 1)};
}

void Arguments::expect_end() const {
  if (!at_end()) fail("expected the end of the command");
}

void Arguments::fail(const std::string& message) const {
  if (!at_end()) {
    throw CommandError(ErrorCode::InvalidInput, message + ", got \"" + words_[next_].text + "\"",
                       words_[next_].column);
  }
  const Word& last = words_.back();
  throw CommandError(ErrorCode::InvalidInput, message + " after \"" + last.text + "\"",
                     last.column);
}

void Arguments::fail_at_last(const std::string& message) const {
  throw CommandError(ErrorCode::InvalidInput, message, last_column());
}

std::size_t Arguments::last_column() const {
  return words_[next_ == 0 ? 0 : next_ - 1].column;
}

}  // namespace dowel::tools
