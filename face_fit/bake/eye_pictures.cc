#include "face_fit/bake/eye_pictures.h"

#include <algorithm>
#include <array>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <utility>
#include <vector>

#include "face_fit/bake/head_picture.h"
#include "face_fit/bake/light_gain.h"
#include "face_fit/bake/red_eye.h"
#include "face_fit/picture/filters.h"
#include "face_fit/picture/float_image.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/picture/resample.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

constexpr float kMinIrisPx = 3;  // radius below which an iris is not worth showing
/// Texel::visible from which a texel's colour counts as the iris's own.
constexpr float kVisibleTexel = 0.9F;
/// Reach around a texel, in radii of the iris, in which the red of a flash is searched, since it
/// runs over the edge of the pupil.
constexpr float kRedRuns = 0.22F;
/// The least width of the shade at a lid's edge, pixels.
constexpr float kMinShadePx = 0.7F;

constexpr int kIrisPixels = 64, kBallPixels = 128;  // to a side of the squares
constexpr int kRings = 24;

struct Texel {
  glm::vec3 colour{0};
  float visible = 0;  ///< share that no lid hides, 0..1
  float radius = 0;   ///< distance from the centre, in radii of the iris
};

/// Returns the median colour at each distance from the iris's centre over the visible texels.
std::array<glm::vec3, kRings> MedianByRing(const std::vector<Texel>& texels) {
  std::array<std::vector<glm::vec3>, kRings> rings;
  const auto ring_of = [](float radius) {
    return std::min(static_cast<int>(radius / fsm::kIrisSpan * kRings), kRings - 1);
  };
  for (const Texel& t : texels) {
    if (t.visible > kVisibleTexel)
      rings[static_cast<std::size_t>(ring_of(t.radius))].push_back(t.colour);
  }
  const auto light = [](glm::vec3 c) { return c.r + c.g + c.b; };
  std::array<glm::vec3, kRings> median;
  // If the whole iris is hidden, use the texel that is hidden least.
  median.fill(std::ranges::max_element(texels, {}, &Texel::visible)->colour);
  int last = -1;
  for (int k = 0; k < kRings; ++k) {
    auto& ring = rings[static_cast<std::size_t>(k)];
    if (ring.empty()) continue;
    const auto middle = ring.begin() + static_cast<std::ptrdiff_t>(ring.size() / 2);
    std::ranges::nth_element(ring, middle, {}, light);
    // Hidden rings take the colour of the next ring inward, the innermost of the next outward.
    for (int empty = last < 0 ? 0 : last + 1; empty < k; ++empty) {
      median[static_cast<std::size_t>(empty)] =
          last < 0 ? *middle : median[static_cast<std::size_t>(last)];
    }
    median[static_cast<std::size_t>(k)] = *middle;
    last = k;
  }
  for (int k = last + 1; k < kRings && last >= 0; ++k) {
    median[static_cast<std::size_t>(k)] = median[static_cast<std::size_t>(last)];
  }
  return median;
}

