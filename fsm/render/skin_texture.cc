#include "fsm/render/skin_texture.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <thread>

#include "fsm/render/noise_tile.h"
#include "fsm/render/skin_map.h"

namespace fsm {
namespace {

constexpr int kSide = SkinTexture::kSide;

/// About exp(-(x / width)^2), and nothing beyond two widths.
float Bell(float x, float width) {
  const float t = std::max(1 - x * x / (4 * width * width), 0.0F);
  return t * t * t * t;
}

float Smooth(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0F, 1.0F);
  return t * t * (3 - 2 * t);
}

/// Everything about a texel before it becomes bytes.
struct Layers {
  std::vector<glm::vec4> tint{static_cast<std::size_t>(kSide) * kSide, glm::vec4(1.0F)};
  std::vector<float> height = std::vector<float>(tint.size());  // of pores and lines, millimetres
  std::vector<float> crease =
      std::vector<float>(tint.size());  // depth at full strength, millimetres
};

/// Smoothed random numbers over cells of a power of two texels, one row at a time, about 0.
class NoiseRow {
 public:
  NoiseRow(int cell, std::uint64_t series) : cell_(cell), series_(series) {}

  const std::vector<float>& At(int y) {
    const int row = y / cell_;
    if (row != row_) {
      row_ = row;
      Lattice(row, lower_);
      Lattice(row + 1, upper_);
    }
    const float t = Ease(static_cast<float>(y % cell_) / static_cast<float>(cell_));
    for (int x = 0; x < kSide; ++x) {
      const auto k = static_cast<std::size_t>(x / cell_);
      const float s = Ease(static_cast<float>(x % cell_) / static_cast<float>(cell_));
      const float low = lower_[k] + (lower_[k + 1] - lower_[k]) * s;
      const float high = upper_[k] + (upper_[k + 1] - upper_[k]) * s;
      out_[static_cast<std::size_t>(x)] = low + (high - low) * t;
    }
    return out_;
  }

