#include "face_fit/bake/smile_folds.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/picture/plane.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

float DistanceToLine(glm::vec2 p, std::span<const glm::vec2> line) {
  float nearest = 1e9F;
  for (std::size_t k = 1; k < line.size(); ++k) {
    nearest = std::min(nearest, DistanceToSegment(p, line[k - 1], line[k]));
  }
  return nearest;
}

/// Fills dark valleys near a line that are narrower than twice `valley_px`, by the share `smile`.
/// Raises `filled_share` to the share by which each pixel was filled, 0..1.
void FillFold(std::span<const glm::vec2> line, float smile, float pixels_per_mm, int valley_px,
              fsm::Image& photo, Mask& filled_share) {
  const float reach_mm = PhotoLook().smile.folds.reach_mm;
  Box2 box;
  for (const glm::vec2 p : line) box.Add(p);
  const float margin = reach_mm * pixels_per_mm + 2 * static_cast<float>(valley_px);
  const glm::ivec2 first = glm::max(glm::ivec2(box.low - margin), 0);
  const glm::ivec2 last = glm::min(glm::ivec2(box.high + margin) + 1, {photo.width, photo.height});
  if (last.x <= first.x || last.y <= first.y) return;
  const glm::ivec2 size = last - first;
  // Each channel separately: folds are redder than the skin beside them.
  const auto colours = VectorImage::From(size.x, size.y, [&](int x, int y) {
    return Rgb(photo, photo.Index(first.x + x, first.y + y));
  });
  const VectorImage filled = Blurred(Closed(colours, valley_px), std::max(valley_px / 2, 1));
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const glm::ivec2 pixel = first + glm::ivec2(x, y);
      const float gap_mm = DistanceToLine(glm::vec2(pixel) + 0.5F, line) / pixels_per_mm;
      const float blend = smile * fsm::SmoothStep(reach_mm, 0.5F * reach_mm, gap_mm);
      const glm::vec3 lit = glm::max(filled(x, y), colours(x, y));
      if (lit != colours(x, y))
        filled_share(pixel.x, pixel.y) = std::max(filled_share(pixel.x, pixel.y), blend);
      SetRgb(photo, photo.Index(pixel.x, pixel.y), glm::mix(colours(x, y), lit, blend));
    }
  }
}

}  // namespace

Mask FillSmileFolds(const FoundFace& face, float smile, float pixels_per_mm, fsm::Image& photo) {
  FloatImage filled_share(photo.width, photo.height);
  const int valley_px =
      static_cast<int>(std::lround(PhotoLook().smile.folds.half_width_mm * pixels_per_mm));
  if (smile <= 0 || valley_px < 1) return filled_share;
  for (const fsm::Side side : fsm::kSides) {
    FillFold(face.Line(point::kSmileFold[side]), smile, pixels_per_mm, valley_px, photo,
             filled_share);
  }
  return filled_share;
}

}  // namespace facefit
