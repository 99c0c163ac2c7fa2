#pragma once

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// Returns the contrast of a bar across the bridge of the nose, where glasses rest, to the skin
/// above and below it, divided by the skin's brightness. Above kGlassesContrast the face wears
/// glasses.
float BridgeContrast(const FoundFace& face, const fsm::Image& photo);
inline constexpr float kGlassesContrast = 0.11F;

}  // namespace facefit