 private:
  static float Ease(float t) { return t * t * (3 - 2 * t); }
  void Lattice(int row, std::vector<float>& out) const {
    const int count = kSide / cell_;
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
  std::vector<float> out_ = std::vector<float>(kSide);
};

/// Calls `paint(texel, weight)` for the texels of a round spot, its weight falling to 0 at
/// `radius`.
template <typename Paint>
void Stamp(const SkinMap& map, float x, float y, float radius, Paint paint) {
  const int reach = static_cast<int>(std::ceil(radius));
  const int cx = static_cast<int>(x);
  const int cy = static_cast<int>(y);
  for (int ty = std::max(cy - reach, 0); ty <= std::min(cy + reach, kSide - 1); ++ty) {
    for (int tx = std::max(cx - reach, 0); tx <= std::min(cx + reach, kSide - 1); ++tx) {
      const float dx = static_cast<float>(tx) + 0.5F - x;
      const float dy = static_cast<float>(ty) + 0.5F - y;
      const float far = (dx * dx + dy * dy) / (radius * radius);
      const auto i = SkinMap::Index(tx, ty);
      if (far < 1 && map.kind[i] != SkinMap::kNone) paint(i, (1 - far) * (1 - far));
    }
  }
}

// ---- colour and highlights that change slowly over the face

/// Redder and paler places, shadow of the lids, where skin is oily.
void PaintRegions(const SkinMap& map, const FaceMarks& m, int first_row, int last_row,
                  Layers& out) {
  NoiseRow broad(64, 1);
  NoiseRow middle(16, 2);
  NoiseRow fine(4, 3);
  NoiseRow lines(2, 4);
  const float eye_y = m.pupil[1].y;
  const float cheek_x = 0.72F * m.zygion[1].x;
  const float cheek_y = 0.45F * m.nasion.y + 0.55F * m.subnasale.y;
  for (int y = first_row; y < last_row; ++y) {
    const auto& b = broad.At(y);
    const auto& d = middle.At(y);
    const auto& f = fine.At(y);
    const auto& l = lines.At(y);
    for (int x = 0; x < kSide; ++x) {
      const auto i = SkinMap::Index(x, y);
      if (map.kind[i] == SkinMap::kNone) continue;
      const auto c = static_cast<std::size_t>(x);
      const glm::vec3 p = map.place[i];
      const float side = std::abs(p.x);
      const bool front = p.z > 0;
      glm::vec4& t = out.tint[i];
      // Skin is never of one colour: patches of 20, 5 and 1 millimetres.
      const float patch = 0.5F * b[c] + 0.6F * d[c] + 0.3F * f[c];
      t *= 1.0F + patch * glm::vec4(0.030F, 0.062F, 0.062F, 0.10F);
      if (map.kind[i] == SkinMap::kLip) {
        // Upright lines, glossier on the lower lip.
        const float crack = l[c] * 0.5F + f[c] * 0.5F;
        t *= 1.0F + crack * glm::vec4(0.06F, 0.10F, 0.10F, 0.5F);
        t.a *= p.y < m.stomion.y ? 1.25F : 0.85F;
        out.height[i] += 0.05F * crack;
        continue;
      }
      if (!front) continue;
      const float cheek = Bell(side - cheek_x, 17) * Bell(p.y - cheek_y, 17);
      const float tip = Bell(side, 11) * Bell(p.y - m.pronasale.y, 10) *
                        Smooth(m.subnasale.z, m.pronasale.z, p.z);
      const float chin = Bell(side, 15) * Bell(p.y - 0.8F * m.gnathion.y - 0.2F * m.stomion.y, 11);
      const float flush = 0.55F * cheek + 0.6F * tip + 0.3F * chin;
      t *= 1.0F - flush * (0.75F + 0.5F * d[c]) * glm::vec4(0.02F, 0.16F, 0.13F, 0);
      // Thin skin below the eyes is bluish and darker; the lids are warmer.
      const float from_pupil = (side - m.pupil[1].x) / 17;
      const float below = Bell(p.y - (eye_y - 10), 5.5F) * Bell(from_pupil, 1);
      const float lid = Bell(p.y - (eye_y + 6.5F), 5) * Bell(from_pupil, 1.1F);
      const float corner = Bell(side - m.endocanthion[1].x + 1, 5) * Bell(p.y - eye_y + 1, 7);
      t *= 1.0F - below * glm::vec4(0.10F, 0.135F, 0.08F, 0.3F) -
           lid * glm::vec4(0.05F, 0.13F, 0.11F, -0.2F) -
           corner * glm::vec4(0.09F, 0.19F, 0.16F, 0.2F);
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
}

// ---- spots

/// Pores sit a millimetre apart, wider on nose and cheeks; each is a dark pit.
void PaintPores(const SkinMap& map, const FaceMarks& m, Layers& out) {
  constexpr int kApart = 5;
  std::uint64_t n = 0;
  for (int y = 0; y < kSide; y += kApart) {
    for (int x = 0; x < kSide; x += kApart, ++n) {
      const float px = static_cast<float>(x) + kApart * Chance(11, n);
      const float py = static_cast<float>(y) + kApart * Chance(12, n);
      const auto at = SkinMap::Index(std::min(static_cast<int>(px), kSide - 1),
                                     std::min(static_cast<int>(py), kSide - 1));
      if (map.kind[at] != SkinMap::kSkin) continue;
      const glm::vec3 p = map.place[at];
      const float from_nose = glm::length(glm::vec2(p.x * 0.7F, p.y - m.pronasale.y)) / 40;
      const float size = 0.35F + 0.65F * Bell(from_nose, 1);
      const float deep = size * (0.4F + 0.6F * Chance(13, n));
      Stamp(map, px, py, 1.6F + 0.9F * size, [&](std::size_t i, float w) {
        out.tint[i] *= 1.0F - w * deep * glm::vec4(0.07F, 0.10F, 0.10F, 0.45F);
        out.height[i] -= w * deep * 0.075F;
      });
    }
  }
}

/// Faint brown freckles over nose and cheeks, a few darker moles.
void PaintFreckles(const SkinMap& map, const FaceMarks& m, Layers& out) {
  for (std::uint64_t n = 0; n < 2600; ++n) {
    const float x = kSide * (0.18F + 0.64F * Chance(21, n));
    const float y = kSide * (0.25F + 0.6F * Chance(22, n));
    const auto at = SkinMap::Index(static_cast<int>(x), static_cast<int>(y));
    if (map.kind[at] != SkinMap::kSkin) continue;
    const glm::vec3 p = map.place[at];
    const float near_cheek = Bell(std::abs(p.x) - 22, 26) * Bell(p.y - m.pronasale.y - 10, 22);
    if (Chance(23, n) > 0.10F + 0.9F * near_cheek) continue;
    const bool mole = n % 331 == 7;
    const float strength = mole ? 0.8F : 0.10F + 0.22F * Chance(24, n);
    const float radius = mole ? 3.0F : 1.6F + 2.2F * Chance(25, n);
    Stamp(map, x, y, radius, [&](std::size_t i, float w) {
      out.tint[i] *= 1.0F - w * strength * glm::vec4(0.28F, 0.50F, 0.60F, 0.1F);
    });
  }
}

/// Fine vessels beside the nose and on the cheeks: short walks that wander.
void PaintVessels(const SkinMap& map, const FaceMarks& m, Layers& out) {
  for (std::uint64_t n = 0; n < 420; ++n) {
    float x = kSide * (0.25F + 0.5F * Chance(31, n));
    float y = kSide * (0.42F + 0.22F * Chance(32, n));
    float turn = 6.2832F * Chance(33, n);
    for (std::uint64_t step = 0; step < 26; ++step) {
      turn += 1.1F * (Chance(34, n * 64 + step) - 0.5F);
      x += std::cos(turn);
      y += std::sin(turn);
      const auto at = SkinMap::Index(std::clamp(static_cast<int>(x), 0, kSide - 1),
                                     std::clamp(static_cast<int>(y), 0, kSide - 1));
      if (map.kind[at] != SkinMap::kSkin) break;
      const glm::vec3 p = map.place[at];
      const float ala =
          Bell(glm::length(glm::vec2(std::abs(p.x) - m.alare[1].x, p.y - m.alare[1].y)), 9);
      const float cheek = Bell(std::abs(p.x) - 40, 14) * Bell(p.y - m.pronasale.y, 14);
      const float strength = 0.055F * (ala + 0.6F * cheek);
      if (strength < 0.01F) continue;
      Stamp(map, x, y, 1.7F, [&](std::size_t i, float w) {
        out.tint[i] *= 1.0F - w * strength * glm::vec4(0.2F, 1.2F, 0.9F, 0);
      });
    }
  }
}

// ---- creases of expression

float Crease(float off, float width) {
  // A narrow furrow between two low swellings.
  return -Bell(off, width) +
         0.35F * (Bell(off - 2.2F * width, 1.5F * width) + Bell(off + 2.2F * width, 1.5F * width));
}

/// How far below the skin each place lies when all creases are at their deepest.
float CreaseHeight(const glm::vec3& p, const FaceMarks& m) {
  if (p.z < 0) return 0;
  const float side = std::abs(p.x);
  float height = 0;
  // Forehead: lines that follow the brow, rising a little to the sides of the middle.
  const float brow_y = m.nasion.y + 20;
  if (p.y > brow_y - 2 && p.y < m.trichion.y) {
    const float room = m.trichion.y - brow_y;
    const float bow = 2.5F * std::sin(side * 0.055F) + 0.5F * std::sin(p.x * 0.21F + 1);
    for (const float part : {0.20F, 0.40F, 0.60F, 0.78F}) {
      const float reach = (46 - 26 * std::abs(part - 0.45F)) * (part == 0.78F ? 0.7F : 1.0F);
      height += 0.75F * Crease(p.y - brow_y - room * part * 0.9F - bow, 1.15F) *
                Smooth(reach + 8, reach - 8, side);
    }
  }
  // Glabella: two upright lines between the brows, one across the root of the nose.
  const float between = Bell(p.y - (m.nasion.y + 10), 9);
  height += 0.9F * Crease(side - 6.5F - 0.10F * (p.y - m.nasion.y), 1.1F) * between;
  height += 0.6F * Crease(p.y - m.nasion.y + 1.5F, 1.1F) * Bell(side, 8);
  // Crow's feet: three lines fanning out from the outer corner of the eye.
  const glm::vec2 out(side - m.exocanthion[1].x - 2, p.y - m.exocanthion[1].y + 0.5F);
  if (out.x > -2) {
    for (const float angle : {0.50F, 0.05F, -0.42F}) {
      const glm::vec2 along(std::cos(angle), std::sin(angle));
      const float far = glm::dot(out, along);
      const float off = out.y * along.x - out.x * along.y;
      height += 0.55F * Crease(off + 0.02F * far * far * (angle > 0 ? -1.0F : 1.0F) * 0.5F, 0.8F) *
                Smooth(1, 5, far) * Smooth(17, 9, far);
    }
  }
  // Nasolabial fold: from above the wing of the nose past the corner of the mouth.
  const glm::vec3 wing = m.alare[1];
  const glm::vec3 corner = m.cheilion[1];
  const float t = (wing.y + 4 - p.y) / (wing.y + 4 - corner.y);
  const float fold_x = glm::mix(wing.x + 2, corner.x + 9, std::clamp(t, 0.0F, 1.3F)) +
                       3.5F * std::sin(std::clamp(t, 0.0F, 1.0F) * 3.1416F);
  height += 1.1F * Crease((side - fold_x) * 0.8F, 1.7F) * Smooth(-0.12F, 0.12F, t) *
            Smooth(1.35F, 0.85F, t);
  return height;
}

void PaintCreases(const SkinMap& map, const FaceMarks& m, int first_row, int last_row,
                  Layers& out) {
  for (int y = first_row; y < last_row; ++y) {
    for (int x = kSide / 8; x < kSide * 7 / 8; ++x) {
      const auto i = SkinMap::Index(x, y);
      if (map.kind[i] == SkinMap::kSkin) out.crease[i] = CreaseHeight(map.place[i], m);
    }
  }
}

// ---- to bytes

std::uint8_t Byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5F, 0.0F, 255.0F));
}

void WriteRows(const SkinMap& map, const Layers& layers, int first_row, int last_row,
               SkinTexture& out) {
  for (int y = first_row; y < last_row; ++y) {
    for (int x = 0; x < kSide; ++x) {
      const auto i = SkinMap::Index(x, y);
      for (int c = 0; c < 4; ++c) {
        out.tint[4 * i + static_cast<std::size_t>(c)] = Byte(128 * layers.tint[i][c]);
      }
      // Slopes between the neighbours, by their distance on the face.
      const auto left = SkinMap::Index(std::max(x - 1, 0), y);
      const auto right = SkinMap::Index(std::min(x + 1, kSide - 1), y);
      const auto below = SkinMap::Index(x, std::max(y - 1, 0));
      const auto above = SkinMap::Index(x, std::min(y + 1, kSide - 1));
      const float across = std::max(glm::length(map.place[right] - map.place[left]), 0.25F);
      const float upward = std::max(glm::length(map.place[above] - map.place[below]), 0.25F);
      const bool inside = map.kind[left] != SkinMap::kNone && map.kind[right] != SkinMap::kNone &&
                          map.kind[below] != SkinMap::kNone && map.kind[above] != SkinMap::kNone;
      const float scale = inside ? 1.0F : 0.0F;
      const auto slope = [scale](const std::vector<float>& h, std::size_t from, std::size_t to,
                                 float distance, float unit) {
        return Byte(128 + scale * unit * (h[to] - h[from]) / distance);
      };
      out.relief[4 * i] = slope(layers.height, left, right, across, 254);
      out.relief[4 * i + 1] = slope(layers.height, below, above, upward, 254);
      out.relief[4 * i + 2] = slope(layers.crease, left, right, across, 127);
      out.relief[4 * i + 3] = slope(layers.crease, below, above, upward, 127);
    }
  }
}

}  // namespace

