#pragma once

#include <algorithm>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <optional>

#include "face_fit/image/photo_edge.h"

namespace facefit {

/// A colour, 0..255, and how much it covers, 0..1.
struct Paint {
  glm::vec3 colour{0};
  float opacity = 0;
};

/// How far a pixel of the canvas lies beyond the edges of the photo, pixels; 0 where it is not
/// beyond that edge. A pixel beyond a corner has two of them above 0.
struct DistanceOutside {
  float below, above, beside;
  std::optional<PhotoEdge> side;  ///< the edge that `beside` counts from, if it is above 0
  bool Any() const { return below > 0 || above > 0 || side; }
};

/// A photo on a larger canvas. Where nothing else is said, pixels are the photo's, y down, also
/// beyond the photo: its first pixel has its centre at (0.5, 0.5).
/// What each region of the canvas is filled with (drawn for a photo that cuts hair on the left and
/// a shoulder on the right):
///
/// +------------------- canvas -------------------+
/// |               ,-~~~~~~~-.                    |  above: hair, rounded off (HairPaint, dome)
/// |      +-------'-----------`--------+          |  <- upper edge, cuts hair
/// |    ,-|    hair ,-------. hair     |          |  beside: hair bulges (HairPaint)
/// |   (  |   hair |  skin   | hair    |          |
/// |    `-|   hair  \       /  hair    |          |
/// |      |   hair   `-chin'           |          |
/// |      |   hair   | neck | ,--------+-.        |  <- attachment: here the right edge cuts
/// |      |   hair ,-'\skin/`-' cloth  |  `.      |  beside: the shoulder falls, bends into
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
  glm::vec2 chin_px;

  DistanceOutside OutsidePhoto(glm::vec2 p) const {
    const glm::vec2 end(photo_size);
    DistanceOutside outside{std::max(p.y - end.y, 0.0F), std::max(-p.y, 0.0F),
                            std::max({-p.x, p.x - end.x, 0.0F}), std::nullopt};
    if (outside.beside > 0) outside.side = p.x < 0 ? PhotoEdge::kLeft : PhotoEdge::kRight;
    return outside;
  }
};

}  // namespace facefit
