#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "dowel/io/import.h"

namespace dowel {

/// An import's result as bytes, to pass from a worker to its parent on the same machine. The format
/// is private to one version of the program.
std::vector<std::byte> encode(const ImportResult& result);

/// The result that `encode` wrote. The worker may have gone astray before it sent it: every length
/// is checked before it is used. Throws Error{FileMalformed}.
ImportResult decode_result(std::span<const std::byte> bytes);

}  // namespace dowel
