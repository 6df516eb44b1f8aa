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
    Diameter,  ///< mm, either of hole and shaft
    Depth,     ///< mm, of some hole
    Holes,     ///< how many holes it has
    Circle,    ///< mm, pitch circle diameter of some bolt circle
    Volume,    ///< mm^3
    Mass       ///< kg; an element without a density has none
  };
  Quantity quantity = Quantity::Length;
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  std::string term{};  ///< as it was typed, for messages
};

/// A word that the element, or some feature of it, must carry.
struct SearchLabel {
  enum class What {
    Thread,       ///< of some hole or shaft, stated or likely
    HoleThread,   ///< of some hole
    ShaftThread,  ///< of some shaft
    Fit,          ///< ISO 286 class of some feature, in its case: H7 is a hole's, h7 a shaft's
    Role,         ///< of the element
    Material      ///< of the element; a part of it will do
  };
  What what = What::Thread;
  std::string text;    ///< but for Fit in lower case
  std::string term{};  ///< as it was typed, for messages
};

/// All of it must hold. Words are lower case; each must occur in the element's name, family, role,
/// shape class, description, material or source of dimensions, or in the name, use, thread or kind
/// of one of its features, whatever the case there.
struct SearchQuery {
  std::vector<std::string> words;
  std::vector<SearchCondition> conditions;
  std::vector<SearchLabel> labels;
};

/// Reads terms as a user types them: words, and `height>=80`, `hole=12`, `d<10`, `length=80..120`,
/// `mass<=2kg`, `thread=M12`, `fit=H7`, `role=clamp`. `hole M12` is `hole=M12`: a hole with that
/// thread. Lengths are mm, and may say so (`height>=80mm`); they are compared within
/// kCoincident_mm, so that a riser of 80 mm is one of
/// `>=80`, whatever rounding its box carries. Throws Error{InvalidInput} naming the term, its place
/// in the query and what is expected.
SearchQuery parse_query(std::span<const std::string> terms);

bool matches(const Element& element, const SearchQuery& query);

/// The elements that match, best first: by where the words occur (name before family before the
/// rest), then by name. Reads no mesh.
std::vector<Element> search(const Catalog& catalog, const SearchQuery& query);

/// Why a search found nothing: a sentence for each term that no element matches even by itself,
/// with what may have been meant; where each matches some, one that says so. Reads no mesh.
std::vector<std::string> explain_no_match(const Catalog& catalog, const SearchQuery& query);

/// Which of `candidates` a person who typed `name` may have meant, best first, at most `count`:
/// those that begin with it, contain it, or are a few typing errors away; case does not matter.
std::vector<std::string> closest_names(std::string_view name,
                                       std::span<const std::string> candidates,
                                       std::size_t count = 3);

}  // namespace dowel
