#include "fsm/render/skin_texture.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <thread>

#include "fsm/base/smooth_step.h"
#include "fsm/render/painted_strokes.h"
#include "fsm/render/skin_creases.h"
#include "fsm/render/skin_map.h"
#include "fsm/render/skin_regions.h"
#include "fsm/render/skin_series.h"

namespace fsm {
namespace {

constexpr int kSide = SkinTexture::kSide;

std::size_t Texel(int x, int y) {
  return static_cast<std::size_t>(y) * kSide + static_cast<std::size_t>(x);
}

std::uint8_t Byte(float value) {
  return static_cast<std::uint8_t>(std::clamp(value + 0.5f, 0.0f, 255.0f));
}

// ---- the finest detail: a tile repeated over the skin

constexpr int kTile = 256;

struct Fine {
  float pore = 0, crack = 0, grain = 0;  // darkness of pores and lip lines; noise of colour
  glm::vec2 pore_slope{0.0f}, crack_slope{0.0f};
};

std::size_t InTile(int x, int y) {
  return static_cast<std::size_t>((y & (kTile - 1)) * kTile + (x & (kTile - 1)));
}

/// Makes pores about 1.5 mm apart, each a pit, and vertical lines of the lips.
std::vector<Fine> MakeFineTile(const Appearance& appearance) {
  constexpr int kApart = 4;
  std::vector<Fine> tile(static_cast<std::size_t>(kTile) * kTile);
  std::uint64_t n = 0;
  for (int y = 0; y < kTile; y += kApart) {
    for (int x = 0; x < kTile; x += kApart, ++n) {
      const float px = static_cast<float>(x) + kApart * Chance(SkinSeries::kPoreX, n);
      const float py = static_cast<float>(y) + kApart * Chance(SkinSeries::kPoreY, n);
      const float deep = appearance.skin.pore.dark.At(Chance(SkinSeries::kPoreDark, n));
      const float radius = appearance.skin.pore.radius.At(Chance(SkinSeries::kPoreRadius, n));
      for (int ty = y - 2; ty <= y + kApart + 2; ++ty) {
        for (int tx = x - 2; tx <= x + kApart + 2; ++tx) {
          const float dx = static_cast<float>(tx) + 0.5f - px;
          const float dy = static_cast<float>(ty) + 0.5f - py;
          const float w = std::max(0.0f, 1 - (dx * dx + dy * dy) / (radius * radius));
          float& pore = tile[InTile(tx, ty)].pore;
          pore = std::max(pore, w * w * deep);
        }
      }
    }
  }
  for (int y = 0; y < kTile; ++y) {
    for (int x = 0; x < kTile; ++x) {
      const auto at = [](int cx, int cy) {
        return static_cast<std::uint64_t>((cy & 255) << 8 | (cx & 255));
      };
      Fine& f = tile[InTile(x, y)];
      f.grain = Chance(SkinSeries::kCoarseGrain, at(x / 2, y / 2)) +
                Chance(SkinSeries::kFineGrain, at(x, y)) - 1;
      const float t = static_cast<float>(y % 16) / 16;
      f.crack = (Chance(SkinSeries::kLipLine, at(x / 2, y / 16)) * (1 - t) +
                 Chance(SkinSeries::kLipLine, at(x / 2, (y / 16 + 1) % 16)) * t) -
                0.5f;
    }
  }
  const float between = 2 / SkinTexture::kTexelsPerMm;  // millimetres between the two neighbours
  const float pore_mm = appearance.skin.pore.depth;
  const float crack_mm = appearance.skin.lip_lines.depth;
  for (int y = 0; y < kTile; ++y) {
    for (int x = 0; x < kTile; ++x) {
      const Fine& l = tile[InTile(x - 1, y)];
      const Fine& r = tile[InTile(x + 1, y)];
      const Fine& b = tile[InTile(x, y - 1)];
      const Fine& a = tile[InTile(x, y + 1)];
      Fine& f = tile[InTile(x, y)];
      f.pore_slope = glm::vec2(r.pore - l.pore, a.pore - b.pore) * (-pore_mm / between);
      f.crack_slope = glm::vec2(r.crack - l.crack, a.crack - b.crack) * (crack_mm / between);
    }
  }
  return tile;
}

SkinRegion Between(const SkinRegion& a, const SkinRegion& b, float t) {
  return {a.tint + (b.tint - a.tint) * t, a.pores + (b.pores - a.pores) * t,
          a.cracks + (b.cracks - a.cracks) * t};
}

/// Paints rows of both pictures, except the creases.
void PaintRows(const std::vector<SkinRegion>& regions, const std::vector<Fine>& tile,
               const Appearance& appearance, int first, int last, SkinTexture& out) {
  constexpr int kCells = SkinMap::kCells;
  constexpr int kStep = kSide / kCells;
  const glm::vec4 pore_tint = appearance.skin.pore.tint;
  const glm::vec4 crack_tint = appearance.skin.lip_lines.tint;
  const glm::vec4 grain_tint = appearance.skin.grain.tint;
  std::vector<SkinRegion> row(kCells + 1);
  for (int y = first; y < last; ++y) {
    // A cell's value applies at its centre.
    const float at_y = (static_cast<float>(y) + 0.5f) / kStep - 0.5f;
    const int cy = std::clamp(static_cast<int>(std::floor(at_y)), 0, kCells - 2);
    const float ty = std::clamp(at_y - static_cast<float>(cy), 0.0f, 1.0f);
    for (int x = 0; x < kCells; ++x) {
      row[static_cast<std::size_t>(x)] =
          Between(regions[SkinMap::Index(x, cy)], regions[SkinMap::Index(x, cy + 1)], ty);
    }
    row[kCells] = row[kCells - 1];
    std::uint8_t* tint = &out.tint.rgba[4 * Texel(0, y)];
    std::uint8_t* relief = &out.relief.rgba[4 * Texel(0, y)];
    for (int x = 0; x < kSide; ++x, tint += 4, relief += 4) {
      const int shifted = std::max(x - kStep / 2, 0);
      const float tx = (static_cast<float>(shifted % kStep) + 0.5f) / kStep;
      const auto cx = static_cast<std::size_t>(shifted / kStep);
      const SkinRegion r = Between(row[cx], row[cx + 1], tx);
      const Fine& f = tile[InTile(x, y)];
      const float pore = r.pores * f.pore;
      const float crack = r.cracks * f.crack;
      const glm::vec4 c =
          128.0f * r.tint * (1.0f - pore * pore_tint + crack * crack_tint + f.grain * grain_tint);
      for (int k = 0; k < 4; ++k) tint[k] = Byte(c[k]);
      const glm::vec2 slope = 128.0f + 254.0f * (r.pores * f.pore_slope + r.cracks * f.crack_slope);
      relief[0] = Byte(slope.x);
      relief[1] = Byte(slope.y);
      relief[2] = relief[3] = 128;
    }
  }
}

// ---- creases

/// Paints the slopes of the creases, block by block of texels.
void PaintCreases(const SkinMap& map, const CreaseRelief& creases, int first, int last,
                  SkinTexture& out) {
  constexpr int kBlock = 8;
  std::array<float, (kBlock + 1) * (kBlock + 1)> height;
  const auto uv = [](int texel) { return (static_cast<float>(texel) + 0.5f) / kSide; };
  for (int by = first; by < last; by += kBlock) {
    for (int bx = kSide / 8; bx < kSide * 7 / 8; bx += kBlock) {
      if (map.KindAt(uv(bx + kBlock / 2), uv(by + kBlock / 2)) != SkinMap::kSkin) continue;
      if (!creases.MayCrease(map.PositionAt(uv(bx + kBlock / 2), uv(by + kBlock / 2)))) continue;
      for (int k = 0; k < (kBlock + 1) * (kBlock + 1); ++k) {
        height[static_cast<std::size_t>(k)] =
            creases.HeightAt(map.PositionAt(uv(bx + k % (kBlock + 1)), uv(by + k / (kBlock + 1))));
      }
      for (int y = 0; y < kBlock; ++y) {
        for (int x = 0; x < kBlock; ++x) {
          const auto k = static_cast<std::size_t>(y * (kBlock + 1) + x);
          std::uint8_t* relief = &out.relief.rgba[4 * Texel(bx + x, std::min(by + y, kSide - 1))];
          const float unit = 127 * SkinTexture::kTexelsPerMm;
          relief[2] = Byte(128 + unit * (height[k + 1] - height[k]));
          relief[3] = Byte(128 + unit * (height[k + kBlock + 1] - height[k]));
        }
      }
    }
  }
}

// ---- spots

void Tint(SkinTexture& out, std::size_t texel, const glm::vec4& factor) {
  for (int k = 0; k < 4; ++k) {
    auto& byte = out.tint.rgba[4 * texel + static_cast<std::size_t>(k)];
    byte = Byte(static_cast<float>(byte) * factor[k]);
  }
}

/// Calls `paint(texel, weight)` for the texels of a round spot. The weight falls to 0 at `radius`,
/// which is clamped to kMaxRadius.
template <typename Paint>
void Stamp(float x, float y, float radius, Paint paint) {
  constexpr float kMaxRadius = 16;
  radius = std::min(radius, kMaxRadius);
  const int reach = static_cast<int>(std::ceil(radius));
  const int cx = static_cast<int>(x);
  const int cy = static_cast<int>(y);
  for (int ty = std::max(cy - reach, 0); ty <= std::min(cy + reach, kSide - 1); ++ty) {
    for (int tx = std::max(cx - reach, 0); tx <= std::min(cx + reach, kSide - 1); ++tx) {
      const float dx = static_cast<float>(tx) + 0.5f - x;
      const float dy = static_cast<float>(ty) + 0.5f - y;
      const float distance2 = (dx * dx + dy * dy) / (radius * radius);
      if (distance2 < 1) paint(Texel(tx, ty), (1 - distance2) * (1 - distance2));
    }
  }
}

/// Paints faint brown freckles over nose and cheeks, and a few darker moles.
void PaintFreckles(const SkinMap& map, const FaceLandmarks& landmarks, const Appearance& appearance,
                   SkinTexture& out) {
  const auto& skin = appearance.skin;
  for (std::uint64_t n = 0; static_cast<float>(n) < 100 * skin.freckles.hundreds; ++n) {
    const float x = kSide * (0.18f + 0.64f * Chance(SkinSeries::kFreckleX, n));
    const float y = kSide * (0.25f + 0.6f * Chance(SkinSeries::kFreckleY, n));
    if (map.KindAt(x / kSide, y / kSide) != SkinMap::kSkin) continue;
    const glm::vec3 p = map.PositionAt(x / kSide, y / kSide);
    const float near_cheek =
        Bell(std::abs(p.x) - skin.freckled_cheek.side, skin.freckled_cheek.width) *
        Bell(p.y - landmarks.pronasale.y - skin.freckled_cheek.above, skin.freckled_cheek.height);
    if (Chance(SkinSeries::kFreckleThin, n) >
        skin.freckles.everywhere + skin.freckles.cheek * near_cheek)
      continue;
    const bool mole =
        skin.moles.one_in >= 1 && n % static_cast<std::uint64_t>(skin.moles.one_in) == 7;
    const float strength = mole ? skin.moles.strength
                                : skin.freckle.strength.At(Chance(SkinSeries::kFreckleStrength, n));
    const float radius =
        mole ? skin.moles.radius : skin.freckle.radius.At(Chance(SkinSeries::kFreckleRadius, n));
    Stamp(x, y, radius,
          [&](std::size_t i, float w) { Tint(out, i, 1.0f - w * strength * skin.freckle.tint); });
  }
}

/// Paints fine vessels beside the nose and on the cheeks, as short random walks.
void PaintVessels(const SkinMap& map, const FaceLandmarks& landmarks, const Appearance& appearance,
                  SkinTexture& out) {
  const auto& skin = appearance.skin;
  for (std::uint64_t n = 0; static_cast<float>(n) < skin.vessels.count; ++n) {
    float x = kSide * (0.25f + 0.5f * Chance(SkinSeries::kVesselX, n));
    float y = kSide * (0.42f + 0.22f * Chance(SkinSeries::kVesselY, n));
    float turn = 6.2832f * Chance(SkinSeries::kVesselWay, n);
    for (std::uint64_t step = 0; static_cast<float>(step) < skin.vessels.length; ++step) {
      turn += skin.vessels.bend * (Chance(SkinSeries::kVesselBend, n * 64 + step) - 0.5f);
      x += std::cos(turn);
      y += std::sin(turn);
      if (map.KindAt(x / kSide, y / kSide) != SkinMap::kSkin) break;
      const glm::vec3 p = map.PositionAt(x / kSide, y / kSide);
      const float ala = Bell(glm::length(glm::vec2(std::abs(p.x) - landmarks.alare.left.x,
                                                   p.y - landmarks.alare.left.y)),
                             skin.vessels.nose_width);
      const float cheek = Bell(std::abs(p.x) - skin.vessels.cheek_side, skin.vessels.cheek_width) *
                          Bell(p.y - landmarks.pronasale.y, skin.vessels.cheek_width);
      const float strength = skin.vessels.strength * (ala + skin.vessels.cheek * cheek);
      if (strength < 0.01f) continue;
      Stamp(x, y, skin.vessels.radius,
            [&](std::size_t i, float w) { Tint(out, i, 1.0f - w * strength * skin.vessels.tint); });
    }
  }
}

}  // namespace

SkinTexture PaintSkin(const HeadSurface& surface, const HeadVertices& rest,
                      const FaceLandmarks& landmarks, const Appearance& appearance) {
  const SkinMap map(surface, rest);
  const auto regions = PaintRegions(map, landmarks, appearance);
  const auto tile = MakeFineTile(appearance);
  const CreaseRelief creases(landmarks, appearance);
  SkinTexture out{FilledImage(kSide, kSide), FilledImage(kSide, kSide)};
  const auto paint = [&](int first, int last) {
    PaintRows(regions, tile, appearance, first, last, out);
    PaintCreases(map, creases, first, last, out);
  };
  // The face lies in the upper two thirds of the picture.
  constexpr int kMiddle = kSide * 5 / 8;
  std::thread upper([&paint] { paint(kMiddle, kSide); });
  paint(0, kMiddle);
  upper.join();
  PaintFreckles(map, landmarks, appearance, out);
  PaintVessels(map, landmarks, appearance, out);
  PaintStrokes(surface.skin_strokes, out);
  return out;
}

}  // namespace fsm
