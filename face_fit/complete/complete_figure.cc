#include "face_fit/complete/complete_figure.h"

#include <algorithm>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "face_fit/complete/body_paint.h"
#include "face_fit/complete/body_shape.h"
#include "face_fit/complete/canvas.h"
#include "face_fit/complete/hair_paint.h"
#include "face_fit/complete/light_on_face.h"
#include "face_fit/complete/photo_edges.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/grain.h"
#include "face_fit/image/pixels.h"
#include "face_fit/surface/triangles.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Returns the row of the top of the head with hair on it, photo pixels; it may be negative.
float CrownRow(const FittedHead& fitted) {
  float highest = std::numeric_limits<float>::infinity();
  ForEachSkinAndLipTriangle(fitted.base->surface(), [&](const MeshTriangle& triangle) {
    highest = std::min(highest, fitted.pose.PixelOf(fitted.vertices[triangle.corner[0]]).y);
  });
  return highest - PhotoLook().hair.on_crown_mm * fitted.pose.PixelsPerMm();
}

/// Returns a canvas with room for the photo, for head and shoulders below its chin, and for hair
/// above it.
Canvas CanvasFor(const FigureCutout& figure, const FittedHead& fitted, const PhotoEdges& edges,
                 glm::vec2 chin, float crown_px) {
  const float pixels_per_mm = fitted.pose.PixelsPerMm();
  const glm::vec2 size(figure.opacity.width, figure.opacity.height);
  const auto& look = PhotoLook().canvas;
  const glm::vec2 reach = pixels_per_mm * glm::vec2(look.beside_chin_mm, look.below_chin_mm);
  const float widest_px = size.x + 2 * PhotoLook().hair.bulge_most_mm * pixels_per_mm;
  const float above =
      DomeHeightPx(edges, widest_px, crown_px) + look.above_photo_mm * pixels_per_mm;
  const glm::vec2 low = glm::floor(glm::min(chin - glm::vec2(reach.x, 0), glm::vec2(0, -above)));
  const glm::vec2 high = glm::ceil(glm::max(chin + reach, size));
  return {.photo_origin = glm::ivec2(-low),
          .photo_size = glm::ivec2(size),
          .size = glm::ivec2(high - low),
          .pixels_per_mm = pixels_per_mm,
          .chin_px = chin};
}

