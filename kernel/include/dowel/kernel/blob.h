#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dowel/kernel/faceted_solid.h"

namespace dowel {

/// Bytes of `solid`: magic, version, length, little-endian sections, CRC-32C. The same solid gives
/// the same bytes on every machine. Expects: one face index per triangle.
std::vector<std::byte> to_blob(const FacetedSolid& solid);

/// The solid that `to_blob` wrote, to the bit. Blobs are untrusted: every length and index is
/// checked before it is used, memory is bounded by the size of the input, and all values are in
/// range one by one. That the triangles close is `find_defect`'s to say, at import.
/// Throws Error{FileMalformed} (truncated, damaged, bad index) or Error{SchemaMismatch} (newer
/// version), naming `what` (for example "element plate").
FacetedSolid from_blob(std::span<const std::byte> blob, const char* what);

}  // namespace dowel
