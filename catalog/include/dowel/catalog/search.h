#pragma once

#include <cstddef>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "dowel/catalog/catalog.h"
#include "dowel/catalog/element.h"

namespace dowel {

/// What a number of an element must lie between, bounds included.
struct SearchCondition {
  enum class Quantity {
    Length,    ///< mm, of the element's box along the box axis closest to x
    Width,     ///< mm, the same for y
    Height,    ///< mm, the same for z
    Hole,      ///< mm, diameter of some cylinder of some hole
    Shaft,     ///< mm, diameter of some shaft
    Slot,      ///< mm, width of some slot
    Diameter,  ///< mm, either of the two
    Depth,     ///< mm, of some hole
    Holes,     ///< how many holes it has
    Volume     ///< mm^3
  };
  Quantity quantity = Quantity::Length;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
};

/// All of it must hold. Words are lower case; each must occur in the element's name, family, shape
/// class or in the name of one of its features, whatever the case there.
struct SearchQuery {
  std::vector<std::string> words;
  std::vector<SearchCondition> conditions;
};

/// Reads terms as a user types them: words, and `height>=80`, `hole=12`, `d<10`, `length=80..120`.
/// Lengths are mm and compared within kCoincident_mm, so that a riser of 80 mm is one of `>=80`,
/// whatever rounding its box carries. Throws Error{InvalidInput} naming the term and what is
/// expected.
SearchQuery parse_query(std::span<const std::string> terms);

bool matches(const Element& element, const SearchQuery& query);

/// The elements that match, best first: by where the words occur (name before family before the
/// rest), then by name. Reads no mesh.
std::vector<Element> search(const Catalog& catalog, const SearchQuery& query);

/// Which of `candidates` a person who typed `name` may have meant, best first, at most `count`:
/// those that begin with it, contain it, or are a few typing errors away; case does not matter.
std::vector<std::string> closest_names(std::string_view name,
                                       std::span<const std::string> candidates,
                                       std::size_t count = 3);

}  // namespace dowel