std::optional<FaceMarks> FaceMarks::Of(const Head& head) {
  try {
    const auto both = [&head](const std::string& name) {
      return std::array{head.Landmark(name + "_right"), head.Landmark(name + "_left")};
    };
    return FaceMarks{.nasion = head.Landmark("nasion"),
                     .pronasale = head.Landmark("pronasale"),
                     .subnasale = head.Landmark("subnasale"),
                     .stomion = head.Landmark("stomion"),
                     .gnathion = head.Landmark("gnathion"),
                     .trichion = head.Landmark("trichion"),
                     .cheilion = both("cheilion"),
                     .endocanthion = both("endocanthion"),
                     .exocanthion = both("exocanthion"),
                     .pupil = both("pupil"),
                     .alare = both("alare"),
                     .zygion = both("zygion")};
  } catch (const std::out_of_range&) {
    return std::nullopt;
  }
}

SkinTexture PaintSkin(const Head& head, const HeadVertices& rest, const FaceMarks& marks) {
  const SkinMap map(head.topology(), rest, kSide);
  Layers layers;
  SkinTexture out;
  out.tint.resize(layers.tint.size() * 4);
  out.relief.resize(layers.tint.size() * 4);
  // Two halves at once: what is drawn in rows does not reach over their border.
  const auto in_halves = [](const auto& work) {
    std::thread upper([&work] { work(kSide / 2, kSide); });
    work(0, kSide / 2);
    upper.join();
  };
  in_halves([&](int first, int last) {
    PaintRegions(map, marks, first, last, layers);
    PaintCreases(map, marks, first, last, layers);
  });
  PaintPores(map, marks, layers);
  PaintFreckles(map, marks, layers);
  PaintVessels(map, marks, layers);
  in_halves([&](int first, int last) { WriteRows(map, layers, first, last, out); });
  return out;
}

