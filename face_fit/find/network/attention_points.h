#pragma once

#include <array>
#include <glm/vec2.hpp>
#include <string>
#include <utility>

#include "face_fit/find/network/found_face.h"
#include "face_fit/tflite/network.h"
#include "vm_protocol/core/result.h"

namespace facefit {

/// A face found by AttentionNetwork.
struct AttentiveFace {
  FoundFace face;
  /// For each eye: the centre of the iris, then four points of its edge, a quarter turn apart.
  /// Pixels of the image.
  fsm::Sided<std::array<glm::vec2, 5>> iris;
};

/// MediaPipe's landmark network with attention, which looks a second time, closer, at lips and
/// eyes: slower than the plain one, but their x and y are finer; z is the first pass's. Thread: one
/// at a time.
class AttentionNetwork {
 public:
  /// Errors: as FaceNetworks::Load.
  static vm::Result<AttentionNetwork> Load(const std::string& folder);
  /// REQUIRES: `network` has the inputs and outputs of the one that Load reads.
  explicit AttentionNetwork(tflite::Network network) : network_(std::move(network)) {}
  /// Runs the network once, on `crop`.
  AttentiveFace Find(const fsm::Image& image, const NetworkCrop& crop);

 private:
  tflite::Network network_;
};

}  // namespace facefit
