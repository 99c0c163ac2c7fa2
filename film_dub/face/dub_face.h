#pragma once

#include <glm/vec2.hpp>
#include <memory>
#include <span>
#include <vector>

#include "face_fit/find/head/observed_head.h"
#include "face_fit/make_face.h"
#include "fsm/render/camera.h"
#include "fsm/render/renderer.h"
#include "vm_protocol/core/result.h"

namespace filmdub {

/// The face of a film as a head of its own, made of one of its pictures by face_fit, and drawn
/// about as large as the film shows it. Thread: the one that made it.
class DubFace {
 public:
  /// `places`: where that picture shows the points of the face, pixels. Errors: kBadValue (no face
  /// is found there), kUnavailable (nothing can be drawn with).
  static vm::Result<std::unique_ptr<DubFace>> Make(facefit::FaceNetworks& networks,
                                                   const fsm::Image& picture,
                                                   std::span<const glm::vec2> places);

  /// How its head was held in the picture it is made of.
  fsm::Angles held() const { return held_; }
  /// From now on the head is in that state.
  void Pose(const fsm::FaceState& state);
  /// A square picture of it on nothing; alpha = where there is something. Until the next.
  const fsm::Image& Draw();
  /// Where the network's points lie in that picture.
  std::vector<glm::vec2> Points() const;

 private:
  DubFace(facefit::ObservedHead base, const facefit::MadeFace& made, int side);

  const facefit::ObservedHead base_;
  const std::unique_ptr<fsm::Head> head_;
  const fsm::Angles held_;
  const int side_;
  const std::unique_ptr<fsm::RenderContext> context_;
  const std::unique_ptr<fsm::Renderer> renderer_;
  fsm::Scene scene_;
  const fsm::FrameCamera view_;
  fsm::FaceState state_;
  fsm::HeadVertices vertices_;
  fsm::Image drawn_;
};

}  // namespace filmdub