CreaseWeights WeighCreases(const HeadVertices& rest, const FaceMarks& m) {
  CreaseWeights out;
  for (const glm::vec3& p : rest.position) {
    const float side = std::abs(p.x);
    const float front = Smooth(0, 20, p.z);
    const float left = Smooth(-5, 5, p.x);
    const float brow_y = m.nasion.y + 14;
    const float between = Smooth(19, 12, side);
    const glm::vec4 weights =
        front *
        glm::vec4(Smooth(brow_y, brow_y + 8, p.y) * Smooth(60, 48, side) *
                      (1 - between * Smooth(m.nasion.y + 24, m.nasion.y + 16, p.y)),
                  between * Smooth(m.nasion.y - 12, m.nasion.y - 5, p.y) *
                      Smooth(m.nasion.y + 24, m.nasion.y + 16, p.y),
                  Smooth(m.exocanthion[1].x - 2, m.exocanthion[1].x + 2, side) *
                      Bell(p.y - m.exocanthion[1].y, 14),
                  Smooth(m.alare[1].y + 10, m.alare[1].y + 3, p.y) *
                      Smooth(m.gnathion.y, 0.6F * m.cheilion[1].y + 0.4F * m.gnathion.y, p.y) *
                      Smooth(m.alare[1].x - 4, m.alare[1].x + 1, side));
    out.left.push_back(weights * left);
    out.right.push_back(weights * (1 - left));
  }
  return out;
}

}  // namespace fsm
