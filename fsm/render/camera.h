#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec3.hpp>

#include "fsm/render/scene.h"
#include "fsm/rig/face_state.h"

namespace fsm {

/// Where the viewer stands and where the figure stands before him. Millimetres.
struct View {
  glm::mat4 figure_to_world;  ///< from the head's frame; rotation, translation and uniform scale
  glm::mat4 world_to_clip;
  glm::vec3 eye;             ///< the viewer, in world coordinates
  float samples_per_mm = 1;  ///< of the target along one side, at the depth of the face
};

/// Frames head and shoulders as a portrait would: by default a 25 degree lens at the height of the
/// mouth, the whole width of the shoulders' inner half kept in view in narrow pictures. Of
/// `camera`, distance counts from 0.2 to 10 and the field from 5 to 90 degrees. `placed` turns
/// by x, then y, then z about the neck's root; its scale is clamped to 0.01..100.
/// Where the camera has a ParallelView, its longer side fills that of the picture, and the figure
/// turns and grows about its centre, by z, then y, then x: both as in the original. The camera's
/// distance, height and angle act upon it as upon a portrait.
View ViewOfPortrait(const Figure& placed, const Camera& camera, int width, int height);

}  // namespace fsm
