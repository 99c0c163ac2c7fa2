#include "face_fit/complete/body_paint.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <glm/common.hpp>

#include "face_fit/image/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Returns the mean colour of the cloth along the edges; where too little is seen, the table's.
glm::vec3 ClothColour(const Canvas& canvas, const PhotoEdges& edges, const fsm::FaceLight& light,
                      const PerPhotoEdge<BustAttachment>& attachments) {
  glm::vec4 sum(0);
  const auto add = [&sum](const EdgeSample& sample) {
    const bool cloth = sample.kind == EdgeKind::kCloth || sample.kind == EdgeKind::kTip;
    if (cloth) sum += glm::vec4(sample.colour, 1);
  };
  for (int x = 0; x < edges.width(); ++x) add(edges.bottom(x));
  for (const PhotoEdge side : kPhotoEdges) {
    if (!attachments[side].shoulder_slope) continue;
    for (int y = static_cast<int>(attachments[side].row); y < edges.height(); ++y) {
      add(edges.side(side, y));
    }
  }
  const auto& look = PhotoLook().cloth;
  if (sum.w >= look.seen_mm * canvas.pixels_per_mm) return glm::vec3(sum) / sum.w;
  // Drawn cloth is lit as the skin is: it takes the tint of that light, and is grey in a grey
  // photo.
  const glm::vec3 skin = 255.0F * light.skin(), usual = look.usual_skin_colour;
  const float brightest = std::max({skin.r, skin.g, skin.b, 1.0F});
  const float colour = fsm::SmoothStep(0.0F, look.grey_photo_share,
                                       1 - std::min({skin.r, skin.g, skin.b}) / brightest);
  return glm::clamp(
      glm::mix(glm::vec3(Brightness(look.colour) * Brightness(skin) / Brightness(usual)),
               look.colour * skin / usual, colour),
      0.0F, 255.0F);
}

}  // namespace

BodyPaint::BodyPaint(const Canvas& canvas, const PhotoEdges& edges, const fsm::FaceLight& light,
                     const BodyShape& shape)
    : canvas_(canvas),
      light_(light),
      shape_(shape),
      cloth_colour_(ClothColour(canvas, edges, light, shape.attachments())),
      neckline_(FindNeckline(edges, shape.axis())) {
  const glm::vec2 size(canvas.photo_size);
  for (int x = 0; x < edges.width(); ++x) {
    AddDifference(edges.bottom(x), {static_cast<float>(x) + 0.5F, size.y}, below_);
  }
  for (const PhotoEdge side : kPhotoEdges) {
    const BustAttachment& attachment = shape.attachments()[side];
    for (int y = 0; y < edges.height(); ++y) {
      const glm::vec2 pixel(side == PhotoEdge::kLeft ? 0 : size.x, static_cast<float>(y) + 0.5F);
      const bool body = attachment.shoulder_slope && pixel.y > attachment.row;
      const EdgeSample& sample = edges.side(side, y);
      AddDifference(body ? sample : EdgeSample{}, pixel, beside_[side]);
    }
  }
}

BodyPaint::Neckline BodyPaint::FindNeckline(const PhotoEdges& edges, float axis) {
  const auto skin = [&](int x) {
    return x >= 0 && x < edges.width() && edges.bottom(x).kind == EdgeKind::kSkin;
  };
  int from = std::clamp(static_cast<int>(axis), 0, edges.width() - 1), to = from + 1;
  while (skin(from - 1)) --from;
  while (skin(to)) ++to;
  return {0.5F * static_cast<float>(to + from), 0.5F * static_cast<float>(to - from)};
}

glm::vec3 BodyPaint::BustColour(const BustSample& body, Covering covering) const {
  const float shade = light_.On(body.normal) / light_.On({0, 0, 1});
  return shade * glm::mix(1.0F, body.ambient_occlusion, PhotoLook().bust.shade_share) *
         (covering == kCloth ? cloth_colour_ : 255.0F * light_.skin());
}

