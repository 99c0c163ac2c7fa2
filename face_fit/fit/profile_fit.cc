#include "face_fit/fit/profile_fit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <optional>
#include <utility>

#include "face_fit/fit/landmark_warp.h"
#include "face_fit/fit/least_squares.h"
#include "face_fit/picture/pixels.h"
#include "face_fit/surface/rasterizer.h"

namespace facefit {
namespace {

// The profile line of the head. Millimetres.
constexpr float kBin = 2;           // between two places, in height
constexpr float kHalfWidth = 13;    // of the middle of the face, which alone makes the outline
constexpr float kThroat = 16;       // below the chin: there the outline goes back
constexpr float kAboveNasion = 16;  // higher up there may be hair

// Where it is looked for: the person reaches from above the head to the throat at least, to the
// elbows at most. People lean a photo's camera no farther.
constexpr float kLeastTall = 60;          // pixels; smaller figures show no profile
constexpr std::size_t kLeastPlaces = 30;  // of the line, some 6 cm
constexpr float kHeadMm = 180, kElbowsMm = 620;
constexpr float kScaleStep = 1.05F;  // from one scale to the next
constexpr float kRowStepMm = 1.5F;   // and from one row
constexpr std::array kLeanDegrees = {-24.0F, -16.0F, -8.0F, 0.0F, 8.0F, 16.0F, 24.0F};

// What counts as the same line.
constexpr float kLeastConcordance = 0.92F;  // of both lines without their slopes
constexpr float kMostOffMm = 4;             // mean distance: another person's face lies farther
constexpr float kOutlierMm = 8;             // a place farther off than this counts as this
constexpr float kScorePerMm = 0.05F;        // concordance that a millimetre of distance is worth

// How depth is corrected. Millimetres.
constexpr float kReach = 13;  // before and behind the line, where the outline is looked for
constexpr float kReachStep = 0.5F;
constexpr float kEven = 2.2F;         // height over which gaps are evened out (Gaussian sigma)
constexpr float kWide = 24;           // from the middle of the face: there 1/e of the gap counts
constexpr float kMostCorrection = 6;  // in one round
constexpr int kProfileRounds = 3;

/// The profile of the fitted head from the chin up: heights in even steps, and how far forward.
std::vector<glm::vec3> ProfileOf(const FittedHead& fitted, float below_chin) {
  const float low = fitted.At(point::kChin).y - below_chin;
  const float high = fitted.At(point::kNasion).y + kAboveNasion;
  const auto count = static_cast<std::size_t>(std::max(high - low, kBin) / kBin) + 1;
  std::vector<float> z(count, -1e9F);
  ForSkinTriangles(fitted.base->head->topology(), [&](const std::uint32_t* t) {
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::vec3 a = fitted.posed_vertices[t[c]], b = fitted.posed_vertices[t[(c + 1) % 3]];
      for (const float along : {0.0F, 0.25F, 0.5F, 0.75F}) {
        const glm::vec3 p = glm::mix(a, b, along);
        const float bin = (p.y - low) / kBin;
        if (std::abs(p.x) > kHalfWidth || bin < 0) continue;
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
      if (opacity(x, y) < 0.5F) continue;
      columns[static_cast<std::size_t>(y)] = static_cast<float>(x) + 0.5F;
      break;
    }
  }
  return columns;
}

/// Where the profile may lie: the place of its middle, pixels by millimetre, how it leans.
struct ProfilePlacement {
  int direction = 1;
  float scale = 1, tilt = 0, row = 0, column = 0;
  float off = 1e9F;        // mean distance, millimetres
  float concordance = -1;  // of both lines without their slopes, -1..1
  float Score() const { return concordance - kScorePerMm * off; }
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

/// Fills column, off and concordance of a placement that has the rest; false if it does not fit the
/// picture.
bool Compare(const std::vector<glm::vec3>& line, const std::vector<float>& columns,
             ProfilePlacement& placement) {
  placement.column = 0;
  std::vector<float> ours, beside;
  ours.reserve(line.size());
  beside.reserve(line.size());
  for (const glm::vec3& p : line) {
    const glm::vec2 at = placement.At(p);
    if (at.y < 0 || at.y >= static_cast<float>(columns.size())) return false;
    const float column = columns[static_cast<std::size_t>(at.y)];
    if (column < 0) return false;
    ours.push_back(at.x);
    beside.push_back(column - at.x);
  }
  placement.column = Median(beside);
  placement.off = 0;
  for (const float x : beside) {
    placement.off += std::min(std::abs(x - placement.column) / placement.scale, kOutlierMm) /
                     static_cast<float>(line.size());
  }
  if (placement.off > kMostOffMm) return false;
  for (std::size_t i = 0; i < ours.size(); ++i) beside[i] += ours[i];
  placement.concordance = Concordance(std::move(ours), std::move(beside));
  return true;
}

/// Improves a placement in ever smaller steps of size, height and lean (pattern search).
ProfilePlacement RefinedPlacement(const std::vector<glm::vec3>& line,
                                  const std::vector<float>& columns, ProfilePlacement placement) {
  constexpr float kFirstScale = 0.025F, kFirstDegrees = 3;
  for (float step = 1; step > 0.1F; step *= 0.6F) {
    for (int round = 0; round < 4; ++round) {
      const ProfilePlacement from = placement;
      for (const glm::vec3 direction :
           {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0),
            glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
        ProfilePlacement other = from;
        other.scale *= 1 + kFirstScale * step * direction.x;
        other.row += kRowStepMm * other.scale * step * direction.y;
        other.tilt += glm::radians(kFirstDegrees * step) * direction.z;
        if (Compare(line, columns, other) && other.Score() > placement.Score()) placement = other;
      }
    }
  }
  return placement;
}

std::optional<ProfilePlacement> FindProfile(const std::vector<glm::vec3>& line,
                                            const FloatImage& opacity) {
  int top = opacity.height, bottom = -1;
  for (int y = 0; y < opacity.height; ++y) {
    for (int x = 0; x < opacity.width; ++x) {
      if (opacity(x, y) < 0.5F) continue;
      top = std::min(top, y);
      bottom = std::max(bottom, y);
    }
  }
  const auto tall = static_cast<float>(bottom - top);
  if (tall < kLeastTall || line.size() < kLeastPlaces) return {};
  const glm::vec3 middle = line[line.size() / 2];
  std::array<ProfilePlacement, 2> found;
  for (const int direction : {1, -1}) {
    const auto columns = Outline(opacity, direction);
    ProfilePlacement& best = found[direction > 0 ? 0 : 1];
    for (float scale = tall / kElbowsMm; scale < tall / kHeadMm; scale *= kScaleStep) {
      for (const float degrees : kLeanDegrees) {
        const float step = std::max(kRowStepMm * scale, 1.0F);
        for (auto row = static_cast<float>(top); row < static_cast<float>(bottom); row += step) {
          ProfilePlacement placement{.direction = direction,
                                     .scale = scale,
                                     .tilt = glm::radians(degrees),
                                     .row = row,
                                     .middle = middle};
          if (Compare(line, columns, placement) && placement.Score() > best.Score())
            best = placement;
        }
      }
    }
    if (best.off < kMostOffMm) best = RefinedPlacement(line, columns, best);
  }
  // A throat or the back of a head lies as near the line as another's nose; but it has no nose.
  return found[0].Score() > found[1].Score() ? found[0] : found[1];
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
    const glm::vec2 u = pose.Pixel(places[i]);
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
std::optional<float> DepthGap(const FloatImage& opacity, const CameraPose& pose, glm::vec3 p) {
  const auto inside = [&](float by) {
    const glm::vec2 at = pose.Pixel(p + glm::vec3(0, 0, by));
    return opacity.Between(at.x, at.y) - 0.5F;
  };
  if (inside(kReach) > 0) return {};
  for (float by = kReach - kReachStep; by >= -kReach; by -= kReachStep) {
    const float here = inside(by);
    if (here <= 0) continue;
    const float beyond = inside(by + kReachStep);
    return by + kReachStep * here / std::max(here - beyond, 1e-6F);
  }
  return {};
}

float MeanDepthGap(const FloatImage& opacity, const CameraPose& pose,
                   const std::vector<glm::vec3>& line) {
  float sum = 0;
  for (const glm::vec3& p : line) {
    sum += std::abs(DepthGap(opacity, pose, p).value_or(kReach)) / static_cast<float>(line.size());
  }
  return sum;
}

/// Scale, place and lean of the profile once more, from where the outline really is.
CameraPose FitPoseToOutline(const FloatImage& opacity, CameraPose pose,
                            const std::vector<glm::vec3>& line) {
  for (int round = 0; round < 6; ++round) {
    std::vector<glm::vec3> places;
    std::vector<glm::vec2> pixels;
    for (const glm::vec3& p : line) {
      const auto by = DepthGap(opacity, pose, p);
      if (!by) continue;
      places.push_back(p);
      pixels.push_back(pose.Pixel(p + glm::vec3(0, 0, *by)));
    }
    if (places.size() < line.size() / 2) return pose;
    CameraPose best = pose;
    float off = MeanDepthGap(opacity, pose, line);
    for (const float lean : {-2.0F, -1.0F, -0.4F, 0.0F, 0.4F, 1.0F, 2.0F}) {
      const CameraPose next =
          PoseWithTurn(places, pixels, pose.turn + glm::vec3(0, 0, glm::radians(lean)));
      const float at = MeanDepthGap(opacity, next, line);
      if (at >= off) continue;
      off = at;
      best = next;
    }
    pose = best;
  }
  return pose;
}

/// What depth lacks at heights along the profile, evened out.
class DepthGaps {
 public:
  DepthGaps(const FloatImage& opacity, const CameraPose& pose, const std::vector<glm::vec3>& line) {
    for (const glm::vec3& p : line) {
      if (const auto gap = DepthGap(opacity, pose, p)) gaps_.emplace_back(p.y, *gap);
    }
  }
  float At(float height) const {
    float sum = 0, weights = 1e-3F;
    for (const auto& [y, gap] : gaps_) {
      const float off = (y - height) / kEven;
      const float weight = std::exp(-0.5F * off * off);
      sum += weight * gap;
      weights += weight;
    }
    return sum / weights;
  }

 private:
  std::vector<std::pair<float, float>> gaps_;  // heights and depths, millimetres
};

/// Moves the targets of the fit forward or back by the gaps, the less the farther they lie beside
/// the middle of the face, and warps the head again.
void CorrectDepth(const DepthGaps& gaps, Fit& fit) {
  for (LandmarkConstraint& constraint : fit.targets.constraints) {
    const glm::vec3 p = constraint.on_head.On(fit.head.posed_vertices);
    const float weight = std::exp(-p.x * p.x / (kWide * kWide));
    constraint.z += weight * std::clamp(gaps.At(p.y), -kMostCorrection, kMostCorrection);
  }
  WarpToLandmarks(fit.targets, fit.head);
}

}  // namespace

vm::Result<PoseFit> RefineDepthByProfile(const FloatImage& opacity, Fit& fit) {
  const auto placement = FindProfile(ProfileOf(fit.head, kThroat), opacity);
  const auto line = ProfileOf(fit.head, 1);
  const auto refused = [] {
    return vm::Fail(vm::Errc::kBadValue,
                    "no face is found in it, and no outline that could be the profile of the first "
                    "photo's");
  };
  if (!placement || placement->off > kMostOffMm || placement->concordance < kLeastConcordance)
    return refused();
  std::vector<glm::vec2> pixels;
  for (const glm::vec3& p : line) pixels.push_back(placement->At(p));
  PoseFit view;
  view.pose = PoseWithTurn(
      line, pixels,
      {0, glm::radians(90.0F) * static_cast<float>(placement->direction), -placement->tilt});
  view.pose = FitPoseToOutline(opacity, view.pose, line);
  view.residual_mm = MeanDepthGap(opacity, view.pose, line);
  if (view.residual_mm > kMostOffMm) return refused();
  for (int round = 0; round < kProfileRounds; ++round) {
    const auto now = ProfileOf(fit.head, 1);
    if (round > 0) view.pose = FitPoseToOutline(opacity, view.pose, now);
    CorrectDepth(DepthGaps(opacity, view.pose, now), fit);
  }
  return view;
}

}  // namespace facefit
