#include "face_track/learn/head_painter.h"

namespace facetrack {
namespace {

fsm::Scene SceneOfField(float field_degrees) {
  fsm::Scene scene;
  scene.camera.field_degrees = field_degrees;
  return scene;
}

}  // namespace

HeadPainter::HeadPainter()
    : context_(fsm::RenderContext::MakeHeadless(kSide, kSide)),
      renderer_(fsm::Renderer::Make(*context_)),
      scene_(SceneOfField(kField)),
      view_(fsm::ViewOfPortrait({}, scene_.camera, kSide, kSide)),
      lens_(Lens::Of(kSide, kSide, kField)) {}

fsm::Image HeadPainter::Draw(const fsm::Head& head, const fsm::FaceState& state) {
  fsm::HeadVertices vertices;
  head.Evaluate(state, vertices);
  context_->MakeCurrent();
  renderer_->DrawVertices(head, vertices, state.figure, scene_);
  fsm::Image picture;
  renderer_->Read(picture);
  return picture;
}

Pose HeadPainter::rest() const {
  const glm::vec4 origin = view_.figure_to_world * glm::vec4(0, 0, 0, 1);
  return {.turn = glm::mat3(view_.figure_to_world), .place = glm::vec3(origin) - view_.eye};
}

}  // namespace facetrack
