#include "face_fit/bake/head_atlas.h"

#include <algorithm>
#include <glm/common.hpp>

#include "face_fit/image/pixels.h"
#include "face_fit/image/resample.h"

namespace facefit {

fsm::Image PackAtlas(const fsm::Image& map, const fsm::Image& figure, const Mask& opacity,
                     float pixels_per_mm) {
  // Steepens the opacity of small photos, whose edges, a pixel wide, would look blurred on screens
  // with two or more pixels to a millimetre.
  constexpr float kScreenPixelsPerMm = 2, kSteepest = 3;
  const float steep = glm::clamp(kScreenPixelsPerMm / pixels_per_mm, 1.0F, kSteepest);
  const glm::vec2 scale = glm::vec2(figure.width, figure.height) / static_cast<float>(kMapSize);
  fsm::Image out = fsm::FilledImage(2 * kMapSize, kMapSize);
  ForEachPixel(kMapSize, kMapSize, [&](int x, int y, std::size_t i) {
    const glm::vec2 p = (glm::vec2(x, y) + 0.5F) * scale;
    const std::size_t left = out.Index(x, y);
    std::copy_n(&map.rgba[4 * i], 4, &out.rgba[4 * left]);
    SetRgb(out, left + kMapSize, SharpColourAt(figure, p));
    out.rgba[4 * (left + kMapSize) + 3] =
        Byte(255 * (0.5F + steep * (SmoothAt(opacity, p) - 0.5F)));
  });
  return out;
}

glm::vec2 OnFigureHalf(glm::vec2 p) {
  const glm::vec2 inside = glm::clamp(p, 0.5F / kMapSize, 1 - 0.5F / kMapSize);
  return {0.5F + 0.5F * inside.x, inside.y};
}

glm::vec4 SquareRow::Add(const fsm::Image& square) {
  const int size = square.width, top = atlas_.height - kMargin - size;
  for (int y = 0; y < size; ++y) {
    std::copy_n(&square.rgba[4 * square.Index(0, y)], 4 * size,
                &atlas_.rgba[4 * atlas_.Index(left_, top + y)]);
  }
  const glm::vec2 whole(atlas_.width, atlas_.height);
  const glm::vec4 rectangle(glm::vec2(left_, top) / whole,
                            glm::vec2(left_ + size, top + size) / whole);
  left_ += size + kMargin;
  return rectangle;
}

}  // namespace facefit
