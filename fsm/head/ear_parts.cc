#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <numbers>

#include "fsm/head/paint.h"
#include "fsm/head/parts.h"

namespace fsm {

void BuildEars(HeadMesh& mesh) {
  // A shell in polar coordinates about the ear canal: the outline runs from the root of the helix
  // over its top and back down to the lobe. Across, the height over the skull makes helix, groove,
  // antihelix and concha.
  constexpr float kPi = std::numbers::pi_v<float>;
  constexpr int kAround = 20;
  struct Ring {
    float part, lift, open;  // of the outline's radius; off the skull in mm
  };
  constexpr std::array kRings = {
      Ring{0.05f, -3.5f, 0.2f}, Ring{0.22f, -3.0f, 0.35f}, Ring{0.40f, -0.5f, 0.55f},
      Ring{0.55f, 4.5f, 0.95f}, Ring{0.68f, 5.4f, 0.9f},   Ring{0.80f, 5.0f, 0.65f},
      Ring{0.90f, 8.2f, 0.95f}, Ring{1.0f, 8.6f, 1.0f},    Ring{1.03f, 6.4f, 0.9f},
      Ring{0.92f, 2.0f, 0.5f},  Ring{0.55f, -3.0f, 0.3f}};
  // Outline: angle from straight forward, counter-clockwise seen from the agent's left, and radius.
  const Curve outline({0, 40, 80, 115, 150, 185, 220, 250, 275, 300, 330, 360},
                      {10, 21, 34, 37, 34, 29, 27, 29, 29, 22, 12, 10});
  for (const int side : {-1, 1}) {
    const auto first = static_cast<std::uint32_t>(mesh.position.size());
    for (const Ring& ring : kRings) {
      for (int k = 0; k <= kAround; ++k) {
        const float degrees = 360.0f * static_cast<float>(k) / kAround;
        const float angle = degrees * kPi / 180;
        const float radius = outline(degrees) * ring.part;
        const float front = SmoothStep(70, 20, degrees) + SmoothStep(285, 335, degrees);
        const float lobe = SmoothStep(225, 262, degrees) * SmoothStep(315, 280, degrees);
        const float forward = radius * std::cos(angle) * 0.88f;
        const float up = radius * std::sin(angle);
        float lift = glm::mix(ring.lift, ring.lift * 0.35f, front);
        if (ring.part < 0.9f && ring.lift > 0) lift = glm::mix(lift, 5.0f, lobe);
        // The ear leans back and stands off the head behind.
        const glm::vec3 p(63.5f + lift - 0.16f * forward, 3.0f + up, -8.0f + forward - 0.22f * up);
        const glm::vec3 colour = glm::mix(palette::kSkin, palette::kBlush, 0.28f);
        mesh.Add({p.x * static_cast<float>(side), p.y, p.z}, colour, ring.open, Bone::kSkull);
      }
    }
    mesh.Grid(Material::kSkin, first, static_cast<int>(kRings.size()), kAround + 1, side > 0);
  }
}

}  // namespace fsm
