#include "face_fit/side/profile_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/trigonometric.hpp>
#include <utility>

#include "face_fit/image/median.h"
#include "face_fit/image/plane.h"
#include "face_fit/side/correlation.h"
#include "face_fit/surface/triangles.h"

namespace facefit {
namespace {

// The profile line of the head.
constexpr float kLineStepMm = 2;  // between two points, in height
// Half width of the strip along the middle of the face that forms the outline.
constexpr float kHalfWidthMm = 13;
constexpr float kThroatMm = 16;       // below the chin, where the outline goes back
constexpr float kAboveNasionMm = 16;  // higher up there may be hair

// The search: figures reach from above the head to the throat at least, to the elbows at most;
// people hold cameras no more askew than this.
constexpr float kMinHeightPx = 60;      // smaller figures show no profile
constexpr std::size_t kMinPoints = 30;  // of the profile, about 6 cm
constexpr float kHeadMm = 180, kElbowsMm = 620;
constexpr float kScaleStep = 1.05F;  // from one scale to the next
constexpr float kRowStepMm = 1.5F;   // and between rows
constexpr std::array kLeanDegrees = {-24.0F, -16.0F, -8.0F, 0.0F, 8.0F, 16.0F, 24.0F};

// When outline and profile count as the same line.
constexpr float kMinConcordance = 0.92F;  // of both lines with their linear trends removed
constexpr float kOutlierMm = 8;           // distances are clamped to this
constexpr float kScorePerMm = 0.05F;  // concordance that a millimetre of mean distance outweighs

using OutlineColumns = std::vector<std::optional<float>>;
/// Returns for each row the figure's outermost column on a side; nothing where there is none.
OutlineColumns OutlineColumnsOf(const Mask& opacity, PhotoEdge side) {
  OutlineColumns columns(static_cast<std::size_t>(opacity.height));
  for (int y = 0; y < opacity.height; ++y) {
    for (int k = 0; k < opacity.width; ++k) {
      const int x = side == PhotoEdge::kRight ? opacity.width - 1 - k : k;
      if (opacity(x, y) < 0.5F) continue;
      columns[static_cast<std::size_t>(y)] = static_cast<float>(x) + 0.5F;
      break;
    }
  }
  return columns;
}

/// A placement and how well the profile matches the outline there.
struct ProfileMatch {
  ProfilePlacement placement;
  float gap_mm;       ///< mean distance
  float concordance;  ///< with linear trends removed, -1..1
  float Score() const { return concordance - kScorePerMm * gap_mm; }
};

/// Returns the concordance of two lines of equal length with means and slopes removed (Lin, A
/// concordance correlation coefficient to evaluate reproducibility, Biometrics 1989): 1 = equal.
float Concordance(std::vector<float> a, std::vector<float> b) {
  const float half = 0.5F * static_cast<float>(a.size() - 1);
  const auto at = [half](std::size_t i) { return glm::vec2(static_cast<float>(i) - half, 0); };
  RemoveTrend(a, at);
  RemoveTrend(b, at);
  const auto [aa, bb, ab] = ProductSums(a, b);
  return 2 * ab / (aa + bb + 2e-6F);
}

/// Returns how well the profile of that size, tilt and row matches the outline, in the column where
/// the two are nearest; nothing if it does not fit the image or lies too far from the outline.
std::optional<ProfileMatch> MatchOf(const std::vector<glm::vec3>& line,
                                    const OutlineColumns& columns, ProfilePlacement placement) {
  placement.pixel.x = 0;
  std::vector<float> profile, gaps;
  profile.reserve(line.size());
  gaps.reserve(line.size());
  for (const glm::vec3& p : line) {
    const glm::vec2 pixel = placement.PixelOf(p);
    if (pixel.y < 0 || pixel.y >= static_cast<float>(columns.size())) return {};
    const auto column = columns[static_cast<std::size_t>(pixel.y)];
    if (!column) return {};
    profile.push_back(pixel.x);
    gaps.push_back(*column - pixel.x);
  }
  placement.pixel.x = Median(gaps);
  float gap_mm = 0;
  for (const float gap : gaps) {
    gap_mm += std::min(std::abs(gap - placement.pixel.x) / placement.pixels_per_mm, kOutlierMm) /
              static_cast<float>(line.size());
  }
  if (gap_mm > kMaxProfileGapMm) return {};
  std::vector<float> outline = std::move(gaps);
  for (std::size_t i = 0; i < outline.size(); ++i) outline[i] += profile[i];
  return ProfileMatch{placement, gap_mm, Concordance(std::move(profile), std::move(outline))};
}

/// Improves a placement in ever smaller steps of size, height and tilt (pattern search).
ProfileMatch BestNearby(const std::vector<glm::vec3>& line, const OutlineColumns& columns,
                        ProfileMatch best) {
  constexpr float kFirstScale = 0.025F, kFirstDegrees = 3;
  for (float step = 1; step > 0.1F; step *= 0.6F) {
    for (int round = 0; round < 4; ++round) {
      const ProfilePlacement from = best.placement;
      for (const glm::vec3 direction :
           {glm::vec3(1, 0, 0), glm::vec3(-1, 0, 0), glm::vec3(0, 1, 0), glm::vec3(0, -1, 0),
            glm::vec3(0, 0, 1), glm::vec3(0, 0, -1)}) {
        ProfilePlacement other = from;
        other.pixels_per_mm *= 1 + kFirstScale * step * direction.x;
        other.pixel.y += kRowStepMm * other.pixels_per_mm * step * direction.y;
        other.tilt_rad += glm::radians(kFirstDegrees * step) * direction.z;
        const auto match = MatchOf(line, columns, other);
        if (match && match->Score() > best.Score()) best = *match;
      }
    }
  }
  return best;
}

struct FigureRows {
  float top, bottom;
  float Height() const { return bottom - top; }
};
/// Returns the first and the last row of a figure.
FigureRows FigureRowsOf(const OutlineColumns& columns) {
  const auto covered = [](const auto& column) { return column.has_value(); };
  const auto top = std::ranges::find_if(columns, covered) - columns.begin();
  const auto below = std::find_if(columns.rbegin(), columns.rend(), covered).base();
  return {static_cast<float>(top), static_cast<float>(below - columns.begin() - 1)};
}

/// Returns the best of all placements on one outline; `towards`: as of ProfilePlacement.
std::optional<ProfileMatch> SearchOutline(const std::vector<glm::vec3>& line,
                                          const OutlineColumns& columns, PhotoEdge towards,
                                          const FigureRows& rows) {
  std::optional<ProfileMatch> best;
  for (float pixels_per_mm = rows.Height() / kElbowsMm; pixels_per_mm < rows.Height() / kHeadMm;
       pixels_per_mm *= kScaleStep) {
    for (const float degrees : kLeanDegrees) {
      const float step = std::max(kRowStepMm * pixels_per_mm, 1.0F);
      for (float row = rows.top; row < rows.bottom; row += step) {
        const auto match = MatchOf(line, columns,
                                   {.towards = towards,
                                    .pixels_per_mm = pixels_per_mm,
                                    .tilt_rad = glm::radians(degrees),
                                    .pixel = {0, row},
                                    .middle = line[line.size() / 2]});
        if (match && (!best || match->Score() > best->Score())) best = match;
      }
    }
  }
  if (best) best = BestNearby(line, columns, *best);
  return best;
}

}  // namespace

std::vector<glm::vec3> ProfileOf(const FittedHead& fitted, float below_chin_mm) {
  const float low = fitted.PositionOf(point::kChin).y - below_chin_mm;
  const float high = fitted.PositionOf(point::kNasion).y + kAboveNasionMm;
  const auto count = static_cast<std::size_t>(std::max(high - low, kLineStepMm) / kLineStepMm) + 1;
  std::vector<std::optional<float>> foremost(count);
  ForEachSkinAndLipTriangle(fitted.base->surface(), [&](const MeshTriangle& triangle) {
    for (std::size_t c = 0; c < 3; ++c) {
      const glm::vec3 a = fitted.vertices[triangle.corner[c]],
                      b = fitted.vertices[triangle.corner[(c + 1) % 3]];
      for (const float along : {0.0F, 0.25F, 0.5F, 0.75F}) {
        const glm::vec3 p = glm::mix(a, b, along);
        const float step = (p.y - low) / kLineStepMm;
        if (std::abs(p.x) > kHalfWidthMm || step < 0) continue;
        const auto i = static_cast<std::size_t>(step + 0.5F);
        if (i < count && (!foremost[i] || p.z > *foremost[i])) foremost[i] = p.z;
      }
    }
  });
  std::vector<glm::vec3> line;
  for (std::size_t i = 0; i < count; ++i) {
    if (foremost[i]) line.emplace_back(0, low + kLineStepMm * static_cast<float>(i), *foremost[i]);
  }
  return line;
}

glm::vec2 ProfilePlacement::PixelOf(glm::vec3 position) const {
  const glm::vec2 offset(Outward(towards) * (position.z - middle.z), middle.y - position.y);
  return pixel + pixels_per_mm * Rotated(offset, tilt_rad);
}

std::optional<ProfilePlacement> FindProfile(const FittedHead& fitted, const Mask& opacity) {
  const std::vector<glm::vec3> line = ProfileOf(fitted, kThroatMm);
  std::optional<ProfileMatch> best;
  for (const PhotoEdge towards : {PhotoEdge::kRight, PhotoEdge::kLeft}) {
    const OutlineColumns columns = OutlineColumnsOf(opacity, towards);
    const FigureRows rows = FigureRowsOf(columns);
    if (rows.Height() < kMinHeightPx || line.size() < kMinPoints) return {};
    const auto match = SearchOutline(line, columns, towards, rows);
    if (match && (!best || match->Score() >= best->Score())) best = match;
  }
  // A throat or the back of a head may lie as near to the profile as another person's nose, but its
  // form differs.
  if (!best || best->concordance < kMinConcordance) return {};
  return best->placement;
}

}  // namespace facefit
