#include "face_fit/find/figure/matte.h"

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <utility>
#include <vector>

#include "face_fit/image/filters.h"
#include "face_fit/image/pixels.h"
#include "face_fit/tables/photo_look.h"
#include "fsm/image/shrink.h"

namespace facefit {
namespace {

/// Longest side of an image that is solved; mattes of larger ones are upsampled from a copy.
constexpr int kSolvedSize = 720;
/// A length that grows with an image: longer side / divisor + pixels.
struct RelativeReach {
  int divisor, pixels;
  int For(const fsm::Image& image) const {
    return std::max(image.width, image.height) / divisor + pixels;
  }
};
/// Reach of errors of the rough outline.
constexpr RelativeReach kOutlineErrors{90, 2};
/// Regularisation of covariances of colours 0..1: matting Laplacian, guided filter.
constexpr float kLaplacianNoise = 2e-5F, kGuideNoise = 2e-4F;
/// Weight that holds a pixel to its opacity: any pixel, and in addition one of opacity 0 or 1.
constexpr float kPull = 0.003F, kPullDecided = 0.03F;
/// Opacities this close to 0 and 1 become 0 and 1.
constexpr float kNearlyNone = 0.04F;
/// Reaches of the passes of the foreground estimation, wide first.
constexpr RelativeReach kForegroundPasses[] = {{16, 2}, {150, 1}};
/// SuppressWideDoubt: range of uncertain opacity, and evenness of the surroundings (0 = an edge, 1
/// = the same everywhere) from which opacity is decided: not at all, and wholly.
constexpr fsm::Range kDecidedOpacity{0.3F, 0.7F}, kEvenness{0.35F, 0.7F};

using PixelVector = Eigen::ArrayXf;  // one value for each pixel

/// Returns a pixel's colour, 0..1.
glm::vec3 Colour(const fsm::Image& image, std::size_t i) { return Rgb(image, i) / 255.0F; }

/// Returns the inverse of a regularised covariance of colours. In double precision, because grey
/// images have a nearly singular one.
glm::mat3 Inverse(const glm::mat3& spread, float noise) {
  return glm::mat3(glm::inverse(glm::dmat3(spread) + glm::dmat3(static_cast<double>(noise))));
}

/// The matting Laplacian (Levin, Lischinski and Weiss, A Closed Form Solution to Natural Image
/// Matting, 2006), never written out as a matrix: its quadratic form is what remains unexplained if
/// opacity is a linear function of the colours in every window of 3 x 3.
class MattingLaplacian {
 public:
  MattingLaplacian(const fsm::Image& image, const PixelVector& undecided) : width_(image.width) {
    colour_.reserve(image.rgba.size() / 4);
    for (std::size_t i = 0; i < image.rgba.size() / 4; ++i) colour_.push_back(Colour(image, i));
    for (int y = 1; y + 1 < image.height; ++y) {
      for (int x = 1; x + 1 < width_; ++x) {
        const std::size_t i = image.Index(x, y);
        const auto around = Around(i);
        if (std::ranges::none_of(around, [&](std::size_t j) { return undecided[Index(j)] != 0; })) {
          continue;
        }
        Window window{i, glm::vec3(0), glm::mat3(0)};
        glm::mat3 spread(0);
        for (const std::size_t j : around) window.mean += colour_[j] / 9.0F;
        for (const std::size_t j : around) {
          const glm::vec3 deviation = colour_[j] - window.mean;
          spread += glm::outerProduct(deviation, deviation) / 9.0F;
        }
        window.inverse = Inverse(spread, kLaplacianNoise);
        windows_.push_back(window);
      }
    }
  }

  /// Returns the matrix times x.
  PixelVector Times(const PixelVector& x) const {
    PixelVector out = PixelVector::Zero(x.size());
    for (const Window& window : windows_) {
      const auto around = Around(window.middle);
      float mean = 0;
      for (const std::size_t j : around) mean += x[Index(j)] / 9;
      glm::vec3 covariance(0);
      for (const std::size_t j : around) {
        covariance += (colour_[j] - window.mean) * ((x[Index(j)] - mean) / 9);
      }
      const glm::vec3 slope = window.inverse * covariance;
      for (const std::size_t j : around) {
        out[Index(j)] += x[Index(j)] - mean - glm::dot(slope, colour_[j] - window.mean);
      }
    }
    return out;
  }

