#include "face_fit/dress/matte.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <glm/vec3.hpp>
#include <vector>

namespace facefit {
namespace {

/// Longest side of the picture that is solved; larger ones take what was found for a smaller copy.
constexpr int kSolvedSide = 720;

std::size_t Count(const fsm::Image& image) {
  return static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height);
}

glm::vec3 Colour(const fsm::Image& image, std::size_t i) {
  const std::uint8_t* p = &image.rgba[4 * i];
  return glm::vec3(p[0], p[1], p[2]) / 255.0F;
}

/// Of a spread of colours, with noise added. Grey pictures have them all on one line, where single
/// precision does not reach.
glm::mat3 Inverse(const glm::mat3& spread, float noise) {
  return glm::mat3(glm::inverse(glm::dmat3(spread) + glm::dmat3(static_cast<double>(noise))));
}

/// The opacity of a picture whose colours, of figure and background each, lie on a line in every
/// window of 3 x 3 (Levin, Lischinski and Weiss, A Closed Form Solution to Natural Image Matting,
/// 2006): what it cannot explain, as a matrix that is never written out.
class ColourLines {
 public:
  ColourLines(const fsm::Image& image, const std::vector<std::uint8_t>& open)
      : width_(image.width) {
    colour_.reserve(Count(image));
    for (std::size_t i = 0; i < Count(image); ++i) colour_.push_back(Colour(image, i));
    for (int y = 1; y + 1 < image.height; ++y) {
      for (int x = 1; x + 1 < width_; ++x) {
        const auto i = static_cast<std::size_t>(y) * static_cast<std::size_t>(width_) +
                       static_cast<std::size_t>(x);
        const auto at = Around(i);
        if (std::ranges::none_of(at, [&](std::size_t j) { return open[j] != 0; })) continue;
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

  /// out += L x
  void Add(const std::vector<float>& x, std::vector<float>& out) const {
    for (const Window& window : windows_) {
      const auto at = Around(window.middle);
      float mean = 0;
      for (const std::size_t j : at) mean += x[j] / 9;
      glm::vec3 with(0);
      for (const std::size_t j : at) with += (colour_[j] - window.mean) * ((x[j] - mean) / 9);
      const glm::vec3 slope = window.inverse * with;
      for (const std::size_t j : at) {
        out[j] += x[j] - mean - glm::dot(slope, colour_[j] - window.mean);
      }
    }
  }

 private:
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
void Refine(const ColourLines& lines, const std::vector<std::uint8_t>& open,
            const std::vector<float>& pull, std::vector<float>& x) {
  const std::vector<float> start = x;
  const std::size_t n = x.size();
  std::vector<float> rest(n), step(n), moved(n);
  const auto masked = [&](std::vector<float>& v) {
    for (std::size_t i = 0; i < n; ++i) v[i] = open[i] ? v[i] : 0;
  };
  lines.Add(x, rest);
  for (float& r : rest) r = -r;
  masked(rest);
  step = rest;
  const auto dot = [&](const std::vector<float>& a, const std::vector<float>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i)
      sum += static_cast<double>(a[i]) * static_cast<double>(b[i]);
    return sum;
  };
  double left = dot(rest, rest);
  const double enough = left * 1e-5;
  for (int round = 0; round < 120 && left > enough && left > 1e-9; ++round) {
    std::ranges::fill(moved, 0.0F);
    lines.Add(step, moved);
    for (std::size_t i = 0; i < n; ++i) moved[i] += pull[i] * step[i];
    masked(moved);
    const auto by = static_cast<float>(left / std::max(dot(step, moved), 1e-12));
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += by * step[i];
      rest[i] -= by * moved[i];
    }
    const double now = dot(rest, rest);
    const auto keep = static_cast<float>(now / left);
    for (std::size_t i = 0; i < n; ++i) step[i] = rest[i] + keep * step[i];
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
  // The person's outline is right to about this many pixels.
  const int reach = std::max(image.width, image.height) / 90 + 2;
  const FloatImage around = Blurred(person, reach);
  std::vector<std::uint8_t> open(person.at.size());
  std::vector<float> pull(open.size());
  FloatImage out(person.width, person.height);
  for (std::size_t i = 0; i < open.size(); ++i) {
    open[i] = around.at[i] > 0.02F && around.at[i] < 0.98F;
    out.at[i] = open[i] ? Firm(person.at[i]) : std::round(around.at[i]);
  }
  const ColourLines lines(image, open);
  // Then once more from what was found: where colours say nothing it settles on one or the other.
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < open.size(); ++i) {
      const float sure = 2 * out.at[i] - 1;
      pull[i] = 0.003F + 0.03F * sure * sure;
    }
    Refine(lines, open, pull, out.at);
    for (float& v : out.at) v = glm::clamp(v, 0.0F, 1.0F);
    Decide(out, reach);
  }
  return out;
}

FloatImage Scaled(const FloatImage& field, int width, int height) {
  const float across = static_cast<float>(field.width) / static_cast<float>(width);
  const float down = static_cast<float>(field.height) / static_cast<float>(height);
  const FloatImage smooth = Blurred(field, static_cast<int>(std::max(across, down) / 2));
  FloatImage out(width, height);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      out.at[out.Index(x, y)] = smooth.Between((static_cast<float>(x) + 0.5F) * across,
                                               (static_cast<float>(y) + 0.5F) * down);
    }
  }
  return out;
}

/// The small picture's opacity as a linear function of its colours, applied to the large one's.
FloatImage Enlarged(const fsm::Image& small, const FloatImage& opacity, const fsm::Image& large) {
  constexpr int kReach = 1;
  std::array<FloatImage, 3> mean{opacity, opacity, opacity}, with = mean, slope = mean;
  const FloatImage mean_opacity = Blurred(opacity, kReach);
  std::array<std::array<FloatImage, 3>, 3> spread{mean, mean, mean};
  for (std::size_t a = 0; a < 3; ++a) {
    for (std::size_t i = 0; i < opacity.at.size(); ++i) {
      const glm::vec3 c = Colour(small, i);
      const auto k = static_cast<int>(a);
      mean[a].at[i] = c[k];
      with[a].at[i] = c[k] * opacity.at[i];
      for (std::size_t b = 0; b < 3; ++b) spread[a][b].at[i] = c[k] * c[static_cast<int>(b)];
    }
    mean[a] = Blurred(mean[a], kReach);
    with[a] = Blurred(with[a], kReach);
    for (FloatImage& field : spread[a]) field = Blurred(field, kReach);
  }
  FloatImage base = mean_opacity;
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
    for (int a = 0; a < 3; ++a) slope[static_cast<std::size_t>(a)].at[i] = by[a];
    base.at[i] -= glm::dot(by, m);
  }
  for (FloatImage& field : slope) field = Blurred(field, kReach);
  base = Blurred(base, kReach);
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
    out = Enlarged(small, Solve(small, Scaled(person, small.width, small.height)), photo);
  }
  // What is as good as nothing or all is that.
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
    FloatImage figure(photo.width, photo.height), behind = figure;
    for (std::size_t i = 0; i < figure.at.size(); ++i) {
      figure.at[i] = behind.at[i] = static_cast<float>(photo.rgba[4 * i + c]);
    }
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
      out.rgba[4 * i + c] = static_cast<std::uint8_t>(figure.at[i] + 0.5F);
    }
  }
  // Of what is hardly there the colour is hardly known.
  FloatImage known = opacity;
  for (float& v : known.at) v = glm::smoothstep(0.05F, 0.6F, v);
  PushPullInpaint(out, known);
  return out;
}

}  // namespace facefit
