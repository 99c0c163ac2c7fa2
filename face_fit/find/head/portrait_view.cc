#include "face_fit/find/head/portrait_view.h"

#include <glm/vec4.hpp>

#include "fsm/render/renderer.h"

namespace facefit {

PortraitView::PortraitView(int size)
    : size_(size), view_(fsm::ViewOfPortrait({}, fsm::Camera{}, size, size)) {}

fsm::Image PortraitView::Draw(const fsm::Head& head, const fsm::HeadVertices& vertices,
                              const fsm::FaceState& state) const {
  const auto context = fsm::RenderContext::MakeHeadless(size_, size_);
  const auto renderer = fsm::Renderer::Make(*context);
  renderer->DrawVertices(head, vertices, state.figure, fsm::Scene{});
  fsm::Image image;
  renderer->Read(image);
  return image;
}

glm::vec2 PortraitView::PixelOf(glm::vec3 position) const {
  const glm::vec4 clip = view_.world_to_clip * view_.figure_to_world * glm::vec4(position, 1.0F);
  return (0.5F + 0.5F * glm::vec2(clip.x, -clip.y) / clip.w) * static_cast<float>(size_);
}

}  // namespace facefit
