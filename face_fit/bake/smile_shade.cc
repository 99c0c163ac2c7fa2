#include "face_fit/bake/smile_shade.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// What stands for the cheeks: skin at least so far from lips, eyes and nose.
constexpr float kFromLips = -2, kFromEyes = -8, kFromNose = -2;

/// Where on the base face a smile shades the skin: from below the eyes to above the chin, beside
/// the wings of the nose and, less, below it.
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
    const float y = Y(texels, i), x = std::abs(texels.at[i].x_mm);
    return Ramp(eyes_ + below_eyes_, y) * Ramp(chin_ + above_chin_, y) * Ramp(beside_middle_, x) *
           std::max(Ramp(wing_ + beside_wings_, x),
                    below_nose_part_ * Ramp(nose_ + below_nose_, y)) *
           Ramp(outside_lips_, texels.at[i].within_lips_mm);
  }
  /// Whether it is skin that can stand for the cheeks: no lips, no nose.
  bool Skin(const SkinTexels& texels, std::size_t i) const {
    const float y = Y(texels, i), x = std::abs(texels.at[i].x_mm);
    return texels.at[i].within_lips_mm < kFromLips && y < eyes_ + kFromEyes &&
           (x > wing_ || y < nose_ + kFromNose);
  }

 private:
  float Y(const SkinTexels& texels, std::size_t i) const {
    return texels.at[i].above_brows_mm + brows_;
  }
  const glm::vec2 below_eyes_ = PhotoLook().Pair("shade_below_eyes");
  const glm::vec2 above_chin_ = PhotoLook().Pair("shade_above_chin");
  const glm::vec2 beside_middle_ = PhotoLook().Pair("shade_beside_middle");
  const glm::vec2 beside_wings_ = PhotoLook().Pair("shade_beside_wings");
  const glm::vec2 below_nose_ = PhotoLook().Pair("shade_below_nose");
  const float below_nose_part_ = PhotoLook()("shade_below_nose_part");
  const glm::vec2 outside_lips_ = PhotoLook().Pair("shade_outside_lips");
  float brows_, eyes_ = 0, wing_ = 0, nose_ = 0, chin_ = 0;
};

/// Means of colours over a width, of what has weight.
class WeightedMeans {
 public:
  WeightedMeans(const FloatImage& weight, int reach)
      : weight_(weight), reach_(reach), sum_(Soft(weight)) {}
  /// How much there is to go by near a texel, 0..1.
  float Known(std::size_t i) const { return sum_.at[i]; }
  VectorImage Of(VectorImage colours) const {
    for (std::size_t i = 0; i < colours.at.size(); ++i) colours.at[i] *= weight_.at[i];
    colours = Soft(colours);
    for (std::size_t i = 0; i < colours.at.size(); ++i) {
      colours.at[i] /= std::max(sum_.at[i], 1e-3F);
    }
    return colours;
  }

 private:
  template <typename T>
  Raster<T> Soft(const Raster<T>& image) const {
    return Blurred(Blurred(image, reach_), reach_);
  }
  const FloatImage& weight_;
  int reach_;
  FloatImage sum_;
};

}  // namespace

void RemoveSmileShading(const BaseHead& base, const SkinTexels& texels, const FloatImage& seen,
                        float smile, fsm::Image& map) {
  if (smile <= 0) return;
  const glm::ivec2 reach(PhotoLook().Pair("shade_texels"));
  const Cheeks cheeks(base);
  FloatImage weight(kMapSize, kMapSize);
  for (std::size_t i = 0; i < weight.at.size(); ++i) {
    weight.at[i] = cheeks.Skin(texels, i) ? seen.at[i] * seen.at[i] : 0.0F;
  }
  const WeightedMeans fine(weight, reach.x), wide(weight, reach.y);
  const VectorImage colours = Colours(map), near = fine.Of(colours), far = wide.Of(colours);
  for (std::size_t i = 0; i < colours.at.size(); ++i) {
    const float part = smile * cheeks.At(texels, i) * glm::smoothstep(0.1F, 0.5F, fine.Known(i));
    if (part <= 0) continue;
    const glm::vec3 even = (far.at[i] + 1.0F) / (near.at[i] + 1.0F);
    SetRgb(map, i, colours.at[i] * glm::mix(glm::vec3(1), even, part));
  }
}

void GrainFromCheeks(const FloatImage& smooth, fsm::Image& map) {
  if (std::ranges::none_of(smooth.at, [](float s) { return s > 0; })) return;
  const glm::ivec2 from_texel(PhotoLook().Pair("grain_from"));
  const int out = from_texel.x, up = from_texel.y;
  const int reach = static_cast<int>(PhotoLook()("grain_texels"));
  const float most = PhotoLook()("grain_most");
  const VectorImage colours = Colours(map), means = Blurred(Blurred(colours, reach), reach);
  for (int y = up; y < kMapSize; ++y) {
    for (int x = out; x < kMapSize - out; ++x) {
      const std::size_t i = smooth.Index(x, y);
      if (smooth.at[i] <= 0) continue;
      const std::size_t from = smooth.Index(x < kMapSize / 2 ? x - out : x + out, y - up);
      const glm::vec3 grain = (colours.at[from] + 1.0F) / (means.at[from] + 1.0F) - 1.0F;
      SetRgb(map, i, colours.at[i] * (1.0F + smooth.at[i] * glm::clamp(grain, -most, most)));
    }
  }
}

}  // namespace facefit