/// Returns a square of `value(position)` for each texel; (-1, 1) is the upper left corner.
auto MakeSquare(int size, auto value) {
  return Raster<decltype(value(glm::vec2()))>::From(size, size, [&](int x, int y) {
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

/// Returns the picture of an iris. `skin_colour`: of the skin below the eye.
fsm::Image IrisPicture(const PhotoEye& eye, glm::vec3 skin_colour, const fsm::Image& photo) {
  // Width of the lid's shade and lashes.
  const float edge =
      std::max(PhotoLook().eye_picture.lid_shade_radii * eye.iris.radius, kMinShadePx);
  const RedEye flash(skin_colour);
  const auto texels = MakeSquare(kIrisPixels, [&](glm::vec2 p) {
    p *= fsm::kIrisSpan;
    const glm::vec2 pixel = eye.iris.centre + eye.iris.radius * (p.x * eye.right + p.y * eye.up);
    const auto [upper, lower] = eye.lids.LidsAt(eye.lids.Along(pixel));
    const float within = std::min(eye.lids.Down(pixel) - upper, lower - eye.lids.Down(pixel));
    float red = 0;
    for (int k = 0; k < 9; ++k) {
      const glm::vec2 beside =
          pixel + kRedRuns * eye.iris.radius * (glm::vec2(k % 3, k / 3) - 1.0F);
      red = std::max(red, flash.Likelihood(ColourAt(photo, beside)));
    }
    return Texel{flash.Without(ColourAt(photo, pixel), red),
                 fsm::SmoothStep(0.5F * edge, edge, within), glm::length(p)};
  });
  const auto median = MedianByRing(texels.values);
  fsm::Image out = fsm::FilledImage(kIrisPixels, kIrisPixels);
  for (std::size_t i = 0; i < texels.size(); ++i) {
    const Texel& t = texels[i];
    const float ring = std::clamp(t.radius / fsm::kIrisSpan * kRings - 0.5F, 0.0F, kRings - 1.001F);
    const auto k = static_cast<std::size_t>(ring);
    const glm::vec3 usual = glm::mix(median[k], median[k + 1], ring - static_cast<float>(k));
    SetRgb(out, i, glm::mix(usual, t.colour, t.visible));
  }
  return out;
}

/// Returns the picture of the eyeball beside the iris. `rest`: the lids of the eye at rest;
/// `radius`: of the ball; both in millimetres about its centre.
fsm::Image BallPicture(const PhotoEye& eye, const LidLines& rest, float radius,
                       const fsm::Image& photo) {
  const auto pixels = MakeSquare(kBallPixels, [&](glm::vec2 p) {
    p *= fsm::kBallSpan * radius;
    const float along = glm::clamp(rest.Along(p), 0.0F, 1.0F);
    const auto [upper, lower] = rest.LidsAt(along);
    const float between = (rest.Down(p) - upper) / std::max(lower - upper, 0.05F);
    const auto [upper_shown, lower_shown] = eye.lids.LidsAt(along);
    return std::pair(eye.lids.PointAt(along, glm::mix(upper_shown, lower_shown,
                                                      glm::clamp(between, 0.0F, 1.0F))),
                     between);
  });
  const auto& look = PhotoLook().eye_picture;
  const auto beside_iris = [&](glm::vec2 pixel) {
    return fsm::SmoothStep(look.beside_iris_radii,
                           glm::distance(pixel, eye.iris.centre) / eye.iris.radius);
  };
  // Fill the area behind the iris from what is beside it, except the lids' shade and lashes.
  fsm::Image out = fsm::FilledImage(kBallPixels, kBallPixels);
  FloatImage weight(kBallPixels, kBallPixels);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const auto [pixel, between] = pixels[i];
    SetRgb(out, i, ColourAt(photo, pixel));
    weight[i] = beside_iris(pixel) * fsm::SmoothStep(look.upper_lid_share, between) *
                fsm::SmoothStep(look.lower_lid_share, between);
  }
  PushPullInpaint(out, weight);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const glm::vec2 pixel = pixels[i].first;
    SetRgb(out, i, glm::mix(Rgb(out, i), ColourAt(photo, pixel), beside_iris(pixel)));
  }
  return out;
}

struct EyeSquares {
  fsm::Image iris, ball;
};

/// Returns whose picture each eye shows: its own, or the other eye's if it is not seen clearly;
/// nothing if neither is.
std::optional<fsm::Sided<fsm::Side>> ShownEyes(const PhotoIrises& irises) {
  // An eye that is shown on both sides must not be half shut.
  constexpr float kForBoth = 0.1F;
  const auto clear = [&irises](fsm::Side k, float contrast) {
    return irises.circles[k].contrast >= contrast && irises.circles[k].radius >= kMinIrisPx;
  };
  if (clear(fsm::Side::kRight, kClearIris) && clear(fsm::Side::kLeft, kClearIris)) {
    return {{fsm::Side::kRight, fsm::Side::kLeft}};
  }
  for (const fsm::Side k : fsm::kSides) {
    if (clear(k, kForBoth)) return {{k, k}};
  }
  return std::nullopt;
}

/// Returns the mean colour of the skin below and beside an eye.
glm::vec3 LightBeside(const FoundFace& face, const fsm::Image& photo, fsm::Side side) {
  glm::vec3 light(1);
  const auto& below = point::kBelowEye[side];
  for (const PointIndex i : below)
    light += ColourAt(photo, face.PixelOf(i)) / static_cast<float>(below.size());
  return light;
}

/// Returns the mirror image of a square, multiplied by a gain.
fsm::Image Mirrored(const fsm::Image& square, glm::vec3 gain) {
  fsm::Image out = Turned(square, 2);
  for (std::size_t i = 0; i < out.rgba.size() / 4; ++i) SetRgb(out, i, Rgb(out, i) * gain);
  return out;
}

/// Returns the lids of an eye of the head at rest, millimetres from the centre of its ball.
LidLines LidsAtRest(const ObservedHead& base, fsm::Side side, const fsm::EyeTransform& transform) {
  const glm::vec3 centre = base.head().topology().eyes[side].centre;
  EyePoints rest;
  for (std::size_t i = 0; i < rest.size(); ++i) {
    rest[i] = glm::vec2(base.AtRest(point::kEyeOutline[side][i]) - centre);
  }
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

std::optional<fsm::Sided<fsm::EyePicture>> PaintEyes(const FoundFace& face, const Fit& fit,
                                                     const fsm::Sided<fsm::EyeTransform>& at_rest,
                                                     const fsm::Image& photo, fsm::Image& picture) {
  const ObservedHead& base = *fit.head.base;
  const auto shown = ShownEyes(fit.irises);
  if (!shown) return std::nullopt;
  const glm::mat3 turned = fit.head.pose.Rotation();
  const glm::vec2 right = glm::normalize(glm::vec2(turned[0].x, -turned[0].y));
  fsm::Sided<EyeSquares> squares;
  for (const fsm::Side k : fsm::kSides) {
    if ((*shown)[k] != k) continue;
    const LidLines lids(EyePointsOf(k, [&](PointIndex p) { return face.PixelOf(p); }));
    const PhotoEye eye{fit.irises.circles[k], lids, right, {right.y, -right.x}};
    const float radius = at_rest[k].size * base.head().topology().eyes[k].ball_radius;
    squares[k] = {IrisPicture(eye, LightBeside(face, photo, k), photo),
                  BallPicture(eye, LidsAtRest(base, k, at_rest[k]), radius, photo)};
  }
  SquareRow row(picture);
  fsm::Sided<fsm::EyePicture> pictures;
  for (const fsm::Side k : fsm::kSides) {
    if (const fsm::Side other = (*shown)[k]; other != k) {
      const glm::vec3 gain =
          LightGain(LightBeside(face, photo, k), LightBeside(face, photo, other));
      squares[k] = {Mirrored(squares[other].iris, gain), Mirrored(squares[other].ball, gain)};
    }
    pictures[k].iris = row.Add(squares[k].iris);
    pictures[k].ball = row.Add(squares[k].ball);
  }
  return pictures;
}

}  // namespace facefit
