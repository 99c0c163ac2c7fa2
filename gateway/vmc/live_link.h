#pragma once

#include <cstdint>
#include <string>

#include "gateway/vmc/face_frame.h"

namespace gateway {

struct LiveLinkOptions {
  std::string id;       ///< of the device, 36 letters as of a UUID
  std::string subject;  ///< the name that Unreal shows
  bool angles = true;   ///< of head and eyes; else they are 0
};
/// One frame as the app Live Link Face sends it (version 6) to Unreal, a datagram for each:
///
///   u8 6 | i32 length, id | i32 length, subject | i32 frame, f32 part of it | i32 rate, i32 1
///   | u8 61 | f32 x 61
///
/// Numbers are big-endian. The 61 are ARKit's 52 in Live Link's order, then yaw, pitch and roll of
/// head, left eye and right eye, where 1 is half a turn: yaw to the agent's left, pitch up, roll to
/// its left shoulder. Frames are counted from the face's clock, kLiveLinkRate a second. Pure.
std::string LiveLinkPacket(const FaceFrame& frame, const FaceWeights& weights,
                           const LiveLinkOptions& options);
inline constexpr std::int32_t kLiveLinkRate = 60;

}  // namespace gateway