/// Makes tips of a collar transparent, which would float beside the drawn neck. Tips with no
/// background within neck.hair_hang_mm above the edge stay: removing them would leave a hole.
FigureCutout WithoutTips(const PhotoEdges& edges, float pixels_per_mm, FigureCutout figure) {
  const int height = figure.opacity.height;
  const int highest =
      std::max(height - MmToPixels(PhotoLook().neck.hair_hang_mm, pixels_per_mm), 0);
  constexpr float kBackground = 0.3F;  // opacity; the matte is uncertain beside such tips
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

/// The figure on its canvas while parts are painted.
struct CanvasLayers {
  FigureCutout figure;
  Mask known, drawn;  ///< opacity from the photo; opacity of what is painted beyond it
  Mask coloured;      ///< 1 where a colour is known

  explicit CanvasLayers(glm::ivec2 size)
      : figure{fsm::FilledImage(size.x, size.y), Mask(size.x, size.y)},
        known(size.x, size.y),
        drawn(known),
        coloured(known) {}
};

/// Copies the photo's figure onto the canvas. `without_tips`: the figure without tips of collars,
/// whose colours count as unknown.
void CopyPhoto(const Canvas& canvas, const FigureCutout& figure, const FigureCutout& without_tips,
               CanvasLayers& out) {
  ForEachPixel(canvas.photo_size.x, canvas.photo_size.y, [&](int x, int y, std::size_t from) {
    const std::size_t to = out.known.Index(x + canvas.photo_origin.x, y + canvas.photo_origin.y);
    SetRgb(out.figure.colours, to, Rgb(without_tips.colours, from));
    out.figure.opacity[to] = out.known[to] = without_tips.opacity[from];
    out.coloured[to] = without_tips.opacity[from] == figure.opacity[from] ? 1 : 0;
  });
}

/// Raises the opacity of the lowest rows to that above them where the drawn body continues below:
/// the matte is uncertain at the very edge.
void CloseLowerEdge(const Canvas& canvas, const FigureCutout& figure, const BodyShape& body,
                    Mask& opacity) {
  const int band_px = MmToPixels(PhotoLook().edge.band_mm, canvas.pixels_per_mm);
  const int above = canvas.photo_size.y - 1 - 2 * band_px;
  if (above < 0) return;
  for (int y = canvas.photo_size.y - band_px; y < canvas.photo_size.y; ++y) {
    for (int x = 0; x < canvas.photo_size.x; ++x) {
      float& pixel = opacity(x + canvas.photo_origin.x, y + canvas.photo_origin.y);
      const glm::vec2 here = glm::vec2(x, y) + 0.5F;
      const float below = body.OpacityAt(here, body.SampleAt(here));
      pixel = std::max(pixel, std::min(figure.opacity(x, above), below));
    }
  }
}

void PaintBeyond(const Canvas& canvas, const BodyPaint& body, const HairPaint& hair,
                 CanvasLayers& out) {
  ForEachPixel(canvas.size.x, canvas.size.y, [&](int x, int y, std::size_t i) {
    const glm::ivec2 pixel = glm::ivec2(x, y) - canvas.photo_origin;
    if (pixel == glm::clamp(pixel, glm::ivec2(0), canvas.photo_size - 1)) return;
    const glm::vec2 centre = glm::vec2(pixel) + 0.5F;
    const Paint under = body.PaintAt(centre), over = hair.PaintAt(centre);
    SetRgb(out.figure.colours, i, glm::mix(under.colour, over.colour, over.opacity));
    out.drawn[i] = over.opacity + (1 - over.opacity) * under.opacity;
    out.figure.opacity[i] = out.drawn[i];
    out.coloured[i] = out.drawn[i] > 0 ? 1 : 0;
  });
}

}  // namespace

CompletedFigure CompleteFigure(const FittedHead& fitted, const FigureCutout& figure) {
  const float crown_px = CrownRow(fitted);
  const fsm::FaceLight light = LightOnFace(fitted, figure.colours);
  const PhotoEdges edges(fitted, figure, 255.0F * light.skin());
  const Canvas canvas = CanvasFor(figure, fitted, edges,
                                  fitted.pose.PixelOf(fitted.PositionOf(point::kChin)), crown_px);
  const FigureCutout without_tips = WithoutTips(edges, canvas.pixels_per_mm, figure);
  CameraPose pose = fitted.pose;
  pose.centre_px += glm::vec2(canvas.photo_origin);
  const BodyShape body(canvas, edges, without_tips.opacity,
                       DrawBust(fitted, pose, canvas.size.x, canvas.size.y));
  const HairPaint hair(canvas, edges, without_tips.colours, crown_px);
  CanvasLayers out(canvas.size);
  CopyPhoto(canvas, figure, without_tips, out);
  CloseLowerEdge(canvas, without_tips, body, out.figure.opacity);
  PaintBeyond(canvas, BodyPaint(canvas, edges, light, body), hair, out);
  // Fill the colours outside the figure from inside: interpolation mixes them into the outline.
  PushPullInpaint(out.figure.colours, out.coloured);
  AddGrainToFigure(out.known, out.drawn, canvas.pixels_per_mm, out.figure.colours);
  const float neck =
      canvas.chin_px.y + PhotoLook().bust.reported_below_chin_mm * canvas.pixels_per_mm;
  return {std::move(out.figure), pose,
          Completed{.neck = static_cast<float>(canvas.photo_size.y) < neck,
                    .shoulders = body.CutsShoulder(),
                    .hair = hair.CutsHair()}};
}

}  // namespace facefit
