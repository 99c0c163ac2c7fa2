#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "fsm/base/random.h"
#include "fsm/render/skin_parts.h"

namespace fsm {
namespace {

/// Smoothed random numbers about 0, one row of a SkinMap at a time; `cell` cells from one number to
/// the next.
class NoiseRow {
 public:
  NoiseRow(int cell, std::uint64_t series) : cell_(cell), series_(series) {}

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
  std::uint64_t series_;
  int row_ = -1;
  std::vector<float> lower_, upper_;
  std::vector<float> out_ = std::vector<float>(SkinMap::kCells);
};

/// The regions of one head's face, by its landmarks.
class RegionPainter {
 public:
  RegionPainter(const FaceLandmarks& landmarks, const Appearance& appearance)
      : m_(landmarks), table_(appearance) {}

  /// `broad`, `fine`: of the patches there, about 0.
  SkinRegion At(SkinMap::Kind kind, const glm::vec3& p, float broad, float fine) const {
    SkinRegion out;
    const float patch = patches_broad_ * broad + patches_fine_ * fine;
    out.tint *= 1.0F + patch * patches_tint_;
    if (kind == SkinMap::kLip) {
      out.cracks = 1;
      out.tint.a *= p.y < m_.stomion.y ? lower_lip_ : upper_lip_;
      return out;
    }
    const float from_nose = glm::length(glm::vec2(p.x * 0.7F, p.y - m_.pronasale.y));
    out.pores = pores_ + nose_pores_ * Bell(from_nose, nose_pores_width_);
    if (p.z > 0) PaintFront(p, fine, out.tint);
    return out;
  }

 private:
  void PaintFront(const glm::vec3& p, float fine, glm::vec4& tint) const {
    const float side = std::abs(p.x);
    const float cheek_x = cheek_zygion_ * m_.zygion.left.x;
    const float cheek_y = cheek_nasion_ * m_.nasion.y + cheek_subnasale_ * m_.subnasale.y;
    const float cheek = Bell(side - cheek_x, cheek_width_) * Bell(p.y - cheek_y, cheek_width_);
    const float tip = Bell(side, nose_tip_width_) * Bell(p.y - m_.pronasale.y, nose_tip_height_) *
                      SmoothStep(m_.subnasale.z, m_.pronasale.z, p.z);
    const float chin =
        Bell(side, chin_width_) *
        Bell(p.y - chin_gnathion_ * m_.gnathion.y - chin_stomion_ * m_.stomion.y, chin_height_);
    const float flush = blood_cheek_ * cheek + blood_nose_tip_ * tip + blood_chin_ * chin;
    tint *= 1.0F - flush * (blood_even_ + blood_patches_ * fine) * blood_tint_;
    const float high = SmoothStep(m_.nasion.y + 8, m_.nasion.y + 30, p.y);
    const float low = SmoothStep(m_.stomion.y + 6, 0.7F * m_.gnathion.y + 0.3F * m_.stomion.y, p.y);
    tint *= 1.0F - high * forehead_tint_ - low * lower_face_tint_;
    tint *= AroundEye(side, p.y);
    tint.a *= Oil(p, tip, chin);
  }

  /// Thin skin below the eyes is bluish and darker; the lids are warmer.
  glm::vec4 AroundEye(float side, float y) const {
    const glm::vec3 pupil = m_.pupil.left;
    const float from_pupil = (side - pupil.x) / eye_width_;
    const float below =
        Bell(y - (pupil.y + below_eye_above_), below_eye_height_) * Bell(from_pupil, 1);
    const float lid = Bell(y - (pupil.y + lid_above_), lid_height_) * Bell(from_pupil, lid_width_);
    const float corner = Bell(side - m_.endocanthion.left.x - eye_corner_away_, eye_corner_width_) *
                         Bell(y - pupil.y - eye_corner_away_, eye_corner_height_);
    return 1.0F - below * below_eye_tint_ - lid * lid_tint_ - corner * eye_corner_tint_;
  }

