#include "fsm/render/skin_regions.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "fsm/base/smooth_step.h"
#include "fsm/render/skin_series.h"

namespace fsm {
namespace {

/// Smoothed random numbers about 0, one row of a SkinMap at a time; `cell` is the distance between
/// two numbers, in cells.
class NoiseRow {
 public:
  NoiseRow(int cell, SkinSeries series) : cell_(cell), series_(series) {}

  const std::vector<float>& At(int y) {
    if (y / cell_ != row_) {
      row_ = y / cell_;
      Lattice(row_, lower_);
      Lattice(row_ + 1, upper_);
    }
    const float t = Ease(y % cell_);
    for (int x = 0; x < SkinMap::kCells; ++x) {
      const auto k = static_cast<std::size_t>(x / cell_);
      const float s = Ease(x % cell_);
      const float low = lower_[k] + (lower_[k + 1] - lower_[k]) * s;
      const float high = upper_[k] + (upper_[k + 1] - upper_[k]) * s;
      out_[static_cast<std::size_t>(x)] = low + (high - low) * t;
    }
    return out_;
  }

 private:
  float Ease(int step) const {
    const float t = static_cast<float>(step) / static_cast<float>(cell_);
    return t * t * (3 - 2 * t);
  }
  void Lattice(int row, std::vector<float>& out) const {
    const int count = SkinMap::kCells / cell_;
    out.resize(static_cast<std::size_t>(count) + 1);
    for (int k = 0; k <= count; ++k) {
      const auto at = static_cast<std::uint64_t>(row) << 16 | static_cast<std::uint64_t>(k % count);
      out[static_cast<std::size_t>(k)] = 2 * Chance(series_, at) - 1;
    }
  }

  int cell_;
  SkinSeries series_;
  int row_ = -1;
  std::vector<float> lower_, upper_;
  std::vector<float> out_ = std::vector<float>(SkinMap::kCells);
};

/// Computes the skin regions of one face from its landmarks.
class RegionPainter {
 public:
  RegionPainter(const FaceLandmarks& landmarks, const Appearance& appearance)
      : landmarks_(landmarks), skin_(appearance.skin) {}

  /// `broad`, `fine`: noise of the patches at this place, about 0.
  SkinRegion At(SkinMap::Kind kind, const glm::vec3& p, float broad, float fine) const {
    SkinRegion out;
    const float patch = skin_.patches.broad * broad + skin_.patches.fine * fine;
    out.tint *= 1.0f + patch * skin_.patches.tint;
    if (kind == SkinMap::kLip) {
      out.cracks = 1;
      out.tint.a *=
          p.y < landmarks_.stomion.y ? skin_.lip_highlights.lower : skin_.lip_highlights.upper;
      return out;
    }
    const float from_nose =
        glm::length(glm::vec2(p.x * skin_.pores.nose_narrow, p.y - landmarks_.pronasale.y));
    out.pores = skin_.pores.everywhere + skin_.pores.nose * Bell(from_nose, skin_.pores.nose_width);
    if (p.z > 0) PaintFront(p, fine, out.tint);
    return out;
  }

 private:
  void PaintFront(const glm::vec3& p, float fine, glm::vec4& tint) const {
    const float side = std::abs(p.x);
    const float cheek_x = skin_.cheek.zygion * landmarks_.zygion.left.x;
    const float cheek_y =
        skin_.cheek.nasion * landmarks_.nasion.y + skin_.cheek.subnasale * landmarks_.subnasale.y;
    const float cheek =
        Bell(side - cheek_x, skin_.cheek.width) * Bell(p.y - cheek_y, skin_.cheek.width);
    const float tip = Bell(side, skin_.nose_tip.width) *
                      Bell(p.y - landmarks_.pronasale.y, skin_.nose_tip.height) *
                      SmoothStep(landmarks_.subnasale.z, landmarks_.pronasale.z, p.z);
    const float chin =
        Bell(side, skin_.chin.width) * Bell(p.y - skin_.chin.gnathion * landmarks_.gnathion.y -
                                                skin_.chin.stomion * landmarks_.stomion.y,
                                            skin_.chin.height);
    const float flush =
        skin_.blood.cheek * cheek + skin_.blood.nose_tip * tip + skin_.blood.chin * chin;
    tint *= 1.0f - flush * (skin_.blood.even + skin_.blood.patches * fine) * skin_.blood.tint;
    const float high = skin_.forehead.above.Ramp(p.y - landmarks_.nasion.y);
    const float low = SmoothStep(
        landmarks_.stomion.y + skin_.lower_face.above,
        glm::mix(landmarks_.stomion.y, landmarks_.gnathion.y, skin_.lower_face.whole), p.y);
    tint *= 1.0f - high * skin_.forehead.tint - low * skin_.lower_face.tint;
    tint *= AroundEye(side, p.y);
    tint.a *= Oil(p, tip, chin);
  }

