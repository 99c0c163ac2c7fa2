#pragma once

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "fsm/image/image.h"
#include "fsm/render/camera.h"
#include "fsm/rig/head.h"

namespace facefit {

/// Draws a head from the front in a square image, for networks to look at.
class PortraitView {
 public:
  explicit PortraitView(int size);
  /// Throws std::runtime_error if rendering is impossible.
  fsm::Image Draw(const fsm::Head& head, const fsm::HeadVertices& vertices,
                  const fsm::FaceState& state) const;
  /// Returns the pixel of a position in the head's frame, millimetres; y runs down.
  glm::vec2 PixelOf(glm::vec3 position) const;
  float mm_per_pixel() const { return 2 / view_.samples_per_mm; }  // two samples to a pixel

 private:
  int size_;
  fsm::FrameCamera view_;
};

}  // namespace facefit
