#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "fsm/base/random.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/paint.h"
#include "fsm/head/parts.h"

namespace fsm {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;

class LashBuilder {
 public:
  LashBuilder(const EyeAnatomy& eye, const Identity& identity, bool of_photo, int side,
              HeadMesh& mesh)
      : eye_(eye),
        features_(identity.Look()),
        palette_(identity.palette),
        size_(identity.lashes),
        of_photo_(of_photo),
        side_(static_cast<float>(side)),
        mesh_(mesh) {
    weights_.eye = static_cast<std::int8_t>(side);
    weights_.free = 0;
  }

  void Row(bool upper) {
    upper_ = upper;
    weights_.lid_upper = upper ? 1.0f : 0.0f;
    weights_.lid_lower = 1 - weights_.lid_upper;
    if (upper) Line();
    const auto& row = features_[upper ? "upper_lashes" : "lower_lashes"];
    const int hairs = static_cast<int>(row[0]);
    for (int i = 0; i < hairs; ++i) {
      const float part = (static_cast<float>(i) + 0.5f) / static_cast<float>(hairs);
      Hair(glm::mix(row[1], row[2], part) + 0.008f * NoiseAt(i, 71), i);
    }
  }

 private:
  float X(float along) const { return glm::mix(eye_.inner_x(), eye_.outer_x(), along); }
  /// One of the three numbers of a row: for the upper lid, the lower lid, or lids of a photo.
  float ByLid(const char* name) const {
    const auto& n = features_[name];
    return of_photo_ ? n[2] : upper_ ? n[0] : n[1];
  }
  float Angle(float x) const { return upper_ ? eye_.UpperAngle(x) : eye_.LowerAngle(x); }

  std::uint32_t Add(glm::vec3 p, float at_x, float dark) {
    weights_.domain = {at_x * side_, eye_.centre().y};
    p.x *= side_;
    const glm::vec3 colour = glm::mix(palette_.skin, palette_.lash, of_photo_ ? 1.0f : dark);
    const std::uint32_t i = mesh_.Add(p, colour, 1, Bone::kSkin, weights_);
    if (of_photo_) mesh_.opacity.back() = dark;
    return i;
  }
  void Face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    const Material material = of_photo_ ? Material::kShutLash : Material::kLash;
    if (side_ > 0) {
      mesh_.Triangle(material, a, b, c);
    } else {
      mesh_.Triangle(material, a, c, b);
    }
  }

