#include "face_fit/fit/profile_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

#include "face_fit/picture/pixels.h"
#include "face_fit/picture/plane.h"
#include "face_fit/surface/triangles.h"

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
constexpr float kOutlierMm = 8;             // a place farther off than this counts as this
constexpr float kScorePerMm = 0.05F;        // concordance that a millimetre of distance is worth

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

float Score(const ProfilePlacement& placement) {
  return placement.concordance - kScorePerMm * placement.off;
}

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
  if (placement.off > kMostProfileOffMm) return false;
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
        if (Compare(line, columns, other) && Score(other) > Score(placement)) placement = other;
      }
    }
  }
  return placement;
}

}  // namespace

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

glm::vec2 ProfilePlacement::At(glm::vec3 p) const {
  const glm::vec2 v(static_cast<float>(direction) * (p.z - middle.z), middle.y - p.y);
  return glm::vec2(column, row) + scale * Rotated(v, tilt);
}

std::optional<ProfilePlacement> FindProfile(const FittedHead& fitted, const FloatImage& opacity) {
  const std::vector<glm::vec3> line = ProfileOf(fitted, kThroat);
  const std::array outlines{Outline(opacity, 1), Outline(opacity, -1)};
  const auto seen = [](float column) { return column >= 0; };
  const auto top = std::ranges::find_if(outlines[0], seen) - outlines[0].begin();
  const auto below = std::find_if(outlines[0].rbegin(), outlines[0].rend(), seen).base();
  const auto bottom = below - outlines[0].begin() - 1;
  const auto tall = static_cast<float>(bottom - top);
  if (tall < kLeastTall || line.size() < kLeastPlaces) return {};
  const glm::vec3 middle = line[line.size() / 2];
  // A throat or the back of a head lies as near the line as another's nose; but it has no nose.
  ProfilePlacement best;
  for (const int direction : {1, -1}) {
    const auto& columns = outlines[direction > 0 ? 0 : 1];
    ProfilePlacement found;
    for (float scale = tall / kElbowsMm; scale < tall / kHeadMm; scale *= kScaleStep) {
      for (const float degrees : kLeanDegrees) {
        const float step = std::max(kRowStepMm * scale, 1.0F);
        for (auto row = static_cast<float>(top); row < static_cast<float>(bottom); row += step) {
          ProfilePlacement placement{.direction = direction,
                                     .scale = scale,
                                     .tilt = glm::radians(degrees),
                                     .row = row,
                                     .middle = middle};
          if (Compare(line, columns, placement) && Score(placement) > Score(found))
            found = placement;
        }
      }
    }
    if (found.off < kMostProfileOffMm) found = RefinedPlacement(line, columns, found);
    if (direction > 0 || Score(found) >= Score(best)) best = found;
  }
  if (best.off > kMostProfileOffMm || best.concordance < kLeastConcordance) return {};
  return best;
}

}  // namespace facefit
