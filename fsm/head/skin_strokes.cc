#include "fsm/head/skin_strokes.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "fsm/base/pi.h"
#include "fsm/base/smooth_step.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/paint_stream.h"

namespace fsm {
namespace {

// The place of the brows: middle line and half height over x, on the base identity's face.
class BrowShape {
 public:
  explicit BrowShape(const Identity& identity)
      : brows_(identity.brows),
        features_(*identity.features),
        middle_(CurveOf(identity.features->brow_middle)),
        half_(CurveOf(identity.features->brow_half_height)) {}

  // `level`: -1 at the lower edge .. 1 at the upper.
  float Y(float x, float level) const {
    const float from = middle_.begin_x(), to = middle_.end_x();
    const float straight = glm::mix(middle_(from), middle_(to), (x - from) / (to - from));
    return glm::mix(straight, middle_(x), brows_.arch) + brows_.thickness * half_(x) * level +
           brows_.height_mm;
  }
  float Density() const { return brows_.density; }
  // Returns how densely hair covers the skin, 0..1.
  float Cover(glm::vec2 at) const {
    const float x = std::abs(at.x);
    const float within = std::clamp(x, middle_.begin_x(), middle_.end_x());
    const float high = brows_.thickness * std::max(half_(within), 1.0f) + 0.8f;
    const float offset = (at.y - Y(within, 0)) / high;
    return brows_.density * std::exp(-offset * offset) * features_.brow_cover.inner.Ramp(x) *
           features_.brow_cover.outer.Ramp(x);
  }

 private:
  const Identity::Brows brows_;
  const Features& features_;
  Curve middle_, half_;
};

/// Builds the hairs of both brows.
class BrowBuilder {
 public:
  BrowBuilder(const SkinFront& front, const Identity& identity, const BrowShape& shape)
      : front_(front), palette_(identity.palette), features_(*identity.features), shape_(shape) {}

  std::vector<SkinStroke> Build() {
    const int columns = static_cast<int>(features_.brow_hairs.columns);
    const int rows = static_cast<int>(features_.brow_hairs.rows);
    for (const Side side : kSides) {
      for (int i = 0; i < columns * rows; ++i) {
        const int seed = 2 * i + (side == Side::kLeft ? 1 : 0);
        const float column =
            static_cast<float>(i / rows) + 0.5f + 0.9f * NoiseAt(seed, PaintStream::kBrowAlong);
        const float x = features_.brow_width.from +
                        features_.brow_width.all * column / static_cast<float>(columns);
        const float row =
            static_cast<float>(i % rows) + 0.5f + 0.7f * NoiseAt(seed, PaintStream::kBrowRow);
        AddHair(side, x, -1 + 2 * row / static_cast<float>(rows), seed);
      }
    }
    return std::move(hairs_);
  }

 private:
  /// `level`: as for BrowShape::Y.
  void AddHair(Side side, float x, float level, int seed) {
    const float ends = features_.brow_sparse.inner.Ramp(x) * features_.brow_sparse.outer.Ramp(x);
    // The brow is sparse where it begins.
    if (0.5f + 0.5f * NoiseAt(seed, PaintStream::kBrowThin) >
        shape_.Density() * (0.35f + 0.65f * ends))
      return;
    const glm::vec2 root(x, shape_.Y(x, 0.9f * level - 0.1f));
    // Upper hairs lean down and lower ones up, so that they meet in the middle of the brow.
    const float angle = (grow_(x) - features_.brow_lean.edge * level +
                         features_.brow_lean.uneven * NoiseAt(seed, PaintStream::kBrowLean)) *
                        kPi / 180;
    const float bend = features_.brow_bend.At(level) * kPi / 180;
    const float length = features_.brow_hair_length.At(NoiseAt(seed, PaintStream::kBrowLength)) *
                         (0.6f + 0.4f * ends);
    const auto step = [&](float a) { return 0.5f * length * glm::vec2(std::cos(a), std::sin(a)); };
    const glm::vec2 middle = root + step(angle);
    hairs_.push_back(
        {.root = front_.UvAt(root, side),
         .middle = front_.UvAt(middle, side),
         .tip = front_.UvAt(middle + step(angle + bend), side),
         .width_mm = features_.brow_hair_width.At(NoiseAt(seed, PaintStream::kBrowWidth)) *
                     (0.7f + 0.3f * ends),
         .tint = features_.brow_tint.factor * palette_.brow / palette_.skin *
                 (1 + features_.brow_tint.uneven * NoiseAt(seed, PaintStream::kBrowTint))});
  }

