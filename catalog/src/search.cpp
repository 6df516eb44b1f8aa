#include "dowel/catalog/search.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

#include "dowel/kernel/error.h"
#include "dowel/kernel/tolerance.h"

namespace dowel {
namespace {

using Quantity = SearchCondition::Quantity;
using What = SearchLabel::What;

constexpr std::string_view kBlanks = " \t\r\n";
constexpr std::string_view kOperators = "<>=";

constexpr std::array<std::pair<std::string_view, Quantity>, 16> kQuantities{{
    {"length", Quantity::Length},
    {"l", Quantity::Length},
    {"width", Quantity::Width},
    {"w", Quantity::Width},
    {"height", Quantity::Height},
    {"h", Quantity::Height},
    {"hole", Quantity::Hole},
    {"shaft", Quantity::Shaft},
    {"slot", Quantity::Slot},
    {"diameter", Quantity::Diameter},
    {"d", Quantity::Diameter},
    {"depth", Quantity::Depth},
    {"holes", Quantity::Holes},
    {"circle", Quantity::Circle},
    {"volume", Quantity::Volume},
    {"mass", Quantity::Mass},
}};

constexpr std::array<std::pair<std::string_view, What>, 6> kLabels{{
    {"thread", What::Thread},
    {"hole", What::HoleThread},
    {"shaft", What::ShaftThread},
    {"fit", What::Fit},
    {"role", What::Role},
    {"material", What::Material},
}};

/// ASCII only: names in other scripts are matched as they stand.
std::string lower(std::string_view text) {
  std::string result(text);
  for (char& c : result) {
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  }
  return result;
}

bool contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

/// A word or comparison of a query, and where it begins in the terms with a blank between each.
struct Token {
  std::string text;
  std::size_t at = 0;
};

/// All terms as one list of tokens; blanks around operators are dropped, so that `height >= 80` is
/// one token however the shell split it.
std::vector<Token> tokens_of(std::span<const std::string> terms) {
  std::vector<Token> tokens;
  bool expects_value = false;
  std::size_t term_at = 0;
  for (const std::string& term : terms) {
    std::size_t at = 0;
    while ((at = term.find_first_not_of(kBlanks, at)) != std::string::npos) {
      const std::size_t end = std::min(term.find_first_of(kBlanks, at), term.size());
      const std::string word = term.substr(at, end - at);
      const bool continues = expects_value || contains(kOperators, word.substr(0, 1));
      if (continues && !tokens.empty()) {
        tokens.back().text += word;
      } else {
        tokens.push_back({word, term_at + at});
      }
      expects_value = contains(kOperators, word.substr(word.size() - 1));
      at = end;
    }
    term_at += term.size() + 1;
  }
  return tokens;
}

[[noreturn]] void fail(const Token& token, const std::string& expected) {
  throw Error(ErrorCode::InvalidInput, "search query, character " + std::to_string(token.at + 1) +
                                           ", \"" + token.text + "\": expected " + expected);
}

std::string_view unit_of(Quantity quantity) {
  if (quantity == Quantity::Mass) return "kg";
  if (quantity == Quantity::Volume) return "mm3";
  return quantity == Quantity::Holes ? "" : "mm";
}

double parse_number(const Token& token, std::string_view text, std::string_view unit) {
  if (text.ends_with(unit)) text.remove_suffix(unit.size());
  double value = 0.0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) {
    fail(token, "a number instead of \"" + std::string(text) + "\"");
  }
  return value;
}

Quantity parse_quantity(const Token& token, std::string_view name) {
  std::string known;
  std::vector<std::string> words;
  for (const auto& [word, quantity] : kQuantities) {
    if (word == name) return quantity;
    if (word.size() == 1) continue;
    known += (known.empty() ? "" : ", ") + std::string(word);
    words.emplace_back(word);
  }
  for (const auto& [word, what] : kLabels) {
    if (std::ranges::find(words, word) != words.end()) continue;
    known += ", " + std::string(word);
    words.emplace_back(word);
  }
  const std::vector<std::string> guess = closest_names(name, words, 1);
  fail(token, "one of " + known + " before the comparison" +
                  (guess.empty() ? "" : "; did you mean " + guess.front() + "?"));
}

/// "M12", "m12x1.5".
bool is_thread(std::string_view text) {
  return text.size() >= 2 && (text[0] == 'M' || text[0] == 'm') && text[1] >= '1' && text[1] <= '9';
}

/// What `name=text` asks for where that is no number: nothing where it can only be one.
std::optional<SearchLabel> parse_label(const Token& token, std::string_view name,
                                       const std::string& comparison, std::string_view text) {
  const auto* const found =
      std::ranges::find(kLabels, name, &std::pair<std::string_view, What>::first);
  if (found == kLabels.end()) return std::nullopt;
  const What what = found->second;
  const bool may_be_size = what == What::HoleThread || what == What::ShaftThread;
  if (may_be_size && !is_thread(text)) return std::nullopt;
  if (comparison != "=" && comparison != "==") fail(token, "= after " + std::string(name));
  if (text.empty()) fail(token, "a word after =");
  if (what == What::Thread && !is_thread(text)) fail(token, "a thread such as M12 or M12x1.5");
  return SearchLabel{what, what == What::Fit ? std::string(text) : lower(text), token.text};
}

SearchCondition parse_condition(const Token& token, Quantity quantity,
                                const std::string& comparison, std::string_view number) {
  SearchCondition condition;
  condition.quantity = quantity;
  condition.term = token.text;
  const auto value = [&](std::string_view text) {
    return parse_number(token, text, unit_of(quantity));
  };
  if (comparison == "=" || comparison == "==") {
    const std::size_t dots = number.find("..");
    const bool is_range = dots != std::string_view::npos;
    const double low = value(number.substr(0, dots));
    const double high = is_range ? value(number.substr(dots + 2)) : low;
    condition.low = low - kCoincident_mm;
    condition.high = high + kCoincident_mm;
  } else if (comparison == ">=") {
    condition.low = value(number) - kCoincident_mm;
  } else if (comparison == ">") {
    condition.low = value(number) + kCoincident_mm;
  } else if (comparison == "<=") {
    condition.high = value(number) + kCoincident_mm;
  } else if (comparison == "<") {
    condition.high = value(number) - kCoincident_mm;
  } else {
    fail(token, "one of =, <, <=, >, >=");
  }
  return condition;
}

void parse_comparison(const Token& token, SearchQuery& query) {
  const std::size_t at = token.text.find_first_of(kOperators);
  const std::size_t end = std::min(token.text.find_first_not_of(kOperators, at), token.text.size());
  const std::string name = lower(token.text.substr(0, at));
  const std::string comparison = token.text.substr(at, end - at);
  const std::string_view value = std::string_view(token.text).substr(end);
  if (auto label = parse_label(token, name, comparison, value)) {
    query.labels.push_back(std::move(*label));
  } else {
    query.conditions.push_back(
        parse_condition(token, parse_quantity(token, name), comparison, value));
  }
}

std::vector<double> circle_diameters_mm(const Element& element) {
  std::vector<double> result;
  for (const BoltCircle& circle : element.bolt_circles) result.push_back(circle.diameter_mm);
  return result;
}

/// Every value of the quantity that the element has.
std::vector<double> values(const Element& element, Quantity quantity) {
  const Eigen::Vector3d size = 2.0 * element.obb.half_extents_mm;
  switch (quantity) {
    case Quantity::Length:
      return {size.x()};
    case Quantity::Width:
      return {size.y()};
    case Quantity::Height:
      return {size.z()};
    case Quantity::Volume:
      return {element.volume_mm3};
    case Quantity::Mass:
      if (const auto mass_kg = element.mass_kg()) return {*mass_kg};
      return {};
    case Quantity::Holes:
      return {static_cast<double>(
          std::ranges::count(element.features, FeatureKind::Hole, &Feature::kind))};
    case Quantity::Circle:
      return circle_diameters_mm(element);
    default:
      break;
  }
  const bool wants_holes = quantity == Quantity::Hole || quantity == Quantity::Diameter;
  const bool wants_shafts = quantity == Quantity::Shaft || quantity == Quantity::Diameter;
  std::vector<double> result;
  for (const Feature& feature : element.features) {
    if (feature.kind == FeatureKind::Hole && quantity == Quantity::Depth) {
      result.push_back(feature.depth_mm);
    } else if (feature.kind == FeatureKind::Hole && wants_holes) {
      result.push_back(feature.diameter_mm);
      for (const HoleSegment& segment : feature.segments) {
        if (segment.type == HoleSegment::Type::Cylinder) result.push_back(segment.diameter_mm);
      }
    } else if ((feature.kind == FeatureKind::Slot && quantity == Quantity::Slot) ||
               (feature.kind == FeatureKind::Shaft && wants_shafts)) {
      result.push_back(feature.diameter_mm);
    }
  }
  return result;
}

bool holds(const Element& element, const SearchCondition& condition) {
  return std::ranges::any_of(values(element, condition.quantity), [&condition](double value) {
    return condition.low <= value && value <= condition.high;
  });
}

bool carries(const Element& element, const SearchLabel& label) {
  if (label.what == What::Role) return lower(element.role) == label.text;
  if (label.what == What::Material) return contains(lower(element.material), label.text);
  return std::ranges::any_of(element.features, [&label](const Feature& feature) {
    if (label.what == What::Fit) return feature.fit == label.text;
    if (label.what == What::HoleThread && feature.kind != FeatureKind::Hole) return false;
    if (label.what == What::ShaftThread && feature.kind != FeatureKind::Shaft) return false;
    return !feature.thread.empty() && lower(feature.thread) == label.text;
  });
}

/// Where a word occurs: 0 is the whole name, larger is farther from it; nothing: nowhere.
std::optional<int> place_of(const Element& element, const std::string& word) {
  const std::string name = lower(element.name);
  if (name == word) return 0;
  if (name.starts_with(word)) return 1;
  if (contains(name, word)) return 2;
  if (contains(lower(element.family), word) || contains(lower(element.role), word)) return 3;
  if (contains(to_string(element.shape), word)) return 4;
  const bool in_feature = std::ranges::any_of(element.features, [&word](const Feature& feature) {
    return contains(lower(feature.name), word) || to_string(feature.kind) == word ||
           contains(lower(feature.use), word) || lower(feature.thread) == word;
  });
  if (in_feature) return 5;
  const bool in_text = contains(lower(element.description), word) ||
                       contains(lower(element.material), word) ||
                       contains(lower(element.dimensions_by), word);
  return in_text ? std::optional(6) : std::nullopt;
}

/// Sum of the places of all words; nothing where the element does not match.
std::optional<int> distance_from(const Element& element, const SearchQuery& query) {
  int sum = 0;
  for (const std::string& word : query.words) {
    const auto place = place_of(element, word);
    if (!place) return std::nullopt;
    sum += *place;
  }
  const bool all_hold = std::ranges::all_of(
      query.conditions, [&element](const auto& condition) { return holds(element, condition); });
  const bool all_carried = std::ranges::all_of(
      query.labels, [&element](const auto& label) { return carries(element, label); });
  return all_hold && all_carried ? std::optional(sum) : std::nullopt;
}

/// Insertions, deletions, replacements and swaps of neighbours that turn `a` into `b` (optimal
/// string alignment).
std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> before_last;
  std::vector<std::size_t> last(b.size() + 1);
  std::iota(last.begin(), last.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::vector<std::size_t> current(b.size() + 1, i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = last[j - 1] + (a[i - 1] == b[j - 1] ? 0U : 1U);
      current[j] = std::min({replaced, last[j] + 1, current[j - 1] + 1});
      if (i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1]) {
        current[j] = std::min(current[j], before_last[j - 2] + 1);
      }
    }
    before_last = std::exchange(last, std::move(current));
  }
  return last[b.size()];
}

