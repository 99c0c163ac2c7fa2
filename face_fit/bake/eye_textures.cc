#include "face_fit/bake/eye_textures.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "face_fit/bake/head_atlas.h"
#include "face_fit/bake/red_eye.h"
#include "face_fit/bake/skin_colours.h"
#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"
#include "face_fit/image/plane.h"
#include "face_fit/image/raster.h"
#include "face_fit/image/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

constexpr float kMinIrisPx = 3;  // radius below which an iris is not worth showing
/// IrisPixel::visible from which a pixel's colour counts as the iris's own.
constexpr float kVisiblePixel = 0.9F;
/// The least width of the shade at a lid's edge, pixels.
constexpr float kMinShadePx = 0.7F;

constexpr int kIrisPixels = 64, kBallPixels = 128;  // to a side of the squares
constexpr std::size_t kRings = 24;

/// A pixel of the texture of an iris.
struct IrisPixel {
  glm::vec3 colour{0};
  float visible = 0;  ///< share that no lid hides, 0..1
  float radius = 0;   ///< distance from the centre, in radii of the iris
};

/// Returns the median colour at each distance from the iris's centre over the visible pixels.
std::array<glm::vec3, kRings> MedianByRing(const std::vector<IrisPixel>& pixels) {
  std::array<std::vector<glm::vec3>, kRings> rings;
  for (const IrisPixel& p : pixels) {
    const auto ring = static_cast<std::size_t>(p.radius / fsm::kIrisSpan * kRings);
    if (p.visible > kVisiblePixel) rings[std::min(ring, kRings - 1)].push_back(p.colour);
  }
  const auto light = [](glm::vec3 c) { return c.r + c.g + c.b; };
  std::array<glm::vec3, kRings> median;
  // If the whole iris is hidden, use the pixel that is hidden least.
  median.fill(std::ranges::max_element(pixels, {}, &IrisPixel::visible)->colour);
  std::optional<glm::vec3> last;
  for (std::size_t k = 0; k < kRings; ++k) {
    if (!rings[k].empty()) {
      const auto middle = rings[k].begin() + static_cast<std::ptrdiff_t>(rings[k].size() / 2);
      std::ranges::nth_element(rings[k], middle, {}, light);
      if (!last) std::fill_n(median.begin(), k, *middle);
      last = *middle;
    }
    // Hidden rings take the colour of the next ring inward, the innermost of the next outward.
    if (last) median[k] = *last;
  }
  return median;
}

/// Returns a square of `value(position)` for each pixel; (-1, 1) is the upper left corner.
template <typename T>
Raster<T> MakeSquare(int size, auto value) {
  return Raster<T>::From(size, size, [&](int x, int y) {
    const glm::vec2 p = 2.0F * (glm::vec2(x, y) + 0.5F) / static_cast<float>(size) - 1.0F;
    return value(glm::vec2(p.x, -p.y));
  });
}

/// An eye as a photo shows it.
struct PhotoEye {
  const IrisCircle& iris;
  LidLines lids;
  glm::vec2 right, up;  ///< the head's axes in the photo, unit
};

