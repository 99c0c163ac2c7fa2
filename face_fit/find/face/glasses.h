#pragma once

#include "face_fit/find/network/found_face.h"

namespace facefit {

/// Returns the contrast of a bar across the bridge of the nose, where glasses rest, to the skin
/// above and below it, divided by the skin's brightness.
float BridgeContrast(const FoundFace& face, const fsm::Image& photo);
/// The contrast above which a face wears glasses.
inline constexpr float kGlassesContrast = 0.11F;
inline bool WearsGlasses(const FoundFace& face, const fsm::Image& photo) {
  return BridgeContrast(face, photo) > kGlassesContrast;
}

}  // namespace facefit
