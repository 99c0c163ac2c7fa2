#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "fsm/base/grain.h"
#include "fsm/base/spline.h"
#include "fsm/head/hair_parts.h"

namespace fsm {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr glm::vec3 kVolume{81.5f, 103.0f, 103};  // half axes of the hair over the skull
constexpr float kEnd = 1.0f;

// Strands start along the parting, sweep over the skull and hang. Those at the face's edge are the
// fringe: they come down over the forehead slantwise, a little off the skin, towards the temples.
class LongHair {
 public:
  LongHair(const LongStyle& style, const Palette& palette, HeadMesh& mesh)
      : style_(style),
        volume_(kVolume + style.full_mm),
        palette_(palette),
        scalp_(mesh),
        mesh_(mesh) {}

  void Build() {
    Shade();
    for (const float side : {-1.0f, 1.0f}) {
      Shell(side);
      Lining(side);
      Locks(side);
      Wisps(side);
      Fringe(side);
    }
  }

 private:
  // `i` runs from the face's edge (0) to the middle of the back (1), `t` from the parting (0) over
  // the end of the skull (kCap) to the ends (1).
  static constexpr float kCap = 0.58f;

  glm::vec3 Direction(float i, float side, float t) const {
    const float along = glm::mix(31.0f, 158.0f, std::pow(i, 0.9f)) * kPi / 180;
    const glm::vec3 start =
        glm::normalize(glm::vec3(style_.parting, std::sin(along), std::cos(along)));
    const float azimuth = glm::mix(56.0f, 180.0f, std::pow(i, 0.85f));
    const float edge = SmoothStep(0.25f, 0, i);
    // The side away from the parting has the longer way round the forehead.
    const float away = side < 0 ? 1.0f : 0.0f;
    const glm::vec3 bend =
        HairDirection(side * azimuth * glm::mix(1.0f, 0.78f - 0.02f * away, edge),
                      glm::mix(38.0f, 14.0f - 2.0f * away, edge));
    const glm::vec3 end = HairDirection(side * azimuth, glm::mix(-8.0f, -14.0f, edge));
    return glm::normalize((1 - t) * (1 - t) * start + 2 * t * (1 - t) * bend + t * t * end);
  }

  float EndY(float i, float side) const {
    return glm::mix(style_.front_y, style_.back_y, std::sqrt(SmoothStep(0, 0.8f, i))) +
           2.0f * std::sin(17 * i + side);
  }

  glm::vec3 Point(float i, float side, float t, float out_mm) const {
    const float cap = std::min(1.0f, t / kCap);
    const glm::vec3 d = Direction(i, side, cap);
    const glm::vec3 scaled = d / volume_;
    const float volume = 1 / std::sqrt(glm::dot(scaled, scaled));
    const float skin = scalp_.Distance(d);
    const float part = SmoothStep(0, 0.17f, i) * (0.8f + 0.2f * SmoothStep(0, 0.3f, cap));
    const float fringe = 1.2f + 4.0f * std::sin(kPi * SmoothStep(0, 1, cap));
    const float least = skin + glm::mix(fringe, 7.5f, SmoothStep(0, 0.12f, i));
    float radius =
        std::max(least, glm::mix(skin + 1.2f + 4.5f * SmoothStep(0.3f, 1, cap), volume, part));
    // The parting is a furrow in the hair.
    radius = glm::mix(skin + 0.55f * (radius - skin), radius, SmoothStep(-0.1f, 0.28f, cap));
    glm::vec3 p = kHairCentre + d * (radius + out_mm);
    if (t > kCap) {
      const float hang = (t - kCap) / (kEnd - kCap);
      const glm::vec3 out = glm::normalize(glm::vec3(d.x, 0, d.z));
      const float front = SmoothStep(0.35f, 0, i);
      p.y = glm::mix(p.y, EndY(i, side), hang);
      const float full = glm::mix(5.0f, 1.0f, front) * std::sin(std::min(1.0f, 1.2f * hang) * kPi);
      const float wave =
          style_.wave_mm * std::sin(7 * hang + 9 * i + side) * SmoothStep(0.1f, 0.6f, hang);
      p +=
          out * (full + wave - glm::mix(17.0f, 30.0f, SmoothStep(0, 0.6f, i)) * hang * hang * hang);
      p.z += front * 8 * hang * (1 - 0.4f * hang);
      // At the face it follows the cheek.
      p.x -= side * front * 6.5f * std::sin(std::min(1.0f, 1.5f * hang) * kPi * 0.5f);
    }
    return p;
  }

  glm::vec3 Along(float i, float side, float t) const {
    return glm::normalize(Point(i, side, t + 0.02f, 0) - Point(i, side, t - 0.02f, 0) +
                          glm::vec3(0, -1e-3f, 0));
  }

