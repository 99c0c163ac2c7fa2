#include "face_fit/bake/complete_figure.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "face_fit/bake/body_paint.h"
#include "face_fit/bake/canvas.h"
#include "face_fit/bake/grain.h"
#include "face_fit/bake/hair_paint.h"
#include "face_fit/bake/photo_edges.h"
#include "face_fit/find/head/rasterizer.h"
#include "face_fit/picture/inpaint.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// The row of the top of the head with hair on it.
float CrownRow(const BaseHead& base, const FittedHead& fitted) {
  float highest = 1e9F;
  ForSkinTriangles(base.head->topology(), [&](const std::uint32_t* t) {
    const glm::vec3 at = fitted.pose.ToCamera(fitted.posed_vertices[*t]);
    highest = std::min(highest, fitted.pose.Project(at).y);
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
    if (edges.bottom()[static_cast<std::size_t>(x)].stuff != Stuff::kTip) continue;
    int gap = height - 1;
    while (gap >= highest && figure.opacity.at[figure.opacity.Index(x, gap)] > kBackground) {
      --gap;
    }
    if (gap < highest) continue;
    for (int y = gap; y < height; ++y) figure.opacity.at[figure.opacity.Index(x, y)] = 0;
  }
  return figure;
}

}  // namespace

CompletedFigure CompleteFigure(const BaseHead& base, const FittedHead& fitted, const Cutout& seen) {
  const glm::vec3 chin = base.points[point::kChin].On(fitted.posed_vertices);
  const float crown = CrownRow(base, fitted);
  const Canvas canvas =
      CanvasFor(seen, fitted, fitted.pose.Project(fitted.pose.ToCamera(chin)), crown);
  const fsm::FaceLight light = LightOnFace(base, fitted, seen);
  const PhotoEdges edges(base, fitted, seen, 255.0F * light.skin());
  const Cutout figure = WithoutTips(edges, canvas.per_mm, seen);
  FittedHead on_canvas = fitted;
  on_canvas.pose.centre += glm::vec2(canvas.photo);
  const BodyPaint body(canvas, edges, figure.opacity, light,
                       DrawBust(base, on_canvas, canvas.size.x, canvas.size.y));
  const HairPaint hair(canvas, edges, figure, crown);
  CompletedFigure out{
      {fsm::FilledImage(canvas.size.x, canvas.size.y), FloatImage(canvas.size.x, canvas.size.y)},
      glm::vec2(canvas.photo),
      {}};
  FloatImage& opacity = out.figure.opacity;
  const int seam = std::max(static_cast<int>(PhotoLook()("edge_band") * canvas.per_mm), 1);
  FloatImage known(canvas.size.x, canvas.size.y), drawn = known, coloured = known;
  for (int y = 0; y < canvas.size.y; ++y) {
    for (int x = 0; x < canvas.size.x; ++x) {
      const std::size_t i = opacity.Index(x, y);
      const glm::ivec2 at = glm::ivec2(x, y) - canvas.photo;
      if (at == glm::clamp(at, glm::ivec2(0), canvas.photo_size - 1)) {
        const std::size_t from = figure.opacity.Index(at.x, at.y);
        SetRgb(out.figure.colours, i, Rgb(figure.colours, from));
        opacity.at[i] = known.at[i] = figure.opacity.at[from];
        coloured.at[i] = figure.opacity.at[from] == seen.opacity.at[from] ? 1 : 0;
        // The matte is in doubt at the very edge: where the body goes on below, the figure does.
        if (at.y >= canvas.photo_size.y - seam && canvas.photo_size.y > 2 * seam) {
          const float above =
              figure.opacity.at[figure.opacity.Index(at.x, canvas.photo_size.y - 1 - 2 * seam)];
          const float cover = body.At(glm::vec2(at) + 0.5F).cover;
          opacity.at[i] = std::max(opacity.at[i], std::min(above, cover));
        }
        continue;
      }
      const glm::vec2 place = glm::vec2(at) + 0.5F;
      const Paint under = body.At(place), over = hair.At(place);
      SetRgb(out.figure.colours, i, glm::mix(under.colour, over.colour, over.cover));
      opacity.at[i] = over.cover + (1 - over.cover) * under.cover;
      drawn.at[i] = opacity.at[i];
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
