#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <utility>
#include <vector>

#include "fsm/head/paint.h"
#include "fsm/head/parts.h"

namespace fsm {
namespace {

// A bob parted on one side. Strands start along the parting, sweep over the skull and hang to the
// jaw; neighbouring strands make one surface, combed by ridges and streaks.
constexpr float kRadians = std::numbers::pi_v<float> / 180;
constexpr glm::vec3 kCentre{0, 44, -9};
constexpr glm::vec3 kVolume{81, 102, 103};  // half axes of the hair over the skull
constexpr float kPartX = 0.16f;             // sideways place of the parting, as part of the volume
constexpr int kStrands = 34;                // per side
constexpr int kInnerFirst = 2;              // the inner layer stays behind the face's edge
constexpr int kCapRows = 11;
constexpr int kHangRows = 9;
constexpr int kRows = kCapRows + kHangRows;

glm::vec3 Direction(float azimuth, float elevation) {
  return {std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
          std::cos(azimuth) * std::cos(elevation)};
}

glm::vec3 OnVolume(glm::vec3 direction, float scale) {
  const glm::vec3 d = direction / kVolume;
  return kCentre + direction * (scale / std::sqrt(glm::dot(d, d)));
}

struct Strand {
  glm::vec3 start, bend, end;  // directions from the centre
  float scale;                 // of the volume
  float end_y;                 // where it ends
  float tuck;                  // how far the end curls inwards
};

// `i` runs from the face's edge (0) to the middle of the back (1).
Strand StrandAt(float i, float side) {
  Strand s{};
  // The parting runs from the hairline over the crown to the back of the head.
  const float along = glm::mix(33.5f, 158.0f, i) * kRadians;
  s.start = glm::normalize(glm::vec3(kPartX, std::sin(along), std::cos(along)));
  const float azimuth = glm::mix(66.0f, 180.0f, std::pow(i, 0.85f)) * kRadians;
  s.bend = Direction(side * azimuth * glm::mix(0.86f, 1.0f, SmoothStep(0, 0.4f, i)),
                     glm::mix(9.0f, 38.0f, SmoothStep(0, 0.5f, i)) * kRadians);
  s.end = Direction(side * azimuth, -8 * kRadians);
  s.scale = glm::mix(0.945f, 1.0f, SmoothStep(0, 0.16f, i));
  s.end_y = glm::mix(-74.0f, -98.0f, SmoothStep(0, 0.8f, i));
  s.tuck = glm::mix(13.0f, 26.0f, i);
  return s;
}

glm::vec3 StrandPoint(const Strand& s, float row, float front) {
  const float cap = std::min(1.0f, row / (kCapRows - 1));
  // A curve from the parting sideways, then down: its last part heads straight for the ground, so
  // that it goes over into the hanging part without a corner.
  const float t = cap;
  const glm::vec3 d =
      glm::normalize((1 - t) * (1 - t) * s.start + 2 * t * (1 - t) * s.bend + t * t * s.end);
  const float rise = s.scale * (0.965f + 0.035f * SmoothStep(0, 0.25f, cap));
  glm::vec3 p = OnVolume(d, rise);
  if (row > kCapRows - 1) {
    const float hang = (row - (kCapRows - 1)) / kHangRows;
    const glm::vec3 out = glm::normalize(glm::vec3(s.end.x, 0, s.end.z));
    p.y = glm::mix(p.y, s.end_y, hang);
    // Falls straight, fuller at the cheek, and curls in at the end; the back follows the neck.
    p += out * (3.5f * std::sin(std::min(1.0f, hang * 1.25f) * std::numbers::pi_v<float>) -
                s.tuck * hang * hang * hang);
    p.z += front * 9 * hang * (1 - 0.3f * hang);
  }
  return p;
}

// The skin under the hair, as distance from the hair's centre by direction: hair must lie over it.
class Skull {
 public:
  explicit Skull(const HeadMesh& mesh) {
    for (std::size_t i = 0; i < mesh.position.size(); ++i) {
      const glm::vec3 d = mesh.position[i] - kCentre;
      const float length = glm::length(d);
      if (mesh.bone[i] != Bone::kFlesh || mesh.position[i].y < 20 || length < 60) continue;
      points_.push_back({d / length, length});
    }
  }
  float Distance(glm::vec3 direction) const {
    float sum = 0;
    float weights = 0;
    for (const auto& [d, length] : points_) {
      const float off = 1 - glm::dot(d, direction);
      if (off > 0.03f) continue;
      const float weight = std::exp(-off / 0.004f);
      sum += weight * length;
      weights += weight;
    }
    return weights > 0 ? sum / weights : 0.0f;
  }

