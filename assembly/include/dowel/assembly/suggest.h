#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace dowel {

/// Names that `word` may have been meant for, best first, at most `count`: equal but for case, then
/// by edit distance (insert, delete, replace, swap neighbours) up to a third of the word's length,
/// then those that start with it. Ties in the order of `candidates`.
std::vector<std::string> similar_words(std::string_view word,
                                       const std::vector<std::string>& candidates,
                                       std::size_t count = 3);

/// "; did you mean A, B or C?" or nothing where there are none.
std::string did_you_mean(const std::vector<std::string>& suggestions);

}  // namespace dowel