  const SkinFront& front_;
  const Palette& palette_;
  const Features& features_;
  const BrowShape& shape_;
  const Curve grow_ = CurveOf(features_.brow_growth);
  std::vector<SkinStroke> hairs_;
};

}  // namespace

std::vector<SkinStroke> BuildBrows(const SkinFront& front, const Identity& identity,
                                   MeshBuilder& mesh) {
  const BrowShape shape(identity);
  // The soft tone of the skin between the hairs.
  const float tone = identity.features->brow_tone;
  for (std::size_t i = 0; i < mesh.position.size(); ++i) {
    const glm::vec3 p = mesh.position[i];
    if (p.z < 30) continue;
    mesh.albedo[i] =
        glm::mix(mesh.albedo[i], identity.palette.brow, tone * shape.Cover({p.x, p.y}));
  }
  return BrowBuilder(front, identity, shape).Build();
}

std::vector<SkinStroke> BuildLidFolds(const SkinFront& front, const EyeAnatomy& eye,
                                      const Identity& identity) {
  constexpr int kSteps = 26;
  const Features& features = *identity.features;
  const auto widths = ListOf(features.lid_fold_widths);
  const auto tints = ListOf(features.lid_fold_tints);
  const Curve base_height = CurveOf(features.lid_fold_height);
  const auto height = [&](float along) {
    return base_height(along) + glm::mix(identity.fold.inner_mm, identity.fold.outer_mm, along);
  };
  std::vector<SkinStroke> folds;
  folds.reserve(2 * widths.size() * kSteps);
  for (const Side side : kSides) {
    const auto at = [&](float share) {
      const float along = std::clamp(share, 0.0f, 1.0f);
      const float x = glm::mix(eye.inner_x() + 0.5f, eye.outer_x() + 1.0f, along);
      return front.UvAt({x, eye.UpperY(x) + height(along)}, side);
    };
    for (std::size_t stroke = 0; stroke < widths.size(); ++stroke) {
      for (int k = 0; k < kSteps; ++k) {
        const float share = static_cast<float>(k) / kSteps;
        const float ends = SmoothStep(0, 0.25f, share) * SmoothStep(1, 0.85f, share);
        folds.push_back({.root = at(share),
                         .middle = at(share + 0.5f / kSteps),
                         .tip = at(share + 1.0f / kSteps),
                         .width_mm = widths[stroke] * (0.35f + 0.65f * ends),
                         .tint = glm::mix(glm::vec3(1), features.lid_fold_colour * tints[stroke],
                                          identity.fold.dark * (0.25f + 0.75f * ends))});
      }
    }
  }
  return folds;
}

std::vector<SkinStroke> BuildStubble(const SkinFront& front, const SkinPainter& painter,
                                     const Identity& identity) {
  const Features& features = *identity.features;
  const float aside = features.stubble_place.aside, narrows = features.stubble_place.narrows;
  const Range height = features.stubble_place.height;
  const glm::vec2 lips(0, features.stubble_place.lips_y);
  const glm::vec2 lips_size = features.stubble_place.lips_half_size;
  std::vector<SkinStroke> hairs;
  if (identity.palette.beard <= 0) return hairs;
  for (int k = 0; k < static_cast<int>(100 * features.stubble.hundreds); ++k) {
    const glm::vec2 at(aside * NoiseAt(k, PaintStream::kStubbleAside),
                       height.At(0.5f + 0.5f * NoiseAt(k, PaintStream::kStubbleHeight)));
    const glm::vec2 half(std::abs(at.x), at.y);
    if (half.x > aside - narrows * (height.to - at.y)) continue;  // beside the jaw
    const float chance = 0.5f + 0.5f * NoiseAt(k, PaintStream::kStubbleThin);
    constexpr float kBeforeAll = 200;  // the front of the face has the most
    if (chance > painter.Beard(half, kBeforeAll)) continue;
    const glm::vec2 from_lips = (half - lips) / lips_size;
    if (glm::dot(from_lips, from_lips) < 1) continue;
    const glm::vec3 root = front.PointAt(half);
    if (chance > painter.Beard(half, root.z)) continue;
    const float length =
        features.stubble.length * (1 + 0.5f * NoiseAt(k, PaintStream::kStubbleLength));
    const float lean = 0.6f * NoiseAt(k, PaintStream::kStubbleLean);
    const auto along = [&](float share) {
      return front.PointAt(half + share * length * glm::vec2(lean, -1));
    };
    const glm::vec3 tip = along(1);
    if (glm::length(tip - root) > 3 * length) continue;  // across an edge
    const auto on_skin = [&](glm::vec3 p) {
      p.x = std::copysign(p.x, at.x);
      return SkinUv(p);
    };
    const float cover =
        features.stubble.cover * (1 + 0.4f * NoiseAt(k, PaintStream::kStubbleCover));
    hairs.push_back(
        {.root = on_skin(root),
         .middle = on_skin(along(0.5f)),
         .tip = on_skin(tip),
         .width_mm = features.stubble.width,
         .tint = glm::mix(glm::vec3(1), identity.palette.hair / identity.palette.skin, cover)});
  }
  return hairs;
}

}  // namespace fsm