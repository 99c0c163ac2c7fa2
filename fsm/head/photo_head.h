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

/// The face of a person from a photo: what a folder made by face_fit holds (docs/photo.md).
struct PhotoHead {
  std::string base = "galatea";             ///< the built-in face that is warped
  std::vector<WarpPoint> points;            ///< of the base face at rest, millimetres
  float smooth = 0;                         ///< see Warp
  std::optional<Sided<EyeTransform>> eyes;  ///< right, left; else both go with the warp alike
  glm::vec3 iris_colour{0.1f}, white_colour{0.6f};  ///< linear RGB
  float iris_size = 1, teeth = 1;       ///< of the table's iris; brightness of the teeth
  bool glasses = false;                 ///< the photo shows some: the skin behind them stays
  std::optional<glm::vec3> lip_colour;  ///< linear RGB, where the lips turn inward
  std::optional<Sided<EyePicture>> eye_pictures;  ///< in the photo
  float saturation = 1;  ///< of what is painted beside the photo: 0 for a grey one
  float lined = 1;  ///< how deep the skin creases with expression, 0..1: less where it is smooth
  /// The skin's map in the photo: HeadTopology::uv (0, 0) and (1, 1), as u right, v down in 0..1.
  glm::vec2 skin_low{0, 1}, skin_high{0.5f, 0};
  glm::vec3 seen_from{0, 0, 1};      ///< unit, from the head to the camera
  std::vector<glm::vec3> also_seen;  ///< likewise, of photos from the side
  float skin_bottom_y = -110;        ///< below it the figure shows neck and clothes

  /// Hair, neck and clothes: a sheet with gentle depth.
  struct SheetVertex {
    glm::vec3 position;
    glm::vec2 texcoord;  ///< in the photo, 0..1, v down
  };
  std::vector<SheetVertex> sheet;
  std::vector<std::uint32_t> sheet_triangles;

  std::shared_ptr<const Image> photo;          ///< read by the caller: photo.png
  std::shared_ptr<const Features> features{};  ///< in place of the built-in ones

  /// `features`, or else the built-in ones.
  const Features& UsedFeatures() const { return features ? *features : Features::BuiltIn(); }
};

/// Reads face.txt; `name` is for messages. Throws std::runtime_error naming file and line.
PhotoHead ReadPhotoHead(const std::string& name, std::string_view text);
std::string WritePhotoHead(const PhotoHead& head);

}  // namespace fsm
