#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "face_fit/bake/texture_bake.h"

namespace facefit {

inline std::size_t MapIndex(int x, int y) {
  return static_cast<std::size_t>(y) * kMapSide + static_cast<std::size_t>(x);
}

inline constexpr float kBrowsEnd = 27;  ///< millimetres above the nasion

/// For each texel of the skin's map: where it lies in a photo, and how squarely it was seen.
struct SkinTexels {
  std::vector<glm::vec2> pixel;
  std::vector<float> facing;    ///< cosine of its normal to the way to the camera; -1 = not seen
  std::vector<float> outward;   ///< square of its distance from the head's upright axis, at rest
  std::vector<float> across;    ///< millimetres to the person's left of the middle
  std::vector<float> up;        ///< millimetres above the brows
  std::vector<float> off_seam;  ///< millimetres from where the lips meet
  std::vector<float> within_lips_mm;  ///< of the border of the lips, negative outside
  std::vector<float> aside;  ///< 1 on the sides of the head and below the chin, 0 on the face
  SkinTexels()
      : pixel(static_cast<std::size_t>(kMapSide) * kMapSide),
        facing(pixel.size(), -1),
        outward(pixel.size(), -1e9F),
        across(pixel.size(), 0),
        up(pixel.size(), -1),
        off_seam(pixel.size(), 1e9F),
        within_lips_mm(pixel.size(), -1e9F),
        aside(pixel.size(), 0) {}
};

/// Whether a texel belongs to what is counted as face.
inline bool OnFront(const SkinTexels& texels, std::size_t i) {
  return texels.outward[i] > 0 && i / kMapSide > kMapSide / 5 && i / kMapSide < kMapSide * 3 / 4;
}

/// For each texel of the skin's map its place in a photo taken with `pose`. `hidden`: skin that the
/// head itself covers, as the jaw covers the throat, counts as not seen (facing -1). Texels that no
/// triangle covers keep the values of a new SkinTexels.
SkinTexels ProjectSkin(const BaseHead& base, const FittedHead& fitted, const CameraPose& pose,
                       bool hidden);

}  // namespace facefit