/// Returns the texture of an iris. `skin_colour`: of the skin below the eye.
fsm::Image IrisTexture(const PhotoEye& eye, glm::vec3 skin_colour, const fsm::Image& photo) {
  // Width of the lid's shade and lashes.
  const float edge =
      std::max(PhotoLook().eye_texture.lid_shade_radii * eye.iris.radius_px, kMinShadePx);
  const RedEye flash(skin_colour);
  const auto pixels = MakeSquare<IrisPixel>(kIrisPixels, [&](glm::vec2 p) {
    p *= fsm::kIrisSpan;
    const glm::vec2 pixel =
        eye.iris.centre_px + eye.iris.radius_px * (p.x * eye.right + p.y * eye.up);
    const auto [upper, lower] = eye.lids.LidsAt(eye.lids.Along(pixel));
    const float within = std::min(eye.lids.Down(pixel) - upper, lower - eye.lids.Down(pixel));
    float red = 0;
    for (const glm::ivec2 offset : kAround) {
      const glm::vec2 beside =
          pixel + PhotoLook().flash.search_radii * eye.iris.radius_px * glm::vec2(offset);
      red = std::max(red, flash.Likelihood(ColourAt(photo, beside)));
    }
    return IrisPixel{flash.Without(ColourAt(photo, pixel), red),
                     fsm::SmoothStep(0.5F * edge, edge, within), glm::length(p)};
  });
  const auto median = MedianByRing(pixels.values);
  fsm::Image out = fsm::FilledImage(kIrisPixels, kIrisPixels);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const IrisPixel& p = pixels[i];
    const float ring = std::clamp(p.radius / fsm::kIrisSpan * kRings - 0.5F, 0.0F, kRings - 1.001F);
    const auto k = static_cast<std::size_t>(ring);
    const glm::vec3 usual = glm::mix(median[k], median[k + 1], ring - static_cast<float>(k));
    SetRgb(out, i, glm::mix(usual, p.colour, p.visible));
  }
  return out;
}

/// A texel of the eyeball beside the iris: where the photo shows it, and its position between the
/// upper lid (0) and the lower one (1).
struct BallTexel {
  glm::vec2 photo_px;
  float between_lids;
};

/// Returns the texture of the eyeball beside the iris. `rest`: the lids of the eye at rest;
/// `radius`: of the ball; both in millimetres about its centre.
fsm::Image BallTexture(const PhotoEye& eye, const LidLines& rest, float radius,
                       const fsm::Image& photo) {
  const auto texels = MakeSquare<BallTexel>(kBallPixels, [&](glm::vec2 p) {
    p *= fsm::kBallSpan * radius;
    const float along = glm::clamp(rest.Along(p), 0.0F, 1.0F);
    const auto [upper, lower] = rest.LidsAt(along);
    const float between = (rest.Down(p) - upper) / std::max(lower - upper, 0.05F);
    const auto [upper_shown, lower_shown] = eye.lids.LidsAt(along);
    const float shown = glm::mix(upper_shown, lower_shown, glm::clamp(between, 0.0F, 1.0F));
    return BallTexel{eye.lids.PointAt(along, shown), between};
  });
  const auto& look = PhotoLook().eye_texture;
  const auto beside_iris = [&](glm::vec2 pixel) {
    return look.beside_iris_radii.Ramp(glm::distance(pixel, eye.iris.centre_px) /
                                       eye.iris.radius_px);
  };
  // Fill the area behind the iris from what is beside it, except the lids' shade and lashes.
  fsm::Image out = fsm::FilledImage(kBallPixels, kBallPixels);
  Mask weight(kBallPixels, kBallPixels);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const auto [pixel, between] = texels[i];
    SetRgb(out, i, ColourAt(photo, pixel));
    weight[i] = beside_iris(pixel) * look.upper_lid_share.Ramp(between) *
                look.lower_lid_share.Ramp(between);
  }
  PushPullInpaint(out, weight);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const glm::vec2 pixel = texels[i].photo_px;
    SetRgb(out, i, glm::mix(Rgb(out, i), ColourAt(photo, pixel), beside_iris(pixel)));
  }
  return out;
}

struct EyeSquares {
  fsm::Image iris, ball;
};

/// Returns whose texture each eye shows: its own, or the other eye's if it is not seen clearly;
/// nothing if neither is.
std::optional<fsm::Sided<fsm::Side>> ShownEyes(const PhotoIrises& irises) {
  // The clear eye is mirrored only if it is wide open.
  constexpr float kForBoth = 0.1F;
  const auto shown = [&irises](fsm::Side side) {
    return irises.eyes[side].seen && irises.eyes[side].circle.radius_px >= kMinIrisPx;
  };
  if (shown(fsm::Side::kRight) && shown(fsm::Side::kLeft)) {
    return {{fsm::Side::kRight, fsm::Side::kLeft}};
  }
  for (const fsm::Side side : fsm::kSides) {
    if (shown(side) && irises.eyes[side].circle.contrast >= kForBoth) return {{side, side}};
  }
  return std::nullopt;
}