 private:
  static Eigen::Index Index(std::size_t i) { return static_cast<Eigen::Index>(i); }
  struct Window {
    std::size_t middle;
    glm::vec3 mean;
    glm::mat3 inverse;
  };
  std::array<std::size_t, 9> Around(std::size_t i) const {
    const auto w = static_cast<std::size_t>(width_);
    return {i - w - 1, i - w, i - w + 1, i - 1, i, i + 1, i + w - 1, i + w, i + w + 1};
  }
  int width_;
  std::vector<glm::vec3> colour_;
  std::vector<Window> windows_;
};

/// Runs conjugate gradients on undecided pixels (`undecided` = 1); `pull` holds each to its initial
/// `x`.
void ConjugateGradients(const MattingLaplacian& laplacian, const PixelVector& undecided,
                        const PixelVector& pull, PixelVector& x) {
  constexpr int kRounds = 120;
  constexpr double kEnough = 1e-5;  // share of the residual's initial squared norm
  const auto square = [](const PixelVector& v) { return v.matrix().cast<double>().squaredNorm(); };
  PixelVector residual = -undecided * laplacian.Times(x);
  PixelVector direction = residual;
  double squared_norm = square(residual);
  const double enough = std::max(squared_norm * kEnough, 1e-9);
  for (int round = 0; round < kRounds && squared_norm > enough; ++round) {
    const PixelVector product = undecided * (laplacian.Times(direction) + pull * direction);
    const double curvature = direction.matrix().cast<double>().dot(product.matrix().cast<double>());
    const auto alpha = static_cast<float>(squared_norm / std::max(curvature, 1e-12));
    x += alpha * direction;
    residual -= alpha * product;
    const double next = square(residual);
    direction = residual + static_cast<float>(next / squared_norm) * direction;
    squared_norm = next;
  }
}

/// Decides pixels that are half opaque over a wide area, which is doubt and not an edge.
void SuppressWideDoubt(Mask& opacity, int reach) {
  FloatImage square = opacity;
  for (float& v : square.values) v *= v;
  const FloatImage mean = Blurred(opacity, reach), mean_square = Blurred(square, reach);
  for (std::size_t i = 0; i < opacity.size(); ++i) {
    const float m = mean[i], most = m * (1 - m);
    if (most < 1e-3F) continue;
    const float even = 1 - (mean_square[i] - m * m) / most;
    const float sure = kDecidedOpacity.Ramp(opacity[i]);
    opacity[i] = glm::mix(opacity[i], sure, kEvenness.Ramp(even));
  }
}

Mask SolveOpacity(const fsm::Image& image, const Mask& person) {
  const auto& look = PhotoLook().figure;
  const int reach = kOutlineErrors.For(image);
  const Mask around = Blurred(person, reach);
  Mask out(person.width, person.height);
  const auto count = static_cast<Eigen::Index>(out.size());
  PixelVector undecided(count);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const bool doubt = look.outline_doubt_share.Contains(around[i]);
    undecided[static_cast<Eigen::Index>(i)] = doubt ? 1.0F : 0.0F;
    out[i] = doubt ? look.sharpened_share.Ramp(person[i]) : std::round(around[i]);
  }
  const MattingLaplacian laplacian(image, undecided);
  // The second round settles pixels whose colours tell nothing on 0 or 1.
  for (int round = 0; round < 2; ++round) {
    PixelVector opacity = Eigen::Map<const PixelVector>(out.values.data(), count);
    const PixelVector pull = kPull + kPullDecided * (2 * opacity - 1).square();
    ConjugateGradients(laplacian, undecided, pull, opacity);
    Eigen::Map<PixelVector>(out.values.data(), count) = opacity.max(0).min(1);
    SuppressWideDoubt(out, reach);
  }
  return out;
}

/// Opacity as a linear function of the colours around a pixel: dot(slope, colour) + base.
struct OpacityGuide {
  VectorImage slope;
  FloatImage base;
};

/// Fits by least squares over 3 x 3 pixels (guided filter; He, Sun and Tang 2010).
OpacityGuide FitGuide(const fsm::Image& image, const Mask& opacity) {
  constexpr int kReach = 1;
  VectorImage mean(image.width, image.height), product = mean;
  Raster<glm::mat3> square(image.width, image.height);
  for (std::size_t i = 0; i < opacity.size(); ++i) {
    const glm::vec3 c = Colour(image, i);
    mean[i] = c;
    product[i] = c * opacity[i];
    square[i] = glm::outerProduct(c, c);
  }
  mean = Blurred(mean, kReach);
  product = Blurred(product, kReach);
  square = Blurred(square, kReach);
  OpacityGuide fit{mean, Blurred(opacity, kReach)};
  for (std::size_t i = 0; i < opacity.size(); ++i) {
    const glm::vec3 m = mean[i];
    const glm::mat3 spread = square[i] - glm::outerProduct(m, m);
    fit.slope[i] = Inverse(spread, kGuideNoise) * (product[i] - m * fit.base[i]);
    fit.base[i] -= glm::dot(fit.slope[i], m);
  }
  return {Blurred(fit.slope, kReach), Blurred(fit.base, kReach)};
}

/// Upsamples the small image's opacity, guided by the large image's colours.
Mask GuidedUpsampling(const fsm::Image& small, const Mask& opacity, const fsm::Image& large) {
  const OpacityGuide fit = FitGuide(small, opacity);
  const glm::vec2 scale =
      glm::vec2(small.width, small.height) / glm::vec2(large.width, large.height);
  return Mask::From(large.width, large.height, [&](int x, int y) {
    const glm::vec2 p = (glm::vec2(x, y) + 0.5F) * scale;
    const float plain = opacity.SampleAt(p.x, p.y);
    if (plain <= 0 || plain >= 1) return plain;
    const glm::vec3 colour = Colour(large, large.Index(x, y));
    return glm::clamp(glm::dot(fit.slope.SampleAt(p.x, p.y), colour) + fit.base.SampleAt(p.x, p.y),
                      0.0F, 1.0F);
  });
}

/// Returns the opacity of CutOutFigure.
Mask Matte(const fsm::Image& photo, const Mask& person) {
  const int longer = std::max(photo.width, photo.height);
  Mask out;
  if (longer <= kSolvedSize) {
    out = SolveOpacity(photo, person);
  } else {
    const fsm::Image small = fsm::Shrunk(photo, std::max(photo.width * kSolvedSize / longer, 1),
                                         std::max(photo.height * kSolvedSize / longer, 1));
    out = GuidedUpsampling(
        small, SolveOpacity(small, ScaledDown(person, small.width, small.height)), photo);
  }
  for (float& v : out.values) v = glm::clamp((v - kNearlyNone) / (1 - 2 * kNearlyNone), 0.0F, 1.0F);
  return out;
}

}  // namespace

