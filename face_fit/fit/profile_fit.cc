#include "face_fit/fit/profile_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <optional>
#include <utility>

#include "face_fit/find/head/rasterizer.h"
#include "face_fit/fit/landmark_warp.h"
#include "face_fit/fit/least_squares.h"
#include "face_fit/picture/pixels.h"

namespace facefit {
namespace {

constexpr float kBin = 2;           // millimetres of height between places of the line
constexpr float kMiddle = 13;       // so far to its sides the middle of the face makes the outline
constexpr float kThroat = 16;       // below the chin, where the outline goes back
constexpr float kAboveNasion = 16;  // where hair may begin
constexpr float kReach = 13;        // how far off the line is looked for, millimetres
constexpr float kLeastAlike = 0.92F;  // of lines without their slopes
constexpr float kMostOff = 4;  // a mean beyond it is no face's, or another one's, millimetres

/// The profile of the fitted head from the chin up: heights in even steps, and how far forward.
std::vector<glm::vec3> ProfileOf(const BaseHead& base, const FittedHead& fitted, float below_chin) {
  const float low = base.points[point::kChin].On(fitted.posed_vertices).y - below_chin;
  const float high = base.points[point::kNasion].On(fitted.posed_vertices).y + kAboveNasion;
  const auto count = static_cast<std::size_t>(std::max(high - low, kBin) / kBin) + 1;
  std::vector<float> z(count, -1e9F);
  ForSkinTriangles(base.head->topology(), [&](const std::uint32_t* t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::vec3 a = fitted.posed_vertices[t[c]], b = fitted.posed_vertices[t[(c + 1) % 3]];
      for (const float along : {0.0F, 0.25F, 0.5F, 0.75F}) {
        const glm::vec3 p = glm::mix(a, b, along);
        const float bin = (p.y - low) / kBin;
        if (std::abs(p.x) > kMiddle || bin < 0) continue;
        const auto i = static_cast<std::size_t>(bin + 0.5F);
        if (i < count) z[i] = std::max(z[i], p.z);
      }
    }
  });
  std::vector<glm::vec3> line;
  for (std::size_t i = 0; i < count; ++i) {
    if (z[i] > -1e8F) line.emplace_back(0, low + kBin * static_cast<float>(i), z[i]);
  }
  return line;
}

/// The figure's outermost column of each row, to the right (direction 1) or to the left; -1: none.
std::vector<float> Outline(const FloatImage& opacity, int direction) {
  std::vector<float> columns(static_cast<std::size_t>(opacity.height), -1);
  for (int y = 0; y < opacity.height; ++y) {
    for (int k = 0; k < opacity.width; ++k) {
      const int x = direction > 0 ? opacity.width - 1 - k : k;
      if (opacity.at[opacity.Index(x, y)] < 0.5F) continue;
      columns[static_cast<std::size_t>(y)] = static_cast<float>(x) + 0.5F;
      break;
    }
  }
  return columns;
}

/// Where the profile may lie: the place of its middle, pixels by millimetre, how it leans.
struct Guess {
  int direction = 1;
  float scale = 1, tilt = 0, row = 0, column = 0;
  float off = 1e9F;  // mean distance, millimetres
  float alike = -1;  // concordance of the lines without their slopes, -1..1
  float Rating() const { return alike - 0.05F * off; }
  glm::vec3 middle{0};
  glm::vec2 At(glm::vec3 p) const {
    const glm::vec2 v(static_cast<float>(direction) * (p.z - middle.z), middle.y - p.y);
    const float c = std::cos(tilt), s = std::sin(tilt);
    return glm::vec2(column, row) + scale * glm::vec2(v.x * c - v.y * s, v.x * s + v.y * c);
  }
};

/// Concordance of two lines with as many places, means and slopes taken off (Lin, A concordance
/// correlation coefficient to evaluate reproducibility, Biometrics 1989): 1 = the same.
float Concordance(std::vector<float> a, std::vector<float> b) {
  const auto flatten = [](std::vector<float>& v) {
    const float half = 0.5F * static_cast<float>(v.size() - 1);
    float mean = 0, slope = 0, squares = 0;
    for (std::size_t i = 0; i < v.size(); ++i) {
      const float at = static_cast<float>(i) - half;
      mean += v[i] / static_cast<float>(v.size());
      slope += at * v[i];
      squares += at * at;
    }
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] -= mean + slope / squares * (static_cast<float>(i) - half);
    }
  };
  flatten(a);
  flatten(b);
  float aa = 1e-6F, bb = 1e-6F, ab = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    aa += a[i] * a[i];
    bb += b[i] * b[i];
    ab += a[i] * b[i];
  }
  return 2 * ab / (aa + bb);
}

