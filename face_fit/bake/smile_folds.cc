#include "face_fit/bake/smile_folds.h"

#include <algorithm>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <span>

#include "face_fit/bake/skin_texels.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"
#include "face_fit/image/plane.h"
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

/// Fills dark valleys near a line that are narrower than twice `valley_px`, by `share`.
/// Raises `filled_share` to the share by which each pixel was filled, 0..1.
void FillFold(std::span<const glm::vec2> line, float share, float pixels_per_mm, int valley_px,
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
  ForEachPixel(size.x, size.y, [&](int x, int y, std::size_t i) {
    const glm::ivec2 pixel = first + glm::ivec2(x, y);
    const float gap_mm = DistanceToLine(glm::vec2(pixel) + 0.5F, line) / pixels_per_mm;
    const float blend = share * fsm::SmoothStep(reach_mm, 0.5F * reach_mm, gap_mm);
    const glm::vec3 lit = glm::max(filled[i], colours[i]);
    if (lit != colours[i])
      filled_share(pixel.x, pixel.y) = std::max(filled_share(pixel.x, pixel.y), blend);
    SetRgb(photo, photo.Index(pixel.x, pixel.y), glm::mix(colours[i], lit, blend));
  });
}

}  // namespace

Mask FillSmileFolds(const FoundFace& face, float share, float pixels_per_mm, fsm::Image& photo) {
  Mask filled_share(photo.width, photo.height);
  const int valley_px = MmToPixels(PhotoLook().smile.folds.half_width_mm, pixels_per_mm, 0);
  if (share <= 0 || valley_px < 1) return filled_share;
  for (const fsm::Side side : fsm::kSides) {
    FillFold(face.Line(point::kSmileFold[side]), share, pixels_per_mm, valley_px, photo,
             filled_share);
  }
  return filled_share;
}

void GrainFromCheeks(const Mask& lost, fsm::Image& map) {
  if (std::ranges::none_of(lost.values, [](float s) { return s > 0; })) return;
  const auto& look = PhotoLook().smile.grain;
  const int outward = MmToTexels(look.outward_mm, kMapSize), up = MmToTexels(look.up_mm, kMapSize);
  const int reach = MmToTexels(look.coarsest_mm, kMapSize);
  const VectorImage colours = Colours(map), means = Blurred(Blurred(colours, reach), reach);
  for (int y = up; y < kMapSize; ++y) {
    for (int x = outward; x < kMapSize - outward; ++x) {
      const std::size_t i = lost.Index(x, y);
      if (lost[i] <= 0) continue;
      const std::size_t from = lost.Index(x < kMapSize / 2 ? x - outward : x + outward, y - up);
      const glm::vec3 grain = (colours[from] + 1.0F) / (means[from] + 1.0F) - 1.0F;
      SetRgb(map, i,
             colours[i] * (1.0F + lost[i] * glm::clamp(grain, -look.most_share, look.most_share)));
    }
  }
}

}  // namespace facefit
