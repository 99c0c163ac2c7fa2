#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "fsm/head/hair_parts.h"
#include "fsm/head/spline.h"

namespace fsm {
namespace {

constexpr float kPi = std::numbers::pi_v<float>;
constexpr glm::vec3 kVolume{83.5f, 107.5f, 105};  // half axes of the hair over the skull
constexpr float kPartX = 0.17f;  // sideways place of the parting, as part of the volume
constexpr float kEnd = 1.0f;

// Strands start along the parting, sweep over the skull and hang. Those at the face's edge run
// along the hairline close to the skin, those behind them ever higher: hair grows out of the head,
// it is not put on.
class LongHair {
 public:
  LongHair(const Palette& palette, HeadMesh& mesh) : palette_(palette), scalp_(mesh), mesh_(mesh) {}

  void Build() {
    for (const float side : {-1.0f, 1.0f}) {
      Shell(side);
      Lining(side);
      Locks(side);
      Roots(side);
    }
  }

 private:
  // `i` runs from the face's edge (0) to the middle of the back (1), `t` from the parting (0) over
  // the end of the skull (kCap) to the ends (1).
  static constexpr float kCap = 0.58f;

  glm::vec3 Direction(float i, float side, float t) const {
    const float along = glm::mix(30.0f, 158.0f, std::pow(i, 0.9f)) * kPi / 180;
    const glm::vec3 start = glm::normalize(glm::vec3(kPartX, std::sin(along), std::cos(along)));
    const float azimuth = glm::mix(69.0f, 180.0f, std::pow(i, 0.85f));
    const float edge = SmoothStep(0.25f, 0, i);
    // The side away from the parting has the longer way round the forehead.
    const float away = side < 0 ? 1.0f : 0.0f;
    const glm::vec3 bend =
        HairDirection(side * azimuth * glm::mix(1.0f, 0.72f - 0.06f * away, edge),
                      glm::mix(38.0f, 22.5f + 2.5f * away, edge));
    const glm::vec3 end = HairDirection(side * azimuth, glm::mix(-8.0f, -11.0f, edge));
    return glm::normalize((1 - t) * (1 - t) * start + 2 * t * (1 - t) * bend + t * t * end);
  }

  float EndY(float i, float side) const {
    return glm::mix(-94.0f, -116.0f, SmoothStep(0, 0.6f, i)) + 4.0f * std::sin(17 * i + side) +
           3.0f * std::sin(41 * i + 2 * side);
  }

  glm::vec3 Point(float i, float side, float t, float out_mm) const {
    const float cap = std::min(1.0f, t / kCap);
    const glm::vec3 d = Direction(i, side, cap);
    const glm::vec3 scaled = d / kVolume;
    const float volume = 1 / std::sqrt(glm::dot(scaled, scaled));
    const float skin = scalp_.Distance(d);
    const float part = SmoothStep(0, 0.17f, i) * (0.8f + 0.2f * SmoothStep(0, 0.3f, cap));
    const float least = skin + glm::mix(0.9f, 7.5f, SmoothStep(0, 0.12f, i));
    float radius =
        std::max(least, glm::mix(skin + 0.9f + 4.5f * SmoothStep(0.3f, 1, cap), volume, part));
    // The parting is a furrow in the hair.
    radius = glm::mix(skin + 0.55f * (radius - skin), radius, SmoothStep(-0.1f, 0.28f, cap));
    glm::vec3 p = kHairCentre + d * (radius + out_mm);
    if (t > kCap) {
      const float hang = (t - kCap) / (kEnd - kCap);
      const glm::vec3 out = glm::normalize(glm::vec3(d.x, 0, d.z));
      const float front = SmoothStep(0.35f, 0, i);
      p.y = glm::mix(p.y, EndY(i, side), hang);
      const float full = 5.0f * std::sin(std::min(1.0f, 1.2f * hang) * kPi);
      const float wave = 2.2f * std::sin(7 * hang + 9 * i + side) * SmoothStep(0.1f, 0.6f, hang);
      p += out * (full + wave - glm::mix(15.0f, 30.0f, i) * hang * hang * hang);
      p.z += front * 8 * hang * (1 - 0.4f * hang);
    }
    return p;
  }

  static float Ridge(float i, float t) {
    const float phase = 52 * i + 2.0f * std::sin(3 * t + 9 * i);
    return (1.0f * std::sin(phase) + 0.6f * std::sin(2.3f * phase + 1)) *
           SmoothStep(0.02f, 0.3f, t) * (0.6f + 0.7f * t) * SmoothStep(0, 0.08f, i);
  }

