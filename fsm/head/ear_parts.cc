#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>
#include <vector>

#include "fsm/head/paint.h"
#include "fsm/head/parts.h"

namespace fsm {
namespace {

// The outer ear in its own plane, seen from the agent's left: u backwards, v upwards from the
// tragus, millimetres. Heights are off the side of the head.
const std::array<glm::vec2, 18> kOutline = {{{1.5f, 4},
                                             {0.5f, 13},
                                             {2.5f, 22},
                                             {8, 28.6f},
                                             {16, 30.5f},
                                             {24, 28},
                                             {30, 21},
                                             {32.6f, 11},
                                             {31.5f, 1},
                                             {28.2f, -7},
                                             {23.6f, -14},
                                             {19, -20.6f},
                                             {14, -26},
                                             {8, -28.5f},
                                             {3, -26.5f},
                                             {0.6f, -19},
                                             {0, -11},
                                             {-1.2f, -2}}};
constexpr glm::vec2 kMiddle{13, 0};

float Bump(glm::vec2 at, glm::vec2 middle, glm::vec2 size) {
  const glm::vec2 d = (at - middle) / size;
  return std::exp(-0.5f * glm::dot(d, d));
}

float DistanceToLine(glm::vec2 p, const std::vector<glm::vec2>& line) {
  float least = 1e9f;
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const glm::vec2 d = line[i + 1] - line[i];
    const float t = std::clamp(glm::dot(p - line[i], d) / glm::dot(d, d), 0.0f, 1.0f);
    least = std::min(least, glm::length(p - line[i] - t * d));
  }
  return least;
}

float Ridge(float distance, float width) {
  return std::exp(-0.5f * distance * distance / (width * width));
}

struct Relief {
  float height, open;
};

Relief ReliefAt(glm::vec2 p) {
  // The rim from its root in the bowl over the top to the lobe; the antihelix with its fork.
  static const std::vector<glm::vec2> kHelix = {{9, 2},      {4, 5},   {2.4f, 13},     {4.5f, 21},
                                                {9, 26.4f},  {16, 28}, {22.6f, 26},    {28, 20},
                                                {30.2f, 11}, {29, 1},  {25.8f, -6.5f}, {22, -13}};
  static const std::vector<glm::vec2> kAnti = {{15, 21.5f}, {20.5f, 14},  {22, 5},
                                               {20.5f, -4}, {16, -11.5f}, {10, -13.5f}};
  static const std::vector<glm::vec2> kFork = {{8, 15.5f}, {15, 14}, {21, 9}};
  const float lobe = SmoothStep(-12, -18, p.y);
  const float helix = Ridge(DistanceToLine(p, kHelix), 1.9f) * (1 - lobe);
  const float anti = Ridge(DistanceToLine(p, kAnti), 2.3f);
  const float fork = Ridge(DistanceToLine(p, kFork), 2.0f);
  const float bowl = Bump(p, {10.5f, -3.5f}, {6.2f, 7.0f}) + 0.35f * Bump(p, {10, 7.5f}, {6, 2.6f});
  const float tragus = Bump(p, {1.5f, -1.5f}, {2.6f, 3.6f});
  const float notch = Bump(p, {6.0f, -11.5f}, {2.2f, 2.6f});
  const float flare = 0.7f + 0.40f * std::max(p.x, 0.0f) - 0.004f * p.x * p.x;
  const float height = flare + 3.6f * helix + 2.8f * anti + 1.6f * fork - 4.8f * bowl +
                       4.6f * tragus - 2.2f * notch + 1.6f * lobe;
  const float groove = (1 - helix) * (1 - anti) * (1 - fork) * (1 - lobe);
  return {height, 1 - 0.8f * std::min(1.0f, bowl) - 0.32f * groove * (1 - tragus)};
}

glm::vec3 Place(glm::vec2 p, float height) {
  // Leans back at the top; the front lies in the skin of the cheek.
  return {66.2f + height, 0.95f * p.y + 0.05f * p.x, 2.0f - p.x - 0.16f * p.y};
}

}  // namespace

