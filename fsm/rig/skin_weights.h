#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "fsm/base/side.h"

namespace fsm {

/// What carries a vertex. Skin follows action units, mouth, lids and jaw; the others move as rigid
/// bodies (the tongue bends a little).
enum class Bone : std::uint8_t { kSkin, kSkull, kJaw, kTongue, kEyeLeft, kEyeRight };

/// SideOfEye returns the side of an eye's bone, or nothing for other bones; BoneOf is its inverse.
constexpr std::optional<Side> SideOfEye(Bone bone) {
  if (bone == Bone::kEyeRight) return Side::kRight;
  if (bone == Bone::kEyeLeft) return Side::kLeft;
  return std::nullopt;
}
constexpr Bone BoneOf(Side eye) { return eye == Side::kRight ? Bone::kEyeRight : Bone::kEyeLeft; }

/// One of the lips, and the skin on its side of the mouth.
enum class Lip : std::uint8_t { kUpper, kLower };

/// How much a skin vertex takes part in each motion; all weights are 0..1.
struct SkinWeights {
  glm::vec2 domain{};        ///< position on the face in millimetres: nearly (x, y) at rest
  float above_mouth = 0.5f;  ///< 1 = moves with the upper lip's side, 0 = with the lower's
  float jaw = 0;
  float neck = 1;  ///< the vertex's share of the head's rotation
  /// How free the vertex is of what holds it: the share of the action units' displacement that skin
  /// takes (0 at lid margins), and of the tongue's bending (0 at its root).
  float free = 1;
};

}  // namespace fsm
