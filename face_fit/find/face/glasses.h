#pragma once

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// How much a bar across the nose between the eyes differs from the skin above and below it, as
/// part of their brightness: where glasses rest. Beyond kGlassesContrast there are some.
float BridgeContrast(const FoundFace& face, const fsm::Image& photo);
inline constexpr float kGlassesContrast = 0.11F;

}  // namespace facefit