/// Fills column, off and alike of a guess that has the rest; false if it does not fit the picture.
bool Rate(const std::vector<glm::vec3>& line, const std::vector<float>& columns, Guess& guess) {
  guess.column = 0;
  std::vector<float> ours, beside;
  ours.reserve(line.size());
  beside.reserve(line.size());
  for (const glm::vec3& p : line) {
    const glm::vec2 at = guess.At(p);
    if (at.y < 0 || at.y >= static_cast<float>(columns.size())) return false;
    const float column = columns[static_cast<std::size_t>(at.y)];
    if (column < 0) return false;
    ours.push_back(at.x);
    beside.push_back(column - at.x);
  }
  guess.column = Median(beside);
  guess.off = 0;
  for (const float x : beside) {
    guess.off +=
        std::min(std::abs(x - guess.column) / guess.scale, 8.0F) / static_cast<float>(line.size());
  }
  if (guess.off > kMostOff) return false;
  for (std::size_t i = 0; i < ours.size(); ++i) beside[i] += ours[i];
  guess.alike = Concordance(std::move(ours), std::move(beside));
  return true;
}

/// Better and better in ever smaller steps of size, height and lean.
Guess Refined(const std::vector<glm::vec3>& line, const std::vector<float>& columns, Guess guess) {
  for (float step = 1; step > 0.1F; step *= 0.6F) {
    for (int round = 0; round < 4; ++round) {
      const Guess from = guess;
      for (const glm::vec3 direction :
           {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0),
            glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
        Guess other = from;
        other.scale *= 1 + 0.025F * step * direction.x;
        other.row += 1.5F * other.scale * step * direction.y;
        other.tilt += glm::radians(3 * step) * direction.z;
        if (Rate(line, columns, other) && other.Rating() > guess.Rating()) guess = other;
      }
    }
  }
  return guess;
}

std::optional<Guess> Search(const std::vector<glm::vec3>& line, const FloatImage& opacity) {
  int top = opacity.height, bottom = -1;
  for (int y = 0; y < opacity.height; ++y) {
    for (int x = 0; x < opacity.width; ++x) {
      if (opacity.at[opacity.Index(x, y)] < 0.5F) continue;
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  const auto tall = static_cast<float>(bottom - top);
  if (tall < 60 || line.size() < 30) return {};
  const glm::vec3 middle = line[line.size() / 2];
  std::array<Guess, 2> found;
  for (const int direction : {1, -1}) {
    const auto columns = Outline(opacity, direction);
    Guess& best = found[direction > 0 ? 0 : 1];
    // From the head alone, cut at the throat, to a figure down to the elbows.
    for (float scale = tall / 620; scale < tall / 180; scale *= 1.05F) {
      for (const float degrees : {-24.0F, -16.0F, -8.0F, 0.0F, 8.0F, 16.0F, 24.0F}) {
        const float step = std::max(1.5F * scale, 1.0F);
        for (auto row = static_cast<float>(top); row < static_cast<float>(bottom); row += step) {
          Guess guess{.direction = direction,
                      .scale = scale,
                      .tilt = glm::radians(degrees),
                      .row = row,
                      .middle = middle};
          if (Rate(line, columns, guess) && guess.Rating() > best.Rating()) best = guess;
        }
      }
    }
    if (best.off < kMostOff) best = Refined(line, columns, best);
  }
  // A throat or the back of a head lies as near the line as another's nose; but it has no nose.
  return found[0].Rating() > found[1].Rating() ? found[0] : found[1];
}

/// The pose that shows places nearest to pixels, with the turn as given.
CameraPose PoseWithTurn(const std::vector<glm::vec3>& places, const std::vector<glm::vec2>& pixels,
                        glm::vec3 turn) {
  CameraPose pose;
  pose.turn = turn;
  pose.focal = 1;
  pose.centre = {0, 0};
  LinearLeastSquares sum;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const glm::vec2 u = pose.Project(pose.ToCamera(places[i]));
    sum.Add({static_cast<double>(u.x), 1, 0}, static_cast<double>(pixels[i].x));
    sum.Add({static_cast<double>(u.y), 0, 1}, static_cast<double>(pixels[i].y));
  }
  const auto solved = sum.Solve(1e-12);
  pose.focal = static_cast<float>(solved[0]);
  pose.centre = {static_cast<float>(solved[1]), static_cast<float>(solved[2])};
  return pose;
}

/// How far before (or behind) a place of the profile the outline lies, millimetres of depth;
/// nothing beyond reach.
std::optional<float> Forward(const FloatImage& opacity, const CameraPose& pose, glm::vec3 p) {
  const auto inside = [&](float by) {
    const glm::vec2 at = pose.Project(pose.ToCamera(p + glm::vec3(0, 0, by)));
    return opacity.Between(at.x, at.y) - 0.5F;
  };
  constexpr float kStep = 0.5F;
  if (inside(kReach) > 0) return {};
  for (float by = kReach - kStep; by >= -kReach; by -= kStep) {
    const float here = inside(by);
    if (here <= 0) continue;
    const float beyond = inside(by + kStep);
    return by + kStep * here / std::max(here - beyond, 1e-6F);
  }
  return {};
}

float MeanForward(const FloatImage& opacity, const CameraPose& pose,
                  const std::vector<glm::vec3>& line) {
  float sum = 0;
  for (const glm::vec3& p : line) {
    sum += std::abs(Forward(opacity, pose, p).value_or(kReach)) / static_cast<float>(line.size());
  }
  return sum;
}

/// Scale, place and lean of the profile once more, from where the outline really is.
CameraPose Refine(const FloatImage& opacity, CameraPose pose, const std::vector<glm::vec3>& line) {
  for (int round = 0; round < 6; ++round) {
    std::vector<glm::vec3> places;
    std::vector<glm::vec2> pixels;
    for (const glm::vec3& p : line) {
      const auto by = Forward(opacity, pose, p);
      if (!by) continue;
      places.push_back(p);
      pixels.push_back(pose.Project(pose.ToCamera(p + glm::vec3(0, 0, *by))));
    }
    if (places.size() < line.size() / 2) return pose;
    CameraPose best = pose;
    float off = MeanForward(opacity, pose, line);
    for (const float lean : {-2.0F, -1.0F, -0.4F, 0.0F, 0.4F, 1.0F, 2.0F}) {
      const CameraPose next =
          PoseWithTurn(places, pixels, pose.turn + glm::vec3(0, 0, glm::radians(lean)));
      const float at = MeanForward(opacity, next, line);
      if (at >= off) continue;
      off = at;
      best = next;
    }
    pose = best;
  }
  return pose;
}

/// What depth lacks at heights along the profile, evened out.
struct DepthGaps {
  std::vector<float> y, by;
  float At(float height) const {
    constexpr float kEven = 2.2F;  // millimetres
    float sum = 0, weight = 1e-3F;
    for (std::size_t i = 0; i < y.size(); ++i) {
      const float off = (y[i] - height) / kEven;
      const float w = std::exp(-0.5F * off * off);
      sum += w * by[i];
      weight += w;
    }
    return sum / weight;
  }
};

}  // namespace

