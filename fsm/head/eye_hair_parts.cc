#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "fsm/head/paint.h"
#include "fsm/head/parts.h"

namespace fsm {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

struct LashRow {
  bool upper;
  int hairs;
  float from, to;  // along the lid, 0 inner corner .. 1 outer
};
constexpr std::array kLashRows = {LashRow{true, 30, 0.10f, 0.99f},
                                  LashRow{false, 12, 0.35f, 0.97f}};

class LashBuilder {
 public:
  LashBuilder(const EyeAnatomy& eye, const Identity& identity, int side, HeadMesh& mesh)
      : eye_(eye),
        palette_(identity.palette),
        size_(identity.lashes),
        side_(static_cast<float>(side)),
        mesh_(mesh) {
    flesh_.eye = static_cast<std::int8_t>(side);
    flesh_.free = 0;
  }

  void Row(const LashRow& row) {
    upper_ = row.upper;
    flesh_.lid_upper = row.upper ? 1.0f : 0.0f;
    flesh_.lid_lower = 1 - flesh_.lid_upper;
    if (row.upper) Line();
    for (int i = 0; i < row.hairs; ++i) {
      const float part = (static_cast<float>(i) + 0.5f) / static_cast<float>(row.hairs);
      Hair(glm::mix(row.from, row.to, part) + 0.008f * Grain(i, 71), i);
    }
  }

 private:
  float X(float along) const { return glm::mix(eye_.inner_x(), eye_.outer_x(), along); }
  float Angle(float x) const { return upper_ ? eye_.UpperAngle(x) : eye_.LowerAngle(x); }

  std::uint32_t Add(glm::vec3 p, float at_x, float dark) {
    flesh_.domain = {at_x * side_, eye_.centre().y};
    p.x *= side_;
    return mesh_.Add(p, glm::mix(palette_.skin, palette_.lash, dark), 1, Bone::kFlesh, flesh_);
  }
  void Face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    if (side_ > 0) {
      mesh_.Triangle(Material::kLash, a, b, c);
    } else {
      mesh_.Triangle(Material::kLash, a, c, b);
    }
  }

  // The roots together: a thin dark line on the upper rim, thickening outward.
  void Line() {
    constexpr int kSteps = 14;
    std::array<std::uint32_t, 2> before{};
    for (int i = 0; i <= kSteps; ++i) {
      const float part = static_cast<float>(i) / kSteps;
      const float x = X(glm::mix(0.06f, 0.99f, part));
      const float thick = (0.35f + 0.65f * size_) *
                          (0.40f + 0.70f * std::sin(kPi * std::min(1.0f, 0.1f + 0.68f * part)));
      const float radius = eye_.LidRadius(x);
      const float ends = SmoothStep(0, 0.2f, part);
      const std::uint32_t low =
          Add(eye_.OnLid(x, Angle(x) - 0.10f / radius, radius - 0.1f), x, 0.6f + 0.4f * ends);
      const std::uint32_t high =
          Add(eye_.OnLid(x, Angle(x) + thick / radius, radius + 0.45f), x, 0.2f + 0.65f * ends);
      if (i > 0) {
        Face(before[0], low, high);
        Face(before[0], high, before[1]);
      }
      before = {low, high};
    }
  }

  void Hair(float along, int i) {
    const float x = X(along);
    const float angle = Angle(x);
    const float up = upper_ ? 1.0f : -1.0f;
    const float radius = eye_.LidRadius(x) + 0.05f;
    const float fan = 1.5f * (along - 0.42f) + 0.10f * Grain(i, 5);
    const float length =
        size_ * (upper_ ? (1.6f + 2.8f * std::sin(kPi * std::min(1.0f, 0.18f + 0.62f * along))) *
                              (1 + 0.12f * Grain(i, 9))
                        : 1.3f * (1 + 0.2f * Grain(i, 9)));
    const glm::vec3 out = glm::normalize(glm::vec3(fan, std::sin(angle), std::cos(angle) * 1.25f));
    const float width = upper_ ? 0.24f : 0.12f;
    // Lower hairs are thin: much of the skin shows between them.
    const float dark = upper_ ? 0.9f : 0.35f;
    const glm::vec3 root = eye_.OnLid(x, angle + 0.02f * up, radius);
    // Out and then up (the lower ones down): a curved card of two segments.
    const glm::vec3 middle = root + length * (0.5f * out + glm::vec3(0, 0.06f * up, 0));
    const glm::vec3 tip =
        root + length * (0.72f * out + glm::vec3(0, (upper_ ? 0.44f : -0.40f), 0));
    const std::uint32_t a = Add(root - glm::vec3(width, 0, 0), x, dark);
    const std::uint32_t b = Add(root + glm::vec3(width, 0, 0), x, dark);
    const std::uint32_t c = Add(middle - glm::vec3(0.6f * width, 0, 0), x, dark);
    const std::uint32_t d = Add(middle + glm::vec3(0.6f * width, 0, 0), x, dark);
    const std::uint32_t e = Add(tip, x, 0.75f * dark);
    Face(a, b, d);
    Face(a, d, c);
    Face(c, d, e);
  }

