#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "fsm/base/spline.h"
#include "fsm/render/appearance.h"
#include "fsm/render/skin_map.h"
#include "fsm/render/skin_texture.h"

namespace fsm {

/// About exp(-(x / width)^2), and 0 from two widths on; of a width of 0 or less 0 all over.
inline float Bell(float x, float width) {
  if (!(std::abs(x) < 2 * width)) return 0;
  const float t = std::max(1 - x * x / (4 * width * width), 0.0F);
  return t * t * t * t;
}

/// Four of the numbers of a row, as a tint.
inline glm::vec4 TintOf(const std::vector<float>& n, std::size_t first) {
  return {n[first], n[first + 1], n[first + 2], n[first + 3]};
}

/// What changes slowly over the skin, one for each cell of a SkinMap.
struct SkinRegion {
  glm::vec4 tint{1.0F};  ///< factors on colour and on highlights
  float pores = 0;       ///< how strongly they show, 0..1
  float cracks = 0;      ///< the same of the lines of lips
};
std::vector<SkinRegion> PaintRegions(const SkinMap& map, const FaceLandmarks& landmarks,
                                     const Appearance& appearance);

/// The creases of expression as a relief on the skin of a face. What it is made of outlives it.
class CreaseRelief {
 public:
  CreaseRelief(const FaceLandmarks& landmarks, const Appearance& appearance);
  /// How high above the skin a place lies when all creases are at their deepest, millimetres.
  float HeightAt(const glm::vec3& place) const;
  /// False where no crease is within a few millimetres.
  bool MayCrease(const glm::vec3& place) const;

 private:
  using Numbers = std::vector<float>;
  float Furrow(float off, float width) const;
  // The creases of one region; `side` is how far the place is from the median. Each adds to what
  // there is.
  void AddForehead(const glm::vec3& p, float side, float& height) const;
  void AddGlabella(const glm::vec3& p, float side, float& height) const;
  void AddBridge(const glm::vec3& p, float side, float& height) const;
  void AddCrowsFeet(const glm::vec3& p, float side, float& height) const;
  void AddNasolabial(const glm::vec3& p, float side, float& height) const;

  const FaceLandmarks& m_;
  const float swelling_;
  const Numbers &lines_, &depth_, &form_, &reach_;  // of the forehead
  const Numbers &glabella_, &nasion_, &bridge_, &crows_feet_, &nasolabial_;
};

/// Draws hairs into the tint, each a bent line that ends in a point.
void PaintHairs(std::span<const SkinHair> hairs, SkinTexture& out);

}  // namespace fsm
