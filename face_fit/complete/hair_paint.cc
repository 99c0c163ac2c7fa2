#include "face_fit/complete/hair_paint.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>

#include "face_fit/image/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Returns a number of about 0..1 that varies from strand to strand without a visible period. `at`:
/// millimetres along an edge.
float StrandNoise(float at) {
  return 0.5F + 0.17F * (std::sin(at * 1.31F) + std::sin(at * 0.43F + 1.3F) +
                         std::sin(at * 0.171F + 0.4F));
}

/// Returns the position in a pattern of `length` that is repeated mirrored (GL_MIRRORED_REPEAT).
float MirroredRepeat(float way, float length) {
  if (length <= 0) return 0;
  const float rest = std::fmod(way, 2 * length);
  return std::min(rest, 2 * length - rest);
}

/// Half a circle over -1..1: 1 in the middle, 0 at the ends and beyond.
float Arc(float radii) { return std::sqrt(std::max(1 - radii * radii, 0.0F)); }

}  // namespace

float DomeHeightPx(const PhotoEdges& edges, float width_px, float crown_px) {
  const auto& look = PhotoLook().hair;
  // A figure that touches the upper edge from corner to corner is cut where the head is widest.
  const float least = edges.TopCutsWholeEdge() ? look.dome_of_whole_edge : look.dome_least_by_width;
  return std::clamp(-crown_px, width_px * least, width_px * look.dome_most_by_width);
}

HairPaint::HairPaint(const Canvas& canvas, const PhotoEdges& edges, const fsm::Image& colours,
                     float crown_px)
    : canvas_(canvas),
      edges_(edges),
      colours_(colours),
      top_(LongestRun(edges.width(),
                      [&](int x) { return edges.top(x).kind != EdgeKind::kNothing; })),
      sides_{.right = SpanOf(PhotoEdge::kRight), .left = SpanOf(PhotoEdge::kLeft)} {
  const auto& look = PhotoLook().hair;
  const float most = look.bulge_most_mm * canvas.pixels_per_mm;
  for (const PhotoEdge side : kPhotoEdges) {
    bulge_px_[side] = std::min(look.bulge_by_length * sides_[side].Length(), most);
    // Where the upper edge cuts hair up to a corner, the dome extends over the bulge beside it.
    if (bulge_px_[side] <= 0 || sides_[side].from > 1 || top_.Length() <= 0) continue;
    if (side == PhotoEdge::kLeft && top_.from < 1) top_.from -= bulge_px_[side];
    if (side == PhotoEdge::kRight && top_.to > static_cast<float>(canvas.photo_size.x) - 1) {
      top_.to += bulge_px_[side];
    }
  }
  if (top_.Length() > 0) dome_px_ = DomeHeightPx(edges, top_.Length(), crown_px);
  cut_ = dome_px_ > 0 || bulge_px_.left + bulge_px_.right > 0;
  for (int x = 0; x < edges.width(); ++x) {
    const EdgeSample& sample = edges.bottom(x);
    below_.Add(sample.colour, sample.kind == EdgeKind::kHair ? 1 : 0);
  }
  // A mean, because single dark columns below the chin are wrinkles.
  const auto& beard = PhotoLook().beard;
  bearded_ = below_.MeanAround(canvas.chin_px.x, beard.half_width_mm * canvas.pixels_per_mm).w >
             beard.hair_share;
}

HairPaint::EdgeSpan HairPaint::LongestRun(int count, auto cuts_head) {
  EdgeSpan longest, span;
  for (int i = 0; i < count; ++i) {
    float& end = cuts_head(i) ? span.to : span.from;
    end = static_cast<float>(i) + 1;
    if (span.Length() > longest.Length()) longest = span;
  }
  return longest;
}

HairPaint::EdgeSpan HairPaint::SpanOf(PhotoEdge side) const {
  // Above the chin everything cut at a side is hair or a hat, whatever its colour; below the chin
  // only what has the hair's colour.
  const EdgeSpan longest = LongestRun(edges_.height(), [&](int y) {
    const EdgeKind kind = edges_.side(side, y).kind;
    const bool above_chin = static_cast<float>(y) < canvas_.chin_px.y;
    return kind == EdgeKind::kHair || (above_chin && kind != EdgeKind::kNothing);
  });
  return longest.from < canvas_.chin_px.y ? longest : EdgeSpan{};
}

float HairPaint::DomePx(float x) const {
  if (dome_px_ <= 0) return 0;
  return dome_px_ * Arc((x - 0.5F * (top_.from + top_.to)) / (0.5F * top_.Length()));
}