  const EyeAnatomy& eye_;
  const Palette& palette_;
  float size_;
  float side_;
  HeadMesh& mesh_;
  Flesh flesh_;
  bool upper_ = true;
};

}  // namespace

void BuildLashes(const EyeAnatomy& eye, const Identity& identity, HeadMesh& mesh) {
  for (const int side : {-1, 1}) {
    LashBuilder builder(eye, identity, side, mesh);
    for (const LashRow& row : kLashRows) builder.Row(row);
  }
}

namespace {

// Where brows lie: middle line and half height over x, on the base identity's face.
class BrowPlace {
 public:
  explicit BrowPlace(const Identity& identity)
      : thickness_(identity.brow_thickness), height_(identity.brow_height) {}

  // `level` -1 at the lower edge .. 1 at the upper.
  float Y(float x, float level) const {
    return middle_(x) + thickness_ * half_(x) * level - 0.8f + height_;
  }
  // How densely the skin is covered, 0..1.
  float Cover(glm::vec2 at) const {
    const float x = std::abs(at.x);
    if (x < 6 || x > 60) return 0;
    const float high = thickness_ * std::max(half_(std::clamp(x, 9.0f, 56.0f)), 1.0f) + 0.8f;
    const float off = (at.y - Y(std::clamp(x, 9.0f, 56.0f), 0)) / high;
    return std::exp(-off * off) * SmoothStep(8, 17, x) * SmoothStep(60, 48, x);
  }

 private:
  float thickness_, height_;
  Curve middle_{{9, 16, 26, 36, 43, 50, 56}, {39.6f, 41.2f, 43.4f, 45.0f, 44.6f, 42.0f, 38.6f}};
  Curve half_{{9, 13, 20, 32, 42, 50, 56}, {2.0f, 2.9f, 3.1f, 2.6f, 1.9f, 1.2f, 0.6f}};
};

}  // namespace

void BuildBrows(const SkinFront& front, const Identity& identity, HeadMesh& mesh) {
  const Palette& palette = identity.palette;
  const BrowPlace place(identity);
  // Most of a brow's tone is on the skin; the hairs only break it up.
  for (std::size_t i = 0; i < mesh.position.size(); ++i) {
    const glm::vec3 p = mesh.position[i];
    if (p.z < 30 || std::abs(p.y - 42) > 16) continue;
    mesh.albedo[i] = glm::mix(mesh.albedo[i], palette.brow, 0.84f * place.Cover({p.x, p.y}));
  }
  // Which way the hairs grow, degrees from outward to up, over x.
  const Curve grow({9, 14, 22, 36, 48, 56}, {80, 58, 34, 14, -14, -34});
  constexpr int kColumns = 24;
  constexpr int kRows = 4;
  for (const int side : {-1, 1}) {
    const auto mirror = [side](glm::vec3 p) { return p * glm::vec3(side, 1, 1); };
    for (int i = 0; i < kColumns * kRows; ++i) {
      const int column = i / kRows;
      const int row = i % kRows;
      const float x = 10.5f + (44.5f * (static_cast<float>(column) +
                                        0.25f * static_cast<float>(row) + 0.35f * Grain(i, 21))) /
                                  kColumns;
      const float level = -1 + 2 * (static_cast<float>(row) + 0.5f + 0.4f * Grain(i, 22)) / kRows;
      const glm::vec2 at(x, place.Y(x, level));
      // Upper hairs lean down, lower ones up: they meet in the middle of the brow.
      const float angle = (grow(x) - 24 * level + 9 * Grain(i, 23)) * kPi / 180;
      const glm::vec2 along(std::cos(angle), std::sin(angle));
      const float ends = SmoothStep(8, 19, x) * SmoothStep(58, 50, x);
      const float length = (4.6f + 1.6f * Grain(i, 24)) * (0.65f + 0.35f * ends);
      const float width = 0.42f * (0.55f + 0.45f * ends);
      const glm::vec2 across(-along.y, along.x);
      const auto over = [&front](glm::vec2 xy, float lift) {
        glm::vec3 normal;
        const glm::vec3 p = front.PointAt(xy, normal);
        return p + lift * normal;
      };
      const glm::vec3 a = over(at + width * across, 0.15f);
      const glm::vec3 b = over(at - width * across, 0.15f);
      const glm::vec3 c = over(at + length * along, 0.55f);
      std::array<std::uint32_t, 3> id{};
      int k = 0;
      const glm::vec3 colour = palette.brow * (1 + 0.15f * Grain(i, 25));
      for (const glm::vec3 p : {a, b, c}) {
        const glm::vec3 q = mirror(p);
        const glm::vec3 soft = glm::mix(palette.skin, colour, k < 2 ? 0.45f + 0.3f * ends : 0.5f);
        id[static_cast<std::size_t>(k++)] =
            mesh.Add(q, soft, 1, Bone::kFlesh, FleshAt({q.x, q.y}, 0, -43));
      }
      if (side > 0) {
        mesh.Triangle(Material::kBrow, id[0], id[1], id[2]);
      } else {
        mesh.Triangle(Material::kBrow, id[0], id[2], id[1]);
      }
    }
  }
}

}  // namespace fsm
