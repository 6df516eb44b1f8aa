#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace dowel {

/// FNV-1a, 64 bits: finds damage and equal content, not malice. Source: Fowler, Noll, Vo,
/// draft-eastlake-fnv.
inline std::uint64_t checksum(std::span<const std::byte> bytes) noexcept {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const std::byte byte : bytes) {
    hash = (hash ^ std::to_integer<std::uint64_t>(byte)) * 0x100000001b3U;
  }
  return hash;
}

}  // namespace dowel
