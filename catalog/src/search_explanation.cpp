// Why a search found nothing.

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "dowel/catalog/search.h"

namespace dowel {
namespace {

using What = SearchLabel::What;

/// One term of a query, and a query for it alone.
struct Term {
  std::string text;
  SearchQuery query;
  const SearchLabel* label = nullptr;
  bool is_word = false;
  bool is_matched = false;
};

std::vector<Term> terms_of(const SearchQuery& query) {
  std::vector<Term> terms;
  for (const std::string& word : query.words) {
    terms.push_back(
        {word, {.words = {word}, .conditions = {}, .labels = {}}, nullptr, true, false});
  }
  for (const SearchCondition& condition : query.conditions) {
    terms.push_back({condition.term,
                     {.words = {}, .conditions = {condition}, .labels = {}},
                     nullptr,
                     false,
                     false});
  }
  for (const SearchLabel& label : query.labels) {
    terms.push_back(
        {label.term, {.words = {}, .conditions = {}, .labels = {label}}, &label, false, false});
  }
  return terms;
}

bool is_letter_or_digit(char c) {
  return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z') ||
         (static_cast<unsigned char>(c) & 0x80U) != 0;
}

/// The words of `text`.
void add_words(const std::string& text, std::set<std::string>& words) {
  auto at = text.begin();
  while (at != text.end()) {
    const auto begin = std::find_if(at, text.end(), is_letter_or_digit);
    at = std::find_if_not(begin, text.end(), is_letter_or_digit);
    if (begin != at) words.emplace(begin, at);
  }
}

/// What the elements of a catalogue could have been found by.
struct Vocabulary {
  std::set<std::string> words;
  std::set<std::string> roles;
  std::set<std::string> threads;
  std::set<std::string> fits;

  void add(const Element& element) {
    for (const std::string* text :
         {&element.name, &element.role, &element.description, &element.material}) {
      add_words(*text, words);
    }
    if (!element.role.empty()) roles.insert(element.role);
    for (const Feature& feature : element.features) {
      add_words(feature.use, words);
      if (!feature.thread.empty()) threads.insert(feature.thread);
      if (!feature.fit.empty()) fits.insert(feature.fit);
    }
  }

  const std::set<std::string>& for_term(const Term& term) const {
    static const std::set<std::string> none;
    if (term.is_word) return words;
    if (term.label == nullptr || term.label->what == What::Material) return none;
    if (term.label->what == What::Role) return roles;
    return term.label->what == What::Fit ? fits : threads;
  }
};

/// `word` as a size that is compared, where it names one.
std::optional<std::string> as_comparison(const std::string& word) {
  for (const char* name : {"length", "width", "height", "diameter", "depth", "mass", "volume"}) {
    if (word == name) return word + ">=1";
  }
  return std::nullopt;
}

std::string sentence(const Term& term, const Vocabulary& vocabulary) {
  std::string text = "no element matches \"" + term.text + "\"";
  const std::optional<std::string> comparison =
      term.is_word ? as_comparison(term.text) : std::nullopt;
  if (comparison) return text + "; a size is compared, as in " + *comparison;
  const std::set<std::string>& known = vocabulary.for_term(term);
  const std::string& meant = term.label == nullptr ? term.text : term.label->text;
  std::string guesses;
  for (const std::string& guess :
       closest_names(meant, std::vector<std::string>(known.begin(), known.end()))) {
    guesses += (guesses.empty() ? "\"" : "\" or \"") + guess;
  }
  return guesses.empty() ? text : text + "; did you mean " + guesses + "\"?";
}

}  // namespace

std::vector<std::string> explain_no_match(const Catalog& catalog, const SearchQuery& query) {
  std::vector<Term> terms = terms_of(query);
  Vocabulary vocabulary;
  for (const std::string& name : catalog.names()) {
    const std::optional<Element> element = catalog.find(name);
    if (!element) continue;  // another program has just removed it
    vocabulary.add(*element);
    for (Term& term : terms) term.is_matched = term.is_matched || matches(*element, term.query);
  }
  std::vector<std::string> sentences;
  for (const Term& term : terms) {
    if (!term.is_matched) sentences.push_back(sentence(term, vocabulary));
  }
  if (sentences.empty() && terms.size() > 1) {
    sentences.emplace_back("each term matches some element, but none matches all of them");
  }
  return sentences;
}

}  // namespace dowel
