#include "gateway/vmc/vmc_bundle.h"

#include <oscpack/osc/OscOutboundPacketStream.h>

#include <cmath>
#include <numbers>
#include <vector>

namespace gateway {
namespace {

constexpr std::size_t kMostBytes = 16u << 10;  // 60 weights take less than 4 KiB
/// Of the head's turn the neck takes one half: so the bend lies between shoulders and skull.
constexpr float kNecksShare = 0.5F;

using Quaternion = std::array<float, 4>;

Quaternion Product(const Quaternion& a, const Quaternion& b) {
  return {a[3] * b[0] + a[0] * b[3] + a[1] * b[2] - a[2] * b[1],
          a[3] * b[1] - a[0] * b[2] + a[1] * b[3] + a[2] * b[0],
          a[3] * b[2] + a[0] * b[1] - a[1] * b[0] + a[2] * b[3],
          a[3] * b[3] - a[0] * b[0] - a[1] * b[1] - a[2] * b[2]};
}

Quaternion About(std::size_t axis, float degrees) {
  const float half = degrees * std::numbers::pi_v<float> / 360;
  Quaternion rotation{0, 0, 0, std::cos(half)};
  rotation[axis] = std::sin(half);
  return rotation;
}

void AddBone(osc::OutboundPacketStream& packet, const char* name, const Quaternion& rotation) {
  packet << osc::BeginMessage("/VMC/Ext/Bone/Pos") << name << 0.0F << 0.0F << 0.0F;
  for (const float part : rotation) packet << part;
  packet << osc::EndMessage;
}

}  // namespace

std::array<float, 4> UnityRotation(float down, float right, float tilt) {
  // The viewer's right is the avatar's left, -x: turning there is negative about y, and tilting
  // there takes the top of the head from y to -x, which is positive about z.
  return Product(Product(About(1, -right), About(0, down)), About(2, tilt));
}

std::string VmcBundle(const FaceFrame& frame, const FaceWeights& weights,
                      const VmcOptions& options) {
  std::vector<char> buffer(kMostBytes);
  osc::OutboundPacketStream packet(buffer.data(), buffer.size());
  packet << osc::BeginBundleImmediate;
  packet << osc::BeginMessage("/VMC/Ext/OK") << osc::int32{1} << osc::EndMessage;
  packet << osc::BeginMessage("/VMC/Ext/T") << static_cast<float>(frame.at.count()) / 1e6F
         << osc::EndMessage;
  if (options.bones) {
    const auto share = [&frame](float part) {
      return UnityRotation(part * frame.head[0], part * frame.head[1], part * frame.head[2]);
    };
    AddBone(packet, "Neck", share(kNecksShare));
    AddBone(packet, "Head", share(1 - kNecksShare));
    AddBone(packet, "LeftEye", UnityRotation(frame.left_eye[0], frame.left_eye[1], 0));
    AddBone(packet, "RightEye", UnityRotation(frame.right_eye[0], frame.right_eye[1], 0));
  }
  const auto values = weights.Of(frame, options.names);
  for (std::size_t i = 0; i < values.size(); ++i) {
    packet << osc::BeginMessage("/VMC/Ext/Blend/Val") << weights.Names(options.names)[i].c_str()
           << values[i] << osc::EndMessage;
  }
  packet << osc::BeginMessage("/VMC/Ext/Blend/Apply") << osc::EndMessage;
  packet << osc::EndBundle;
  return {packet.Data(), packet.Size()};
}

}  // namespace gateway
