#include "face_fit/bake/smile_shade.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Distances that reference skin of the cheeks keeps from lips, eyes and nose, whose blurred edges
/// must not enter it.
constexpr float kFromLipsMm = 2, kBelowEyesMm = 8, kBelowNoseMm = 2;
/// Share of reference skin around a texel over which shading begins to be removed: none below the
/// first, all from the second on.
constexpr glm::vec2 kKnownCheek{0.1F, 0.5F};

/// The region of the base face that a smile shades: from below the eyes to above the chin, beside
/// the wings of the nose and, less, below it.
class Cheeks {
 public:
  explicit Cheeks(const ObservedHead& base) {
    using namespace point;
    const auto at = [&base](PointIndex i) { return base.AtRest(i); };
    eyes_ = 0.5F * (at(kEyeBottomRight).y + at(kEyeBottomLeft).y);
    wing_ = 0.5F * std::abs(at(kNoseRight).x - at(kNoseLeft).x);
    nose_ = at(kNoseBottom).y;
    chin_ = at(kChin).y;
  }
  float ShadeAt(const SkinTexels& texels, std::size_t i) const {
    const float y = texels[i].y_mm, x = std::abs(texels[i].x_mm);
    const auto& look = PhotoLook().smile.shade;
    return fsm::SmoothStep(eyes_ + look.below_eyes_mm, y) *
           fsm::SmoothStep(chin_ + look.above_chin_mm, y) *
           fsm::SmoothStep(look.beside_middle_mm, x) *
           std::max(fsm::SmoothStep(wing_ + look.beside_wings_mm, x),
                    look.below_nose_share * fsm::SmoothStep(nose_ + look.below_nose_mm, y)) *
           fsm::SmoothStep(look.outside_lips_mm, texels[i].within_lips_mm);
  }
  /// Returns whether a texel is reference skin of the cheeks: neither lips nor nose.
  bool IsReferenceSkin(const SkinTexels& texels, std::size_t i) const {
    const float y = texels[i].y_mm, x = std::abs(texels[i].x_mm);
    return texels[i].within_lips_mm < -kFromLipsMm && y < eyes_ - kBelowEyesMm &&
           (x > wing_ || y < nose_ - kBelowNoseMm);
  }

 private:
  float eyes_ = 0, wing_ = 0, nose_ = 0, chin_ = 0;
};

/// Weighted means of colours over a reach.
class WeightedMeans {
 public:
  WeightedMeans(const Mask& weight, int reach)
      : weight_(weight), reach_(reach), sum_(Soft(weight)) {}
  /// Returns the share of known texels around one, 0..1.
  float Known(std::size_t i) const { return sum_[i]; }
  VectorImage MeansOf(VectorImage colours) const {
    for (std::size_t i = 0; i < colours.size(); ++i) colours[i] *= weight_[i];
    colours = Soft(colours);
    for (std::size_t i = 0; i < colours.size(); ++i) {
      colours[i] /= std::max(sum_[i], 1e-3F);
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

void RemoveSmileShading(const ObservedHead& base, const SkinTexels& texels, const Mask& coverage,
                        float smile, fsm::Image& map) {
  if (smile <= 0) return;
  const auto& shade = PhotoLook().smile.shade;
  const Cheeks cheeks(base);
  FloatImage weight(kMapSize, kMapSize);
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = cheeks.IsReferenceSkin(texels, i) ? coverage[i] * coverage[i] : 0.0F;
  }
  const WeightedMeans fine(weight, TexelsOf(shade.fine_mm, kMapSize)),
      wide(weight, TexelsOf(shade.wide_mm, kMapSize));
  const VectorImage colours = Colours(map), fine_mean = fine.MeansOf(colours),
                    wide_mean = wide.MeansOf(colours);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    const float evened =
        smile * cheeks.ShadeAt(texels, i) * fsm::SmoothStep(kKnownCheek, fine.Known(i));
    if (evened <= 0) continue;
    const glm::vec3 even = (wide_mean[i] + 1.0F) / (fine_mean[i] + 1.0F);
    SetRgb(map, i, colours[i] * glm::mix(glm::vec3(1), even, evened));
  }
}

void GrainFromCheeks(const Mask& lost, fsm::Image& map) {
  if (std::ranges::none_of(lost.values, [](float s) { return s > 0; })) return;
  const auto& look = PhotoLook().smile.grain;
  const int outward = TexelsOf(look.outward_mm, kMapSize), up = TexelsOf(look.up_mm, kMapSize);
  const int reach = TexelsOf(look.coarsest_mm, kMapSize);
  const VectorImage colours = Colours(map), means = Blurred(Blurred(colours, reach), reach);
  for (int y = up; y < kMapSize; ++y) {
    for (int x = outward; x < kMapSize - outward; ++x) {
      const std::size_t i = lost.Index(x, y);
      if (lost[i] <= 0) continue;
      const std::size_t from = lost.Index(x < kMapSize / 2 ? x - outward : x + outward, y - up);
      const glm::vec3 grain = (colours[from] + 1.0F) / (means[from] + 1.0F) - 1.0F;
      SetRgb(map, i,
             colours[i] * (1.0F + lost[i] * glm::clamp(grain, -look.most_share, look.most_share)));
    }
  }
}

}  // namespace facefit
