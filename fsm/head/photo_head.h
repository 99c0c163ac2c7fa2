#pragma once

#include <cstdint>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fsm/head/features.h"
#include "fsm/head/warp.h"
#include "fsm/rig/eye_transform.h"
#include "fsm/rig/head.h"

namespace fsm {

/// The face of a person from a photo, as stored in a folder made by face_fit (docs/photo.md).
struct PhotoHead {
  std::string base = "galatea";                     ///< the built-in face that is warped
  std::vector<WarpPoint> points;                    ///< on the base face at rest, millimetres
  float smooth = 0;                                 ///< see Warp
  std::optional<Sided<EyeTransform>> eyes;          ///< none: both follow the warp alike
  glm::vec3 iris_colour{0.1f}, white_colour{0.6f};  ///< linear RGB
  float iris_size = 1, teeth = 1;       ///< factors on the table's iris, on the teeth's light
  bool glasses = false;                 ///< the photo shows glasses: the skin behind them stays
  std::optional<glm::vec3> lip_colour;  ///< linear RGB, where the lips roll inward
  std::optional<Sided<EyePicture>> eye_pictures;  ///< where the photo shows the eyes
  float saturation = 1;  ///< of parts painted beside the photo; 0 for a grey photo
  float lined = 1;       ///< depth of expression creases, 0..1; lower for smooth skin
  /// The skin's map in the atlas: u right, v down, 0..1, of HeadSurface::uv (0, 0) and (1, 1).
  glm::vec2 skin_low{0, 1}, skin_high{0.5f, 0};
  glm::vec3 seen_from{0, 0, 1};      ///< unit vector from the head to the camera
  std::vector<glm::vec3> also_seen;  ///< the same for photos from the side
  float skin_bottom_y = -110;        ///< below this y the sheet shows neck and clothes

  /// Hair, neck and clothes: a sheet of little depth.
  struct SheetVertex {
    glm::vec3 position;
    glm::vec2 texcoord;  ///< in the atlas, 0..1, v down
  };
  std::vector<SheetVertex> sheet;
  std::vector<std::uint32_t> sheet_triangles;

  std::shared_ptr<const Image> atlas;  ///< photo.png, read by the caller
  std::shared_ptr<const Features> features = Features::BuiltIn();  ///< never null
};

/// Reads face.txt; `name` is for error messages. Throws std::runtime_error naming file and line.
PhotoHead ReadPhotoHead(const std::string& name, std::string_view text);
std::string WritePhotoHead(const PhotoHead& photo_head);

}  // namespace fsm