  float Oil(const glm::vec3& p, float tip, float chin) const {
    const float side = std::abs(p.x);
    const float forehead = Bell(side, 34) * SmoothStep(m_.nasion.y + 8, m_.nasion.y + 22, p.y);
    const float bridge = Bell(side, 7) * SmoothStep(m_.subnasale.y, m_.nasion.y, p.y) *
                         SmoothStep(m_.nasion.y + 6, m_.nasion.y - 4, p.y);
    const float bow = Bell(side, 7) * Bell(p.y - 0.5F * (m_.subnasale.y + m_.stomion.y), 5);
    const float cheek_bone =
        Bell(side - 0.6F * m_.zygion.left.x, 12) * Bell(p.y - m_.pronasale.y - 14, 9);
    const float jaw = SmoothStep(m_.pronasale.y, m_.stomion.y, p.y) * SmoothStep(20, 45, side);
    return oil_ + oil_forehead_ * forehead + oil_bridge_ * bridge + oil_nose_tip_ * tip +
           oil_lip_bow_ * bow + oil_cheek_bone_ * cheek_bone + oil_chin_ * chin - oil_jaw_ * jaw;
  }

  const FaceLandmarks& m_;
  const NumberTable& table_;
  const float patches_broad_ = table_("skin patches broad"),
              patches_fine_ = table_("skin patches fine"),
              lower_lip_ = table_("skin lip_highlights lower"),
              upper_lip_ = table_("skin lip_highlights upper"),
              pores_ = table_("skin pores everywhere"), nose_pores_ = table_("skin pores nose"),
              nose_pores_width_ = table_("skin pores nose_width"),
              cheek_zygion_ = table_("skin cheek zygion"),
              cheek_nasion_ = table_("skin cheek nasion"),
              cheek_subnasale_ = table_("skin cheek subnasale"),
              cheek_width_ = table_("skin cheek width"),
              nose_tip_width_ = table_("skin nose_tip width"),
              nose_tip_height_ = table_("skin nose_tip height"),
              chin_width_ = table_("skin chin width"), chin_height_ = table_("skin chin height"),
              chin_gnathion_ = table_("skin chin gnathion"),
              chin_stomion_ = table_("skin chin stomion"),
              blood_cheek_ = table_("skin blood cheek"),
              blood_nose_tip_ = table_("skin blood nose_tip"),
              blood_chin_ = table_("skin blood chin"), blood_even_ = table_("skin blood even"),
              blood_patches_ = table_("skin blood patches"), eye_width_ = table_("skin eye width"),
              below_eye_above_ = table_("skin below_eye above"),
              below_eye_height_ = table_("skin below_eye height"),
              lid_above_ = table_("skin lid above"), lid_height_ = table_("skin lid height"),
              lid_width_ = table_("skin lid width"),
              eye_corner_away_ = table_("skin eye_corner away"),
              eye_corner_width_ = table_("skin eye_corner width"),
              eye_corner_height_ = table_("skin eye_corner height"),
              oil_ = table_("skin oil everywhere"), oil_forehead_ = table_("skin oil forehead"),
              oil_bridge_ = table_("skin oil bridge"), oil_nose_tip_ = table_("skin oil nose_tip"),
              oil_lip_bow_ = table_("skin oil lip_bow"),
              oil_cheek_bone_ = table_("skin oil cheek_bone"), oil_chin_ = table_("skin oil chin"),
              oil_jaw_ = table_("skin oil jaw");
  const glm::vec4 patches_tint_ = table_.Vector4("skin patches tint"),
                  forehead_tint_ = table_.Vector4("skin forehead tint"),
                  lower_face_tint_ = table_.Vector4("skin lower_face tint"),
                  blood_tint_ = table_.Vector4("skin blood tint"),
                  below_eye_tint_ = table_.Vector4("skin below_eye tint"),
                  lid_tint_ = table_.Vector4("skin lid tint"),
                  eye_corner_tint_ = table_.Vector4("skin eye_corner tint");
};

}  // namespace

std::vector<SkinRegion> PaintRegions(const SkinMap& map, const FaceLandmarks& landmarks,
                                     const Appearance& appearance) {
  const RegionPainter painter(landmarks, appearance);
  std::vector<SkinRegion> out(map.kind.size());
  NoiseRow broad(16, 1);  // patches of 20 and of 5 millimetres
  NoiseRow fine(4, 2);
  for (int y = 0; y < SkinMap::kCells; ++y) {
    const auto& b = broad.At(y);
    const auto& f = fine.At(y);
    for (int x = 0; x < SkinMap::kCells; ++x) {
      const auto i = SkinMap::Index(x, y);
      const auto c = static_cast<std::size_t>(x);
      if (map.kind[i] != SkinMap::kNone) {
        out[i] = painter.At(map.kind[i], map.place[i], b[c], f[c]);
      }
    }
  }
  return out;
}

}  // namespace fsm