  static float Ridge(float i, float t) {
    const float phase = 52 * i + 2.0f * std::sin(3 * t + 9 * i);
    return (1.0f * std::sin(phase) + 0.6f * std::sin(2.3f * phase + 1)) *
           SmoothStep(0.02f, 0.3f, t) * (0.6f + 0.7f * t) * SmoothStep(0, 0.08f, i);
  }

  void Shade() {
    std::vector<glm::vec3> edge;
    for (const float side : {-1.0f, 1.0f}) {
      for (int k = 0; k <= 32; ++k)
        edge.push_back(Point(0, side, 0.02f * static_cast<float>(k), 0));
    }
    ShadeByHair(edge, 17, palette_, mesh_);
  }

  void Shell(float side) {
    constexpr int kStrands = 30;
    constexpr int kCapRows = 13;  // the skull is round, what hangs nearly straight
    constexpr int kRows = 19;
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      // Closer together at the face, where the edge is seen.
      const float u = static_cast<float>(k) / kStrands;
      const float i = glm::mix(u * u, u, 0.45f);
      for (int row = 0; row <= kRows; ++row) {
        const float t =
            row <= kCapRows
                ? kCap * static_cast<float>(row) / kCapRows
                : glm::mix(kCap, kEnd, static_cast<float>(row - kCapRows) / (kRows - kCapRows));
        const glm::vec3 p = Point(i, side, t, Ridge(i, t));
        const float open = glm::mix(0.6f, 1.0f, SmoothStep(0, 0.12f, t)) *
                           glm::mix(0.7f, 1.0f, SmoothStep(0, 0.1f, i));
        mesh_.Add(p, StrandColour(palette_, k * 3, row) * glm::mix(0.85f, 1.1f, t), open,
                  Bone::kSkull);
        const float edge = k == 0 ? 0.1f : k == 1 ? 0.8f : 1.0f;
        mesh_.strands.back() = {.along = Along(i, side, t),
                                .density = edge * SmoothStep(1.04f, 0.86f, t),
                                .place = {side * 215 * i, 260 * t}};
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, side > 0);
  }

  // The dark inside of the hair, seen beside the neck and beyond the far temple.
  void Lining(float side) {
    constexpr int kStrands = 12;
    constexpr int kRows = 6;
    constexpr std::array kInset{-14.0f, -10.0f, -7.0f, -4.5f, -2.5f, -1.2f, -0.5f};
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      // Beside the face it reaches up to the forehead: there one looks under the hair.
      const float u = static_cast<float>(k) / kStrands;
      const float i = glm::mix(0.005f, 1.0f, glm::mix(u * u, u, 0.4f));
      const float behind = SmoothStep(0.06f, 0.3f, i);
      for (int row = 0; row <= kRows; ++row) {
        const float t =
            glm::mix(kCap * glm::mix(0.1f, 0.6f, behind), kEnd, static_cast<float>(row) / kRows);
        const float inset = glm::mix(-0.6f, kInset[static_cast<std::size_t>(row)], behind);
        mesh_.Add(Point(i, side, t, inset), palette_.hair, 0.5f, Bone::kSkull);
        mesh_.strands.back() = {.along = Along(i, side, t),
                                .density = SmoothStep(1.04f, 0.86f, t),
                                .place = {215 * i, 260 * t}};
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, side < 0);
  }

  void Locks(float side) {
    constexpr int kEdge = 9;
    constexpr int kLocks = 34;
    for (int k = 0; k < kLocks; ++k) {
      const int seed = k + (side > 0 ? 500 : 0);
      const float u =
          (static_cast<float>(k - kEdge) + 0.5f + 0.4f * Grain(seed, 1)) / (kLocks - kEdge);
      const bool edge = k < kEdge;
      const float i = edge ? 0.005f * static_cast<float>(k) : u;
      const float from =
          edge ? 0.02f + 0.028f * static_cast<float>(k) : 0.18f + 0.14f * (Grain(seed, 2) + 1);
      const float to =
          edge ? 0.52f + 0.03f * static_cast<float>(k % 5) : 1.01f + 0.03f * Grain(seed, 3);
      const float lift = edge ? 0.8f : 2.2f + 0.9f * Grain(seed, 4);
      std::vector<glm::vec3> path;
      constexpr int kSteps = 6;
      for (int s = 0; s <= kSteps; ++s) {
        const float v = static_cast<float>(s) / kSteps;
        const float t = glm::mix(from, to, v);
        const float drift = edge ? 0.10f * v * v * (1 + 0.4f * Grain(seed, 5))
                                 : 0.018f * std::sin(4 * v + static_cast<float>(k));
        path.push_back(Point(std::clamp(i + drift, 0.0f, 1.0f), side, t,
                             lift * std::sin(kPi * (0.12f + 0.8f * v))));
      }
      AddLock(path,
              {.width_mm = edge ? 9.0f : 15.0f + 4 * Grain(seed, 6),
               .root_part = edge ? 0.4f : 0.5f,
               .tip_part = 0.6f,
               .fray_from = 0.66f},
              palette_, seed, mesh_);
    }
  }