std::array<std::pair<const char*, glm::vec3>, 4> EarLandmarks() {
  const auto at = [](glm::vec2 p) { return Place(p, 0); };
  return {{{"superaurale", at({16, 30.5f})},
           {"subaurale", at({8, -28.5f})},
           {"preaurale", at({0, 8})},
           {"postaurale", at({32.6f, 11})}}};
}

void BuildEars(const Palette& palette, HeadMesh& mesh) {
  constexpr int kAround = 24;
  constexpr std::array kRings = {0.16f, 0.34f, 0.50f, 0.64f, 0.76f, 0.86f, 0.94f, 1.0f};
  std::vector<float> at;
  for (std::size_t i = 0; i < kOutline.size() + 6; ++i) at.push_back(static_cast<float>(i));
  const SplineBasis basis(at);
  std::vector<float> weights(at.size());
  const auto outline = [&](int k) {
    basis.Weights(3 + static_cast<float>(k) * static_cast<float>(kOutline.size()) / kAround,
                  weights);
    glm::vec2 p(0);
    for (std::size_t i = 0; i < at.size(); ++i) {
      p += weights[i] * kOutline[(i + kOutline.size() - 3) % kOutline.size()];
    }
    return p;
  };
  const glm::vec3 colour = glm::mix(palette.skin, palette.blush, 0.30f);
  for (const int side : {-1, 1}) {
    const auto add = [&](glm::vec3 p, float open) {
      p.x *= static_cast<float>(side);
      return mesh.Add(p, glm::mix(palette.blush * 0.8f, colour, open), 0.15f + 0.85f * open,
                      Bone::kSkull);
    };
    const auto fan = [&](std::uint32_t a, std::uint32_t b, std::uint32_t c, bool flip) {
      flip ? mesh.Triangle(Material::kSkin, a, b, c) : mesh.Triangle(Material::kSkin, a, c, b);
    };
    const Relief deep = ReliefAt(kMiddle);
    const std::uint32_t middle = add(Place(kMiddle, deep.height), deep.open);
    std::vector<std::vector<std::uint32_t>> rings;
    for (const float part : kRings) {
      auto& ring = rings.emplace_back();
      for (int k = 0; k < kAround; ++k) {
        const glm::vec2 p = glm::mix(kMiddle, outline(k), part);
        const Relief r = ReliefAt(p);
        ring.push_back(add(Place(p, r.height - (part == 1.0f ? 1.3f : 0)), r.open));
      }
    }
    // Round the rim and down its back into the head.
    for (const auto& [part, drop, open] :
         {std::array{0.97f, 3.4f, 0.8f}, {0.80f, 5.2f, 0.55f}, {0.55f, 30, 0.2f}}) {
      auto& ring = rings.emplace_back();
      for (int k = 0; k < kAround; ++k) {
        const glm::vec2 p = glm::mix(kMiddle, outline(k), part);
        const float height = 0.5f + 0.40f * std::max(p.x, 0.0f) - 0.004f * p.x * p.x;
        ring.push_back(add(Place(p, height + 1.8f - drop), open));
      }
    }
    const std::uint32_t inside = add(Place(kMiddle, -26), 0.2f);
    for (int k = 0; k < kAround; ++k) {
      const auto a = static_cast<std::size_t>(k);
      const auto b = static_cast<std::size_t>((k + 1) % kAround);
      fan(middle, rings.front()[b], rings.front()[a], side > 0);
      for (std::size_t r = 0; r + 1 < rings.size(); ++r) {
        fan(rings[r][a], rings[r][b], rings[r + 1][b], side > 0);
        fan(rings[r][a], rings[r + 1][b], rings[r + 1][a], side > 0);
      }
      fan(inside, rings.back()[a], rings.back()[b], side > 0);
    }
  }
}

}  // namespace fsm
