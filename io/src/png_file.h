#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dowel {

/// Pixels as a PNG file. `rgb`: sRGB bytes, three a pixel, row by row from the top.
/// Expects: 3 x width x height bytes, neither side 0. Throws Error{InvalidInput} where the format
/// cannot hold the picture.
std::vector<std::byte> encode_png(std::span<const std::uint8_t> rgb, std::uint32_t width_px,
                                  std::uint32_t height_px);

}  // namespace dowel
