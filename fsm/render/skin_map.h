#pragma once

#include <cstdint>
#include <glm/vec3.hpp>
#include <vector>

#include "fsm/head/head.h"

namespace fsm {

/// The skin unrolled: for every texel over HeadTopology::uv, where on the resting head it lies.
/// Where surfaces lie behind each other (the inside of the lips), the outer one counts.
struct SkinMap {
  enum Kind : std::uint8_t { kNone, kSkin, kLip };

  SkinMap(const HeadTopology& topology, const HeadVertices& rest, int side);

  /// Of the texel in column x and row y of a map of SkinTexture::kSide.
  static std::size_t Index(int x, int y);

  std::vector<Kind> kind;
  std::vector<glm::vec3> place;  ///< millimetres

 private:
  void Fill(const HeadTopology& topology, const HeadVertices& rest, const std::uint32_t* corners,
            Kind what, int side);
  std::vector<float> outward_;  // distance from the vertical axis of what is drawn so far
};

}  // namespace fsm
