#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>

#include "dowel/catalog/catalog.h"
#include "dowel/catalog/element.h"

namespace dowel {

/// Called after each element of a sheet; false stops the drawing.
using SheetCallback = std::function<bool(std::size_t done, std::size_t total)>;

/// One HTML page that needs nothing else and loads nothing: each of `elements`, by family, drawn
/// with its features coloured by kind and named, and its data. What the first picture hides is
/// shown in a second one from the opposite corner. Texts are shown as they are, whatever is in
/// them. Same catalogue, same bytes. Cost: some 50 ms and 20 kB an element.
/// Expects: `elements` as `catalog` has them.
/// Throws Error where the facets of an element cannot be read.
std::string to_sheet(const Catalog& catalog, std::span<const Element> elements,
                     const SheetCallback& on_element = nullptr);

/// Writes `to_sheet`. The file appears whole or not at all; not where the callback stops it.
/// Throws Error{FileUnwritable}, too.
void write_sheet(const std::filesystem::path& file, const Catalog& catalog,
                 std::span<const Element> elements, const SheetCallback& on_element = nullptr);

}  // namespace dowel
