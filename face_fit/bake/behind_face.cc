#include "face_fit/bake/behind_face.h"

#include <glm/common.hpp>

#include "face_fit/bake/chin.h"
#include "face_fit/bake/skin_surface.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/grain.h"
#include "face_fit/image/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Returns an image with unknown pixels inpainted and grain added.
fsm::Image FilledIn(fsm::Image image, const Mask& known, float pixels_per_mm) {
  PushPullInpaint(image, known);
  AddGrainToFigure(known, Mask(image.width, image.height, 1), pixels_per_mm, image);
  return image;
}

}  // namespace

fsm::Image BehindFace(const FittedHead& fitted, const CameraPose& pose,
                      const FigureCutout& figure) {
  const int width = figure.colours.width, height = figure.colours.height;
  const Chin chin(fitted);
  Mask face =
      VisibleSkin(fitted, pose, {glm::vec2(0.5F), 1, width, height}, chin.SkinBottom()).Covered();
  FillHoles(face);
  // The hole is slightly smaller than the skin, whose edge looks like the sheet's there. Forehead
  // and temples are mostly hair already, so the hole begins at the brows. Before the neck it is as
  // large as the skin, or the chin would show twice.
  const float pixels_per_mm = pose.PixelsPerMm();
  const auto& look = PhotoLook().behind_face;
  const Mask soft = Blurred(face, MmToPixels(look.around_mm, pixels_per_mm));
  Mask keep(width, height, 1), beside(width, height, 1), below(width, height);
  ForEachPixel(width, height, [&](int x, int y, std::size_t i) {
    const glm::vec2 pixel = glm::vec2(x, y) + 0.5F;
    const glm::vec3 position = pose.PositionOf(pixel, kBesideFaceDepthMm);
    const float hole = glm::mix(look.face_share, look.neck_share, chin.BeforeNeckShare(position));
    keep[i] = (hole + look.edge_share).Ramp(soft[i]);
    beside[i] = (look.neck_share + look.neck_edge_share).Ramp(soft[i]);
    below[i] = chin.BelowShare(position);
  });
  fsm::Image out = FilledIn(figure.colours, keep, pixels_per_mm);
  // Behind the jaw, fill from the neck below and not from the jaw.
  const fsm::Image neck = FilledIn(figure.colours, beside, pixels_per_mm);
  for (std::size_t i = 0; i < keep.size(); ++i) {
    const float blend = below[i] * (1 - keep[i]);
    if (blend > 0) SetRgb(out, i, glm::mix(Rgb(out, i), Rgb(neck, i), blend));
  }
  return out;
}

}  // namespace facefit