  // The roots together: a thin dark line on the upper rim, thickening outward.
  void Line() {
    constexpr int kSteps = 14;
    const auto& ends_at = features_["lash_line"];
    const auto& thickness = features_["lash_line_thickness"];
    std::array<std::uint32_t, 2> before{};
    for (int i = 0; i <= kSteps; ++i) {
      const float part = static_cast<float>(i) / kSteps;
      const float x = X(glm::mix(ends_at[0], ends_at[1], part));
      const float thick =
          (0.35f + 0.65f * size_) *
          (thickness[0] + thickness[1] * std::sin(kPi * std::min(1.0f, 0.1f + 0.68f * part)));
      const float radius = eye_.LidRadius(x);
      const float ends = SmoothStep(0, 0.2f, part);
      const float soft = of_photo_ ? 0.65f * SmoothStep(0, 0.5f, part) : 1.0f;
      const std::uint32_t low = Add(eye_.OnLid(x, Angle(x) - 0.10f / radius, radius - 0.1f), x,
                                    soft * (0.6f + 0.4f * ends));
      const std::uint32_t high = Add(eye_.OnLid(x, Angle(x) + thick / radius, radius + 0.45f), x,
                                     of_photo_ ? 0 : 0.2f + 0.65f * ends);
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
    // Neighbours lean together in threes.
    const float clump = 0.16f * (static_cast<float>(1 - i % 3)) + 0.10f * NoiseAt(i, 5) +
                        (of_photo_ ? 0.35f * NoiseAt(i, 6) : 0.0f);
    const auto& fans = features_["lash_fan"];
    const auto& long_by = features_["upper_lash_length"];
    const float fan = fans[1] * (along - fans[0]) + clump;
    const float length =
        size_ * (upper_ ? (long_by[0] +
                           long_by[1] * std::sin(kPi * std::min(1.0f, 0.18f + 0.62f * along))) *
                              (0.94f + (of_photo_ ? 0.6f : 0.34f) * NoiseAt(i, 9))
                        : features_("lower_lash_length") * (1 + 0.2f * NoiseAt(i, 9)));
    const glm::vec3 out = glm::normalize(glm::vec3(fan, std::sin(angle), std::cos(angle) * 1.25f));
    const float width = ByLid("lash_width");
    // Lower hairs are thin: much of the skin shows between them.
    const float dark = ByLid("lash_darkness") + (of_photo_ ? 0.2f * NoiseAt(i, 4) : 0.0f);
    const float rise = ByLid("lash_rise");
    const glm::vec3 root = eye_.OnLid(x, angle + 0.02f * up, radius);
    // Out and then up (the lower ones down): a curved card of two segments.
    const glm::vec3 middle = root + length * (0.5f * out + glm::vec3(0, 0.06f * up, 0));
    const glm::vec3 tip = root + length * (0.72f * out + glm::vec3(0, rise, 0));
    const std::uint32_t a = Add(root - glm::vec3(width, 0, 0), x, dark);
    const std::uint32_t b = Add(root + glm::vec3(width, 0, 0), x, dark);
    const std::uint32_t c = Add(middle - glm::vec3(0.6f * width, 0, 0), x, dark);
    const std::uint32_t d = Add(middle + glm::vec3(0.6f * width, 0, 0), x, dark);
    const std::uint32_t e = Add(tip, x, (of_photo_ ? 0.2f : 0.75f) * dark);
    Face(a, b, d);
    Face(a, d, c);
    Face(c, d, e);
  }

  const EyeAnatomy& eye_;
  const Features& features_;
  const Palette& palette_;
  float size_;
  bool of_photo_;
  float side_;
  HeadMesh& mesh_;
  SkinWeights weights_;
  bool upper_ = true;
};

}  // namespace

void BuildLashes(const EyeAnatomy& eye, const Identity& identity, bool of_photo, HeadMesh& mesh) {
  for (const int side : {-1, 1}) {
    LashBuilder builder(eye, identity, of_photo, side, mesh);
    builder.Row(true);
    if (!of_photo) builder.Row(false);
  }
}

namespace {

// Where brows lie: middle line and half height over x, on the base identity's face.
class BrowPlace {
 public:
  explicit BrowPlace(const Identity& identity)
      : thickness_(identity.brow_thickness),
        height_(identity.brow_height),
        middle_(identity.Look().CurveOf("brow_middle")),
        half_(identity.Look().CurveOf("brow_half_height")) {}

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
  Curve middle_, half_;
};

}  // namespace

std::vector<SkinHair> BuildLidFolds(const SkinFront& front, const EyeAnatomy& eye,
                                    const Features& features) {
  constexpr int kSteps = 26;
  const auto& widths = features["lid_fold_widths"];
  const auto& tints = features["lid_fold_tints"];
  const Curve height = features.CurveOf("lid_fold_height");
  std::vector<SkinHair> folds;
  folds.reserve(2 * widths.size() * kSteps);
  for (const float side : {-1.0f, 1.0f}) {
    const auto at = [&](float part) {
      const float along = std::clamp(part, 0.0f, 1.0f);
      const float x = glm::mix(eye.inner_x() + 0.5f, eye.outer_x() + 1.0f, along);
      glm::vec3 normal;
      glm::vec3 p = front.PointAt({x, eye.UpperY(x) + height(along)}, normal);
      p.x *= side;
      return Unroll(p);
    };
    for (std::size_t stroke = 0; stroke < widths.size(); ++stroke) {
      for (int k = 0; k < kSteps; ++k) {
        const float part = static_cast<float>(k) / kSteps;
        const float ends = SmoothStep(0, 0.25f, part) * SmoothStep(1, 0.85f, part);
        folds.push_back(
            {.root = at(part),
             .middle = at(part + 0.5f / kSteps),
             .tip = at(part + 1.0f / kSteps),
             .width_mm = widths[stroke] * (0.35f + 0.65f * ends),
             .tint = glm::mix(glm::vec3(1), features.Vector("lid_fold_colour") * tints[stroke],
                              0.25f + 0.75f * ends)});
      }
    }
  }
  return folds;
}

