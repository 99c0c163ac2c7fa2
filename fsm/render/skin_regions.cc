#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>

#include "fsm/base/random.h"
#include "fsm/render/noise_tile.h"
#include "fsm/render/skin_parts.h"

namespace fsm {
namespace {

constexpr int kCells = SkinMap::kCells;

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
    for (int x = 0; x < kCells; ++x) {
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
    const int count = kCells / cell_;
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
  std::vector<float> out_ = std::vector<float>(kCells);
};

}  // namespace

// Redder and paler places, shadow of the lids, where skin is oily.
std::vector<SkinRegion> PaintRegions(const SkinMap& map, const FaceMarks& m) {
  std::vector<SkinRegion> out(map.kind.size());
  NoiseRow broad(16, 1);
  NoiseRow middle(4, 2);
  const float eye_y = m.pupil[1].y;
  const float cheek_x = 0.72F * m.zygion[1].x;
  const float cheek_y = 0.45F * m.nasion.y + 0.55F * m.subnasale.y;
  for (int y = 0; y < kCells; ++y) {
    const auto& b = broad.At(y);
    const auto& d = middle.At(y);
    for (int x = 0; x < kCells; ++x) {
      const auto i = SkinMap::Index(x, y);
      if (map.kind[i] == SkinMap::kNone) continue;
      const auto c = static_cast<std::size_t>(x);
      const glm::vec3 p = map.place[i];
      const float side = std::abs(p.x);
      const bool front = p.z > 0;
      glm::vec4& t = out[i].tint;
      // Skin is never of one colour: patches of 20 and 5 millimetres.
      const float patch = 0.5F * b[c] + 0.6F * d[c];
      t *= 1.0F + patch * glm::vec4(0.030F, 0.062F, 0.062F, 0.10F);
      if (map.kind[i] == SkinMap::kLip) {
        // The lower lip is wetter.
        out[i].cracks = 1;
        t.a *= p.y < m.stomion.y ? 1.25F : 0.85F;
        continue;
      }
      const float from_nose = glm::length(glm::vec2(p.x * 0.7F, p.y - m.pronasale.y));
      out[i].pores = 0.35F + 0.65F * Bell(from_nose, 40);
      if (!front) continue;
      const float cheek = Bell(side - cheek_x, 17) * Bell(p.y - cheek_y, 17);
      const float tip = Bell(side, 11) * Bell(p.y - m.pronasale.y, 10) *
                        Smooth(m.subnasale.z, m.pronasale.z, p.z);
      const float chin = Bell(side, 15) * Bell(p.y - 0.8F * m.gnathion.y - 0.2F * m.stomion.y, 11);
      const float flush = 0.55F * cheek + 0.6F * tip + 0.3F * chin;
      t *= 1.0F - flush * (0.75F + 0.5F * d[c]) * glm::vec4(0.02F, 0.15F, 0.15F, 0);
      // Thin skin below the eyes is bluish and darker; the lids are warmer.
      const float from_pupil = (side - m.pupil[1].x) / 17;
      const float below = Bell(p.y - (eye_y - 10), 5.5F) * Bell(from_pupil, 1);
      const float lid = Bell(p.y - (eye_y + 6.5F), 5) * Bell(from_pupil, 1.1F);
      const float corner = Bell(side - m.endocanthion[1].x + 1, 5) * Bell(p.y - eye_y + 1, 7);
      t *= 1.0F - below * glm::vec4(0.05F, 0.06F, 0.05F, 0.3F) -
           lid * glm::vec4(0.05F, 0.11F, 0.13F, -0.2F) -
           corner * glm::vec4(0.04F, 0.06F, 0.08F, 0.2F);
      const float forehead = Bell(side, 34) * Smooth(m.nasion.y + 8, m.nasion.y + 22, p.y);
      const float bridge = Bell(side, 7) * Smooth(m.subnasale.y, m.nasion.y, p.y) *
                           Smooth(m.nasion.y + 6, m.nasion.y - 4, p.y);
      const float bow = Bell(side, 7) * Bell(p.y - 0.5F * (m.subnasale.y + m.stomion.y), 5);
      const float cheek_bone =
          Bell(side - 0.6F * m.zygion[1].x, 12) * Bell(p.y - m.pronasale.y - 14, 9);
      const float jaw = Smooth(m.pronasale.y, m.stomion.y, p.y) * Smooth(20, 45, side);
      t.a *= 0.78F + 0.35F * forehead + 0.5F * bridge + 0.75F * tip + 0.3F * bow +
             0.35F * cheek_bone + 0.3F * chin - 0.25F * jaw;
    }
  }
  return out;
}

}  // namespace fsm
