#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>

#include "fsm/image/image.h"
#include "fsm/rig/head_asset.h"

namespace fsm {

enum class ViewMode { kTexture, kTextureWithWireframe, kWireframe };

/// A lamp far away. What is not said is as tables/appearance.txt has it.
struct DirectionalLight {
  /// Towards the lamp: x to the viewer's right, y up, z to the viewer.
  std::optional<glm::vec3> direction = {};
  std::optional<glm::vec3> tint = {};  ///< linear RGB; white is as bright as the lamp of the table
  float strength = 1;
};

/// Where the viewer stands.
struct Camera {
  float distance = 1;        ///< as part of that from which head and shoulders fill the view
  float height_mm = 0;       ///< above the middle of the portrait, of viewer and aim
  float field_degrees = 25;  ///< seen from below to above; the head stays as large
  float angle_degrees = 0;   ///< round the head, positive = to the viewer's right
  std::optional<ParallelView> parallel =
      {};  ///< instead of the portrait; the field means nothing then
  /// Figure::translation counts half the longer side of the view, not millimetres.
  bool moves_by_half_views = false;
};

/// Everything in a picture but the head.
struct Scene {
  glm::vec3 background{0.35f, 0.42f, 0.48f};  ///< sRGB 0..1, when there is no picture
  bool studio = false;  ///< instead of that colour, a wall that is brighter behind the head
  /// Stretched over the view; another picture is another object.
  std::shared_ptr<const Image> background_image = {};
  bool show_background = true;  ///< off: transparent black
  ViewMode view_mode = ViewMode::kTexture;
  Camera camera;
  glm::vec3 wire{0.10f, 0.55f, 0.42f};  ///< sRGB, of the lines of ViewMode::kWireframe
  bool wire_on_black = false;           ///< which have no background then
  DirectionalLight key, fill, rim;
};

}  // namespace fsm
