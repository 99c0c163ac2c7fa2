#include "face_fit/complete/complete_figure.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "face_fit/complete/body_paint.h"
#include "face_fit/complete/canvas.h"
#include "face_fit/complete/hair_paint.h"
#include "face_fit/complete/light_on_face.h"
#include "face_fit/complete/photo_edges.h"
#include "face_fit/picture/filters.h"
#include "face_fit/picture/grain.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/surface/rasterizer.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// The row of the top of the head with hair on it.
float CrownRow(const FittedHead& fitted) {
  float highest = 1e9F;
  ForSkinTriangles(fitted.base->head->topology(), [&](const std::uint32_t* t) {
    highest = std::min(highest, fitted.pose.Pixel(fitted.posed_vertices[*t]).y);
  });
  return highest - PhotoLook()("hair_on_crown") * fitted.pose.PixelsPerMm();
}

/// Room for the photo, for head and shoulders below its chin, and for hair above it.
Canvas CanvasFor(const Cutout& figure, const FittedHead& fitted, glm::vec2 chin, float crown) {
  const float per_mm = fitted.pose.PixelsPerMm();
  const glm::vec2 size(figure.opacity.width, figure.opacity.height);
  const glm::vec2 reach = PhotoLook().Pair("canvas_from_chin") * per_mm;
  const float wide = size.x + 2 * PhotoLook()("hair_beside") * per_mm;
  const glm::vec2 dome = wide * PhotoLook().Pair("hair_dome");
  const float above = std::clamp(-crown, dome.x, dome.y) + PhotoLook()("canvas_above") * per_mm;
  const glm::vec2 low = glm::floor(glm::min(chin - glm::vec2(reach.x, 0), glm::vec2(0, -above)));
  const glm::vec2 high = glm::ceil(glm::max(chin + reach, size));
  return {.photo = glm::ivec2(-low),
          .photo_size = glm::ivec2(size),
          .size = glm::ivec2(high - low),
          .per_mm = per_mm,
          .chin = chin};
}

/// Takes away the tips of a collar, which would float beside the neck that is drawn: where the
/// background begins a little above the edge, or it would leave a hole.
Cutout WithoutTips(const PhotoEdges& edges, float per_mm, Cutout figure) {
  const int height = figure.opacity.height;
  const int highest = std::max(height - static_cast<int>(PhotoLook()("edge_hangs") * per_mm), 0);
  constexpr float kBackground = 0.3F;  // the matte is in doubt beside such tips
  for (int x = 0; x < figure.opacity.width; ++x) {
    if (edges.bottom(x).kind != EdgeKind::kTip) continue;
    int gap = height - 1;
    while (gap >= highest && figure.opacity(x, gap) > kBackground) {
      --gap;
    }
    if (gap < highest) continue;
    for (int y = gap; y < height; ++y) figure.opacity(x, y) = 0;
  }
  return figure;
}

}  // namespace

CompletedFigure CompleteFigure(const FittedHead& fitted, const Cutout& seen) {
  const glm::vec3 chin = fitted.At(point::kChin);
  const float crown = CrownRow(fitted);
  const Canvas canvas = CanvasFor(seen, fitted, fitted.pose.Pixel(chin), crown);
  const fsm::FaceLight light = LightOnFace(fitted, seen);
  const PhotoEdges edges(fitted, seen, 255.0F * light.skin());
  const Cutout figure = WithoutTips(edges, canvas.per_mm, seen);
  FittedHead on_canvas = fitted;
  on_canvas.pose.centre += glm::vec2(canvas.photo);
  const BodyPaint body(canvas, edges, figure.opacity, light,
                       DrawBust(on_canvas, canvas.size.x, canvas.size.y));
  const HairPaint hair(canvas, edges, figure, crown);
  const auto [width, height] = std::pair(canvas.size.x, canvas.size.y);
  CompletedFigure out{
      {fsm::FilledImage(width, height), FloatImage(width, height)}, glm::vec2(canvas.photo), {}};
  FloatImage& opacity = out.figure.opacity;
  const int seam = std::max(static_cast<int>(PhotoLook()("edge_band") * canvas.per_mm), 1);
  const int above_seam = canvas.photo_size.y - 1 - 2 * seam;
  // Opacities that the photo tells and that are drawn; 1 where a colour is known.
  FloatImage known(width, height), drawn = known, coloured = known;
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const std::size_t i = opacity.Index(x, y);
      const glm::ivec2 at = glm::ivec2(x, y) - canvas.photo;
      const glm::vec2 place = glm::vec2(at) + 0.5F;
      if (at == glm::clamp(at, glm::ivec2(0), canvas.photo_size - 1)) {
        const std::size_t from = seen.opacity.Index(at.x, at.y);
        SetRgb(out.figure.colours, i, Rgb(figure.colours, from));
        opacity.at[i] = known.at[i] = figure.opacity.at[from];
        coloured.at[i] = figure.opacity.at[from] == seen.opacity.at[from] ? 1 : 0;
        // The matte is in doubt at the very edge: where the body goes on below, the figure does.
        if (at.y >= canvas.photo_size.y - seam && above_seam >= 0) {
          opacity.at[i] = std::max(
              opacity.at[i], std::min(figure.opacity(at.x, above_seam), body.At(place).opacity));
        }
        continue;
      }
      const Paint under = body.At(place), over = hair.At(place);
      SetRgb(out.figure.colours, i, glm::mix(under.colour, over.colour, over.opacity));
      opacity.at[i] = drawn.at[i] = over.opacity + (1 - over.opacity) * under.opacity;
      coloured.at[i] = opacity.at[i] > 0 ? 1 : 0;
    }
  }
  // Colours go on beyond the outline, where they are mixed into it.
  PushPullInpaint(out.figure.colours, coloured);
  const int grain = std::max(static_cast<int>(PhotoLook()("hole_grain") * canvas.per_mm), 2);
  AddGrain(known, drawn, grain, out.figure.colours);
  const float neck = canvas.chin.y + PhotoLook()("completed_neck") * canvas.per_mm;
  out.completed = {.neck = static_cast<float>(canvas.photo_size.y) < neck,
                   .shoulders = body.CutsShoulder(),
                   .hair = hair.Cut()};
  return out;
}

}  // namespace facefit
