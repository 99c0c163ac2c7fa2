#include "fsm/head/lashes.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "fsm/base/pi.h"
#include "fsm/base/smooth_step.h"
#include "fsm/head/paint_stream.h"

namespace fsm {
namespace {

class LashBuilder {
 public:
  LashBuilder(const EyeAnatomy& eye, const Identity& identity, bool of_photo, Side side,
              MeshBuilder& mesh)
      : eye_(eye),
        features_(*identity.features),
        palette_(identity.palette),
        size_(identity.lashes),
        of_photo_(of_photo),
        side_(SignOf(side)),
        mesh_(mesh) {
    weights_.eye = side;
    weights_.skin.free = 0;
  }

  void Row(bool upper) {
    upper_ = upper;
    weights_.lid_upper = upper ? 1.0f : 0.0f;
    weights_.lid_lower = 1 - weights_.lid_upper;
    if (upper) Line();
    const Range along = upper ? features_.upper_lashes.along : features_.lower_lashes.along;
    const float count = upper ? features_.upper_lashes.count : features_.lower_lashes.count;
    const int hairs = static_cast<int>(count);
    for (int i = 0; i < hairs; ++i) {
      const float share = (static_cast<float>(i) + 0.5f) / static_cast<float>(hairs);
      Hair(along.At(share) + 0.008f * NoiseAt(i, PaintStream::kLashPlace), i);
    }
  }

 private:
  float X(float along) const { return glm::mix(eye_.inner_x(), eye_.outer_x(), along); }
  /// Selects from a row the number for the upper lid, the lower lid, or the lids of a photo.
  float ByLid(const auto& row) const {
    return of_photo_ ? row.photo : upper_ ? row.upper : row.lower;
  }
  float Angle(float x) const { return upper_ ? eye_.UpperAngle(x) : eye_.LowerAngle(x); }

  std::uint32_t Add(glm::vec3 p, float at_x, float dark) {
    weights_.skin.domain = {at_x * side_, eye_.centre().y};
    p.x *= side_;
    const glm::vec3 colour = glm::mix(palette_.skin, palette_.lash, of_photo_ ? 1.0f : dark);
    const std::uint32_t i = mesh_.Add(p, colour, 1, Bone::kSkin, weights_);
    if (of_photo_) mesh_.opacity.back() = dark;
    return i;
  }
  void Face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
    mesh_.Triangle(of_photo_ ? Material::kShutLash : Material::kLash, a, b, c, side_ < 0);
  }

  // Adds the roots as a thin dark line on the upper margin that thickens outward.
  void Line() {
    constexpr int kSteps = 14;
    std::array<std::uint32_t, 2> before{};
    for (int i = 0; i <= kSteps; ++i) {
      const float share = static_cast<float>(i) / kSteps;
      const float x = X(features_.lash_line.At(share));
      const float thick =
          (0.35f + 0.65f * size_) *
          features_.lash_line_thickness.At(std::sin(kPi * std::min(1.0f, 0.1f + 0.68f * share)));
      const float radius = eye_.LidRadius(x);
      const float ends = SmoothStep(0, 0.2f, share);
      const float soft =
          of_photo_ ? features_.lash_line_dark.photo * SmoothStep(0, 0.5f, share) : 1.0f;
      const std::uint32_t low = Add(eye_.LidPoint(x, Angle(x) - 0.10f / radius, radius - 0.1f), x,
                                    soft * features_.lash_line_dark.rim.At(ends));
      const std::uint32_t high = Add(eye_.LidPoint(x, Angle(x) + thick / radius, radius + 0.45f), x,
                                     of_photo_ ? 0 : features_.lash_line_dark.above.At(ends));
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
    // Neighbouring lashes lean together in threes.
    const float clump =
        features_.lash_clump.threes * (static_cast<float>(1 - i % 3)) +
        features_.lash_clump.each * NoiseAt(i, PaintStream::kLashLean) +
        (of_photo_ ? features_.lash_clump.photo * NoiseAt(i, PaintStream::kPhotoLashLean) : 0.0f);
    const float fan = features_.lash_fan.out * (along - features_.lash_fan.from) + clump;
    const float differs = ByLid(features_.lash_lengths) * NoiseAt(i, PaintStream::kLashLength);
    const float outward = std::sin(kPi * std::min(1.0f, 0.18f + 0.62f * along));
    const float length =
        size_ * (upper_ ? features_.upper_lash_length.At(outward) * (0.94f + differs)
                        : features_.lower_lash_length * (1 + differs));
    const glm::vec3 out = glm::normalize(glm::vec3(fan, std::sin(angle), std::cos(angle) * 1.25f));
    const float width = ByLid(features_.lash_width);
    // Lower lashes are thin, and much of the skin shows between them.
    const float dark =
        ByLid(features_.lash_darkness) +
        (of_photo_ ? features_.lash_photo_dark * NoiseAt(i, PaintStream::kPhotoLashDark) : 0.0f);
    const float rise = ByLid(features_.lash_rise);
    const glm::vec3 root = eye_.LidPoint(x, angle + 0.02f * up, radius);
    // A lash is a curved strip of two segments: outward, then up (the lower ones down).
    const glm::vec3 middle = root + length * (0.5f * out + glm::vec3(0, 0.06f * up, 0));
    const glm::vec3 tip = root + length * (0.72f * out + glm::vec3(0, rise, 0));
    const std::uint32_t a = Add(root - glm::vec3(width, 0, 0), x, dark);
    const std::uint32_t b = Add(root + glm::vec3(width, 0, 0), x, dark);
    const std::uint32_t c = Add(middle - glm::vec3(0.6f * width, 0, 0), x, dark);
    const std::uint32_t d = Add(middle + glm::vec3(0.6f * width, 0, 0), x, dark);
    const std::uint32_t e = Add(tip, x, (of_photo_ ? 0.2f : 1.0f) * dark);
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
  MeshBuilder& mesh_;
  BakeWeights weights_;
  bool upper_ = true;
};

}  // namespace

void BuildLashes(const EyeAnatomy& eye, const Identity& identity, bool of_photo,
                 MeshBuilder& mesh) {
  for (const Side side : kSides) {
    LashBuilder builder(eye, identity, of_photo, side, mesh);
    builder.Row(true);
    if (!of_photo) builder.Row(false);
  }
}

}  // namespace fsm
