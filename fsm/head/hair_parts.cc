#include "fsm/head/hair_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>

#include "fsm/base/smooth_step.h"
#include "fsm/head/landmarks.h"
#include "fsm/head/paint_stream.h"

namespace fsm {

Scalp::Scalp(const MeshBuilder& mesh) {
  for (std::size_t i = 0; i < mesh.position.size(); ++i) {
    const glm::vec3 d = mesh.position[i] - kHairCentre;
    const float length = glm::length(d);
    if (mesh.bone[i] != Bone::kSkin || mesh.position[i].y < -70 || length < 45) continue;
    if (mesh.position[i].y < 5 && mesh.position[i].z > 45) continue;  // facial features
    if (mesh.weights[i].skin.neck <= 0) continue;                     // cloth
    points_.push_back({d / length, length});
  }
}

float Scalp::Distance(glm::vec3 direction) const {
  // Behind, the skin has few points, because hair hides it.
  const float reach = glm::mix(0.004f, 0.03f, SmoothStep(0.1f, -0.5f, direction.z));
  float sum = 0;
  float weights = 0;
  for (const auto& [d, length] : points_) {
    const float difference = 1 - glm::dot(d, direction);
    if (difference > 12 * reach) continue;
    const float weight = std::exp(-difference / reach);
    sum += weight * length;
    weights += weight;
  }
  return weights > 0 ? sum / weights : 80.0f;
}

glm::vec3 Scalp::Over(glm::vec3 direction, float lift) const {
  return kHairCentre + direction * (Distance(direction) + lift);
}

glm::vec3 HairDirection(float azimuth, float elevation) {
  const float a = glm::radians(azimuth);
  const float e = glm::radians(elevation);
  return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

glm::vec3 HairLook::StrandColour(int strand, int row) const {
  const float fine = NoiseAt(strand * 7, PaintStream::kStrandColour);
  const float broad = NoiseAt(strand / 4, PaintStream::kStreakColour);
  const float along =
      features_.hair_streaks.along * NoiseAt(strand, PaintStream::kStreakAlong, row);
  // Dark hair shows its streaks; light hair is more even.
  const float strength =
      1 - features_.hair_even.part * features_.hair_even.green.Ramp(palette_.hair.g);
  const float light = 1 + strength * (features_.hair_streaks.strand * fine +
                                      features_.hair_streaks.broad * broad + along);
  return palette_.hair * light *
         glm::mix(glm::vec3(1), features_.hair_lightest, 0.5f + 0.5f * fine);
}

float HairLook::AboveHairline(glm::vec3 p) const {
  const glm::vec3 d = p - kHairCentre;
  return glm::degrees(std::asin(d.y / glm::length(d))) -
         HairlineElevation(glm::degrees(std::atan2(d.x, d.z)));
}

void HairLook::ShadeSkin(std::span<const glm::vec3> edge, float reach_mm, MeshBuilder& mesh) const {
  const float lowest = features_.hair_on_skin.lowest;
  for (std::size_t i = 0; i < mesh.position.size(); ++i) {
    const glm::vec3 p = mesh.position[i];
    if (mesh.bone[i] != Bone::kSkin || p.y < lowest) continue;
    float nearest = 1e9f;
    for (const glm::vec3 q : edge) nearest = std::min(nearest, glm::dot(p - q, p - q));
    const float beside =
        std::exp(-nearest / (reach_mm * reach_mm)) * SmoothStep(lowest, lowest + 30, p.y);
    const float near = beside * SmoothStep(10, 40, p.y);
    const float under = features_.hair_on_skin.under.Ramp(AboveHairline(p));
    mesh.openness[i] *= 1 - features_.hair_on_skin.shade * std::max(beside, under);
    mesh.albedo[i] = glm::mix(
        mesh.albedo[i], palette_.hair,
        std::max(features_.hair_on_skin.tint * near, features_.hair_on_skin.under_tint * under));
  }
}

void HairLook::AddLock(std::span<const glm::vec3> path, const LockStyle& style, int seed,
                       MeshBuilder& mesh) const {
  const float streaks = features_.lock_streaks, root_light = features_.lock_root_light;
  std::array<std::uint32_t, 2> before{};
  const int last = static_cast<int>(path.size()) - 1;
  float along_mm = 90 * (1 + NoiseAt(seed, PaintStream::kLockTileAlong));
  const float across_mm = 130 * (1 + NoiseAt(seed, PaintStream::kLockTileAcross));
  for (int k = 0; k <= last; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const float t = static_cast<float>(k) / static_cast<float>(last);
    const glm::vec3 step = path[std::min(i + 1, path.size() - 1)] - path[i > 0 ? i - 1 : 0];
    const glm::vec3 outward = style.outward == glm::vec3(0) ? path[i] - kHairCentre : style.outward;
    glm::vec3 across = glm::cross(step, outward);
    const float length = glm::length(across);
    across = length > 1e-4f ? across / length : glm::vec3(1, 0, 0);
    // A single hair stands on its edge, so that it is seen where it crosses the outline.
    if (style.single) across = glm::normalize(glm::cross(across, step) + glm::vec3(0, 1e-4f, 0));
    if (k > 0) along_mm += glm::length(path[i] - path[i - 1]);
    const float taper = glm::mix(style.root_share, 1.0f, SmoothStep(0, 0.3f, t)) *
                        glm::mix(1.0f, style.tip_share, SmoothStep(0.5f, 1, t));
    const glm::vec3 colour = glm::mix(palette_.hair, StrandColour(seed, k), streaks) *
                             glm::mix(1.0f, style.tip_light, t);
    const float shade = style.open * glm::mix(root_light, 1.0f, SmoothStep(0, 0.25f, t));
    const float density = glm::mix(style.root_density, 1.0f, SmoothStep(0, 0.16f, t)) *
                          SmoothStep(1.0f, style.fray_from, t);
    std::array<std::uint32_t, 2> now{};
    for (std::size_t edge = 0; edge < 2; ++edge) {
      const float side = edge == 0 ? -1.0f : 1.0f;
      const float half = 0.5f * style.width_mm * taper;
      now[edge] = mesh.Add(path[i] + side * half * across, colour, shade, Bone::kSkull);
      mesh.strands.back() = {.along = glm::normalize(step + glm::vec3(0, -1e-4f, 0)),
                             .density = density,
                             .across = style.single ? 0.5f * side : side,
                             .tile_mm = {across_mm + side * half, along_mm}};
    }
    if (k > 0) mesh.Quad(Material::kHair, before[0], before[1], now[1], now[0]);
    before = now;
  }
}

SkinStroke HairLook::SkinHair(const Scalp& scalp, glm::vec3 root, glm::vec3 along, float strength,
                              int seed) const {
  const float length = features_.hairline_length.At(NoiseAt(seed, PaintStream::kHairlineLength)) *
                       (0.4f + 0.6f * strength);
  const glm::vec3 aside = glm::cross(root, along);
  const glm::vec3 direction = glm::normalize(
      along + features_.hairline_uneven * NoiseAt(seed, PaintStream::kHairlineWay) * aside);
  const glm::vec3 bent = glm::normalize(
      along + features_.hairline_uneven * NoiseAt(seed, PaintStream::kHairlineBend) * aside);
  const auto at = [&](glm::vec3 d) { return SkinUv(scalp.Over(glm::normalize(d), 0)); };
  const glm::vec3 middle = root + direction * (0.5f * length / 100);
  const float cover = features_.hairline_cover.At(NoiseAt(seed, PaintStream::kHairlineCover)) *
                      (0.3f + 0.7f * strength);
  return {.root = at(root),
          .middle = at(middle),
          .tip = at(middle + bent * (0.5f * length / 100)),
          .width_mm = features_.hairline_width.At(NoiseAt(seed, PaintStream::kHairlineWidth)),
          .tint = glm::mix(glm::vec3(1), palette_.hair / palette_.skin, cover)};
}

void HairLook::AlignNormals(std::span<const glm::vec3> position,
                            std::span<glm::vec3> normal) const {
  const float below = features_.hair_as_one.below, share = features_.hair_as_one.part;
  for (std::size_t i = 0; i < position.size(); ++i) {
    const glm::vec3 from = position[i] - kHairCentre;
    const glm::vec3 outward = glm::normalize(from * glm::vec3(1, from.y > 0 ? 1.0f : below, 1));
    if (glm::dot(normal[i], outward) < -0.3f) continue;  // lining; single hairs stand upright
    normal[i] = glm::normalize(glm::mix(normal[i], outward, share));
  }
}

}  // namespace fsm