  void Shell(float side) {
    constexpr int kStrands = 22;
    constexpr int kRows = 14;
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      // Closer together at the face, where the edge is seen.
      const float u = static_cast<float>(k) / kStrands;
      const float i = glm::mix(u * u, u, 0.45f);
      for (int row = 0; row <= kRows; ++row) {
        const float t = static_cast<float>(row) / kRows;
        const glm::vec3 p = Point(i, side, t, Ridge(i, t));
        const float open = glm::mix(0.6f, 1.0f, SmoothStep(0, 0.12f, t)) *
                           glm::mix(0.7f, 1.0f, SmoothStep(0, 0.1f, i));
        // The first strand is sparse: skin shows between its hairs.
        const float dense = k > 0 || t > kCap ? 1.0f : 0.72f + 0.28f * SmoothStep(0.35f, kCap, t);
        mesh_.Add(p, glm::mix(palette_.skin, StrandColour(palette_, k * 3, row), dense), open,
                  Bone::kSkull);
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, side < 0);
  }

  // The dark inside of the hanging hair, seen beside the neck.
  void Lining(float side) {
    constexpr int kStrands = 12;
    constexpr int kRows = 5;
    const auto first = static_cast<std::uint32_t>(mesh_.position.size());
    for (int k = 0; k <= kStrands; ++k) {
      const float i = glm::mix(0.03f, 1.0f, static_cast<float>(k) / kStrands);
      for (int row = 0; row <= kRows; ++row) {
        const float t = glm::mix(kCap * 0.86f, 0.985f, static_cast<float>(row) / kRows);
        const float inset = row == 0 ? -16.0f : -7.0f;
        mesh_.Add(Point(i, side, t, inset), palette_.hair * 0.7f, 0.25f, Bone::kSkull);
      }
    }
    mesh_.Grid(Material::kHair, first, kStrands + 1, kRows + 1, side > 0);
  }

  void Locks(float side) {
    constexpr int kLocks = 30;
    for (int k = 0; k < kLocks; ++k) {
      const int seed = k + (side > 0 ? 500 : 0);
      const float u = (static_cast<float>(k) + 0.5f + 0.4f * Grain(seed, 1)) / kLocks;
      const bool edge = k < 9;
      const float i = edge ? 0.005f * static_cast<float>(k) : u;
      const float from =
          edge ? 0.02f + 0.028f * static_cast<float>(k) : 0.18f + 0.14f * (Grain(seed, 2) + 1);
      const float to =
          edge ? 0.52f + 0.03f * static_cast<float>(k % 5) : 1.0f + 0.035f * Grain(seed, 3);
      const float lift = edge ? 0.8f : 1.4f + 0.9f * Grain(seed, 4);
      std::vector<glm::vec3> path;
      constexpr int kSteps = 7;
      for (int s = 0; s <= kSteps; ++s) {
        const float v = static_cast<float>(s) / kSteps;
        const float t = glm::mix(from, to, v);
        const float drift = edge ? 0.10f * v * v * (1 + 0.4f * Grain(seed, 5))
                                 : 0.018f * std::sin(4 * v + static_cast<float>(k));
        path.push_back(Point(std::clamp(i + drift, 0.0f, 1.0f), side, t,
                             lift * std::sin(kPi * (0.12f + 0.8f * v))));
      }
      AddLock(path, edge ? 7.0f : 11.0f + 3 * Grain(seed, 6), edge ? 0.15f : 0.06f, palette_, seed,
              1.0f, mesh_);
    }
  }

  // Single small locks that leave the skin before the edge and run slantwise into it, so that the
  // hairline is no drawn line.
  void Roots(float side) {
    constexpr int kRoots = 26;
    for (int k = 0; k < kRoots; ++k) {
      const int seed = k + (side > 0 ? 900 : 700);
      const float t = 0.01f + 0.42f * (static_cast<float>(k) + 0.4f * Grain(seed, 1)) / kRoots;
      const glm::vec3 on_edge = Point(0, side, t, 0);
      glm::vec3 down = Point(0, side, t + 0.03f, 0) - on_edge;
      down = glm::normalize(down);
      const glm::vec3 outward = glm::normalize(on_edge - kHairCentre);
      const glm::vec3 face = glm::cross(outward, down) * side;  // away from the hair
      const float reach = 1.1f + 0.9f * Grain(seed, 2);
      std::vector<glm::vec3> path;
      constexpr int kSteps = 3;
      for (int s = 0; s <= kSteps; ++s) {
        const float v = static_cast<float>(s) / kSteps;
        const float i = 0.075f * v * v;
        const glm::vec3 p =
            Point(i, side, t + 0.17f * v * (1 + 0.3f * Grain(seed, 3)), 0.7f + 0.8f * v);
        path.push_back(p + face * (reach * (1 - v) * (1 - v)) - outward * (0.6f * (1 - v)));
      }
      AddLock(path, 3.0f + Grain(seed, 4), 0.2f, palette_, seed, 0.95f, mesh_);
    }
  }

  const Palette& palette_;
  Scalp scalp_;
  HeadMesh& mesh_;
};

}  // namespace

void BuildLongHair(const Palette& palette, HeadMesh& mesh) { LongHair(palette, mesh).Build(); }

}  // namespace fsm
