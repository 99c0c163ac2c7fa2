#include "fsm/head/face_light.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>

namespace fsm {

float ScreenBrightness(glm::vec3 screen) {
  return 0.3f * screen.r + 0.6f * screen.g + 0.1f * screen.b + 0.004f;
}

FaceLight::FaceLight(std::span<const Patch> skin) {
  constexpr int kRounds = 4;       // the first round weights all patches equally
  constexpr float kSpread = 0.6f;  // of the logarithm of light; patches beyond are not skin
  constexpr float kMin = 1e-3f;
  for (int round = 0; round < kRounds && !skin.empty(); ++round) {
    glm::mat4 spread(1e-3f);
    glm::vec4 sum(0), colours(0);
    for (const Patch& patch : skin) {
      const glm::vec4 n(patch.normal, 1);
      const float light = FromScreen(ScreenBrightness(patch.screen));
      const float expected = std::max(glm::dot(light_, n), kMin);
      const float odd = round == 0 ? 0 : std::log(light / expected) / kSpread;
      const float weight = std::exp(-odd * odd);
      spread += weight * glm::outerProduct(n, n);
      sum += weight * light * n;
      colours += weight * glm::vec4(patch.screen, 1);
    }
    skin_ = glm::vec3(colours) / std::max(colours.w, 1e-6f);
    light_ = glm::inverse(spread) * sum;
  }
}

float FaceLight::On(glm::vec3 normal) const {
  return std::sqrt(std::max(glm::dot(light_, glm::vec4(normal, 1)), 0.01f));
}

}  // namespace fsm
