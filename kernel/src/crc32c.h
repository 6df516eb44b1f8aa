#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace dowel {

/// CRC-32C (Castagnoli) of `bytes`, as iSCSI and ext4 use it: that of "123456789" is 0xE3069283.
std::uint32_t crc32c(std::span<const std::byte> bytes);

}  // namespace dowel