float HairPaint::BulgePx(PhotoEdge side, float y) const {
  const EdgeSpan& span = sides_[side];
  const float bulge_px = bulge_px_[side];
  if (bulge_px <= 0) return 0;
  // Hair cut at a corner of the photo does not end there.
  const float from = span.from < 1 ? -dome_px_ : span.from;
  const bool goes_on = span.to > static_cast<float>(canvas_.photo_size.y) - 1;
  const float to = goes_on ? span.to + PhotoLook().hair.falls_mm * canvas_.pixels_per_mm : span.to;
  return bulge_px * Arc((2 * y - from - to) / (to - from));
}

glm::vec3 HairPaint::Colour(glm::vec2 pixel) const {
  const glm::vec2 size(canvas_.photo_size);
  const DistanceOutside outside = canvas_.OutsidePhoto(pixel);
  glm::vec2 mirrored = glm::clamp(pixel, glm::vec2(0.5F), size - 0.5F);
  const bool above = outside.above > 0;
  const int reach_px = above
                           ? edges_.top(static_cast<int>(mirrored.x)).hair_reach_px
                           : edges_.side(*outside.side, static_cast<int>(mirrored.y)).hair_reach_px;
  // Mirrored back and forth within the hair, so that no skin is repeated.
  const float inward_px =
      MirroredRepeat(above ? outside.above : outside.beside, static_cast<float>(reach_px));
  if (above) {
    mirrored.y = std::clamp(inward_px, 0.5F, size.y - 0.5F);
  } else {
    mirrored.x = std::clamp(*outside.side == PhotoEdge::kLeft ? inward_px : size.x - inward_px,
                            0.5F, size.x - 0.5F);
  }
  const float enough = fsm::SmoothStep(0.0F, PhotoLook().hair.enough_mm * canvas_.pixels_per_mm,
                                       static_cast<float>(reach_px));
  return glm::mix(edges_.hair(), ColourAt(colours_, mirrored), enough);
}

Paint HairPaint::HairBelow(glm::vec2 pixel, float below_px) const {
  const glm::vec2 size(canvas_.photo_size);
  const float below_mm = below_px / canvas_.pixels_per_mm;
  const float x = pixel.x < 0 ? -pixel.x : pixel.x > size.x ? 2 * size.x - pixel.x : pixel.x;
  const auto& look = PhotoLook().hair;
  const auto& beard = PhotoLook().beard;
  const glm::vec4 hair = below_.MeanAround(
      x, (look.spread_mm + look.spread_per_mm * below_mm) * canvas_.pixels_per_mm);
  // Below a bearded chin hangs the beard, which is short.
  const float beside_mm = std::abs(x - canvas_.chin_px.x) / canvas_.pixels_per_mm;
  const float falls_mm =
      bearded_ ? glm::mix(beard.falls_mm, look.falls_mm, beard.ends_beside_chin_mm.Ramp(beside_mm))
               : look.falls_mm * look.falls_beside_chin_mm.Ramp(beside_mm);
  const float end_mm = falls_mm * (0.5F + 0.5F * StrandNoise(pixel.x / canvas_.pixels_per_mm));
  if (below_mm >= end_mm) return {glm::vec3(hair), 0};
  return {glm::vec3(hair),
          hair.w * fsm::SmoothStep(end_mm, look.strand_whole_share * end_mm, below_mm)};
}

Paint HairPaint::PaintAt(glm::vec2 pixel) const {
  const DistanceOutside outside = canvas_.OutsidePhoto(pixel);
  assert(outside.Any());
  if (outside.below > 0) {
    Paint hair = HairBelow(pixel, outside.below);
    if (outside.side) {
      const float reach = BulgePx(*outside.side, pixel.y);
      if (reach <= 0) return {};
      hair.opacity *=
          fsm::SmoothStep(reach, PhotoLook().hair.whole_bulge_share * reach, outside.beside);
    }
    return hair;
  }
  const float inside_px = outside.above > 0 ? DomePx(pixel.x) - outside.above
                                            : BulgePx(*outside.side, pixel.y) - outside.beside;
  const float soft_px = PhotoLook().hair.outline_mm * canvas_.pixels_per_mm *
                        (0.5F + StrandNoise((pixel.x + pixel.y) / canvas_.pixels_per_mm));
  if (inside_px <= 0) return {};
  return {Colour(pixel), std::min(inside_px / soft_px, 1.0F)};
}

}  // namespace facefit
