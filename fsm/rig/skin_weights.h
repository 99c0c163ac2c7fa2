#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <optional>

#include "fsm/base/side.h"

namespace fsm {

/// What carries a vertex. Skin follows the action units, the mouth, the lids and the jaw; the
/// others move as rigid bodies (the tongue bends a little).
enum class Bone : std::uint8_t { kSkin, kSkull, kJaw, kTongue, kEyeLeft, kEyeRight };

/// The eye that a bone is, if it is one, and the bone of an eye.
constexpr std::optional<Side> EyeOf(Bone bone) {
  if (bone == Bone::kEyeRight) return Side::kRight;
  if (bone == Bone::kEyeLeft) return Side::kLeft;
  return std::nullopt;
}
constexpr Bone BoneOf(Side eye) { return eye == Side::kRight ? Bone::kEyeRight : Bone::kEyeLeft; }

/// How a vertex of skin takes part in the motions; all weights 0..1.
struct SkinWeights {
  glm::vec2 domain{};        ///< where on the face: nearly (x, y) at rest
  float above_mouth = 0.5f;  ///< 1 = moves with the upper lip's side, 0 = with the lower's
  float jaw = 0;
  float neck = 1;  ///< part of the head's turn it makes
  /// How free it is of what holds it: the part of the action units' motion that skin takes (lid
  /// rims take none), and of the tongue's bending (its root takes none).
  float free = 1;
};

}  // namespace fsm
