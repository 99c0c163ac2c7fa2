#include "face_fit/bake/smile_shade.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// The region of the base face that a smile shades: from below the eyes to above the chin, beside
/// the wings of the nose and, less, below it.
class Cheeks {
 public:
  explicit Cheeks(const ObservedHead& base) {
    using namespace point;
    const auto at = [&base](PointIndex i) { return base.AtRest(i); };
    eyes_y_mm_ = 0.5F * (at(kEyeBottomRight).y + at(kEyeBottomLeft).y);
    half_nose_mm_ = 0.5F * std::abs(at(kNoseRight).x - at(kNoseLeft).x);
    nose_y_mm_ = at(kNoseBottom).y;
    chin_y_mm_ = at(kChin).y;
  }
  float ShadeAt(const SkinTexel& texel) const {
    const float y = texel.y_mm, x = std::abs(texel.x_mm);
    const auto& look = PhotoLook().smile.shade;
    return (eyes_y_mm_ + look.below_eyes_mm).Ramp(y) * (chin_y_mm_ + look.above_chin_mm).Ramp(y) *
           look.beside_middle_mm.Ramp(x) *
           std::max((half_nose_mm_ + look.beside_wings_mm).Ramp(x),
                    look.below_nose_share * (nose_y_mm_ + look.below_nose_mm).Ramp(y)) *
           look.outside_lips_mm.Ramp(texel.within_lips_mm);
  }
  /// Returns whether a texel is reference skin of the cheeks: neither lips nor nose.
  bool IsReferenceSkin(const SkinTexel& texel) const {
    const float y = texel.y_mm, x = std::abs(texel.x_mm);
    const auto& look = PhotoLook().smile.reference;
    return texel.within_lips_mm < -look.off_lips_mm && y < eyes_y_mm_ - look.below_eyes_mm &&
           (x > half_nose_mm_ || y < nose_y_mm_ - look.below_nose_mm);
  }

 private:
  float eyes_y_mm_ = 0, half_nose_mm_ = 0, nose_y_mm_ = 0, chin_y_mm_ = 0;
};

}  // namespace

void RemoveSmileShading(const ObservedHead& base, const SkinTexels& texels, const Mask& coverage,
                        float share, fsm::Image& map) {
  if (share <= 0) return;
  const auto& shade = PhotoLook().smile.shade;
  const Cheeks cheeks(base);
  Mask weight(kMapSize, kMapSize);
  for (std::size_t i = 0; i < weight.size(); ++i) {
    weight[i] = texels[i] && cheeks.IsReferenceSkin(*texels[i]) ? coverage[i] * coverage[i] : 0.0F;
  }
  const VectorImage colours = Colours(map);
  const WeightedBlur fine(colours, weight, MmToTexels(shade.fine_mm, kMapSize), 2),
      wide(colours, weight, MmToTexels(shade.wide_mm, kMapSize), 2);
  for (std::size_t i = 0; i < colours.size(); ++i) {
    if (!texels[i]) continue;
    const float evened = share * cheeks.ShadeAt(*texels[i]) *
                         PhotoLook().smile.reference.known_share.Ramp(fine.weight[i]);
    if (evened <= 0) continue;
    const glm::vec3 even = (wide.MeanAt(i) + 1.0F) / (fine.MeanAt(i) + 1.0F);
    SetRgb(map, i, colours[i] * glm::mix(glm::vec3(1), even, evened));
  }
}

}  // namespace facefit
