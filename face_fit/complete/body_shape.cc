#include "face_fit/complete/body_shape.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

bool IsBody(const EdgeSample& sample) {
  return sample.kind == EdgeKind::kSkin || sample.kind == EdgeKind::kCloth;
}

/// Returns the fall of the outline over the outermost sixteenth of the photo above a row.
float OutlineSlope(const Canvas& canvas, const Mask& opacity, PhotoEdge side, float row) {
  const int inward = std::max(canvas.photo_size.x / 16, 1);
  const int x = side == PhotoEdge::kLeft ? inward : canvas.photo_size.x - 1 - inward;
  int y = static_cast<int>(row);
  while (y > 0 && opacity(x, y - 1) > 0.5F) --y;
  return PhotoLook().shoulder.fall_per_px.Clamp((row - static_cast<float>(y)) /
                                                static_cast<float>(inward));
}

/// `axis`: as BodyShape's.
BustAttachment AttachmentOf(const Canvas& canvas, const PhotoEdges& edges, const Mask& opacity,
                            const Bust& bust, float axis, PhotoEdge side) {
  const float end = static_cast<float>(canvas.photo_size.y);
  BustAttachment attachment{.row = end, .shoulder_slope = {}};
  // Follow the photo's edge upward while it cuts the body.
  while (attachment.row > std::max(canvas.chin_px.y, 0.0F) + 1 &&
         IsBody(edges.side(side, static_cast<int>(attachment.row) - 1))) {
    --attachment.row;
  }
  float half_width =
      side == PhotoEdge::kLeft ? axis : static_cast<float>(canvas.photo_size.x) - axis;
  bool hidden = false;
  if (attachment.row < end) {
    attachment.shoulder_slope = OutlineSlope(canvas, opacity, side, attachment.row);
  } else {
    // Otherwise follow the lower edge outward while it cuts the body; hair may hide the rest of it.
    int x = std::clamp(static_cast<int>(axis), 0, edges.width() - 1);
    const auto on_edge = [&] { return x >= 0 && x < edges.width(); };
    while (on_edge() && IsBody(edges.bottom(x))) x += side == PhotoEdge::kLeft ? -1 : 1;
    hidden = on_edge() && edges.bottom(x).kind == EdgeKind::kHair;
    half_width = std::abs(static_cast<float>(x) + 0.5F - axis);
  }
  const float bust_half_width =
      bust.HalfWidth(side, attachment.row + static_cast<float>(canvas.photo_origin.y) - 0.5F);
  const auto& look = PhotoLook().bust;
  fsm::Range limit{look.least_width_ratio, look.most_width_ratio};
  if (hidden) limit.from = 1;
  // A photo that ends at the jaw is wider there than the neck below it, so the ratio is limited;
  // above the chin the bust has a jaw of its own.
  const float below_chin_mm = (attachment.row - canvas.chin_px.y) / canvas.pixels_per_mm;
  if (below_chin_mm < 0) limit.to = std::min(limit.to, look.most_width_ratio_at_jaw);
  attachment.fade_mm = look.width_decay_mm.At(look.photo_end_below_chin_mm.Ramp(below_chin_mm));
  attachment.width_ratio = limit.Clamp(half_width / bust_half_width);
  return attachment;
}

}  // namespace

BodyShape::BodyShape(const Canvas& canvas, const PhotoEdges& edges, const Mask& opacity, Bust bust)
    : canvas_(canvas),
      bust_(std::move(bust)),
      axis_(bust_.axis - static_cast<float>(canvas.photo_origin.x)) {
  for (const PhotoEdge side : kPhotoEdges) {
    attachments_[side] = AttachmentOf(canvas, edges, opacity, bust_, axis_, side);
  }
}

BustSample BodyShape::SampleAt(glm::vec2 pixel) const {
  const glm::vec2 on_canvas = pixel + glm::vec2(canvas_.photo_origin);
  const BustAttachment& attachment =
      on_canvas.x < bust_.axis ? attachments_.left : attachments_.right;
  const float below_mm = std::max(pixel.y - attachment.row, 0.0F) / canvas_.pixels_per_mm;
  const float width_ratio =
      attachment.shoulder_slope
          ? attachment.width_ratio
          : glm::mix(1.0F, attachment.width_ratio, std::exp(-below_mm / attachment.fade_mm));
  const float x = bust_.axis + (on_canvas.x - bust_.axis) / width_ratio;
  if (x < 0 || x > static_cast<float>(bust_.opacity.width)) return {};
  return {bust_.opacity.SampleAt(x, on_canvas.y), bust_.cloth.SampleAt(x, on_canvas.y),
          bust_.ambient_occlusion.SampleAt(x, on_canvas.y), bust_.normal.SampleAt(x, on_canvas.y)};
}

float BodyShape::OpacityAt(glm::vec2 pixel, const BustSample& sample) const {
  const DistanceOutside outside = canvas_.OutsidePhoto(pixel);
  if (!outside.side) {
    if (outside.above > 0) return 0;
    // Below the photo everything on the side of a cut shoulder is body.
    return (pixel.x < axis_ ? attachments_.left : attachments_.right).shoulder_slope
               ? 1
               : sample.opacity;
  }
  const BustAttachment& attachment = attachments_[*outside.side];
  if (!attachment.shoulder_slope) return outside.below > 0 ? sample.opacity : 0;
  // A cut shoulder continues at its fall and bends down into the arm along a parabola.
  const float outline = attachment.row + *attachment.shoulder_slope * outside.beside +
                        outside.beside * outside.beside /
                            (2 * PhotoLook().shoulder.radius_mm * canvas_.pixels_per_mm);
  return fsm::SmoothStep(-1.0F, 1.0F, pixel.y - outline);
}

}  // namespace facefit
