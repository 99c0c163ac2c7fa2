#include "face_fit/bake/lips.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>
#include <vector>

#include "face_fit/image/pixels.h"
#include "face_fit/image/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

float LogRedness(glm::vec3 c) { return std::log((c.r + 4) / (c.g + 4)); }

struct Tone {
  explicit Tone(glm::vec3 mean)
      : colour(mean), redness(LogRedness(mean)), brightness(Brightness(mean)) {}
  glm::vec3 colour;
  float redness, brightness;
};

/// Returns the mean of the texels whose ranks by redness (0 least, 1 most) lie in a range.
Tone MeanTone(std::vector<glm::vec3> texels, fsm::Range ranks) {
  std::ranges::sort(texels, {}, LogRedness);
  const auto index = [&](float rank) {
    return static_cast<std::size_t>(rank * static_cast<float>(texels.size() - 1));
  };
  glm::vec3 sum(0);
  for (std::size_t i = index(ranks.from); i <= index(ranks.to); ++i) sum += texels[i];
  return Tone(sum / static_cast<float>(index(ranks.to) - index(ranks.from) + 1));
}

}  // namespace

void RestoreLipColour(const SkinTexels& texels, fsm::Image& map) {
  const auto& look = PhotoLook().lips;
  constexpr float kMinDifference = 0.05F;  // difference of redness between lips and skin
  std::vector<glm::vec3> lips, beside;
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (!texels[i]) continue;
    const float within_mm = texels[i]->within_lips_mm;
    if (within_mm > look.surely_inside_mm) lips.push_back(Rgb(map, i));
    if (look.skin_mm.Contains(within_mm)) beside.push_back(Rgb(map, i));
  }
  if (lips.empty() || beside.empty()) return;
  const Tone lip = MeanTone(std::move(lips), look.typical_share),
             skin = MeanTone(std::move(beside), look.typical_skin_share);
  if (lip.redness - skin.redness < kMinDifference) return;
  const glm::vec3 hue = lip.colour / lip.brightness;
  const float darker = glm::clamp(lip.brightness / skin.brightness, look.darkest, 1.0F);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (!texels[i] || texels[i]->within_lips_mm <= 0) continue;
    const glm::vec3 c = Rgb(map, i);
    const float bright = Brightness(c);
    const float lacks =
        glm::clamp((lip.redness - LogRedness(c)) / (lip.redness - skin.redness), 0.0F, 1.0F);
    // Highlights and the dark gap between the lips keep their colour.
    const float blend = look.reddened_share * lacks *
                        fsm::SmoothStep(0.0F, look.fades_in_mm, texels[i]->within_lips_mm) *
                        look.shine.Ramp(bright / skin.brightness) *
                        look.gap.Ramp(bright / skin.brightness);
    SetRgb(map, i, glm::mix(c, hue * bright * darker, blend));
  }
}

void DrawLipSeam(const SkinTexels& texels, float saturation, fsm::Image& map) {
  const auto& look = PhotoLook().lip_seam;
  const glm::vec3 dark = glm::mix(look.takes_from_grey, look.takes_from_colour, saturation);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    if (!texels[i]) continue;
    const float line = look.dark_within_mm.Ramp(texels[i]->off_lip_seam_mm);
    if (line > 0) SetRgb(map, i, Rgb(map, i) * (1.0F - dark * line));
  }
}

}  // namespace facefit