std::vector<SkinHair> BuildBrows(const SkinFront& front, const Identity& identity, HeadMesh& mesh) {
  const Palette& palette = identity.palette;
  const Features& features = identity.Look();
  const BrowPlace place(identity);
  // The soft tone between the hairs.
  for (std::size_t i = 0; i < mesh.position.size(); ++i) {
    const glm::vec3 p = mesh.position[i];
    if (p.z < 30 || std::abs(p.y - 42) > 16) continue;
    mesh.albedo[i] =
        glm::mix(mesh.albedo[i], palette.brow, features("brow_tone") * place.Cover({p.x, p.y}));
  }
  const Curve grow = features.CurveOf("brow_growth");
  const int columns = static_cast<int>(features["brow_hairs"][0]);
  const int rows = static_cast<int>(features["brow_hairs"][1]);
  const auto& across = features["brow_width"];
  const auto& long_by = features["brow_hair_length"];
  const auto& wide_by = features["brow_hair_width"];
  std::vector<SkinHair> hairs;
  for (const int side : {-1, 1}) {
    for (int i = 0; i < columns * rows; ++i) {
      const int row = i % rows;
      const int seed = 2 * i + (side > 0 ? 1 : 0);
      const float column = static_cast<float>(i / rows) + 0.5f + 0.9f * NoiseAt(seed, 21);
      const float x = across[0] + across[1] * column / static_cast<float>(columns);
      const float level = -1 + 2 * (static_cast<float>(row) + 0.5f + 0.7f * NoiseAt(seed, 22)) /
                                   static_cast<float>(rows);
      const float ends = SmoothStep(7, 20, x) * SmoothStep(59, 47, x);
      // Sparse where it begins.
      if (0.5f + 0.5f * NoiseAt(seed, 26) > 0.35f + 0.65f * ends) continue;
      const glm::vec2 root(x, place.Y(x, 0.9f * level - 0.1f));
      // Upper hairs lean down, lower ones up: they meet in the middle of the brow.
      const float angle = (grow(x) - 20 * level + 9 * NoiseAt(seed, 23)) * kPi / 180;
      const float bend = (-14 - 8 * level) * kPi / 180;
      const float length = (long_by[0] + long_by[1] * NoiseAt(seed, 24)) * (0.6f + 0.4f * ends);
      const auto on_skin = [&](glm::vec2 at) {
        glm::vec3 normal;
        glm::vec3 p = front.PointAt(at, normal);
        p.x *= static_cast<float>(side);
        return Unroll(p);
      };
      const auto step = [&](float a) {
        return 0.5f * length * glm::vec2(std::cos(a), std::sin(a));
      };
      const glm::vec2 middle = root + step(angle);
      hairs.push_back(
          {.root = on_skin(root),
           .middle = on_skin(middle),
           .tip = on_skin(middle + step(angle + bend)),
           .width_mm = (wide_by[0] + wide_by[1] * NoiseAt(seed, 27)) * (0.7f + 0.3f * ends),
           .tint = 1.5f * palette.brow / palette.skin * (1 + 0.35f * NoiseAt(seed, 25))});
    }
  }
  return hairs;
}

}  // namespace fsm
