// Frames of the face as the wire has them, tables of weights, and the bundle made of a frame.

#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "gateway/vmc/vmc_bundle.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  static_cast<void>(gateway::FaceWeights::Read(text, text, text, text));
  const auto frame = gateway::ParseFaceFrame(text);
  if (!frame) return 0;
  for (const auto names : {gateway::VmcNames::kVrm0, gateway::VmcNames::kPerfectSync}) {
    const auto& weights = gateway::FaceWeights::Built();
    for (const float weight : weights.Of(*frame, names)) {
      if (!(weight >= 0 && weight <= 1)) std::abort();
    }
    if (gateway::VmcBundle(*frame, weights, {.names = names}).empty()) std::abort();
  }
  return 0;
}
