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
#include <vector>

#include "face_fit/picture/filters.h"
#include "face_fit/picture/inpaint.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/tables/photo_look.h"

namespace facefit {
namespace {

/// Longest side of the picture that is solved; larger ones take what was found for a smaller copy.
constexpr int kSolvedSide = 720;

using Numbers = Eigen::ArrayXf;  // of each pixel

/// 0..1.
glm::vec3 Colour(const fsm::Image& image, std::size_t i) { return Rgb(image, i) / 255.0F; }

/// The inverse of a covariance of colours with noise added. Grey pictures have them all on one
/// line, where single precision does not reach.
glm::mat3 Inverse(const glm::mat3& spread, float noise) {
  return glm::mat3(glm::inverse(glm::dmat3(spread) + glm::dmat3(static_cast<double>(noise))));
}

/// The opacity of a picture whose colours, of figure and background each, lie on a line in every
/// window of 3 x 3 (Levin, Lischinski and Weiss, A Closed Form Solution to Natural Image Matting,
/// 2006): what it cannot explain, as a matrix that is never written out.
class ColourLines {
 public:
  ColourLines(const fsm::Image& image, const Numbers& open) : width_(image.width) {
    colour_.reserve(image.rgba.size() / 4);
    for (std::size_t i = 0; i < image.rgba.size() / 4; ++i) colour_.push_back(Colour(image, i));
    for (int y = 1; y + 1 < image.height; ++y) {
      for (int x = 1; x + 1 < width_; ++x) {
        const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x);
        const auto at = Around(i);
        if (std::ranges::none_of(at, [&](std::size_t j) { return open[Index(j)] != 0; })) continue;
        Window window{i, glm::vec3(0), glm::mat3(0)};
        glm::mat3 spread(0);
        for (const std::size_t j : at) window.mean += colour_[j] / 9.0F;
        for (const std::size_t j : at) {
          const glm::vec3 off = colour_[j] - window.mean;
          spread += glm::outerProduct(off, off) / 9.0F;
        }
        window.inverse = Inverse(spread, 2e-5F);
        windows_.push_back(window);
      }
    }
  }

