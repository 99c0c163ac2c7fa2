#pragma once

#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <variant>

#include "fsm/image/image.h"
#include "fsm/rig/head_asset.h"

namespace fsm {

enum class ViewMode { kTexture, kTextureWithWireframe, kWireframe };

/// A directional lamp. Members that are not set are those of tables/appearance.txt.
struct DirectionalLight {
  /// Direction towards the lamp: x to the viewer's right, y up, z to the viewer.
  std::optional<glm::vec3> direction = {};
  std::optional<glm::vec3> tint = {};  ///< linear RGB; white is as bright as the table's lamp
  float strength = 1;
};

/// The position of the viewer.
struct Camera {
  float distance = 1;   ///< 1: head and shoulders fill the view
  float height_mm = 0;  ///< of viewer and aim, above the middle of the portrait
  /// Vertical field of view; the head's size stays. 14 degrees show a portrait from 1.34 m: seen
  /// from within personal space, faces are trusted less (Bryan, Perona, Adolphs, PLoS ONE 7(9),
  /// 2012: e45301).
  float field_degrees = 14;
  float angle_degrees = 0;  ///< around the head, positive = to the viewer's right
  /// If true, Figure::translation counts halves of the view's longer side instead of millimetres.
  bool moves_by_half_views = false;
};

/// What is behind the figure.
struct Transparent {};
struct StudioWall {};                       ///< brighter behind the head
using Background = std::variant<glm::vec3,  ///< a colour, sRGB 0..1
                                Transparent, StudioWall,
                                /// Stretched over the view. Not null; a changed picture must be
                                /// another object.
                                std::shared_ptr<const Image>>;
inline constexpr glm::vec3 kPlainBackground{0.35f, 0.42f, 0.48f};

/// Everything in a picture except the head.
struct Scene {
  Background background = kPlainBackground;
  ViewMode view_mode = ViewMode::kTexture;
  Camera camera;
  glm::vec3 wire{0.10f, 0.55f, 0.42f};  ///< sRGB, line colour of ViewMode::kWireframe
  bool wire_on_black = false;           ///< black background for ViewMode::kWireframe
  DirectionalLight key, fill, rim;
};

}  // namespace fsm
