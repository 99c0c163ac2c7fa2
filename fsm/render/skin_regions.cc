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
      : m_(landmarks), appearance_(appearance) {}

  /// `broad`, `fine`: of the patches there, about 0.
  SkinRegion At(SkinMap::Kind kind, const glm::vec3& p, float broad, float fine) const {
    SkinRegion out;
    const float patch = patches_[0] * broad + patches_[1] * fine;
    out.tint *= 1.0F + patch * TintOf(patches_, 2);
    if (kind == SkinMap::kLip) {
      out.cracks = 1;
      out.tint.a *= p.y < m_.stomion.y ? lip_[0] : lip_[1];
      return out;
    }
    const float from_nose = glm::length(glm::vec2(p.x * 0.7F, p.y - m_.pronasale.y));
    out.pores = pores_[0] + pores_[1] * Bell(from_nose, pores_[2]);
    if (p.z > 0) PaintFront(p, fine, out.tint);
    return out;
  }

 private:
  using Numbers = std::vector<float>;

  void PaintFront(const glm::vec3& p, float fine, glm::vec4& tint) const {
    const float side = std::abs(p.x);
    const float cheek_x = cheek_[0] * m_.zygion.left.x;
    const float cheek_y = cheek_[1] * m_.nasion.y + cheek_[2] * m_.subnasale.y;
    const float cheek = Bell(side - cheek_x, cheek_[3]) * Bell(p.y - cheek_y, cheek_[3]);
    const float tip = Bell(side, nose_tip_[0]) * Bell(p.y - m_.pronasale.y, nose_tip_[1]) *
                      SmoothStep(m_.subnasale.z, m_.pronasale.z, p.z);
    const float chin = Bell(side, chin_[0]) *
                       Bell(p.y - chin_[2] * m_.gnathion.y - chin_[3] * m_.stomion.y, chin_[1]);
    const float flush = blood_[0] * cheek + blood_[1] * tip + blood_[2] * chin;
    tint *= 1.0F - flush * (blood_[3] + blood_[4] * fine) * TintOf(blood_, 5);
    const float high = SmoothStep(m_.nasion.y + 8, m_.nasion.y + 30, p.y);
    const float low = SmoothStep(m_.stomion.y + 6, 0.7F * m_.gnathion.y + 0.3F * m_.stomion.y, p.y);
    tint *= 1.0F - high * TintOf(forehead_, 0) - low * TintOf(lower_face_, 0);
    tint *= AroundEye(side, p.y);
    tint.a *= Oil(p, tip, chin);
  }

  /// Thin skin below the eyes is bluish and darker; the lids are warmer.
  glm::vec4 AroundEye(float side, float y) const {
    const glm::vec3 pupil = m_.pupil.left;
    const float from_pupil = (side - pupil.x) / eye_width_[0];
    const float below = Bell(y - (pupil.y + below_eye_[0]), below_eye_[1]) * Bell(from_pupil, 1);
    const float lid = Bell(y - (pupil.y + lid_[0]), lid_[1]) * Bell(from_pupil, eye_width_[1]);
    const float corner = Bell(side - m_.endocanthion.left.x - eye_corner_[0], eye_corner_[1]) *
                         Bell(y - pupil.y - eye_corner_[0], eye_corner_[2]);
    return 1.0F - below * TintOf(below_eye_, 2) - lid * TintOf(lid_, 2) -
           corner * TintOf(eye_corner_, 3);
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
    return oil_[0] + oil_[1] * forehead + oil_[2] * bridge + oil_[3] * tip + oil_[4] * bow +
           oil_[5] * cheek_bone + oil_[6] * chin - oil_[7] * jaw;
  }

  const Numbers& Look(const char* name) const { return appearance_.Skin(name); }

  const FaceLandmarks& m_;
  const Appearance& appearance_;
  const Numbers &patches_ = Look("patches"), &lip_ = Look("lip_highlights"),
                &pores_ = Look("pores");
  const Numbers &cheek_ = Look("cheek"), &nose_tip_ = Look("nose_tip"), &chin_ = Look("chin");
  const Numbers &forehead_ = Look("forehead"), &lower_face_ = Look("lower_face");
  const Numbers &blood_ = Look("blood"), &eye_width_ = Look("eye_width"),
                &below_eye_ = Look("below_eye");
  const Numbers &lid_ = Look("lid"), &eye_corner_ = Look("eye_corner"), &oil_ = Look("oil");
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
