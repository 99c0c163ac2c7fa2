#pragma once

#include <algorithm>
#include <cmath>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "fsm/base/smooth_step.h"
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
  CreaseRelief(const FaceLandmarks& landmarks, const Appearance& appearance)
      : landmarks_(landmarks), skin_(appearance.skin) {}
  /// How high above the skin a place lies when all creases are at their deepest, millimetres.
  float HeightAt(const glm::vec3& place) const;
  /// False where no crease is within a few millimetres.
  bool MayCrease(const glm::vec3& place) const;

 private:
  float Furrow(float off, float width) const;
  // The creases of one region; `side` is how far the place is from the median. Each adds to what
  // there is.
  void AddForehead(const glm::vec3& p, float side, float& height) const;
  void AddGlabella(const glm::vec3& p, float side, float& height) const;
  void AddBridge(const glm::vec3& p, float side, float& height) const;
  void AddCrowsFeet(const glm::vec3& p, float side, float& height) const;
  void AddNasolabial(const glm::vec3& p, float side, float& height) const;

  const FaceLandmarks& landmarks_;
  const decltype(Appearance::skin)& skin_;
};

/// Draws hairs into the tint, each a bent line that ends in a point.
void PaintHairs(std::span<const SkinHair> hairs, SkinTexture& out);

}  // namespace fsm
