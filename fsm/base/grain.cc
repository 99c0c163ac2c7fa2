#include "fsm/base/grain.h"

#include <cstdint>

namespace fsm {

float Grain(int i, int j) {
  std::uint32_t h =
      static_cast<std::uint32_t>(i) * 0x9E3779B1u ^ static_cast<std::uint32_t>(j) * 0x85EBCA77u;
  h ^= h >> 15;
  h *= 0x2C1B3C6Du;
  h ^= h >> 13;
  return static_cast<float>(h & 0xFFFFu) / 32767.5f - 1.0f;
}

}  // namespace fsm