void BodyPaint::AddDifference(const EdgeSample& edge, glm::vec2 pixel, Differences& to) const {
  const BustSample body = shape_.SampleAt(pixel);
  for (const Covering covering : {kSkin, kCloth}) {
    const bool known = edge.kind == (covering == kCloth ? EdgeKind::kCloth : EdgeKind::kSkin);
    to[covering].Add(edge.colour - BustColour(body, covering), known ? 1 : 0);
  }
}

float BodyPaint::ClothShare(glm::vec2 pixel, const DistanceOutside& outside, float on_bust) const {
  const float reach_px = PhotoLook().beyond_edge.told_within_mm * canvas_.pixels_per_mm;
  const bool below = outside.below > 0;
  assert(below || outside.side);
  const Differences& differences = below ? below_ : beside_[*outside.side];
  const float along_px = below ? pixel.x : pixel.y;
  const float skin = differences[kSkin].MeanAround(along_px, reach_px).w,
              cloth = differences[kCloth].MeanAround(along_px, reach_px).w;
  if (skin + cloth <= 0) return on_bust;
  const float at_edge = cloth / (skin + cloth);
  if (!below) return at_edge;
  // An open neckline that the lower edge cuts closes below it along half an ellipse.
  const float half_widths = (pixel.x - neckline_.middle) / neckline_.half_width;
  const auto& look = PhotoLook().neckline;
  const float hem_mm = look.closes_mm * std::sqrt(std::max(1 - half_widths * half_widths, 0.0F));
  return std::max(at_edge, on_bust * fsm::SmoothStep(hem_mm - look.hem_mm, hem_mm + look.hem_mm,
                                                     outside.below / canvas_.pixels_per_mm));
}

glm::vec3 BodyPaint::EdgeDifference(glm::vec2 pixel, const DistanceOutside& outside,
                                    Covering covering) const {
  const auto& look = PhotoLook().beyond_edge;
  const bool cloth = covering == kCloth;
  const float spread_mm = cloth ? look.cloth.spread_mm : look.skin.spread_mm;
  const float spread_per_mm = cloth ? look.cloth.spread_per_mm : look.skin.spread_per_mm;
  const float decay_mm = cloth ? look.cloth.decay_mm : look.skin.decay_mm;
  const auto difference = [&](const EdgeMeans& edge, float along_px, float away_px) {
    const float away_mm = away_px / canvas_.pixels_per_mm;
    const glm::vec4 mean =
        edge.MeanAround(along_px, (spread_mm + spread_per_mm * away_mm) * canvas_.pixels_per_mm);
    return std::exp(-away_mm / decay_mm) *
           glm::mix(edge.All(), glm::vec3(mean), mean.w / (mean.w + look.half_trusted_share));
  };
  glm::vec3 sum(0);
  const float beyond_px = outside.below + outside.beside;
  if (outside.below > 0) {
    sum += outside.below / beyond_px * difference(below_[covering], pixel.x, outside.below);
  }
  if (outside.side) {
    // The colours of a sleeve continue downward along its fall, not along rows.
    const float row = std::clamp(pixel.y - PhotoLook().shoulder.sleeve_fall_per_px * outside.beside,
                                 shape_.attachments()[*outside.side].row,
                                 static_cast<float>(canvas_.photo_size.y));
    sum += outside.beside / beyond_px *
           difference(beside_[*outside.side][covering], row, outside.beside);
  }
  return sum;
}

Paint BodyPaint::PaintAt(glm::vec2 pixel) const {
  const DistanceOutside outside = canvas_.OutsidePhoto(pixel);
  assert(outside.Any());
  const BustSample body = shape_.SampleAt(pixel);
  const float opacity = shape_.OpacityAt(pixel, body);
  if (opacity <= 0) return {};
  return {glm::mix(BustColour(body, kSkin) + EdgeDifference(pixel, outside, kSkin),
                   BustColour(body, kCloth) + EdgeDifference(pixel, outside, kCloth),
                   ClothShare(pixel, outside, body.cloth)),
          opacity};
}

}  // namespace facefit
