#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "fsm/render/scene.h"
#include "fsm/rig/face_state.h"

namespace fsm {

/// The poses of viewer and figure. Millimetres.
struct FrameCamera {
  glm::mat4 figure_to_world;  ///< from the head's frame; rotation, translation, uniform scale
  glm::mat4 world_to_clip;
  glm::vec3 eye;             ///< the viewer's position in the world's frame
  float samples_per_mm = 1;  ///< of the framebuffer along one side, at the face's depth
};

/// Frames head and shoulders as a portrait does: at the height of the mouth; in narrow pictures the
/// inner half of the shoulders' width stays in view. The distance of `camera` is clamped to
/// 0.2..10, its field to 5..90 degrees. `placed` rotates by x, then y, then z about the root of the
/// neck; its scale is clamped to 0.01..100. If the head has a view of its own, `parallel`, that
/// one's longer side fills that of the picture, and the figure rotates and scales about its centre,
/// by z, then y, then x; both are as in the original. The camera's distance, height and angle act
/// on it as on a portrait, its field does not.
FrameCamera ViewOfPortrait(const Figure& placed, const Camera& camera, int width, int height,
                           const std::optional<ParallelView>& parallel = {});

}  // namespace fsm