  // Thin locks that leave the edge of the hair towards the face and end there, so that the edge is
  // no drawn line.
  void Wisps(float side) {
    constexpr int kWisps = 24;
    for (int k = 0; k < kWisps; ++k) {
      const int seed = k + (side > 0 ? 900 : 700);
      const float from = 0.06f + 0.74f * (static_cast<float>(k) + 0.4f * Grain(seed, 1)) / kWisps;
      const float long_part = 0.17f * (1 + 0.45f * Grain(seed, 3));
      const float reach =
          (2.2f + 1.5f * Grain(seed, 2)) * (1 + 1.8f * SmoothStep(0.45f, 0.25f, from));
      std::vector<glm::vec3> path;
      constexpr int kSteps = 3;
      for (int s = 0; s <= kSteps; ++s) {
        const float v = static_cast<float>(s) / kSteps;
        const float t = from + long_part * v;
        const float i = 0.05f * (1 - v);
        const glm::vec3 p = Point(i, side, t, 1.2f - 1.2f * v);
        const glm::vec3 down = glm::normalize(Point(i, side, t + 0.02f, 0) - p);
        const glm::vec3 outward = glm::normalize(p - kHairCentre);
        const glm::vec3 face = glm::cross(down, outward) * side;  // away from the hair
        path.push_back(p + face * (reach * v * v) - outward * (1.0f * v * v));
      }
      AddLock(path,
              {.width_mm = 6.5f + 2 * Grain(seed, 4),
               .root_part = 0.6f,
               .fray_from = 0.3f,
               .open = 0.95f},
              palette_, seed, mesh_);
    }
  }

  // Locks from the parting over the upper forehead to the temple. The foremost end first, those
  // from farther back reach lower.
  void Fringe(float side) {
    const int locks = side < 0 ? 16 : 11;
    for (int k = 0; k < locks; ++k) {
      const int seed = k + (side > 0 ? 1300 : 1100);
      const float u =
          (static_cast<float>(k) + 0.5f + 0.5f * Grain(seed, 1)) / static_cast<float>(locks);
      // Some are thin strands that come further down.
      const float strand = k % 3 == 1 && u < 0.7f ? 1.0f : 0.0f;
      const float along = glm::mix(32.0f, 64.0f, u) * kPi / 180;
      const glm::vec3 start =
          glm::normalize(glm::vec3(style_.parting, std::sin(along), std::cos(along)));
      const glm::vec3 bend =
          HairDirection(side * (glm::mix(16.0f, 44.0f, u) + 5 * Grain(seed, 2)),
                        glm::mix(side < 0 ? 19.0f : 22.0f, 33.0f, u) - 3.5f * strand);
      const glm::vec3 end =
          HairDirection(side * (glm::mix(33.0f, 74.0f, u) + 4 * Grain(seed, 3)),
                        glm::mix(9.0f, -9.0f, u) + 5.0f * Grain(seed, 4) - 3.0f * strand);
      std::vector<glm::vec3> path;
      constexpr int kSteps = 7;
      for (int s = 0; s <= kSteps; ++s) {
        const float v = static_cast<float>(s) / kSteps;
        const glm::vec3 d =
            glm::normalize((1 - v) * (1 - v) * start + 2 * v * (1 - v) * bend + v * v * end);
        const glm::vec3 scaled = d / volume_;
        const float skin = scalp_.Distance(d);
        const float full = 0.5f * (1 / std::sqrt(glm::dot(scaled, scaled)) - skin);
        const float lift = glm::mix(full + 2.2f, 8.0f + Grain(seed, 5), SmoothStep(0, 0.55f, v));
        path.push_back(kHairCentre + d * (skin + lift - 4.5f * v * v));
      }
      AddLock(path,
              {.width_mm = 15.0f + 3 * Grain(seed, 6) - 9 * strand,
               .root_part = 0.4f,
               .fray_from = 0.5f,
               .root_density = 0.3f},
              palette_, seed, mesh_);
    }
  }

  const LongStyle style_;
  const glm::vec3 volume_;
  const Palette& palette_;
  Scalp scalp_;
  HeadMesh& mesh_;
};

}  // namespace

void BuildLongHair(const LongStyle& style, const Palette& palette, HeadMesh& mesh) {
  LongHair(style, palette, mesh).Build();
}

}  // namespace fsm