  /// The matrix times x.
  Numbers Of(const Numbers& x) const {
    Numbers out = Numbers::Zero(x.size());
    for (const Window& window : windows_) {
      const auto at = Around(window.middle);
      float mean = 0;
      for (const std::size_t j : at) mean += x[Index(j)] / 9;
      glm::vec3 with(0);
      for (const std::size_t j : at)
        with += (colour_[j] - window.mean) * ((x[Index(j)] - mean) / 9);
      const glm::vec3 slope = window.inverse * with;
      for (const std::size_t j : at) {
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

/// Conjugate gradients on the open pixels; `pull` holds each to `x` as it is at the beginning.
void Refine(const ColourLines& lines, const Numbers& open, const Numbers& pull, Numbers& x) {
  constexpr int kRounds = 120;
  constexpr double kEnough = 1e-5;  // of the square of what is missing at the beginning
  const auto square = [](const Numbers& v) { return v.matrix().cast<double>().squaredNorm(); };
  Numbers rest = -open * lines.Of(x);
  Numbers step = rest;
  double left = square(rest);
  const double enough = std::max(left * kEnough, 1e-9);
  for (int round = 0; round < kRounds && left > enough; ++round) {
    const Numbers moved = open * (lines.Of(step) + pull * step);
    const double along = step.matrix().cast<double>().dot(moved.matrix().cast<double>());
    const auto by = static_cast<float>(left / std::max(along, 1e-12));
    x += by * step;
    rest -= by * moved;
    const double now = square(rest);
    step = rest + static_cast<float>(now / left) * step;
    left = now;
  }
}

/// Towards 0 and 1 where it says which, not where it says half.
float Firm(float v) { return glm::smoothstep(0.08F, 0.92F, v); }

/// Nothing is half there over a wide area: that is doubt, not an edge.
void Decide(FloatImage& opacity, int reach) {
  FloatImage square = opacity;
  for (float& v : square.at) v *= v;
  const FloatImage mean = Blurred(opacity, reach), mean_square = Blurred(square, reach);
  for (std::size_t i = 0; i < opacity.at.size(); ++i) {
    const float m = mean.at[i], most = m * (1 - m);
    if (most < 1e-3F) continue;
    const float even = 1 - (mean_square.at[i] - m * m) / most;
    const float sure = glm::smoothstep(0.3F, 0.7F, opacity.at[i]);
    opacity.at[i] = glm::mix(opacity.at[i], sure, glm::smoothstep(0.35F, 0.7F, even));
  }
}

FloatImage Solve(const fsm::Image& image, const FloatImage& person) {
  const glm::vec2 sure = PhotoLook().Pair("outline_doubt");
  // The person's outline is right to about this many pixels.
  const int reach = std::max(image.width, image.height) / 90 + 2;
  const FloatImage around = Blurred(person, reach);
  FloatImage out(person.width, person.height);
  const auto count = static_cast<Eigen::Index>(out.at.size());
  Numbers open(count);
  for (std::size_t i = 0; i < out.at.size(); ++i) {
    const bool doubt = around.at[i] > sure.x && around.at[i] < sure.y;
    open[static_cast<Eigen::Index>(i)] = doubt ? 1.0F : 0.0F;
    out.at[i] = doubt ? Firm(person.at[i]) : std::round(around.at[i]);
  }
  const ColourLines lines(image, open);
  // Then once more from what was found: where colours say nothing it settles on one or the other.
  for (int round = 0; round < 2; ++round) {
    Numbers opacity = Eigen::Map<const Numbers>(out.at.data(), count);
    const Numbers pull = 0.003F + 0.03F * (2 * opacity - 1).square();
    Refine(lines, open, pull, opacity);
    Eigen::Map<Numbers>(out.at.data(), count) = opacity.max(0).min(1);
    Decide(out, reach);
  }
  return out;
}

/// Opacity as a linear function of the colours around a pixel: dot(slope, colour) + base.
struct OpacityOfColour {
  std::array<FloatImage, 3> slope;
  FloatImage base;
};

OpacityOfColour FitColours(const fsm::Image& image, const FloatImage& opacity) {
  constexpr int kReach = 1;
  std::array<FloatImage, 3> mean{opacity, opacity, opacity}, with = mean;
  std::array<std::array<FloatImage, 3>, 3> spread{mean, mean, mean};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < opacity.at.size(); ++i) {
      const glm::vec3 c = Colour(image, i);
      const auto k = static_cast<int>(a);
      mean[a].at[i] = c[k];
      with[a].at[i] = c[k] * opacity.at[i];
      for (std::size_t b = 0; b < 3; ++b) spread[a][b].at[i] = c[k] * c[static_cast<int>(b)];
    }
    mean[a] = Blurred(mean[a], kReach);
    with[a] = Blurred(with[a], kReach);
    for (FloatImage& field : spread[a]) field = Blurred(field, kReach);
  }
  const FloatImage mean_opacity = Blurred(opacity, kReach);
  OpacityOfColour fit{mean, mean_opacity};
  for (std::size_t i = 0; i < opacity.at.size(); ++i) {
    const glm::vec3 m(mean[0].at[i], mean[1].at[i], mean[2].at[i]);
    const glm::vec3 w(with[0].at[i], with[1].at[i], with[2].at[i]);
    glm::mat3 s(0);
    for (int a = 0; a < 3; ++a) {
      for (int b = 0; b < 3; ++b) {
        s[a][b] =
            spread[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)].at[i] - m[a] * m[b];
      }
    }
    const glm::vec3 by = Inverse(s, 2e-4F) * (w - m * mean_opacity.at[i]);
    for (int a = 0; a < 3; ++a) fit.slope[static_cast<std::size_t>(a)].at[i] = by[a];
    fit.base.at[i] -= glm::dot(by, m);
  }
  for (FloatImage& field : fit.slope) field = Blurred(field, kReach);
  fit.base = Blurred(fit.base, kReach);
  return fit;
}

/// The small picture's opacity, brought to the large one by its colours.
FloatImage Enlarged(const fsm::Image& small, const FloatImage& opacity, const fsm::Image& large) {
  const auto [slope, base] = FitColours(small, opacity);
  FloatImage out(large.width, large.height);
  const float across = static_cast<float>(small.width) / static_cast<float>(large.width);
  const float down = static_cast<float>(small.height) / static_cast<float>(large.height);
  for (int y = 0; y < large.height; ++y) {
    for (int x = 0; x < large.width; ++x) {
      const float u = (static_cast<float>(x) + 0.5F) * across,
                  v = (static_cast<float>(y) + 0.5F) * down;
      const float plain = opacity.Between(u, v);
      const std::size_t i = out.Index(x, y);
      if (plain <= 0 || plain >= 1) {
        out.at[i] = plain;
        continue;
      }
      const glm::vec3 by(slope[0].Between(u, v), slope[1].Between(u, v), slope[2].Between(u, v));
      out.at[i] = glm::clamp(glm::dot(by, Colour(large, i)) + base.Between(u, v), 0.0F, 1.0F);
    }
  }
  return out;
}

}  // namespace

FloatImage Matte(const fsm::Image& photo, const FloatImage& person) {
  const int side = std::max(photo.width, photo.height);
  FloatImage out(0, 0);
  if (side <= kSolvedSide) {
    out = Solve(photo, person);
  } else {
    const fsm::Image small = ScaledDown(photo, std::max(photo.width * kSolvedSide / side, 1),
                                        std::max(photo.height * kSolvedSide / side, 1));
    out = Enlarged(small, Solve(small, ScaledDown(person, small.width, small.height)), photo);
  }
  // Opacities very near to 0 and 1 become 0 and 1.
  for (float& v : out.at) v = glm::clamp((v - 0.04F) / 0.92F, 0.0F, 1.0F);
  return out;
}

fsm::Image WithoutBackground(const fsm::Image& photo, const FloatImage& opacity) {
  // Blurred figure and background mixed as the opacity says, and what then is still missing
  // (Forte, Approximate Fast Foreground Colour Estimation, 2021); first from afar, then from near.
  const int side = std::max(photo.width, photo.height);
  fsm::Image out = photo;
  std::vector<std::size_t> edge;
  for (std::size_t i = 0; i < opacity.at.size(); ++i) {
    if (opacity.at[i] > 0 && opacity.at[i] < 1) edge.push_back(i);
  }
  for (std::size_t c = 0; c < 3; ++c) {
    FloatImage figure = Channel(photo, c), behind = figure;
    for (const int reach : {side / 16 + 2, side / 150 + 1}) {
      FloatImage with = figure, without = behind, none = opacity;
      for (std::size_t i = 0; i < with.at.size(); ++i) {
        with.at[i] *= opacity.at[i];
        none.at[i] = 1 - opacity.at[i];
        without.at[i] *= none.at[i];
      }
      const FloatImage share = Blurred(opacity, reach), rest = Blurred(none, reach);
      with = Blurred(with, reach);
      without = Blurred(without, reach);
      for (const std::size_t i : edge) {
        const float a = opacity.at[i];
        const float f = with.at[i] / (share.at[i] + 1e-4F),
                    b = without.at[i] / (rest.at[i] + 1e-4F);
        const float missing = static_cast<float>(photo.rgba[4 * i + c]) - a * f - (1 - a) * b;
        figure.at[i] = glm::clamp(f + a * missing, 0.0F, 255.0F);
        behind.at[i] = glm::clamp(b + (1 - a) * missing, 0.0F, 255.0F);
      }
    }
    for (const std::size_t i : edge) {
      out.rgba[4 * i + c] = Byte(figure.at[i]);
    }
  }
  // Where the figure is nearly transparent its colour is hardly known and is taken from around.
  FloatImage known = opacity;
  for (float& v : known.at) v = glm::smoothstep(0.05F, 0.6F, v);
  PushPullInpaint(out, known);
  return out;
}

Cutout CutOut(const fsm::Image& photo, const FloatImage& person) {
  FloatImage opacity = Matte(photo, person);
  fsm::Image colours = WithoutBackground(photo, opacity);
  return {std::move(colours), std::move(opacity)};
}

}  // namespace facefit
