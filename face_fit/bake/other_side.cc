#include "face_fit/bake/other_side.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// The gain is one number for each channel of a square of so many texels to a side.
constexpr int kCell = 8;

/// The light that falls on each place of a map, as part of that on the mirrored place.
class SideGain {
 public:
  SideGain(const std::vector<bool>& skin, const fsm::Image& map, const FloatImage& seen)
      : width_((map.width + kCell - 1) / kCell),
        height_((map.height + kCell - 1) / kCell),
        gain_(width_, height_, glm::vec3(1)) {
    VectorImage own(width_, height_), other = own;
    FloatImage both(width_, height_);
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        const std::size_t i = seen.Index(x, y), j = seen.Index(map.width - 1 - x, y);
        if (!skin[i] || !skin[j]) continue;
        const float weight = seen.at[i] * seen.at[j];
        both(x / kCell, y / kCell) += weight / (kCell * kCell);
        own(x / kCell, y / kCell) += weight * Rgb(map, i);
        other(x / kCell, y / kCell) += weight * Rgb(map, j);
      }
    }
    const glm::vec2 limit = PhotoLook().Pair("light_gain");
    // From wide to narrow: what lies nearest counts most, where enough of it was seen.
    for (const int part : {2, 8, 20, 40}) {
      const int reach = std::max(width_ / part, 1);
      const FloatImage known = Blurred(both, reach);
      const VectorImage here = Blurred(own, reach), there = Blurred(other, reach);
      for (std::size_t i = 0; i < known.at.size(); ++i) {
        const float weight = glm::smoothstep(0.0F, 0.1F, known.at[i]);
        for (int c = 0; c < 3; ++c) {
          if (there.at[i][c] <= 0) continue;
          const float gain = glm::clamp(here.at[i][c] / there.at[i][c], limit.x, limit.y);
          gain_.at[i][c] = glm::mix(gain_.at[i][c], gain, weight);
        }
      }
    }
  }
  glm::vec3 At(int x, int y) const {
    return gain_.Between((static_cast<float>(x) + 0.5F) / kCell,
                         (static_cast<float>(y) + 0.5F) / kCell);
  }

 private:
  int width_, height_;
  VectorImage gain_;
};

}  // namespace

void CompleteByMirroring(const std::vector<bool>& skin, fsm::Image& map, FloatImage& seen) {
  const SideGain gain_of_side(skin, map, seen);
  const fsm::Image one_side = map;
  const FloatImage seen_once = seen;
  // What shines or is in the shade on the other side alone, as a wing of the nose in the sun, is
  // kept near to what lies around it here.
  fsm::Image around = map;
  PushPullInpaint(around, seen_once);
  const FloatImage near = Blurred(seen_once, std::max(map.width / 50, 1));
  constexpr float kAny = 50;
  const glm::vec2 near_light = PhotoLook().Pair("other_side_light");
  const glm::vec2 held_by = PhotoLook().Pair("other_side_held");
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = seen.Index(x, y), j = seen.Index(map.width - 1 - x, y);
      const float part = std::max(seen_once.at[j] - seen_once.at[i], 0.0F) * 0.5F;
      if (part <= 0 || !skin[i]) continue;
      const float sum = seen_once.at[i] + part;
      const glm::vec3 gain = gain_of_side.At(x, y);
      const float held = Ramp(held_by, near.at[i]);
      const glm::vec3 here = Rgb(around, i);
      const glm::vec3 brightest = glm::min(glm::mix(kAny, near_light.y, held) * here, 255.0F);
      const glm::vec3 taken =
          glm::clamp(gain * Rgb(one_side, j), held * near_light.x * here, brightest);
      SetRgb(map, i, (seen_once.at[i] * Rgb(one_side, i) + taken * part) / sum);
      seen.at[i] = sum;
    }
  }
}

}  // namespace facefit
