#include "face_fit/bake/behind_face.h"

#include <algorithm>
#include <glm/common.hpp>

#include "face_fit/bake/chin.h"
#include "face_fit/bake/skin_surface.h"
#include "face_fit/picture/filters.h"
#include "face_fit/picture/grain.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Returns a picture with unknown pixels inpainted and grain added.
fsm::Image FilledIn(fsm::Image image, const FloatImage& known, float pixels_per_mm) {
  PushPullInpaint(image, known);
  const int grain =
      std::max(static_cast<int>(PhotoLook().grain.coarsest_on_figure_mm * pixels_per_mm), 2);
  // Pixels of a small photo are as coarse as grain, so none is added.
  const float amount = fsm::SmoothStep(PhotoLook().grain.pixels_per_mm, pixels_per_mm);
  AddGrain(known, FloatImage(image.width, image.height, amount), grain, image);
  return image;
}

}  // namespace

fsm::Image BehindFace(const FittedHead& fitted, const FigureCutout& figure) {
  const int width = figure.colours.width, height = figure.colours.height;
  const Chin chin(fitted);
  Mask face =
      VisibleSkin(fitted, fitted.pose, {glm::vec2(0.5F), 1, width, height}, chin.SkinBottom())
          .Covered();
  FillHoles(face);
  // The hole is slightly smaller than the skin, whose edge looks like the sheet's there. Forehead
  // and temples are mostly hair already, so the hole begins at the brows. Before the neck it is as
  // large as the skin, or the chin would show twice.
  const float pixels_per_mm = fitted.pose.PixelsPerMm();
  const auto& look = PhotoLook().behind_face;
  const Mask soft = Blurred(face, std::max(static_cast<int>(look.around_mm * pixels_per_mm), 1));
  FloatImage keep(width, height, 1), beside(width, height, 1), below(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const glm::vec2 pixel = glm::vec2(x, y) + 0.5F;
      const glm::vec3 position = fitted.pose.PositionAt(pixel, kBesideFaceDepthMm);
      const std::size_t i = keep.Index(x, y);
      const float hole = glm::mix(look.face_share, look.neck_share, chin.BeforeNeck(position));
      keep[i] = fsm::SmoothStep(hole + look.edge_share, soft[i]);
      beside[i] = fsm::SmoothStep(look.neck_share + look.neck_edge_share, soft[i]);
      below[i] = chin.Below(position);
    }
  }
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