/// How far `candidate` is from `name`, both lower case; nothing where nobody means the one by the
/// other. First the kind of likeness, then how much is left.
std::optional<std::pair<int, std::size_t>> likeness(std::string_view name,
                                                    std::string_view candidate) {
  // Longer names than these nobody types, and the effort grows with the square.
  constexpr std::size_t kLongestCompared = 200;
  if (name.empty() || name.size() > kLongestCompared || candidate.size() > kLongestCompared) {
    return std::nullopt;
  }
  if (candidate == name) return std::pair(0, std::size_t{0});
  if (candidate.starts_with(name)) return std::pair(1, candidate.size() - name.size());
  if (contains(candidate, name)) return std::pair(2, candidate.size() - name.size());
  const std::size_t errors = edit_distance(name, candidate);
  const std::size_t errors_allowed = std::max(std::size_t{1}, name.size() / 3);
  if (errors > errors_allowed) return std::nullopt;
  return std::pair(3, errors);
}

}  // namespace

SearchQuery parse_query(std::span<const std::string> terms) {
  SearchQuery query;
  const std::vector<Token> tokens = tokens_of(terms);
  for (std::size_t i = 0; i < tokens.size(); ++i) {
    const std::string word = lower(tokens[i].text);
    if (tokens[i].text.find_first_of(kOperators) != std::string::npos) {
      parse_comparison(tokens[i], query);
    } else if ((word == "hole" || word == "shaft") && i + 1 < tokens.size() &&
               is_thread(tokens[i + 1].text) &&
               tokens[i + 1].text.find_first_of(kOperators) == std::string::npos) {
      std::string term = tokens[i].text + ' ';
      term += tokens[++i].text;
      query.labels.push_back({word == "hole" ? What::HoleThread : What::ShaftThread,
                              lower(tokens[i].text), std::move(term)});
    } else {
      query.words.push_back(word);
    }
  }
  return query;
}

