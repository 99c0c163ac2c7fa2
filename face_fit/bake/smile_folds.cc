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

/// Fills what is dark within `reach` (millimetres) of a line and narrower than twice `valley`
/// (pixels) as much as `smile` says; `smooth` becomes how much of each pixel was filled, 0..1.
void FillFold(std::span<const glm::vec2> line, float smile, float pixels_per_mm, int valley,
              fsm::Image& photo, FloatImage& smooth) {
  const float reach = PhotoLook()("fold_reach");
  Box2 box;
  for (const glm::vec2 at : line) box.Add(at);
  const float margin = reach * pixels_per_mm + 2 * static_cast<float>(valley);
  const glm::ivec2 first = glm::max(glm::ivec2(box.low - margin), 0);
  const glm::ivec2 last = glm::min(glm::ivec2(box.high + margin) + 1, {photo.width, photo.height});
  if (last.x <= first.x || last.y <= first.y) return;
  const glm::ivec2 size = last - first;
  // Each colour for itself: folds are redder than the skin beside them.
  const auto colours = VectorImage::From(size.x, size.y, [&](int x, int y) {
    return Rgb(photo, photo.Index(first.x + x, first.y + y));
  });
  const VectorImage filled = Blurred(Closed(colours, valley), std::max(valley / 2, 1));
  for (int y = 0; y < size.y; ++y) {
    for (int x = 0; x < size.x; ++x) {
      const glm::ivec2 at = first + glm::ivec2(x, y);
      const float off = DistanceToLine(glm::vec2(at) + 0.5F, line) / pixels_per_mm;
      const float part = smile * glm::smoothstep(reach, 0.5F * reach, off);
      const glm::vec3 lit = glm::max(filled(x, y), colours(x, y));
      if (lit != colours(x, y)) smooth(at.x, at.y) = std::max(smooth(at.x, at.y), part);
      SetRgb(photo, photo.Index(at.x, at.y), glm::mix(colours(x, y), lit, part));
    }
  }
}

}  // namespace

FloatImage FillSmileFolds(const FoundFace& face, float smile, float pixels_per_mm,
                          fsm::Image& photo) {
  FloatImage smooth(photo.width, photo.height);
  const int valley = static_cast<int>(std::lround(PhotoLook()("fold_half_width") * pixels_per_mm));
  if (smile <= 0 || valley < 1) return smooth;
  for (const fsm::Side side : fsm::kSides) {
    FillFold(face.Line(point::kSmileFold[side]), smile, pixels_per_mm, valley, photo, smooth);
  }
  return smooth;
}

}  // namespace facefit
