#include "face_fit/bake/other_side.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/inpaint.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Texels that light is told for together.
constexpr int kCell = 8;

/// For each cell of a map what the light of its own side is, as part of that of the other side.
class Light {
 public:
  Light(const std::vector<bool>& skin, const fsm::Image& map, const FloatImage& seen)
      : width_((map.width + kCell - 1) / kCell),
        height_((map.height + kCell - 1) / kCell),
        gain_{FloatImage(width_, height_, 1), FloatImage(width_, height_, 1),
              FloatImage(width_, height_, 1)} {
    std::array<FloatImage, 3> own{gain_}, other{gain_};
    for (auto* fields : {&own, &other}) {
      for (FloatImage& field : *fields) field = FloatImage(width_, height_);
    }
    FloatImage both(width_, height_);
    for (int y = 0; y < map.height; ++y) {
      for (int x = 0; x < map.width; ++x) {
        const std::size_t i = seen.Index(x, y), j = seen.Index(map.width - 1 - x, y);
        if (!skin[i] || !skin[j]) continue;
        const float weight = seen.at[i] * seen.at[j];
        const std::size_t cell = both.Index(x / kCell, y / kCell);
        both.at[cell] += weight / (kCell * kCell);
        for (std::size_t c = 0; c < 3; ++c) {
          own[c].at[cell] += weight * map.rgba[4 * i + c];
          other[c].at[cell] += weight * map.rgba[4 * j + c];
        }
      }
    }
    const glm::vec2 limit = PhotoLook().Pair("light_gain");
    // From wide to narrow: what lies nearest counts most, where enough of it was seen.
    for (const int part : {2, 8, 20, 40}) {
      const int reach = std::max(width_ / part, 1);
      const FloatImage share = Blurred(both, reach);
      for (std::size_t c = 0; c < 3; ++c) {
        const FloatImage here = Blurred(own[c], reach), there = Blurred(other[c], reach);
        for (std::size_t i = 0; i < share.at.size(); ++i) {
          if (there.at[i] <= 0) continue;
          gain_[c].at[i] =
              glm::mix(gain_[c].at[i], glm::clamp(here.at[i] / there.at[i], limit.x, limit.y),
                       glm::smoothstep(0.0F, 0.1F, share.at[i]));
        }
      }
    }
  }
  glm::vec3 At(int x, int y) const {
    const float u = (static_cast<float>(x) + 0.5F) / kCell,
                v = (static_cast<float>(y) + 0.5F) / kCell;
    return {gain_[0].Between(u, v), gain_[1].Between(u, v), gain_[2].Between(u, v)};
  }

 private:
  int width_, height_;
  std::array<FloatImage, 3> gain_;
};

}  // namespace

void TakeFromOtherSide(const std::vector<bool>& skin, fsm::Image& map, FloatImage& seen) {
  const Light light(skin, map, seen);
  const fsm::Image one_side = map;
  const FloatImage seen_once = seen;
  // What shines or is in the shade on the other side alone, as a wing of the nose in the sun, is
  // kept near to what lies around it here.
  fsm::Image around = map;
  PushPullInpaint(around, seen_once);
  const FloatImage near = Blurred(seen_once, std::max(map.width / 50, 1));
  constexpr float kAny = 50;
  const glm::vec2 near_light = PhotoLook().Pair("other_side_light");
  for (int y = 0; y < map.height; ++y) {
    for (int x = 0; x < map.width; ++x) {
      const std::size_t i = seen.Index(x, y), j = seen.Index(map.width - 1 - x, y);
      const float part = std::max(seen_once.at[j] - seen_once.at[i], 0.0F) * 0.5F;
      if (part <= 0 || !skin[i]) continue;
      const float sum = seen_once.at[i] + part;
      const glm::vec3 gain = light.At(x, y);
      const float held = glm::smoothstep(0.05F, 0.4F, near.at[i]);
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
