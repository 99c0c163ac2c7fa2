#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace fsm {

/// Returns the bytes of a text. Lifetime: that of the text.
inline std::span<const std::uint8_t> BytesOf(std::string_view text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

/// Read unsigned numbers of `count` bytes at `offset`. REQUIRES: offset + count <= bytes.size().
inline std::uint32_t LittleEndian(std::span<const std::uint8_t> bytes, std::size_t offset,
                                  std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = count; i-- > 0;) value = value << 8 | bytes[offset + i];
  return value;
}

inline std::uint32_t BigEndian(std::span<const std::uint8_t> bytes, std::size_t offset,
                               std::size_t count) {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < count; ++i) value = value << 8 | bytes[offset + i];
  return value;
}

inline void AppendLittleEndian(std::vector<std::uint8_t>& out, std::uint32_t value,
                               std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) out.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

inline void AppendBigEndian(std::vector<std::uint8_t>& out, std::uint32_t value,
                            std::size_t count) {
  for (std::size_t i = count; i-- > 0;) out.push_back(static_cast<std::uint8_t>(value >> 8 * i));
}

}  // namespace fsm
