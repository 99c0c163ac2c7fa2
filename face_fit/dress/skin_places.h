#pragma once

#include <glm/vec2.hpp>
#include <vector>

#include "face_fit/dress/dress.h"

namespace facefit {

inline std::size_t MapIndex(int x, int y) {
  return static_cast<std::size_t>(y) * kMapSide + static_cast<std::size_t>(x);
}

inline constexpr float kBrowsEnd = 27;  ///< millimetres above the nasion

/// For each texel of the skin's map: where it lies in a photo, and how squarely it was seen.
struct SkinPlaces {
  std::vector<glm::vec2> pixel;
  std::vector<float> facing, outward;
  std::vector<float> across;    ///< millimetres to the person's left of the middle
  std::vector<float> up;        ///< millimetres above the brows
  std::vector<float> off_seam;  ///< millimetres from where the lips meet
  std::vector<float> red;       ///< millimetres within the border of the lips, negative outside
  std::vector<float> aside;     ///< 1 on the sides of the head and below the chin, 0 on the face
  SkinPlaces()
      : pixel(static_cast<std::size_t>(kMapSide) * kMapSide),
        facing(pixel.size(), -1),
        outward(pixel.size(), -1e9F),
        across(pixel.size(), 0),
        up(pixel.size(), -1),
        off_seam(pixel.size(), 1e9F),
        red(pixel.size(), -1e9F),
        aside(pixel.size(), 0) {}
};

/// Whether a texel belongs to what is counted as face.
inline bool OnFront(const SkinPlaces& places, std::size_t i) {
  return places.outward[i] > 0 && i / kMapSide > kMapSide / 5 && i / kMapSide < kMapSide * 3 / 4;
}

/// Where the skin of the fitted head, in the photo's expression, lies for a camera of some pose.
/// `hidden`: what the head itself hides, as the jaw does the throat, is not seen (facing -1).
SkinPlaces PlaceSkin(const BaseHead& base, const Fit& fit, const Pose& pose, bool hidden);

}  // namespace facefit
