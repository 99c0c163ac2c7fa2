#pragma once

#include <memory>

#include "face_fit/find/head/observed_head.h"
#include "face_track/model/look.h"
#include "fsm/render/camera.h"
#include "fsm/render/renderer.h"

namespace facetrack {

/// A head that is drawn as told, and where its camera is.
class HeadPainter {
 public:
  static constexpr int kSide = 512;
  static constexpr float kField = 25;

  HeadPainter();
  fsm::Image Draw(const fsm::Head& head, const fsm::FaceState& state);
  /// Lens and pose of a head that stands as at rest, millimetres of the head.
  Lens lens() const { return lens_; }
  Pose rest() const;

 private:
  std::unique_ptr<fsm::RenderContext> context_;
  std::unique_ptr<fsm::Renderer> renderer_;
  fsm::Scene scene_;
  fsm::FrameCamera view_;
  Lens lens_;
};

}  // namespace facetrack