bool matches(const Element& element, const SearchQuery& query) {
  return distance_from(element, query).has_value();
}

std::vector<Element> search(const Catalog& catalog, const SearchQuery& query) {
  std::vector<std::pair<int, Element>> found;
  for (const std::string& name : catalog.names()) {
    std::optional<Element> element = catalog.find(name);
    if (!element) continue;  // another program has just removed it
    if (const auto distance = distance_from(*element, query)) {
      found.emplace_back(*distance, std::move(*element));
    }
  }
  // Names came sorted, and stay so among equals.
  std::ranges::stable_sort(found, {}, &std::pair<int, Element>::first);
  std::vector<Element> elements;
  elements.reserve(found.size());
  for (auto& entry : found) elements.push_back(std::move(entry.second));
  return elements;
}

std::vector<std::string> closest_names(std::string_view name,
                                       std::span<const std::string> candidates, std::size_t count) {
  const std::string wanted = lower(name);
  std::vector<std::tuple<int, std::size_t, std::string>> found;
  for (const std::string& candidate : candidates) {
    const std::string text = lower(candidate);
    // "riser-80" is as good a guess for "H40/riser-80" as for the whole name.
    const std::string_view last = std::string_view(text).substr(text.rfind('/') + 1);
    auto best = likeness(wanted, text);
    const auto by_last = likeness(wanted, last);
    if (by_last && (!best || *by_last < *best)) best = by_last;
    if (best) found.emplace_back(best->first, best->second, candidate);
  }
  std::ranges::sort(found);
  std::vector<std::string> names;
  for (auto& entry : found) {
    if (names.size() == count) break;
    names.push_back(std::move(std::get<2>(entry)));
  }
  return names;
}

}  // namespace dowel
