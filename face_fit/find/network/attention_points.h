#pragma once

#include <array>
#include <glm/vec2.hpp>

#include "face_fit/find/network/face_finder.h"

namespace facefit {

/// A face as MediaPipe's landmark network with attention sees it: it looks a second time, closer,
/// at lips and eyes, whose points x and y are finer than those of the plain network; z is that of
/// its first look.
struct AttentiveFace {
  FoundFace face;
  /// Of the person's right and left eye: the iris' middle, then four places on its edge, a quarter
  /// of a turn apart. Pixels of the picture.
  fsm::Sided<std::array<glm::vec2, 5>> iris;
};

/// `attention`: what LoadAttentionLandmarks gave. Looks once, at `crop`.
AttentiveFace FindAttentivePoints(Network& attention, const fsm::Image& image,
                                  const NetworkCrop& crop);

}  // namespace facefit
