#include "face_fit/complete/body_paint.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <utility>

#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

bool IsBody(const EdgeSample& sample) {
  return sample.kind == EdgeKind::kSkin || sample.kind == EdgeKind::kCloth;
}

}  // namespace

BodyPaint::BodyPaint(const Canvas& canvas, const PhotoEdges& edges, const FloatImage& opacity,
                     const fsm::FaceLight& light, Bust bust)
    : canvas_(canvas),
      edges_(edges),
      opacity_(opacity),
      light_(light),
      bust_(std::move(bust)),
      joint_{JointOf(PhotoEdge::kLeft), JointOf(PhotoEdge::kRight)},
      cloth_colour_(ClothColour()),
      neckline_(FindNeckline()) {
  const glm::vec2 size(canvas.photo_size);
  for (int x = 0; x < edges.width(); ++x) {
    AddDifference(edges.bottom(x), {static_cast<float>(x) + 0.5F, size.y}, below_);
  }
  for (const PhotoEdge edge : kPhotoEdges) {
    for (int y = 0; y < edges.height(); ++y) {
      const glm::vec2 place(edge == PhotoEdge::kLeft ? 0 : size.x, static_cast<float>(y) + 0.5F);
      const bool body = joint_[edge].cut && place.y > joint_[edge].row;
      const EdgeSample& sample = edges.aside(edge, y);
      AddDifference(body ? sample : EdgeSample{}, place, aside_[edge]);
    }
  }
}

BodyPaint::Joint BodyPaint::JointOf(PhotoEdge edge) const {
  const float end = static_cast<float>(canvas_.photo_size.y);
  Joint joint{.row = end, .width_ratio = 1, .cut = false};
  // Follow the photo's edge upward while it cuts the body.
  while (joint.row > std::max(canvas_.chin.y, 0.0F) + 1 &&
         IsBody(edges_.aside(edge, static_cast<int>(joint.row) - 1))) {
    --joint.row;
  }
  joint.cut = joint.row < end;
  float half_width =
      edge == PhotoEdge::kLeft ? Axis() : static_cast<float>(canvas_.photo_size.x) - Axis();
  bool hidden = false;
  if (!joint.cut) {
    // Otherwise follow the lower edge outward while it cuts the body; hair may hide the rest of it.
    int x = std::clamp(static_cast<int>(Axis()), 0, edges_.width() - 1);
    const auto on_edge = [&] { return x >= 0 && x < edges_.width(); };
    while (on_edge() && IsBody(edges_.bottom(x))) x += edge == PhotoEdge::kLeft ? -1 : 1;
    hidden = on_edge() && edges_.bottom(x).kind == EdgeKind::kHair;
    half_width = std::abs(static_cast<float>(x) + 0.5F - Axis());
  }
  const float bust_half_width =
      bust_.HalfWidth(edge, joint.row + static_cast<float>(canvas_.photo_origin.y) - 0.5F);
  const auto& look = PhotoLook().bust;
  glm::vec2 limit = look.width_ratio;
  // A photo that ends at the jaw is wider there than the neck below it, so the ratio is limited;
  // above the chin the bust has a jaw of its own.
  const float below_chin = (joint.row - canvas_.chin.y) / canvas_.pixels_per_mm;
  if (below_chin < 0) limit.y = std::min(limit.y, look.width_ratio_at_jaw);
  joint.fade_mm = fsm::Lerp(look.fades_mm, fsm::SmoothStep(look.neck_mm, below_chin));
  joint.width_ratio = glm::clamp(half_width / bust_half_width, hidden ? 1.0F : limit.x, limit.y);
  if (joint.cut) joint.slope = OutlineSlope(edge, joint.row);
  return joint;
}

float BodyPaint::OutlineSlope(PhotoEdge edge, float row) const {
  // The fall of the outline over the outermost sixteenth of the photo.
  const int inward = std::max(canvas_.photo_size.x / 16, 1);
  const int x = edge == PhotoEdge::kLeft ? inward : canvas_.photo_size.x - 1 - inward;
  const glm::vec2 limit = PhotoLook().shoulder.fall_per_px;
  int y = static_cast<int>(row);
  while (y > 0 && opacity_(x, y - 1) > 0.5F) --y;
  return std::clamp((row - static_cast<float>(y)) / static_cast<float>(inward), limit.x, limit.y);
}

