#include "gateway/vmc/live_link.h"

#include <bit>
#include <cmath>
#include <vector>

namespace gateway {
namespace {

constexpr char kVersion = 6;
constexpr std::size_t kValues = 61;
constexpr float kHalfTurn = 180;

void Add(std::string& packet, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) packet += static_cast<char>(number >> shift & 0xff);
}
void Add(std::string& packet, std::int32_t number) {
  Add(packet, std::bit_cast<std::uint32_t>(number));
}
void Add(std::string& packet, float number) { Add(packet, std::bit_cast<std::uint32_t>(number)); }
void Add(std::string& packet, const std::string& text) {
  Add(packet, static_cast<std::int32_t>(text.size()));
  packet += text;
}

/// The nine angles. Ours are down, to the viewer's right (the agent's left), tilted towards it.
std::vector<float> Angles(const FaceFrame& frame) {
  const auto of = [](float down, float left, float tilt) {
    return std::vector<float>{left / kHalfTurn, -down / kHalfTurn, tilt / kHalfTurn};
  };
  std::vector<float> angles;
  for (const auto& three : {of(frame.head[0], frame.head[1], frame.head[2]),
                            of(frame.left_eye[0], frame.left_eye[1], 0),
                            of(frame.right_eye[0], frame.right_eye[1], 0)}) {
    angles.insert(angles.end(), three.begin(), three.end());
  }
  return angles;
}

}  // namespace

std::string LiveLinkPacket(const FaceFrame& frame, const FaceWeights& weights,
                           const LiveLinkOptions& options) {
  std::string packet(1, kVersion);
  Add(packet, options.id);
  Add(packet, options.subject);
  const double at = static_cast<double>(frame.at.count()) * kLiveLinkRate / 1e6;
  const double whole = std::floor(at);
  Add(packet, static_cast<std::int32_t>(std::fmod(whole, 86'400.0 * kLiveLinkRate)));
  Add(packet, static_cast<float>(at - whole));
  Add(packet, kLiveLinkRate);
  Add(packet, std::int32_t{1});
  packet += static_cast<char>(kValues);
  std::vector<float> values = weights.Of(frame, VmcNames::kPerfectSync);
  if (options.angles) {
    const auto angles = Angles(frame);
    values.insert(values.end(), angles.begin(), angles.end());
  }
  values.resize(kValues);
  for (const float value : values) Add(packet, value);
  return packet;
}

}  // namespace gateway