vm::Result<PoseFit> RefineDepthByProfile(const BaseHead& base, const FloatImage& opacity,
                                         Fit& fit) {
  const auto guess = Search(ProfileOf(base, fit.head, kThroat), opacity);
  const auto line = ProfileOf(base, fit.head, 1);
  const auto refused = [] {
    return vm::Fail(vm::Errc::kBadValue,
                    "no face is found in it, and no outline that could be the profile of the first "
                    "photo's");
  };
  if (!guess || guess->off > kMostOff || guess->alike < kLeastAlike) return refused();
  std::vector<glm::vec2> pixels;
  for (const glm::vec3& p : line) pixels.push_back(guess->At(p));
  PoseFit view;
  view.pose = PoseWithTurn(
      line, pixels, {0, glm::radians(90.0F) * static_cast<float>(guess->direction), -guess->tilt});
  view.pose = Refine(opacity, view.pose, line);
  view.residual_mm = MeanForward(opacity, view.pose, line);
  if (view.residual_mm > kMostOff) return refused();
  for (int round = 0; round < 3; ++round) {
    const auto now = ProfileOf(base, fit.head, 1);
    if (round > 0) view.pose = Refine(opacity, view.pose, now);
    DepthGaps gaps;
    for (const glm::vec3& p : now) {
      const auto by = Forward(opacity, view.pose, p);
      if (!by) continue;
      gaps.y.push_back(p.y);
      gaps.by.push_back(*by);
    }
    // Beside the middle the outline says less and less.
    constexpr float kWide = 24, kMost = 6;
    for (LandmarkConstraint& constraint : fit.targets.constraints) {
      const glm::vec3 p = constraint.on_head.On(fit.head.posed_vertices);
      const float part = std::exp(-p.x * p.x / (kWide * kWide));
      constraint.z += part * std::clamp(gaps.At(p.y), -kMost, kMost);
    }
    WarpToLandmarks(base, fit.targets, fit.head);
  }
  return view;
}

}  // namespace facefit