glm::vec3 BodyPaint::ClothColour() const {
  glm::vec4 sum(0);
  const auto add = [&sum](const EdgeSample& sample) {
    const bool cloth = sample.kind == EdgeKind::kCloth || sample.kind == EdgeKind::kTip;
    if (cloth) sum += glm::vec4(sample.colour, 1);
  };
  for (int x = 0; x < edges_.width(); ++x) add(edges_.bottom(x));
  for (const PhotoEdge edge : kPhotoEdges) {
    if (!joint_[edge].cut) continue;
    for (int y = static_cast<int>(joint_[edge].row); y < edges_.height(); ++y) {
      add(edges_.aside(edge, y));
    }
  }
  const auto& look = PhotoLook().cloth;
  if (sum.w >= look.seen_mm * canvas_.pixels_per_mm) return glm::vec3(sum) / sum.w;
  // Drawn cloth is lit as the skin is: it takes the tint of that light, and is grey in a grey
  // photo.
  const glm::vec3 skin = 255.0F * light_.skin(), usual = look.usual_skin_colour;
  const float brightest = std::max({skin.r, skin.g, skin.b, 1.0F});
  const float colour = glm::smoothstep(0.0F, look.grey_photo_part,
                                       1 - std::min({skin.r, skin.g, skin.b}) / brightest);
  return glm::clamp(
      glm::mix(glm::vec3(Brightness(look.colour) * Brightness(skin) / Brightness(usual)),
               look.colour * skin / usual, colour),
      0.0F, 255.0F);
}

glm::vec2 BodyPaint::FindNeckline() const {
  const auto skin = [&](int x) {
    return x >= 0 && x < edges_.width() && edges_.bottom(x).kind == EdgeKind::kSkin;
  };
  int from = std::clamp(static_cast<int>(Axis()), 0, edges_.width() - 1), to = from + 1;
  while (skin(from - 1)) --from;
  while (skin(to)) ++to;
  return 0.5F * glm::vec2(to + from, to - from);
}

BodyPaint::BustSample BodyPaint::SampleAt(glm::vec2 place) const {
  const glm::vec2 pixel = place + glm::vec2(canvas_.photo_origin);
  const Joint& joint = pixel.x < bust_.axis ? joint_.left : joint_.right;
  const float below_mm = std::max(place.y - joint.row, 0.0F) / canvas_.pixels_per_mm;
  const float width_ratio =
      joint.cut ? joint.width_ratio
                : glm::mix(1.0F, joint.width_ratio, std::exp(-below_mm / joint.fade_mm));
  const float x = bust_.axis + (pixel.x - bust_.axis) / width_ratio;
  if (x < 0 || x > static_cast<float>(bust_.opacity.width)) return {};
  return {bust_.opacity.SampleAt(x, pixel.y), bust_.cloth.SampleAt(x, pixel.y),
          bust_.openness.SampleAt(x, pixel.y), bust_.normal.SampleAt(x, pixel.y)};
}

glm::vec3 BodyPaint::BustColour(const BustSample& body, Covering covering) const {
  const float shade = light_.On(body.normal) / light_.On({0, 0, 1});
  return shade * glm::mix(1.0F, body.openness, PhotoLook().bust.shade_part) *
         (covering == kCloth ? cloth_colour_ : 255.0F * light_.skin());
}

void BodyPaint::AddDifference(const EdgeSample& edge, glm::vec2 place, Differences& to) const {
  const BustSample body = SampleAt(place);
  for (const Covering covering : {kSkin, kCloth}) {
    const bool known = edge.kind == (covering == kCloth ? EdgeKind::kCloth : EdgeKind::kSkin);
    to[covering].Add(edge.colour - BustColour(body, covering), known ? 1 : 0);
  }
}

