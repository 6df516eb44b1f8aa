#include "dowel/assembly/suggest.h"

#include <algorithm>
#include <optional>
#include <utility>

namespace dowel {
namespace {

/// Beyond this length nobody is helped by a suggestion, and edit distance takes its time.
constexpr std::size_t kLongestWord = 200;

std::string lower_case(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

/// Optimal string alignment distance.
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before(b.size() + 1);
  std::vector<std::size_t> last(b.size() + 1);
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) last[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = last[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, replace});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        row[j] = std::min(row[j], before[j - 2] + 1);
      }
    }
    std::swap(before, last);
    std::swap(last, row);
  }
  return last[b.size()];
}

/// How bad a suggestion `candidate` is for `word`, both in lower case; nothing where it is none.
std::optional<std::size_t> badness(std::string_view word, std::string_view candidate) {
  if (candidate.size() > kLongestWord) return std::nullopt;
  const std::size_t allowed = std::max<std::size_t>(1, word.size() / 3);
  const std::size_t distance = edit_distance(word, candidate);
  if (distance <= allowed && distance < candidate.size()) return distance;
  if (word.size() >= 2 && candidate.starts_with(word)) return allowed + 1;
  return std::nullopt;
}

}  // namespace

std::vector<std::string> similar_words(std::string_view word,
                                       const std::vector<std::string>& candidates,
                                       std::size_t count) {
  if (word.empty() || word.size() > kLongestWord) return {};
  const std::string wanted = lower_case(word);
  std::vector<std::pair<std::size_t, std::size_t>> found;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    if (const auto bad = badness(wanted, lower_case(candidates[i]))) found.emplace_back(*bad, i);
  }
  std::ranges::sort(found);
  if (found.size() > count) found.resize(count);
  std::vector<std::string> result;
  result.reserve(found.size());
  for (const auto& [bad, i] : found) result.push_back(candidates[i]);
  return result;
}

std::string did_you_mean(const std::vector<std::string>& suggestions) {
  if (suggestions.empty()) return {};
  std::string text = "; did you mean ";
  for (std::size_t i = 0; i < suggestions.size(); ++i) {
    if (i > 0) text += i + 1 == suggestions.size() ? " or " : ", ";
    text += suggestions[i];
  }
  return text + "?";
}

}  // namespace dowel
