#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/rig/head.h"

namespace fsm {

/// The skin unrolled: for every cell over HeadTopology::uv, where on the resting head it lies.
/// Where surfaces lie behind each other (the inside of the lips), the outer one counts.
struct SkinMap {
  enum Kind : std::uint8_t { kNone, kSkin, kLip };
  static constexpr int kCells = 256;  ///< along each side

  SkinMap(const HeadTopology& topology, const HeadVertices& rest);

  /// The index of the cell in column x and row y, row 0 at v = 0.
  static std::size_t Index(int x, int y) {
    return static_cast<std::size_t>(y) * kCells + static_cast<std::size_t>(x);
  }
  /// The kind of skin at uv; kNone outside.
  Kind KindAt(float u, float v) const;
  /// The place at uv, between those of the cells.
  glm::vec3 PlaceAt(float u, float v) const;

  std::vector<Kind> kind;
  std::vector<glm::vec3> place;  ///< millimetres

 private:
  void Fill(const HeadTopology& topology, const HeadVertices& rest, const std::uint32_t* corners,
            Kind what);
  std::vector<float> outward_;  // distance from the vertical axis of what is drawn so far
};

}  // namespace fsm