float BodyPaint::ClothAt(glm::vec2 place, const Beyond& beyond, float on_bust) const {
  const float reach_px = PhotoLook().beyond_edge.told_within_mm * canvas_.pixels_per_mm;
  const bool below = beyond.below > 0;
  const Differences& differences = below ? below_ : aside_[beyond.edge];
  const float along_px = below ? place.x : place.y;
  const float skin = differences[kSkin].MeanAround(along_px, reach_px).w,
              cloth = differences[kCloth].MeanAround(along_px, reach_px).w;
  if (skin + cloth <= 0) return on_bust;
  const float at_edge = cloth / (skin + cloth);
  if (!below) return at_edge;
  // An open neckline that the lower edge cuts closes below it along half an ellipse.
  const float half_widths = (place.x - neckline_.x) / neckline_.y;
  const auto& look = PhotoLook().neckline;
  const float depth_mm = look.closes_mm * std::sqrt(std::max(1 - half_widths * half_widths, 0.0F));
  return std::max(at_edge, on_bust * glm::smoothstep(depth_mm - look.hem_mm, depth_mm + look.hem_mm,
                                                     beyond.below / canvas_.pixels_per_mm));
}

glm::vec3 BodyPaint::EdgeDifference(glm::vec2 place, const Beyond& beyond,
                                    Covering covering) const {
  const auto& look = PhotoLook().beyond_edge;
  const bool cloth = covering == kCloth;
  const float spread_mm = cloth ? look.cloth.spread_mm : look.skin.spread_mm;
  const float spread_per_mm = cloth ? look.cloth.spread_per_mm : look.skin.spread_per_mm;
  const float lasts_mm = cloth ? look.cloth.lasts_mm : look.skin.lasts_mm;
  const auto difference = [&](const EdgeMeans& edge, float along_px, float away_px) {
    const float away_mm = away_px / canvas_.pixels_per_mm;
    const glm::vec4 mean =
        edge.MeanAround(along_px, (spread_mm + spread_per_mm * away_mm) * canvas_.pixels_per_mm);
    return std::exp(-away_mm / lasts_mm) *
           glm::mix(edge.All(), glm::vec3(mean), mean.w / (mean.w + look.half_trusted_part));
  };
  glm::vec3 sum(0);
  const float beyond_px = beyond.below + beyond.aside;
  if (beyond.below > 0) {
    sum += beyond.below / beyond_px * difference(below_[covering], place.x, beyond.below);
  }
  if (beyond.aside > 0) {
    // The colours of a sleeve continue downward along its fall, not along rows.
    const float row = std::clamp(place.y - PhotoLook().shoulder.sleeve_fall_per_px * beyond.aside,
                                 joint_[beyond.edge].row, static_cast<float>(canvas_.photo_size.y));
    sum += beyond.aside / beyond_px * difference(aside_[beyond.edge][covering], row, beyond.aside);
  }
  return sum;
}

Paint BodyPaint::PaintAt(glm::vec2 place) const {
  const Beyond beyond = canvas_.BeyondPhoto(place);
  const BustSample body = SampleAt(place);
  float opacity = body.opacity;
  if (beyond.aside <= 0) {
    // Below the photo everything on the side of a cut shoulder is body.
    if (beyond.above > 0) return {};
    if ((place.x < Axis() ? joint_.left : joint_.right).cut) opacity = 1;
  } else {
    // A cut shoulder continues at its slope and bends down into the arm along a parabola.
    const Joint& joint = joint_[beyond.edge];
    if (joint.cut) {
      const float line = joint.row + joint.slope * beyond.aside +
                         beyond.aside * beyond.aside /
                             (2 * PhotoLook().shoulder.radius_mm * canvas_.pixels_per_mm);
      opacity = glm::smoothstep(-1.0F, 1.0F, place.y - line);
    } else if (beyond.below <= 0) {
      opacity = 0;
    }
  }
  if (opacity <= 0) return {};
  return {glm::mix(BustColour(body, kSkin) + EdgeDifference(place, beyond, kSkin),
                   BustColour(body, kCloth) + EdgeDifference(place, beyond, kCloth),
                   ClothAt(place, beyond, body.cloth)),
          opacity};
}

}  // namespace facefit