  /// Thin skin below the eyes is bluish and darker; the lids are warmer.
  glm::vec4 AroundEye(float side, float y) const {
    const glm::vec3 pupil = landmarks_.pupil.left;
    const float from_pupil = (side - pupil.x) / skin_.eye.width;
    const float below =
        Bell(y - (pupil.y + skin_.below_eye.above), skin_.below_eye.height) * Bell(from_pupil, 1);
    const float lid =
        Bell(y - (pupil.y + skin_.lid.above), skin_.lid.height) * Bell(from_pupil, skin_.lid.width);
    const float corner = Bell(side - landmarks_.endocanthion.left.x - skin_.eye_corner.away,
                              skin_.eye_corner.width) *
                         Bell(y - landmarks_.endocanthion.left.y, skin_.eye_corner.height);
    return 1.0f - below * skin_.below_eye.tint - lid * skin_.lid.tint -
           corner * skin_.eye_corner.tint;
  }

  float Oil(const glm::vec3& p, float tip, float chin) const {
    const float side = std::abs(p.x);
    const float up = p.y - landmarks_.nasion.y;
    const float forehead =
        Bell(side, skin_.oily_forehead.width) * skin_.oily_forehead.above.Ramp(up);
    const float bridge = Bell(side, skin_.oily_bridge.width) *
                         SmoothStep(landmarks_.subnasale.y, landmarks_.nasion.y, p.y) *
                         skin_.oily_bridge.above.Ramp(up);
    const float bow_y = 0.5f * (landmarks_.subnasale.y + landmarks_.stomion.y);
    const float bow =
        Bell(side, skin_.oily_lip_bow.width) * Bell(p.y - bow_y, skin_.oily_lip_bow.height);
    const auto& bone = skin_.oily_cheek_bone;
    const float cheek_bone = Bell(side - bone.zygion * landmarks_.zygion.left.x, bone.width) *
                             Bell(p.y - landmarks_.pronasale.y - bone.above, bone.height);
    const float jaw = SmoothStep(landmarks_.pronasale.y, landmarks_.stomion.y, p.y) *
                      skin_.oily_jaw.aside.Ramp(side);
    return skin_.oil.everywhere + skin_.oil.forehead * forehead + skin_.oil.bridge * bridge +
           skin_.oil.nose_tip * tip + skin_.oil.lip_bow * bow + skin_.oil.cheek_bone * cheek_bone +
           skin_.oil.chin * chin - skin_.oil.jaw * jaw;
  }

  const FaceLandmarks& landmarks_;
  const Appearance::Skin& skin_;
};

}  // namespace

std::vector<SkinRegion> PaintRegions(const SkinMap& map, const FaceLandmarks& landmarks,
                                     const Appearance& appearance) {
  const RegionPainter painter(landmarks, appearance);
  std::vector<SkinRegion> out(map.kind.size());
  NoiseRow broad(16, SkinSeries::kBroadPatches);  // patches of 20 mm and of 5 mm
  NoiseRow fine(4, SkinSeries::kFinePatches);
  for (int y = 0; y < SkinMap::kCells; ++y) {
    const auto& b = broad.At(y);
    const auto& f = fine.At(y);
    for (int x = 0; x < SkinMap::kCells; ++x) {
      const auto i = SkinMap::Index(x, y);
      const auto c = static_cast<std::size_t>(x);
      if (map.kind[i] != SkinMap::kNone) {
        out[i] = painter.At(map.kind[i], map.position[i], b[c], f[c]);
      }
    }
  }
  return out;
}

}  // namespace fsm