fsm::Image ForegroundColours(const fsm::Image& photo, const Mask& opacity) {
  // Blurred foreground and background colours, corrected by the remaining difference to the photo
  // (Forte, Approximate Fast Foreground Colour Estimation, 2021).
  fsm::Image out = photo;
  std::vector<std::size_t> edge;
  for (std::size_t i = 0; i < opacity.size(); ++i) {
    if (opacity[i] > 0 && opacity[i] < 1) edge.push_back(i);
  }
  Mask behind_opacity = opacity;
  for (float& v : behind_opacity.values) v = 1 - v;
  VectorImage figure = Colours(photo), behind = figure;
  for (const RelativeReach& pass : kForegroundPasses) {
    const int reach = pass.For(photo);
    const WeightedBlur figure_near(figure, opacity, reach),
        behind_near(behind, behind_opacity, reach);
    for (const std::size_t i : edge) {
      const float a = opacity[i];
      const glm::vec3 f = figure_near.sum[i] / (figure_near.weight[i] + 1e-4F);
      const glm::vec3 b = behind_near.sum[i] / (behind_near.weight[i] + 1e-4F);
      const glm::vec3 missing = Rgb(photo, i) - a * f - (1 - a) * b;
      figure[i] = glm::clamp(f + a * missing, 0.0F, 255.0F);
      behind[i] = glm::clamp(b + (1 - a) * missing, 0.0F, 255.0F);
    }
  }
  for (const std::size_t i : edge) SetRgb(out, i, figure[i]);
  // The colour of nearly transparent pixels is hardly known and is filled in from around.
  Mask known = opacity;
  for (float& v : known.values) v = PhotoLook().figure.colour_known_share.Ramp(v);
  PushPullInpaint(out, known);
  return out;
}

FigureCutout CutOutFigure(const fsm::Image& photo, const Mask& person) {
  Mask opacity = Matte(photo, person);
  fsm::Image colours = ForegroundColours(photo, opacity);
  return {std::move(colours), std::move(opacity)};
}

}  // namespace facefit
