#include "face_fit/bake/smile_shade.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Where on the base face a smile shades the skin, 0..1.
class Cheeks {
 public:
  explicit Cheeks(const BaseHead& base) : brows_(base.head->Landmark("nasion").y + kBrowsEnd) {
    using namespace point;
    const auto at = [&base](PointIndex i) { return base.AtRest(i); };
    eyes_ = 0.5F * (at(kEyeBottomRight).y + at(kEyeBottomLeft).y);
    wing_ = 0.5F * std::abs(at(kNoseRight).x - at(kNoseLeft).x);
    nose_ = at(kNoseBottom).y;
    chin_ = at(kChin).y;
  }
  float At(const SkinTexels& texels, std::size_t i) const {
    const float y = Y(texels, i), x = std::abs(texels.across[i]);
    return glm::smoothstep(eyes_ - 10, eyes_ - 22, y) * glm::smoothstep(chin_ + 8, chin_ + 20, y) *
           glm::smoothstep(58.0F, 44.0F, x) *
           std::max(glm::smoothstep(wing_ + 1, wing_ + 7, x),
                    0.7F * glm::smoothstep(nose_ - 3, nose_ - 7, y)) *
           glm::smoothstep(-1.5F, -4.0F, texels.within_lips_mm[i]);
  }
  /// Whether it is skin that can stand for the cheeks: no lips, no nose.
  bool Skin(const SkinTexels& texels, std::size_t i) const {
    const float y = Y(texels, i), x = std::abs(texels.across[i]);
    return texels.within_lips_mm[i] < -2 && y < eyes_ - 8 && (x > wing_ || y < nose_ - 2);
  }

 private:
  float Y(const SkinTexels& texels, std::size_t i) const { return texels.up[i] + brows_; }
  float brows_, eyes_ = 0, wing_ = 0, nose_ = 0, chin_ = 0;
};

/// Means of one channel over a width, of what has weight.
class Means {
 public:
  Means(const FloatImage& weight, int reach) : weight_(weight), reach_(reach), sum_(Soft(weight)) {}
  /// How much there is to go by near a texel, 0..1.
  float Known(std::size_t i) const { return sum_.at[i]; }
  FloatImage Of(const FloatImage& values) const {
    FloatImage weighted = values;
    for (std::size_t i = 0; i < weighted.at.size(); ++i) weighted.at[i] *= weight_.at[i];
    FloatImage means = Soft(weighted);
    for (std::size_t i = 0; i < means.at.size(); ++i) means.at[i] /= std::max(sum_.at[i], 1e-3F);
    return means;
  }

 private:
  FloatImage Soft(const FloatImage& field) const { return Blurred(Blurred(field, reach_), reach_); }
  const FloatImage& weight_;
  int reach_;
  FloatImage sum_;
};

}  // namespace

void EvenSmileShade(const BaseHead& base, const SkinTexels& texels, const FloatImage& seen,
                    float smile, fsm::Image& map) {
  if (smile <= 0) return;
  const glm::ivec2 reach(PhotoLook().Pair("shade_texels"));
  const Cheeks cheeks(base);
  FloatImage weight(kMapSide, kMapSide);
  for (std::size_t i = 0; i < weight.at.size(); ++i) {
    weight.at[i] = cheeks.Skin(texels, i) ? seen.at[i] * seen.at[i] : 0.0F;
  }
  const Means fine(weight, reach.x), wide(weight, reach.y);
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const FloatImage values = Channel(map, channel);
    const FloatImage near = fine.Of(values), far = wide.Of(values);
    for (std::size_t i = 0; i < values.at.size(); ++i) {
      const float part = smile * cheeks.At(texels, i) * glm::smoothstep(0.1F, 0.5F, fine.Known(i));
      if (part <= 0) continue;
      const float even = (far.at[i] + 1) / (near.at[i] + 1);
      map.rgba[4 * i + channel] = Byte(values.at[i] * glm::mix(1.0F, even, part));
    }
  }
}

void GrainFromCheeks(const FloatImage& smooth, fsm::Image& map) {
  if (std::ranges::none_of(smooth.at, [](float s) { return s > 0; })) return;
  constexpr int kUp = 48, kOut = 36;  // texels, some 12 and 9 millimetres
  constexpr int kGrain = 8;           // what varies over more is no grain
  constexpr float kMost = 0.12F;      // of the brightness: more is a line, not grain
  for (std::size_t channel = 0; channel < 3; ++channel) {
    const FloatImage values = Channel(map, channel);
    const FloatImage means = Blurred(Blurred(values, kGrain), kGrain);
    for (int y = kUp; y < kMapSide; ++y) {
      for (int x = kOut; x < kMapSide - kOut; ++x) {
        const std::size_t i = MapIndex(x, y);
        if (smooth.at[i] <= 0) continue;
        const std::size_t from = MapIndex(x < kMapSide / 2 ? x - kOut : x + kOut, y - kUp);
        const float grain = (values.at[from] + 1) / (means.at[from] + 1) - 1;
        map.rgba[4 * i + channel] =
            Byte(values.at[i] * (1 + smooth.at[i] * glm::clamp(grain, -kMost, kMost)));
      }
    }
  }
}

}  // namespace facefit
