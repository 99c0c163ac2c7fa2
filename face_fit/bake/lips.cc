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

/// The mean of the texels whose rank by redness is `from` to `to` of the way from the least red to
/// the reddest. Sorts them.
ToneStatistics MeanOf(std::vector<glm::vec3>& texels, float from, float to) {
  ToneStatistics kind;
  std::ranges::sort(texels, {}, LogRedness);
  const auto at = [&](float part) {
    return static_cast<std::size_t>(part * static_cast<float>(texels.size() - 1));
  };
  for (std::size_t i = at(from); i <= at(to); ++i) kind.colour += texels[i];
  kind.colour /= static_cast<float>(at(to) - at(from) + 1);
  kind.redness = LogRedness(kind.colour);
  kind.brightness = Brightness(kind.colour);
  return kind;
}

}  // namespace

void RestoreLipColour(const SkinTexels& texels, fsm::Image& map) {
  const fsm::NumberTable& look = PhotoLook();
  const float sure = look("lip_inside"), soft = look("lip_soft"), most = look("lip_reddened");
  const glm::vec2 skin_from = look.Pair("lip_beside");
  constexpr float kLeast = 0.05F;  // between lips and skin, of redness
  std::vector<glm::vec3> lips, beside;
  for (std::size_t i = 0; i < texels.at.size(); ++i) {
    if (texels.at[i].within_lips_mm > sure) lips.push_back(Rgb(map, i));
    if (texels.at[i].within_lips_mm > skin_from.x && texels.at[i].within_lips_mm < skin_from.y)
      beside.push_back(Rgb(map, i));
  }
  if (lips.empty() || beside.empty()) return;
  const ToneStatistics lip = MeanOf(lips, 0.7F, 0.95F), skin = MeanOf(beside, 0.3F, 0.7F);
  if (lip.redness - skin.redness < kLeast) return;
  const glm::vec3 hue = lip.colour / lip.brightness;
  const float darker = glm::clamp(lip.brightness / skin.brightness, 0.5F, 1.0F);
  for (std::size_t i = 0; i < texels.at.size(); ++i) {
    if (texels.at[i].within_lips_mm <= 0) continue;
    const glm::vec3 c = Rgb(map, i);
    const float bright = Brightness(c);
    const float lacks =
        glm::clamp((lip.redness - LogRedness(c)) / (lip.redness - skin.redness), 0.0F, 1.0F);
    // What shines, and what is dark between the lips, has a colour of its own.
    const float part = most * lacks * glm::smoothstep(0.0F, soft, texels.at[i].within_lips_mm) *
                       glm::smoothstep(1.2F, 1.05F, bright / skin.brightness) *
                       glm::smoothstep(0.2F, 0.5F, bright / skin.brightness);
    SetRgb(map, i, glm::mix(c, hue * bright * darker, part));
  }
}

}  // namespace facefit
