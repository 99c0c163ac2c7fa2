#include "face_fit/find/iris.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>

namespace facefit {
namespace {

float Brightness(glm::vec3 c) { return (0.3F * c.r + 0.5F * c.g + 0.2F * c.b) / 255; }

constexpr std::array<float, 7> kAngles = {-0.6F, -0.4F, -0.2F, 0, 0.2F, 0.4F, 0.6F};

}  // namespace

IrisRing FindIris(const fsm::Image& photo, glm::vec2 corner, glm::vec2 other_corner,
                  glm::vec2 middle, float expected) {
  const glm::vec2 axis = other_corner - corner;
  const float wide = std::max(glm::length(axis), 1e-3F);
  const glm::vec2 along = axis / wide, down(-along.y, along.x);
  // The worse of both sides, so that the shadow of a lid or a brow is not taken for an iris.
  const auto contrast = [&](glm::vec2 centre, float radius) {
    std::array<float, 2> step{};
    for (const std::size_t side : {0U, 1U}) {
      const glm::vec2 outward = side == 0 ? -along : along;
      for (const float angle : kAngles) {
        const glm::vec2 way = outward * std::cos(angle) + down * std::sin(angle);
        step[side] += (Brightness(ColourAt(photo, centre + 1.18F * radius * way)) -
                       Brightness(ColourAt(photo, centre + 0.82F * radius * way))) /
                      static_cast<float>(kAngles.size());
      }
    }
    return std::min(step[0], step[1]) + 0.35F * std::max(step[0], step[1]);
  };
  IrisRing best{.centre = middle, .radius = expected, .contrast = 0};
  float most = 0;
  for (const float size : {0.76F, 0.84F, 0.92F, 1.0F, 1.08F, 1.16F}) {
    for (int x = -8; x <= 8; ++x) {
      for (int y = -7; y <= 7; ++y) {
        const glm::vec2 off(static_cast<float>(x) * 0.025F, static_cast<float>(y) * 0.015F);
        const glm::vec2 at = middle + wide * (off.x * along + off.y * down);
        const float seen = contrast(at, size * expected);
        // Of rings as clear the one that lies where eyes look into the camera.
        const float merit = seen * (1 - 6 * (off.x * off.x + off.y * off.y));
        if (merit <= most) continue;
        most = merit;
        best = {.centre = at, .radius = size * expected, .contrast = seen};
      }
    }
  }
  return best;
}

}  // namespace facefit
