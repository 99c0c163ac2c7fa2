#include "fsm/render/camera.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/trigonometric.hpp>

namespace fsm {
namespace {

/// What the picture shows at the depth of the face: from below the collar to above the hair.
constexpr float kFramedBottom = -172.0F;
constexpr float kFramedTop = 158.0F;
/// The least width kept in view: the head with its hair.
constexpr float kFramedWidth = 250.0F;
constexpr float kFaceDepth = 50.0F;
/// The figure turns and grows about the root of the neck, so that it does so on the spot.
constexpr glm::vec3 kPivot{0.0F, -60.0F, 0.0F};

}  // namespace

View FramePortrait(const FaceState& state, const Camera& camera, int width, int height) {
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  const float framed_height = std::max(kFramedTop - kFramedBottom, kFramedWidth / aspect);
  const float half_angle = glm::radians(std::clamp(camera.field_degrees, 5.0F, 90.0F) / 2);
  const float portrait = framed_height / 2 / std::tan(half_angle);
  const float distance = portrait * std::clamp(camera.distance, 0.2F, 10.0F);
  const float middle = (kFramedTop + kFramedBottom) / 2 + camera.height_mm;
  const float angle = glm::radians(camera.angle_degrees);

  // Seen from the side it is the head's own axis that stays in the middle.
  View view;
  const glm::vec3 outward(std::sin(angle), 0.0F, std::cos(angle));
  view.eye = glm::vec3(0.0F, middle, 0.0F) + outward * (kFaceDepth + distance);
  view.world_to_clip =
      glm::perspective(2 * half_angle, aspect, distance * 0.2F, distance * 5.0F + 500.0F) *
      glm::lookAt(view.eye, {0.0F, middle, 0.0F}, {0.0F, 1.0F, 0.0F});

  glm::mat4 figure(1.0F);
  figure = glm::translate(
      figure, kPivot + glm::vec3(state.agent_translation[0], state.agent_translation[1], 0.0F));
  figure = glm::rotate(figure, glm::radians(-state.agent_rotation[2]), {0.0F, 0.0F, 1.0F});
  figure = glm::rotate(figure, glm::radians(state.agent_rotation[1]), {0.0F, 1.0F, 0.0F});
  figure = glm::rotate(figure, glm::radians(state.agent_rotation[0]), {1.0F, 0.0F, 0.0F});
  figure = glm::scale(figure, glm::vec3(std::clamp(state.agent_scale, 0.01F, 100.0F)));
  view.figure_to_world = glm::translate(figure, -kPivot);
  view.samples_per_mm =
      2 * static_cast<float>(height) / framed_height * std::clamp(state.agent_scale, 0.01F, 100.0F);
  return view;
}

}  // namespace fsm
