#include "face_fit/bake/mirroring.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec3.hpp>

#include "face_fit/bake/skin_colours.h"
#include "face_fit/bake/skin_texels.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Side, in texels, of the squares that share a gain.
constexpr int kCell = 8;
/// Reaches over which both sides are compared, from wide to narrow; the narrowest with enough known
/// texels (kEnoughSeen, a share) counts most.
constexpr float kLightReachMm[] = {128, 32, 12, 6};
constexpr float kEnoughSeen = 0.1F;
/// Reach of a texel's surroundings.
constexpr float kAroundMm = 5;

/// The light on each texel of a map, divided by the light on the mirrored texel.
class SideGain {
 public:
  SideGain(const Mask& outside_openings, const fsm::Image& map, const Mask& coverage)
      : width_((map.width + kCell - 1) / kCell),
        height_((map.height + kCell - 1) / kCell),
        gain_(width_, height_, glm::vec3(1)) {
    VectorImage own(width_, height_), other = own;
    Mask both(width_, height_);
    ForEachPixel(map.width, map.height, [&](int x, int y, std::size_t i) {
      const std::size_t j = coverage.Index(map.width - 1 - x, y);
      if (outside_openings[i] < 1 || outside_openings[j] < 1) return;
      const float weight = coverage[i] * coverage[j];
      both(x / kCell, y / kCell) += weight / (kCell * kCell);
      own(x / kCell, y / kCell) += weight * Rgb(map, i);
      other(x / kCell, y / kCell) += weight * Rgb(map, j);
    });
    for (const float reach_mm : kLightReachMm) {
      const int reach = std::max(MmToTexels(reach_mm, map.width) / kCell, 1);
      const Mask known = Blurred(both, reach);
      const VectorImage own_mean = Blurred(own, reach), other_mean = Blurred(other, reach);
      for (std::size_t i = 0; i < known.size(); ++i) {
        const float weight = fsm::SmoothStep(0.0F, kEnoughSeen, known[i]);
        const glm::vec3 gain = LightGain(own_mean[i], other_mean[i]);
        for (int c = 0; c < 3; ++c) {
          if (other_mean[i][c] <= 0) continue;
          gain_[i][c] = glm::mix(gain_[i][c], gain[c], weight);
        }
      }
    }
  }
  glm::vec3 GainAt(int x, int y) const {
    return gain_.SampleAt((static_cast<float>(x) + 0.5F) / kCell,
                          (static_cast<float>(y) + 0.5F) / kCell);
  }

 private:
  int width_, height_;
  VectorImage gain_;
};

}  // namespace

void CompleteByMirroring(const Mask& outside_openings, fsm::Image& map, Mask& coverage) {
  const SideGain gain_of_side(outside_openings, map, coverage);
  const fsm::Image one_side = map;
  const Mask own_coverage = coverage;
  // Keep highlights and shade of the other side alone, as on a wing of the nose in the sun, close
  // to the surrounding colours.
  fsm::Image around = map;
  PushPullInpaint(around, own_coverage);
  const Mask covered_around = Blurred(own_coverage, std::max(MmToTexels(kAroundMm, map.width), 1));
  constexpr float kNoLimit = 50;
  const auto& look = PhotoLook().other_side;
  ForEachPixel(map.width, map.height, [&](int x, int y, std::size_t i) {
    const std::size_t j = coverage.Index(map.width - 1 - x, y);
    const float weight = std::max(own_coverage[j] - own_coverage[i], 0.0F) * 0.5F;
    if (weight <= 0 || outside_openings[i] < 1) return;
    const float sum = own_coverage[i] + weight;
    const glm::vec3 gain = gain_of_side.GainAt(x, y);
    const float held = look.held_by_seen_share.Ramp(covered_around[i]);
    const glm::vec3 beside = Rgb(around, i);
    const glm::vec3 brightest = glm::min(glm::mix(kNoLimit, look.brightest, held) * beside, 255.0F);
    const glm::vec3 taken =
        glm::clamp(gain * Rgb(one_side, j), held * look.darkest * beside, brightest);
    SetRgb(map, i, (own_coverage[i] * Rgb(one_side, i) + taken * weight) / sum);
    coverage[i] = sum;
  });
}

}  // namespace facefit
