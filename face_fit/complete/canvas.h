#pragma once

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace facefit {

/// A colour, 0..255, and how much it covers, 0..1.
struct Paint {
  glm::vec3 colour{0};
  float opacity = 0;
};

enum class PhotoEdge { kLeft, kRight };
inline constexpr std::array kPhotoEdges{PhotoEdge::kLeft, PhotoEdge::kRight};

/// A value for the left and for the right edge of a photo.
template <typename T>
struct PerEdge {
  T left{}, right{};
  T& operator[](PhotoEdge edge) { return edge == PhotoEdge::kLeft ? left : right; }
  const T& operator[](PhotoEdge edge) const { return edge == PhotoEdge::kLeft ? left : right; }
};

/// Where a place lies beside a photo: its distances from the photo, pixels, 0 where it is not
/// beyond that edge. A place at a corner has two of them above 0.
struct Beyond {
  float below, above, aside;
  PhotoEdge edge;  ///< the edge that `aside` counts from; kRight where `aside` is 0
};

/// A photo on a larger canvas. Places are in the photo's pixels, y down, also beyond the photo.
/// What each region of the canvas is filled with (drawn for a photo that cuts hair on the left and
/// a shoulder on the right):
///
/// +------------------- canvas -------------------+
/// |               ,-~~~~~~~-.                    |  above: hair, rounded off (HairPaint, dome)
/// |      +-------'-----------`--------+          |  <- upper edge, cuts hair
/// |    ,-|    hair ,-------. hair     |          |  aside: hair bulges (HairPaint)
/// |   (  |   hair |  skin   | hair    |          |
/// |    `-|   hair  \       /  hair    |          |
/// |      |   hair   `-chin'           |          |
/// |      |   hair   | neck | ,--------+-.        |  <- joint row: here the right edge cuts
/// |      |   hair ,-'\skin/`-' cloth  |  `.      |  aside: the shoulder falls and bends into
/// |      |   hair/cloth\ / cloth      |    `.    |         the arm (BodyPaint)
/// |      +-----------------------------+      \   |  <- lower edge
/// |       )hair | cloth  `hem'  cloth         |  |  below: strands of hair fall and end;
/// |        `-'  | cloth         cloth         |  |         the neckline closes, the body goes on
/// +----------------------------------------------+
struct Canvas {
  glm::ivec2 photo_origin;  ///< the pixel of the canvas that shows the photo's first
  glm::ivec2 photo_size;    ///< pixels, as `size`
  glm::ivec2 size;
  float pixels_per_mm;
  glm::vec2 chin;  ///< place

  Beyond BeyondPhoto(glm::vec2 p) const {
    const glm::vec2 end(photo_size);
    return {std::max(p.y - end.y, 0.0F), std::max(-p.y, 0.0F), std::max({-p.x, p.x - end.x, 0.0F}),
            p.x < 0 ? PhotoEdge::kLeft : PhotoEdge::kRight};
  }
};

}  // namespace facefit
