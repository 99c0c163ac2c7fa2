#pragma once

#include <glm/vec2.hpp>
#include <glm/vec4.hpp>

#include "face_fit/bake/skin_texels.h"
#include "face_fit/image/raster.h"
#include "fsm/image/image.h"

namespace facefit {

// The layout of PhotoHead::atlas, 2 kMapSize x kMapSize pixels. Positions in it are 0..1 from its
// upper left corner:
//
//   +-------------------+-------------------+
//   |  the skin's map   |  the figure: hair |   alpha of the map: 0 no skin, 255 skin;
//   |     .-------.     |  neck and clothes |   alpha of the figure: 0 background, 255 figure
//   |     | face  |     |                   |
//   |      `-----'      |                   |
//   | [iris][ball] ...  |                   |   squares of the eyes, where the map shows the neck
//   +-------------------+-------------------+   and is not used

/// Returns the atlas, without eyes. `opacity`: of the figure; `pixels_per_mm`: of it.
fsm::Image PackAtlas(const fsm::Image& map, const fsm::Image& figure, const Mask& opacity,
                     float pixels_per_mm);

/// The map's corners in the atlas, half a texel inward, so that the halves do not bleed into each
/// other: PhotoHead::skin_low and skin_high.
inline constexpr float kHalfTexel = 0.25F / kMapSize;
inline constexpr glm::vec2 kSkinLow{kHalfTexel, 1}, kSkinHigh{0.5F - kHalfTexel, 0};

/// Returns the position in the atlas of a point of the figure, 0..1 on both axes.
glm::vec2 OnFigureHalf(glm::vec2 p);

/// Copies squares into the atlas's lower left corner, each to the right of the last.
class SquareRow {
 public:
  explicit SquareRow(fsm::Image& atlas) : atlas_(atlas) {}
  /// Returns the rectangle of the square in the atlas: left, top, right, bottom.
  glm::vec4 Add(const fsm::Image& square);

 private:
  static constexpr int kMargin = 4;  // pixels between squares, against bleeding
  fsm::Image& atlas_;
  int left_ = kMargin;
};

}  // namespace facefit