 private:
  std::vector<std::pair<glm::vec3, float>> points_;
};

glm::vec3 Streak(int strand, int row, int side) {
  const float fine = Grain(strand * 7 + side, 3);
  const float broad = Grain((strand + side) / 4, 11);
  const float along = 0.05f * Grain(strand, row + 40);
  const float light = 1 + 0.26f * fine + 0.16f * broad + along;
  return palette::kHair * light *
         glm::mix(glm::vec3(1), glm::vec3(1.12f, 1.0f, 0.85f), 0.5f + 0.5f * fine);
}

}  // namespace

void BuildHair(HeadMesh& mesh) {
  const Skull skull(mesh);
  for (const int side : {-1, 1}) {
    const auto sign = static_cast<float>(side);
    const auto add_layer = [&](bool outer, int first_row) {
      const auto first = static_cast<std::uint32_t>(mesh.position.size());
      // Column -1 rolls the face's edge inwards, so that it has thickness.
      for (int k = outer ? -1 : kInnerFirst; k <= kStrands; ++k) {
        const float i = std::max(0.0f, static_cast<float>(k)) / kStrands;
        Strand strand = StrandAt(i, sign);
        const float front = 1 - SmoothStep(0, 0.3f, i);
        glm::vec3 pushed(0);
        for (int row = first_row; row <= kRows; ++row) {
          glm::vec3 p = StrandPoint(strand, static_cast<float>(row), front);
          const glm::vec3 out =
              glm::normalize(glm::vec3(p.x, 0.4f * (p.y - kCentre.y), p.z - kCentre.z));
          if (row < kCapRows) {
            const glm::vec3 from = p - kCentre;
            const float length = glm::length(from);
            const float least =
                skull.Distance(from / length) + 4.5f + 2.5f * SmoothStep(0, 0.15f, i);
            pushed = std::max(0.0f, least - length) * (from / length);
          }
          // What the skull asked for at the end of the cap fades down the hanging part.
          p += pushed * SmoothStep(kRows, kCapRows - 1, static_cast<float>(row));
          const float down = static_cast<float>(row) / kRows;
          // Locks: broad waves with a few fine ones, drifting sideways along the strand.
          const float phase = i * 46 + 2.0f * std::sin(3 * down + i * 9);
          float ridge = 1.1f * std::sin(phase) + 0.7f * std::sin(2.3f * phase + 1) +
                        0.5f * Grain(k, side + 5);
          ridge *= SmoothStep(0, 0.2f, down) * (0.6f + 0.8f * down);
          // The inner layer begins inside the skull, so that its upper edge never shows.
          const float inset =
              5 + 14 * SmoothStep(static_cast<float>(first_row) + 4, static_cast<float>(first_row),
                                  static_cast<float>(row));
          p += out * (outer ? ridge : -inset);
          if (k < 0) p += -out * 7.0f + glm::vec3(sign * 2.0f, 0, -5.0f);
          if (outer && row == kRows) p.y += 1.2f * Grain(k / 3, side + 9);
          const float edge = k < 0 ? 0.45f : 1.0f;
          const float parting = glm::mix(0.55f, 1.0f, SmoothStep(0, 2.2f, static_cast<float>(row)));
          const float open = outer ? edge * parting : 0.22f;
          mesh.Add(p, Streak(k, row, side), open, Bone::kSkull);
        }
      }
      mesh.Grid(Material::kHair, first, kStrands + (outer ? 2 : 1 - kInnerFirst),
                kRows - first_row + 1, outer == (side < 0));
    };
    add_layer(true, 0);
    add_layer(false, kCapRows - 2);
  }
}

}  // namespace fsm
