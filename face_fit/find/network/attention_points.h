#pragma once

#include <array>
#include <glm/vec2.hpp>

#include "face_fit/find/network/face_networks.h"
#include "face_fit/find/network/found_face.h"

namespace facefit {

/// A face found by MediaPipe's landmark network with attention, which looks a second time, closer,
/// at lips and eyes: their x and y are finer than the plain network's; z is the first pass's.
struct AttentiveFace {
  FoundFace face;
  /// For each eye: the centre of the iris, then four points of its edge, a quarter turn apart.
  /// Pixels of the image.
  fsm::Sided<std::array<glm::vec2, kAttentionIrisPoints>> iris;
};

/// Runs the network once, on `crop`. `attention`: from LoadAttentionLandmarks.
AttentiveFace FindAttentivePoints(tflite::Network& attention, const fsm::Image& image,
                                  const NetworkCrop& crop);

}  // namespace facefit
