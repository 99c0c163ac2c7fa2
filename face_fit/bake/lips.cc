#include "face_fit/bake/lips.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "face_fit/picture/pixels.h"
#include "face_fit/picture/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

float LogRedness(glm::vec3 c) { return std::log((c.r + 4) / (c.g + 4)); }

struct ToneStatistics {
  glm::vec3 colour{0};
  float redness = 0, brightness = 0;
};

/// The mean of the texels whose ranks by redness, 0 for the least red and 1 for the reddest, are in
/// a range. Sorts them.
ToneStatistics MeanOf(std::vector<glm::vec3>& texels, glm::vec2 ranks) {
  ToneStatistics kind;
  std::ranges::sort(texels, {}, LogRedness);
  const auto at = [&](float part) {
    return static_cast<std::size_t>(part * static_cast<float>(texels.size() - 1));
  };
  for (std::size_t i = at(ranks.x); i <= at(ranks.y); ++i) kind.colour += texels[i];
  kind.colour /= static_cast<float>(at(ranks.y) - at(ranks.x) + 1);
  kind.redness = LogRedness(kind.colour);
  kind.brightness = Brightness(kind.colour);
  return kind;
}

}  // namespace

void RestoreLipColour(const SkinTexels& texels, fsm::Image& map) {
  const fsm::NumberTable& look = PhotoLook();
  const float sure = look("lip_inside"), soft = look("lip_soft"), most = look("lip_reddened");
  const glm::vec2 skin_from = look.Pair("lip_beside");
  const glm::vec2 shine = look.Pair("lip_shine"), gap = look.Pair("lip_gap");
  constexpr float kLeast = 0.05F;  // between lips and skin, of redness
  std::vector<glm::vec3> lips, beside;
  for (std::size_t i = 0; i < texels.at.size(); ++i) {
    if (texels.at[i].within_lips_mm > sure) lips.push_back(Rgb(map, i));
    if (texels.at[i].within_lips_mm > skin_from.x && texels.at[i].within_lips_mm < skin_from.y)
      beside.push_back(Rgb(map, i));
  }
  if (lips.empty() || beside.empty()) return;
  const ToneStatistics lip = MeanOf(lips, look.Pair("lip_ranks")),
                       skin = MeanOf(beside, look.Pair("lip_beside_ranks"));
  if (lip.redness - skin.redness < kLeast) return;
  const glm::vec3 hue = lip.colour / lip.brightness;
  const float darker = glm::clamp(lip.brightness / skin.brightness, look("lip_darkest"), 1.0F);
  for (std::size_t i = 0; i < texels.at.size(); ++i) {
    if (texels.at[i].within_lips_mm <= 0) continue;
    const glm::vec3 c = Rgb(map, i);
    const float bright = Brightness(c);
    const float lacks =
        glm::clamp((lip.redness - LogRedness(c)) / (lip.redness - skin.redness), 0.0F, 1.0F);
    // What shines, and what is dark between the lips, has a colour of its own.
    const float part = most * lacks * glm::smoothstep(0.0F, soft, texels.at[i].within_lips_mm) *
                       Ramp(shine, bright / skin.brightness) * Ramp(gap, bright / skin.brightness);
    SetRgb(map, i, glm::mix(c, hue * bright * darker, part));
  }
}

}  // namespace facefit