/// Returns the mean colour of the skin below and beside an eye.
glm::vec3 SkinColourBelowEye(const FoundFace& face, const fsm::Image& photo, fsm::Side side) {
  glm::vec3 light(1);
  const auto& below = point::kBelowEye[side];
  for (const PointIndex i : below)
    light += ColourAt(photo, face.PixelOf(i)) / static_cast<float>(below.size());
  return light;
}

/// Returns the mirror image of a square, multiplied by a gain.
fsm::Image Mirrored(const fsm::Image& square, glm::vec3 gain) {
  fsm::Image out = OrientedByExif(square, 2);
  for (std::size_t i = 0; i < out.rgba.size() / 4; ++i) SetRgb(out, i, Rgb(out, i) * gain);
  return out;
}

/// Returns the lids of an eye of the head at rest, millimetres from the centre of its ball.
LidLines LidsAtRest(const ObservedHead& base, fsm::Side side, const fsm::EyeTransform& transform) {
  const glm::vec3 centre = base.head().EyeCentre(side);
  EyePoints rest =
      EyePointsOf(side, [&](PointIndex i) { return glm::vec2(base.AtRest(i) - centre); });
  const float inner = rest[kInnerCorner].x, outer = rest[kOuterCorner].x;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    const float raised = i % kInnerCorner == 0 ? 0
                         : i < kInnerCorner    ? transform.upper_mm
                                               : transform.lower_mm;
    const float y = rest[i].y + LidShare(rest[i].x, inner, outer) * raised;
    rest[i] = glm::vec2(transform.Rotated(glm::vec3(rest[i].x, y, 0)));
  }
  return LidLines(rest);
}

}  // namespace

std::optional<fsm::Sided<fsm::EyePicture>> PaintEyes(const FoundFace& face, const FaceFit& fit,
                                                     const fsm::Sided<fsm::EyeTransform>& at_rest,
                                                     const fsm::Image& photo, fsm::Image& atlas) {
  const ObservedHead& base = *fit.head.base;
  const auto shown = ShownEyes(fit.irises);
  if (!shown) return std::nullopt;
  const glm::mat3 turned = fit.head.pose.Rotation();
  const glm::vec2 right = glm::normalize(glm::vec2(turned[0].x, -turned[0].y));
  fsm::Sided<EyeSquares> squares;
  for (const fsm::Side side : fsm::kSides) {
    if ((*shown)[side] != side) continue;
    const LidLines lids(EyePointsOf(side, face));
    const PhotoEye eye{fit.irises.eyes[side].circle, lids, right, {right.y, -right.x}};
    const float radius = at_rest[side].size * base.surface().eyes[side].ball_radius;
    squares[side] = {IrisTexture(eye, SkinColourBelowEye(face, photo, side), photo),
                     BallTexture(eye, LidsAtRest(base, side, at_rest[side]), radius, photo)};
  }
  SquareRow row(atlas);
  fsm::Sided<fsm::EyePicture> textures;
  for (const fsm::Side side : fsm::kSides) {
    if (const fsm::Side other = (*shown)[side]; other != side) {
      const glm::vec3 gain =
          LightGain(SkinColourBelowEye(face, photo, side), SkinColourBelowEye(face, photo, other));
      squares[side] = {Mirrored(squares[other].iris, gain), Mirrored(squares[other].ball, gain)};
    }
    textures[side].iris = row.Add(squares[side].iris);
    textures[side].ball = row.Add(squares[side].ball);
  }
  return textures;
}

}  // namespace facefit
