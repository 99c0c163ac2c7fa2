#pragma once

#include <array>
#include <string>

#include "gateway/vmc/face_frame.h"

namespace gateway {

struct VmcOptions {
  VmcNames names = VmcNames::kVrm0;
  bool bones = true;  ///< head, neck and eyes
};
/// One frame as the VirtualMotionCapture protocol has it, a bundle of OSC 1.0: OK, T, bones, a
/// message for each weight, and Apply. Pure.
std::string VmcBundle(const FaceFrame& frame, const FaceWeights& weights,
                      const VmcOptions& options);

/// x, y, z, w of the rotation by our angles (down, to the viewer's right, tilt; degrees) in Unity's
/// frame of an avatar that faces +z: x is its own right, y up; a left-handed frame. Applied tilt
/// first, then down, then to the side.
std::array<float, 4> UnityRotation(float down, float right, float tilt);

}  // namespace gateway
