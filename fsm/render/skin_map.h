#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/rig/head.h"

namespace fsm {

/// The skin unrolled: for each cell of HeadSurface::uv the position on the resting head. Where
/// surfaces overlap (the inside of the lips), the outer one is kept.
struct SkinMap {
  enum Kind : std::uint8_t { kNone, kSkin, kLip };
  static constexpr int kCells = 256;  ///< along each side

  SkinMap(const HeadSurface& surface, const HeadVertices& rest);

  /// Returns the index of the cell in column x and row y; row 0 is at v = 0.
  static std::size_t Index(int x, int y) {
    return static_cast<std::size_t>(y) * kCells + static_cast<std::size_t>(x);
  }
  /// Returns the kind of skin at uv; kNone outside.
  Kind KindAt(float u, float v) const;
  /// Returns the position at uv, interpolated between cells.
  glm::vec3 PositionAt(float u, float v) const;

  std::vector<Kind> kind;
  std::vector<glm::vec3> position;  ///< millimetres

 private:
  void Fill(const HeadSurface& surface, const HeadVertices& rest, const std::uint32_t* corners,
            Kind what);
  std::vector<float> outward_;  // distance from the vertical axis of the surface kept so far
};

}  // namespace fsm
